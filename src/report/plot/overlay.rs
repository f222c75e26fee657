//! The paths of a program and of its conversion in one picture: the source's wide and pale, the target's thin over it.

use super::super::html::escaped;
use super::view::{Bounds, View};
use super::{Drawing, Kind, Path, Point};
use crate::control::trace::Event;
use std::fmt::Write;

/// Side of a drawing, in pixels.
const SIZE: f64 = 330.0;
/// Room round a drawing.
const MARGIN: f64 = 46.0;

/// Points that are drawn of a side, about; of a longer path some are left out.
const POINTS: usize = 1200;

/// Holes and touches that are drawn of a side.
const MARKS: usize = 300;

/// Both paths as an SVG; none where nothing moves. `id` tells its parts from those of other pictures in the page.
pub fn overlay(source: &[Event], target: Option<&[Event]>, id: usize, title: &str) -> Option<String> {
    let source = Path::of(source);
    let target = target.map(Path::of);
    let mut both = Path::default();
    for path in [Some(&source), target.as_ref()].into_iter().flatten() {
        both.strokes.extend(path.strokes.iter().cloned());
    }
    if both.strokes.is_empty() {
        return None;
    }
    let (width, height) = (2.0 * SIZE + 3.0 * MARGIN, SIZE + 1.7 * MARGIN);
    let mut out = format!(
        "<svg role=\"img\" width=\"{width}\" height=\"{height:.0}\" viewBox=\"0 0 {width} {height:.0}\"><title>{}</title>\n",
        escaped(title)
    );
    let askew = Drawing { axes: None, project: super::ISOMETRIC };
    for (column, drawing) in [both.flat(), askew].into_iter().enumerate() {
        let corner = (MARGIN + column as f64 * (SIZE + MARGIN), 0.6 * MARGIN);
        let framed = both_framed(&source, target.as_ref());
        let view = View::new(Bounds::of(framed.into_iter().map(drawing.project)), corner, SIZE);
        frame(&both, &view, &drawing, (id, column), corner, &mut out);
        side(&source, &view, &drawing, ["sr", "sc"], &mut out);
        if let Some(target) = &target {
            side(target, &view, &drawing, ["tr", "tc"], &mut out);
        }
        out.push_str("</g>\n");
        view.scale(&mut out);
    }
    out.push_str("</svg>\n");
    Some(out)
}

/// The points that a drawing must hold.
fn both_framed(source: &Path, target: Option<&Path>) -> Vec<Point> {
    let mut points = source.framed();
    points.extend(target.map(Path::framed).unwrap_or_default());
    points
}

/// The square, its axes, and the clipping of what goes on behind its edge.
fn frame(
    both: &Path,
    view: &View,
    drawing: &Drawing,
    (id, column): (usize, usize),
    (left, top): (f64, f64),
    out: &mut String,
) {
    let name = match drawing.axes {
        Some((across, up)) => format!("{across}{up}, mm"),
        None => "isometric, mm".to_owned(),
    };
    let _ = writeln!(
        out,
        "<text x=\"{left}\" y=\"{:.0}\">{name}</text><rect x=\"{left}\" y=\"{top:.1}\" width=\"{SIZE}\" height=\"{SIZE}\" class=\"fr\"/>",
        top - 6.0
    );
    match drawing.axes {
        Some(names) => view.axes(names, out),
        None => {
            let arm = view.span() * 0.1;
            let foot = view.free_corner(both.points().map(drawing.project));
            let zero = (drawing.project)([0.0; 3]);
            for (label, end) in [("X", [arm, 0.0, 0.0]), ("Y", [0.0, arm, 0.0]), ("Z", [0.0, 0.0, arm])] {
                view.arrow(foot, zero, (drawing.project)(end), label, out);
            }
        }
    }
    let _ = writeln!(
        out,
        "<clipPath id=\"k{id}-{column}\"><rect x=\"{left}\" y=\"{top:.1}\" width=\"{SIZE}\" height=\"{SIZE}\"/></clipPath><g clip-path=\"url(#k{id}-{column})\">"
    );
}

/// The path of a side: cuts over rapids.
fn side(path: &Path, view: &View, drawing: &Drawing, [rapid, cut]: [&str; 2], out: &mut String) {
    let place = |point: &Point| view.place((drawing.project)(*point));
    let all = path.points().count();
    let every = all.div_ceil(POINTS).max(1);
    for (kind, class) in [(Kind::Rapid, rapid), (Kind::Cut, cut)] {
        let mut way = String::new();
        let strokes = path.strokes.iter().filter(|stroke| stroke.kind == kind);
        // Many short strokes are as long as one long one.
        let thinned = path.strokes.len().div_ceil(POINTS).max(1);
        for stroke in strokes.step_by(thinned) {
            let last = stroke.points.len().saturating_sub(1);
            let kept = stroke.points.iter().enumerate().filter(|(at, _)| at % every == 0 || *at == last);
            let seen = kept.map(|(_, point)| place(point)).filter(|(x, y)| x.is_finite() && y.is_finite());
            for (at, (x, y)) in seen.enumerate() {
                let _ = write!(way, "{}{x:.1} {y:.1}", if at == 0 { "M" } else { " " });
            }
        }
        if !way.is_empty() {
            let _ = writeln!(out, "<path class=\"{class}\" d=\"{way}\"/>");
        }
    }
    for hole in path.holes.iter().take(MARKS) {
        let (x, y) = place(hole);
        let _ = writeln!(out, "<circle class=\"{cut}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>");
    }
    for touch in path.touches.iter().take(MARKS) {
        let (x, y) = place(touch);
        let _ = writeln!(out, "<path class=\"{cut}\" d=\"M{:.1} {y:.1}h8m-4 -4v8\"/>", x - 4.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::trace::{EventKind, Place, Position, Told};

    fn feeds(points: &[[f64; 2]]) -> Vec<Event> {
        let at = |[x, y]: [f64; 2]| {
            let mut position = Position::default();
            (position.0[0], position.0[1]) = (x, y);
            position
        };
        let event = |pair: &[[f64; 2]]| Event {
            at: Place::default(),
            what: EventKind::Rapid { from: at(pair[0]), to: at(pair[1]) },
            rounded: 0.0,
            told: Told::Plain,
            open: [false; 2],
        };
        points.windows(2).map(event).collect()
    }

    #[test]
    fn a_picture_is_bounded_and_has_both_sides() {
        let long: Vec<[f64; 2]> = (0..50_000).map(|at| [f64::from(at % 100), f64::from(at)]).collect();
        let drawn = overlay(&feeds(&long), Some(&feeds(&long)), 7, "<a>").unwrap();
        assert!(drawn.len() < 120_000, "{}", drawn.len());
        assert_eq!((drawn.matches("class=\"sr\"").count(), drawn.matches("class=\"tr\"").count()), (2, 2));
        assert!(drawn.contains("<title>&lt;a&gt;</title>") && drawn.contains("id=\"k7-0\""));
    }

    #[test]
    fn numbers_without_a_place_are_not_drawn() {
        let odd = feeds(&[[0.0, 0.0], [f64::NAN, 1.0], [f64::INFINITY, 2.0], [3.0, 4.0]]);
        let drawn = overlay(&odd, None, 1, "").unwrap();
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
        assert_eq!(overlay(&[], Some(&[]), 1, ""), None);
    }
}

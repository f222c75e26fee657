//! The paths of a program and of its counterpart over each other: the source's wide and pale, the target's thin over it.

use super::super::html::escaped;
use super::path::Name;
use super::view::{Bounds, View};
use super::{Coordinates, Drawing, Kind, Path, Point};
use crate::verify::{Picture, Seen};
use std::fmt::Write;

/// How large two drawings side by side are, and how much of a path they show.
#[derive(Clone, Copy)]
pub(super) struct Sheet {
    /// Side of a drawing, in pixels.
    pub size: f64,
    /// Room round a drawing.
    pub margin: f64,
    /// Points that are drawn of a side, about; of a longer path some are left out.
    pub points: usize,
    /// Holes and touches that are drawn of a side.
    pub marks: usize,
}

impl Sheet {
    /// The width of both drawings with the room round them.
    pub fn width(&self) -> f64 {
        2.0 * self.size + 3.0 * self.margin
    }
}

/// In a page of many pictures.
const IN_A_PAGE: Sheet = Sheet { size: 330.0, margin: 46.0, points: 1200, marks: 300 };

/// Places that are marked at which the two differ.
const NAMED: usize = 40;

/// Both paths.
pub(super) struct Both {
    pub source: Path,
    pub target: Option<Path>,
    /// What a drawing must hold, and what it avoids.
    all: Path,
}

impl Both {
    /// Both runs of a picture, with the places at which they differ; none where nothing moves.
    pub fn of(picture: &Picture, coordinates: Coordinates) -> Option<Self> {
        let changes = || picture.apart.changes.iter().take(NAMED);
        let name = |seen: &'_ Seen, told: bool| {
            if told { seen.moment.line.to_string() } else { String::new() }
        };
        // The new line stands beside both rings of a move that goes elsewhere; the old one where nothing else stands.
        let ours: Vec<Name<'_>> = changes()
            .filter_map(|change| Some((change.old.as_ref()?, change.new.is_none())))
            .map(|(old, alone)| Name { at: old.at, what: &old.what, name: name(old, alone) })
            .collect();
        let theirs: Vec<Name<'_>> = changes()
            .filter_map(|change| change.new.as_ref())
            .map(|new| Name { at: new.at, what: &new.what, name: name(new, true) })
            .collect();
        let target = picture.target.as_ref().map(|run| (run, theirs.as_slice()));
        Self::new(Path::of_both((&picture.source, &ours), target, coordinates))
    }

    /// None where nothing moves.
    fn new((source, target): (Path, Option<Path>)) -> Option<Self> {
        let mut all = Path::default();
        for path in [Some(&source), target.as_ref()].into_iter().flatten() {
            all.strokes.extend(path.strokes.iter().cloned());
        }
        (!all.strokes.is_empty()).then_some(Self { source, target, all })
    }

    /// The points that a drawing must hold.
    fn framed(&self) -> Vec<Point> {
        let mut points = self.source.framed();
        points.extend(self.target.as_ref().map(Path::framed).unwrap_or_default());
        points
    }
}

/// Both paths as an SVG, in the unit of the source and in work coordinates; none where nothing moves. `id` tells its parts from
/// those of other pictures in the page.
pub fn overlay(picture: &Picture, id: usize, title: &str) -> Option<String> {
    Some(in_a_page(&Both::of(picture, Coordinates::Work)?, id, title))
}

fn in_a_page(both: &Both, id: usize, title: &str) -> String {
    let sheet = IN_A_PAGE;
    let (width, height) = (sheet.width(), sheet.size + 1.7 * sheet.margin);
    let mut out = format!(
        "<svg role=\"img\" width=\"{width}\" height=\"{height:.0}\" viewBox=\"0 0 {width} {height:.0}\"><title>{}</title>\n",
        escaped(title)
    );
    drawings(both, &sheet, id, 0.6 * sheet.margin, &mut out);
    out.push_str("</svg>\n");
    out
}

/// From above and askew, below `top`.
pub(super) fn drawings(both: &Both, sheet: &Sheet, id: usize, top: f64, out: &mut String) {
    let askew = Drawing { axes: None, project: super::ISOMETRIC };
    for (column, drawing) in [both.all.flat(), askew].into_iter().enumerate() {
        let corner = (sheet.margin + column as f64 * (sheet.size + sheet.margin), top);
        let bounds = Bounds::of(both.framed().into_iter().map(drawing.project));
        let turned = both.source.diameters && drawing.axes == Some(('Z', 'X'));
        let view = View::new(bounds, corner, sheet.size);
        let view = view.in_unit(both.source.unit()).with_diameters(turned);
        frame(both, sheet, &view, &drawing, (id, column), corner, out);
        side(&both.source, sheet, &view, &drawing, ["sr", "sc"], out);
        if let Some(target) = &both.target {
            side(target, sheet, &view, &drawing, ["tr", "tc"], out);
        }
        out.push_str("</g>\n");
        for path in [Some(&both.source), both.target.as_ref()].into_iter().flatten() {
            marks(path, sheet, &view, &drawing, corner, out);
        }
        view.scale(out);
    }
}

/// The square, its axes, and the clipping of what goes on beyond its edge.
fn frame(
    both: &Both,
    sheet: &Sheet,
    view: &View,
    drawing: &Drawing,
    (id, column): (usize, usize),
    (left, top): (f64, f64),
    out: &mut String,
) {
    let (size, unit) = (sheet.size, both.source.unit());
    let name = match drawing.axes {
        Some((across, up)) if view.tells_diameters() => format!("{across}{up}, {unit}, {up} in diameters"),
        Some((across, up)) => format!("{across}{up}, {unit}"),
        None => format!("isometric, {unit}"),
    };
    let _ = writeln!(
        out,
        "<text x=\"{left}\" y=\"{:.0}\">{name}</text><rect x=\"{left}\" y=\"{top:.1}\" width=\"{size}\" height=\"{size}\" class=\"fr\"/>",
        top - 6.0
    );
    match drawing.axes {
        Some(names) => view.axes(names, out),
        None => view.cross(both.all.points(), drawing.project, out),
    }
    let _ = writeln!(
        out,
        "<clipPath id=\"k{id}-{column}\"><rect x=\"{left}\" y=\"{top:.1}\" width=\"{size}\" height=\"{size}\"/></clipPath><g clip-path=\"url(#k{id}-{column})\">"
    );
}

/// The path of a side: cuts over rapids.
fn side(path: &Path, sheet: &Sheet, view: &View, drawing: &Drawing, names: [&str; 2], out: &mut String) {
    let [rapid, cut] = names;
    let place = |point: &Point| view.place((drawing.project)(*point));
    let all = path.points().count();
    let every = all.div_ceil(sheet.points).max(1);
    for (kind, class) in [(Kind::Rapid, rapid), (Kind::Cut, cut)] {
        let mut way = String::new();
        let strokes = path.strokes.iter().filter(|stroke| stroke.kind == kind);
        // Many short strokes are as long as one long one.
        let thinned = path.strokes.len().div_ceil(sheet.points).max(1);
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
    let finite = |point: &&Point| point.iter().all(|value| value.is_finite());
    for hole in path.holes.iter().filter(finite).take(sheet.marks) {
        let (x, y) = place(hole);
        let _ = writeln!(out, "<circle class=\"{cut}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>");
    }
    for touch in path.touches.iter().filter(finite).take(sheet.marks) {
        let (x, y) = place(touch);
        let _ = writeln!(out, "<path class=\"{cut}\" d=\"M{:.1} {y:.1}h8m-4 -4v8\"/>", x - 4.0);
    }
}

/// Where a path starts and ends, and where something differs. What lies outside stands at the edge.
fn marks(
    path: &Path,
    sheet: &Sheet,
    view: &View,
    drawing: &Drawing,
    (left, top): (f64, f64),
    out: &mut String,
) {
    let place = |point: Point| {
        let (x, y) = view.place((drawing.project)(point));
        let inside = (x.clamp(left, left + sheet.size), y.clamp(top, top + sheet.size));
        (x.is_finite() && y.is_finite()).then_some(inside)
    };
    if let Some((x, y)) = path.points().next().and_then(place) {
        let _ = writeln!(out, "<circle class=\"en\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\"/>");
    }
    if let Some((x, y)) = path.points().last().and_then(place) {
        let _ = writeln!(
            out,
            "<rect class=\"en\" x=\"{:.1}\" y=\"{:.1}\" width=\"5\" height=\"5\"/>",
            x - 2.5,
            y - 2.5
        );
    }
    for mark in &path.marks {
        let Some((x, y)) = place(mark.at) else { continue };
        let _ = writeln!(
            out,
            "<circle class=\"ap\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"7\"/><text class=\"ap\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            x + 9.0,
            y - 5.0,
            escaped(&mark.name)
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rapids(points: &[[f64; 2]]) -> Path {
        let mut path = Path::default();
        for pair in points.windows(2) {
            path.line(Kind::Rapid, [pair[0][0], pair[0][1], 0.0], [pair[1][0], pair[1][1], 0.0]);
        }
        path
    }

    #[test]
    fn a_picture_is_bounded_and_has_both_sides() {
        let long: Vec<[f64; 2]> = (0..50_000).map(|at| [f64::from(at % 100), f64::from(at)]).collect();
        let drawn = in_a_page(&Both::new((rapids(&long), Some(rapids(&long)))).unwrap(), 7, "<a>");
        assert!(drawn.len() < 120_000, "{}", drawn.len());
        assert_eq!((drawn.matches("class=\"sr\"").count(), drawn.matches("class=\"tr\"").count()), (2, 2));
        assert!(drawn.contains("<title>&lt;a&gt;</title>") && drawn.contains("id=\"k7-0\""));
    }

    #[test]
    fn numbers_without_a_place_are_not_drawn() {
        let odd = rapids(&[[0.0, 0.0], [f64::NAN, 1.0], [f64::INFINITY, 2.0], [3.0, 4.0]]);
        let drawn = in_a_page(&Both::new((odd, None)).unwrap(), 1, "");
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
        assert!(Both::new((Path::default(), Some(Path::default()))).is_none());
    }
}

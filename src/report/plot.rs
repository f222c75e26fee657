//! The backplot: the tool's path from above and askew, as SVG.

mod overlay;
mod view;

pub use overlay::overlay;

use super::html::escaped;
use crate::control::trace::{Event, EventKind};
use std::fmt::Write;
use view::{Bounds, View};

/// A point of the path, millimetres.
type Point = [f64; 3];

/// A stretch of the path.
#[derive(Clone)]
struct Stroke {
    kind: Kind,
    points: Vec<Point>,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Rapid,
    Cut,
}

/// A way to look at the path: two of its axes, across and up, or none for askew.
struct Drawing {
    axes: Option<(char, char)>,
    project: fn(Point) -> (f64, f64),
}

/// What is drawn.
#[derive(Default)]
struct Path {
    strokes: Vec<Stroke>,
    holes: Vec<Point>,
    touches: Vec<Point>,
}

/// Thirty degrees to either side, Z up.
const ISOMETRIC: fn(Point) -> (f64, f64) = |[x, y, z]| {
    let (sin, cos) = (0.5, 0.866_025_403_784_438_6);
    ((x - y) * cos, (x + y) * sin + z)
};

/// Side of a drawing, in pixels.
const SIZE: f64 = 560.0;
/// Room round a drawing.
const MARGIN: f64 = 60.0;

/// The path as an SVG with two drawings: XY from above, and isometric. A path without a move along Y, as a
/// lathe's, is drawn over Z and X. The rapids before the first cut and after the last one end at the
/// edge of a drawing, so that the part fills it.
pub fn backplot(events: &[Event], title: &str) -> String {
    let path = Path::of(events);
    let mut out = String::new();
    let (width, height) = (2.0 * SIZE + 3.0 * MARGIN, SIZE + 2.5 * MARGIN);
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">"
    );
    let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>");
    let _ = writeln!(out, "<text x=\"{MARGIN}\" y=\"24\" font-size=\"16\">{}</text>", escaped(title));
    let flat = path.flat();
    for (column, drawing) in [flat, Drawing { axes: None, project: ISOMETRIC }].into_iter().enumerate() {
        let left = MARGIN + column as f64 * (SIZE + MARGIN);
        draw(&path, &drawing, (left, 1.25 * MARGIN), &mut out);
    }
    legend(height, &mut out);
    out.push_str("</svg>\n");
    out
}

fn draw(path: &Path, drawing: &Drawing, corner: (f64, f64), out: &mut String) {
    let project = drawing.project;
    let bounds = Bounds::of(path.framed().into_iter().map(project));
    let view = View::new(bounds, corner, SIZE);
    let name = match drawing.axes {
        Some((across, up)) => format!("{across}{up}, mm"),
        None => "isometric, mm".to_owned(),
    };
    let _ = writeln!(
        out,
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{SIZE}\" height=\"{SIZE}\" fill=\"none\" stroke=\"#ccc\"/>",
        corner.0, corner.1
    );
    let _ =
        writeln!(out, "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"#555\">{name}</text>", corner.0, corner.1 - 6.0);
    match drawing.axes {
        Some(names) => view.axes(names, out),
        None => {
            let zero = [0.0; 3];
            let arm = view.span() * 0.1;
            let foot = view.free_corner(path.points().map(project));
            for (label, end) in [("X", [arm, 0.0, 0.0]), ("Y", [0.0, arm, 0.0]), ("Z", [0.0, 0.0, arm])] {
                view.arrow(foot, project(zero), project(end), label, out);
            }
        }
    }
    let _ = writeln!(
        out,
        "<clipPath id=\"{name}\"><rect x=\"{:.1}\" y=\"{:.1}\" width=\"{SIZE}\" height=\"{SIZE}\"/></clipPath>\n<g clip-path=\"url(#{name})\">",
        corner.0,
        corner.1,
        name = &name[..2]
    );
    // Cuts lie over the rapids that go the same way.
    let (rapids, cuts): (Vec<_>, Vec<_>) = path.strokes.iter().partition(|stroke| stroke.kind == Kind::Rapid);
    for stroke in rapids.into_iter().chain(cuts) {
        let style = match stroke.kind {
            Kind::Rapid => "stroke=\"#c60\" stroke-width=\"0.8\" stroke-dasharray=\"5 3\"",
            Kind::Cut => "stroke=\"#036\" stroke-width=\"1.4\"",
        };
        let points: Vec<String> = stroke
            .points
            .iter()
            .map(|point| {
                let (x, y) = view.place(project(*point));
                format!("{x:.2},{y:.2}")
            })
            .collect();
        let _ = writeln!(out, "<polyline fill=\"none\" {style} points=\"{}\"/>", points.join(" "));
    }
    for hole in &path.holes {
        let (x, y) = view.place(project(*hole));
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" fill=\"none\" stroke=\"#080\" stroke-width=\"1.5\"/>"
        );
    }
    for touch in &path.touches {
        let (x, y) = view.place(project(*touch));
        let _ = writeln!(
            out,
            "<path d=\"M{:.2} {y:.2}h8m-4 -4v8\" stroke=\"#b00\" stroke-width=\"1.5\"/>",
            x - 4.0
        );
    }
    if let Some(start) = path.points().next() {
        let (x, y) = view.place(project(start));
        let _ = writeln!(out, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"#c60\"/>");
    }
    out.push_str("</g>\n");
    view.scale(out);
}

fn legend(height: f64, out: &mut String) {
    let y = height - 14.0;
    let entries = [
        ("stroke=\"#c60\" stroke-dasharray=\"5 3\"", "rapid"),
        ("stroke=\"#036\" stroke-width=\"1.4\"", "feed"),
    ];
    for (at, (style, name)) in entries.into_iter().enumerate() {
        let x = MARGIN + 110.0 * at as f64;
        let _ = writeln!(
            out,
            "<line x1=\"{x}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" {style}/><text x=\"{:.1}\" y=\"{y}\">{name}</text>",
            y - 4.0,
            x + 40.0,
            y - 4.0,
            x + 46.0
        );
    }
    let middle = y - 4.0;
    let marks = [
        (
            format!("<circle r=\"4\" cy=\"{middle}\" fill=\"none\" stroke=\"#080\" stroke-width=\"1.5\""),
            "hole",
        ),
        (format!("<path d=\"M-4 {middle}h8m-4 -4v8\" stroke=\"#b00\" stroke-width=\"1.5\""), "touch"),
        (format!("<circle r=\"3\" cy=\"{middle}\" fill=\"#c60\""), "start"),
    ];
    for (at, (mark, name)) in marks.into_iter().enumerate() {
        let x = MARGIN + 230.0 + 70.0 * at as f64;
        let _ = writeln!(
            out,
            "{mark} transform=\"translate({x})\"/><text x=\"{}\" y=\"{y}\">{name}</text>",
            x + 10.0
        );
    }
}

impl Path {
    fn of(events: &[Event]) -> Self {
        let mut path = Path::default();
        for event in events {
            match &event.what {
                EventKind::Rapid { from, to } => path.line(Kind::Rapid, point(&from.0), point(&to.0)),
                EventKind::Feed { from, to, .. } | EventKind::Thread { from, to, .. } => {
                    path.line(Kind::Cut, point(&from.0), point(&to.0));
                }
                EventKind::Probe { from, to, hit, .. } => {
                    path.line(Kind::Cut, point(&from.0), point(&to.0));
                    path.touches.extend(hit.then(|| point(&to.0)));
                }
                EventKind::Arc { from, to, centre, plane, sweep, .. } => {
                    let axes = match plane {
                        crate::control::trace::Plane::Xy => (0, 1, 2),
                        crate::control::trace::Plane::Zx => (2, 0, 1),
                        crate::control::trace::Plane::Yz => (1, 2, 0),
                    };
                    path.arc((point(&from.0), point(&to.0)), point(&centre.0), axes, *sweep);
                }
                EventKind::Hole { at, .. } => path.holes.push(point(&at.0)),
                _ => {}
            }
        }
        path
    }

    /// The drawing from above; of a path that has depth and no Y, over Z and X.
    fn flat(&self) -> Drawing {
        let moves = |axis: usize| {
            let mut values = self.points().map(|point| point[axis]);
            values.next().is_some_and(|first| values.any(|value| value != first))
        };
        if moves(2) && !moves(1) {
            Drawing { axes: Some(('Z', 'X')), project: |point| (point[2], point[0]) }
        } else {
            Drawing { axes: Some(('X', 'Y')), project: |point| (point[0], point[1]) }
        }
    }

    /// The points that a drawing must hold: all but the way to the first cut and the way from the last.
    fn framed(&self) -> Vec<Point> {
        if self.strokes.iter().all(|stroke| stroke.kind == Kind::Rapid) {
            return self.points().collect();
        }
        let mut strokes: Vec<&[Point]> = self.strokes.iter().map(|stroke| &stroke.points[..]).collect();
        if let Some((stroke, points)) = self.strokes.first().zip(strokes.first_mut())
            && stroke.kind == Kind::Rapid
        {
            *points = &points[points.len().saturating_sub(1)..];
        }
        if let Some((stroke, points)) = self.strokes.last().zip(strokes.last_mut())
            && stroke.kind == Kind::Rapid
        {
            *points = &points[..points.len().min(1)];
        }
        strokes.concat()
    }

    fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.strokes.iter().flat_map(|stroke| stroke.points.iter().copied())
    }

    fn line(&mut self, kind: Kind, from: Point, to: Point) {
        match self
            .strokes
            .last_mut()
            .filter(|stroke| stroke.kind == kind && stroke.points.last() == Some(&from))
        {
            Some(stroke) => stroke.points.push(to),
            None => self.strokes.push(Stroke { kind, points: vec![from, to] }),
        }
    }

    /// An arc in pieces of at most three degrees.
    fn arc(&mut self, (from, to): (Point, Point), centre: Point, axes: (usize, usize, usize), sweep: f64) {
        let (first, second, along) = axes;
        let (a, b) = (from[first] - centre[first], from[second] - centre[second]);
        let pieces = ((sweep.abs() / 3.0).ceil() as usize).clamp(1, 400);
        let mut before = from;
        for piece in 1..=pieces {
            let part = piece as f64 / pieces as f64;
            let (sin, cos) = (sweep * part).to_radians().sin_cos();
            let mut next = from;
            next[first] = centre[first] + a * cos - b * sin;
            next[second] = centre[second] + a * sin + b * cos;
            next[along] = from[along] + (to[along] - from[along]) * part;
            let next = if piece == pieces { to } else { next };
            self.line(Kind::Cut, before, next);
            before = next;
        }
    }
}

fn point(axes: &crate::control::scenario::Axes) -> Point {
    [axes[0], axes[1], axes[2]]
}

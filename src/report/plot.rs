//! The backplot: the tool's path from above and askew, as SVG.

mod legend;
mod overlay;
mod pair;
mod path;
mod png;
mod view;

pub use overlay::overlay;
pub use pair::{PairOfRuns, pair};
pub use png::png;

use super::html::escaped;
use crate::control::{End, Run};
use legend::{colour, legend};
use path::{Kind, Path, Stroke};
use std::borrow::Cow;
use std::fmt::Write;
use view::{Bounds, View};

/// A point of the path.
type Point = [f64; 3];

/// What a drawing counts its places from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coordinates {
    /// The work zero, and the tip of the tool.
    #[default]
    Work,
    /// The zero of the machine.
    Machine,
}

/// A way to look at the path: two of its axes, across and up, or none for askew.
struct Drawing {
    axes: Option<(char, char)>,
    project: fn(Point) -> (f64, f64),
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

/// Points that are drawn, about; of a longer path some are left out.
const POINTS: usize = 50_000;
/// Holes and touches that are drawn.
const MARKS: usize = 2000;
/// Letters of a text in the picture.
const LETTERS: usize = 140;

/// The path as an SVG with two drawings: XY from above, and isometric. A path without a move along Y, as a
/// lathe's, and one whose cuts are all in the ZX plane, is drawn over Z and X; of a lathe as it is, with diameters at X. The rapids before the first cut and after the last one end at the
/// edge of a drawing, so that the part fills it. Lengths are in the unit of the program; of one that uses both, in
/// millimetres.
pub fn backplot(run: &Run, title: &str, coordinates: Coordinates) -> String {
    let path = Path::of(run, coordinates);
    let mut out = String::new();
    let (width, height) = (2.0 * SIZE + 3.0 * MARGIN, SIZE + 3.6 * MARGIN);
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">"
    );
    let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>");
    let _ = writeln!(out, "<text x=\"{MARGIN}\" y=\"24\" font-size=\"16\">{}</text>", told(title));
    let _ = writeln!(out, "<text x=\"{MARGIN}\" y=\"42\" fill=\"#555\">{}</text>", about(&path));
    let ending = ending(&run.end);
    if let Some(text) = &ending {
        let _ = writeln!(
            out,
            "<text x=\"{MARGIN}\" y=\"58\" fill=\"#b00\" font-weight=\"bold\">{}</text>",
            told(text)
        );
    }
    if path.strokes.is_empty() {
        let (x, y) = (width / 2.0, height / 2.0);
        let style = "text-anchor=\"middle\" font-size=\"20\" fill=\"#555\"";
        let _ = writeln!(out, "<text x=\"{x}\" y=\"{y}\" {style}>the program makes no move</text>");
    } else {
        let flat = path.flat();
        let drawings = [flat, Drawing { axes: None, project: ISOMETRIC }];
        for (column, drawing) in drawings.into_iter().enumerate() {
            let left = MARGIN + column as f64 * (SIZE + MARGIN);
            draw(&path, &drawing, (left, 1.6 * MARGIN), ending.is_some(), &mut out);
        }
        legend(&path, height - 46.0, &mut out);
        notes(&path, height - 8.0, &mut out);
    }
    out.push_str("</svg>\n");
    out
}

/// What the picture counts from.
fn about(path: &Path) -> &'static str {
    match (path.from_work, path.many_zeros) {
        (true, false) => "work coordinates, at the tip of the tool",
        (true, true) => {
            "work coordinates, at the tip of the tool; places of several work zeros lie over each other"
        }
        (false, _) => "machine coordinates",
    }
}

/// Why the run did not come to its end.
fn ending(end: &End) -> Option<String> {
    match end {
        End::Ended => None,
        End::Alarm { stop, .. } => {
            let parts = [stop.number.as_str(), stop.text.as_str()];
            let text: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
            Some(format!("alarm: {}", text.join(": ")))
        }
        End::StepBudget | End::TimeBudget => Some("the program was still running here".into()),
        End::Error { text, .. } => Some(format!("the run stopped here: {text}")),
    }
}

/// A text in the picture: short, and of letters that XML has.
fn told(text: &str) -> String {
    let plain = |c: char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    let short: String = text.chars().take(LETTERS).map(|c| if plain(c) { c } else { '\u{fffd}' }).collect();
    let more = if text.chars().nth(LETTERS).is_some() { ".." } else { "" };
    format!("{}{more}", escaped(&short))
}

fn notes(path: &Path, y: f64, out: &mut String) {
    let mut notes: Vec<Cow<'_, str>> = Vec::new();
    if path.no_radius {
        notes.push("cutter compensation is on with a radius of 0".into());
    }
    let count = path.points().count();
    if count > POINTS {
        notes.push(format!("of {count} points some are left out").into());
    }
    if path.holes.len() > MARKS || path.touches.len() > MARKS {
        notes.push(format!("the first {MARKS} holes and touches are marked").into());
    }
    if !notes.is_empty() {
        let _ = writeln!(out, "<text x=\"{MARGIN}\" y=\"{y:.0}\" fill=\"#555\">{}</text>", notes.join("; "));
    }
}

fn draw(path: &Path, drawing: &Drawing, corner: (f64, f64), broken: bool, out: &mut String) {
    let project = drawing.project;
    let bounds = Bounds::of(path.framed().into_iter().map(project));
    let unit = path.unit();
    let turned = path.diameters && drawing.axes == Some(('Z', 'X'));
    let view = View::new(bounds, corner, SIZE).in_unit(unit).with_diameters(turned);
    let name = match drawing.axes {
        Some((across, up)) if turned => format!("{across}{up}, {unit}, {up} in diameters"),
        Some((across, up)) => format!("{across}{up}, {unit}"),
        None => format!("isometric, {unit}"),
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
        None => view.cross(path.points(), project, out),
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
    let count = path.points().count();
    // Many short strokes are as long as one long one.
    let every = count.div_ceil(POINTS).max(1);
    let thinned = path.strokes.len().div_ceil(POINTS).max(1);
    for stroke in rapids.into_iter().step_by(thinned).chain(cuts.into_iter().step_by(thinned)) {
        let style = match stroke.kind {
            Kind::Rapid => "stroke=\"#c60\" stroke-width=\"0.8\" stroke-dasharray=\"5 3\"".to_owned(),
            Kind::Cut => format!("stroke=\"{}\" stroke-width=\"1.4\"", colour(stroke.tool)),
        };
        let last = stroke.points.len().saturating_sub(1);
        let kept = stroke.points.iter().enumerate().filter(|(at, _)| at % every == 0 || *at == last);
        let kept: Vec<Point> = kept.map(|(_, point)| *point).collect();
        polyline(&kept, &style, &view, drawing, out);
        if stroke.aside != 0.0 {
            let style = format!("stroke=\"{}\" stroke-width=\"0.6\"", colour(stroke.tool));
            polyline(&beside(&kept, stroke), &style, &view, drawing, out);
        }
    }
    for hole in path.holes.iter().take(MARKS) {
        let (x, y) = view.place(project(*hole));
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" fill=\"none\" stroke=\"#080\" stroke-width=\"1.5\"/>"
        );
    }
    for touch in path.touches.iter().take(MARKS) {
        let (x, y) = view.place(project(*touch));
        let _ = writeln!(
            out,
            "<path d=\"M{:.2} {y:.2}h8m-4 -4v8\" stroke=\"#b00\" stroke-width=\"1.5\"/>",
            x - 4.0
        );
    }
    out.push_str("</g>\n");
    // Start and end may lie outside: then they stand at the edge.
    let inside =
        |(x, y): (f64, f64)| (x.clamp(corner.0, corner.0 + SIZE), y.clamp(corner.1, corner.1 + SIZE));
    if let Some(start) = path.points().next() {
        let (x, y) = inside(view.place(project(start)));
        let _ = writeln!(out, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"#c60\"/>");
    }
    if let Some(end) = path.points().last() {
        let (x, y) = inside(view.place(project(end)));
        let mark = match broken {
            true => format!(
                "d=\"M{:.2} {:.2}l12 12m0 -12l-12 12\" stroke=\"#b00\" stroke-width=\"3\"",
                x - 6.0,
                y - 6.0
            ),
            false => format!("d=\"M{:.2} {:.2}h6v6h-6z\" fill=\"#000\"", x - 3.0, y - 3.0),
        };
        let _ = writeln!(out, "<path {mark}/>");
    }
    view.scale(out);
}

fn polyline(points: &[Point], style: &str, view: &View, drawing: &Drawing, out: &mut String) {
    let places: Vec<String> = points
        .iter()
        .map(|point| {
            let (x, y) = view.place((drawing.project)(*point));
            format!("{x:.2},{y:.2}")
        })
        .collect();
    let _ = writeln!(out, "<polyline fill=\"none\" {style} points=\"{}\"/>", places.join(" "));
}

/// The middle of the cutter, about: each piece of the way is shifted to its side, and corners are not worked out.
fn beside(points: &[Point], stroke: &Stroke) -> Vec<Point> {
    let (first, second, _) = stroke.plane.axes();
    let mut out = Vec::new();
    for (from, to) in points.iter().zip(points.iter().skip(1)) {
        let (ahead, left) = (to[first] - from[first], to[second] - from[second]);
        let length = ahead.hypot(left);
        if length > 0.0 {
            for mut point in [*from, *to] {
                point[first] -= left / length * stroke.aside;
                point[second] += ahead / length * stroke.aside;
                out.push(point);
            }
        }
    }
    out
}

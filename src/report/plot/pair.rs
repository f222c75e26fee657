//! The paths of two programs in a picture of its own.

use super::overlay::{Both, Sheet, drawings};
use super::{Coordinates, about, ending, told};
use crate::control::Run;
use crate::verify::Picture;
use std::fmt::Write;

const SHEET: Sheet = Sheet { size: 560.0, margin: 60.0, points: 25_000, marks: 2000 };

/// How the lines look; the report's pages have the same.
const STYLE: &str = "path,circle{fill:none}.en{fill:#000}text.ap{fill:#b00}circle.ap{stroke:#b00;stroke-width:1.5}\
    .fr{fill:none;stroke:#ccc}.sr{stroke:#f0b37a;stroke-width:3.5}.sc{stroke:#9cc3e6;stroke-width:5}\
    .tr{stroke:#9a4a00;stroke-width:0.9;stroke-dasharray:5 3}.tc{stroke:#00264d;stroke-width:1.3}";

/// What is drawn of two programs: their names, and a run of each.
#[derive(Clone, Debug)]
pub struct PairOfRuns<'p> {
    /// What the old program is called.
    pub old: &'p str,
    /// What the new one is called.
    pub new: &'p str,
    /// The runs, and where they differ. None where no program stands on both sides.
    pub picture: Option<&'p Picture>,
}

/// Both paths as an SVG with two drawings, XY from above and isometric, in the unit of the old program.
pub fn pair(shown: &PairOfRuns<'_>, coordinates: Coordinates) -> String {
    let (width, height) = (SHEET.width(), SHEET.size + 3.6 * SHEET.margin);
    let mut out = String::new();
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">"
    );
    let _ =
        writeln!(out, "<style>{STYLE}</style>\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>");
    let mut line = |y: f64, style: &str, text: &str| {
        let _ = writeln!(out, "<text x=\"{}\" y=\"{y:.0}\" {style}>{text}</text>", SHEET.margin);
    };
    line(24.0, "font-size=\"16\"", &format!("{} and {}", told(shown.old), told(shown.new)));
    let both = shown.picture.and_then(|picture| Both::of(picture, coordinates));
    if let (Some(picture), Some(both)) = (shown.picture, &both) {
        line(42.0, "fill=\"#555\"", about(&both.source));
        let ends = [("the old", Some(&picture.source)), ("the new", picture.target.as_ref())];
        let ends = ends.into_iter().filter_map(|(name, run)| Some(format!("{name}: {}", ending(&run?.end)?)));
        let ends: Vec<String> = ends.collect();
        if !ends.is_empty() {
            line(58.0, "fill=\"#b00\" font-weight=\"bold\"", &told(&ends.join("; ")));
        }
        line(height - 40.0, "fill=\"#555\"", &told(&differs(picture)));
        drawings(both, &SHEET, 0, 1.6 * SHEET.margin, &mut out);
        legend(height - 18.0, &mut out);
    } else {
        let says = match shown.picture {
            Some(_) => "neither program makes a move",
            None => "no program stands on both sides",
        };
        let (x, y) = (width / 2.0, height / 2.0);
        let style = "text-anchor=\"middle\" font-size=\"20\" fill=\"#555\"";
        let _ = writeln!(out, "<text x=\"{x}\" y=\"{y}\" {style}>{says}</text>");
    }
    out.push_str("</svg>\n");
    out
}

/// What differs in the run that is drawn.
fn differs(picture: &Picture) -> String {
    let Picture { source, target, apart, .. } = picture;
    let whole = |run: &Run| ending(&run.end).is_none();
    let Some(target) = target else { return "the new side has no such program".into() };
    let more: usize = apart.changes.iter().map(|change| change.alike).sum();
    match apart.changes.len() + apart.left_out + more {
        0 if !apart.at_end.is_empty() => format!("at the end: {}", apart.at_end.join("; ")),
        0 if whole(source) && whole(target) => "in this run no move, feed, wait or stop differs".into(),
        0 => "nothing differs as far as both went".into(),
        1 => "one place differs in this run".into(),
        places => format!("{places} places differ in this run"),
    }
}

fn legend(y: f64, out: &mut String) {
    let mut x = SHEET.margin;
    let lines = [("sc", "old, feed"), ("sr", "old, rapid"), ("tc", "new, feed"), ("tr", "new, rapid")];
    for (class, name) in lines {
        let _ = writeln!(
            out,
            "<path class=\"{class}\" d=\"M{x:.0} {:.0}h40\"/><text x=\"{:.0}\" y=\"{y:.0}\">{name}</text>",
            y - 4.0,
            x + 46.0
        );
        x += 130.0;
    }
    let _ = writeln!(
        out,
        "<circle class=\"en\" cx=\"{x:.0}\" cy=\"{:.0}\" r=\"2.5\"/><text x=\"{:.0}\" y=\"{y:.0}\">start</text>",
        y - 4.0,
        x + 8.0
    );
    let _ = writeln!(
        out,
        "<rect class=\"en\" x=\"{:.0}\" y=\"{:.0}\" width=\"5\" height=\"5\"/><text x=\"{:.0}\" y=\"{y:.0}\">end</text>",
        x + 50.0,
        y - 6.0,
        x + 60.0
    );
    let _ = writeln!(
        out,
        "<circle class=\"ap\" cx=\"{:.0}\" cy=\"{:.0}\" r=\"7\"/><text x=\"{:.0}\" y=\"{y:.0}\">a move differs: its line in the new program, or in the old one if it is gone</text>",
        x + 107.0,
        y - 4.0,
        x + 120.0
    );
}

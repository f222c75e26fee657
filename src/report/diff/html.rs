//! A diff as one HTML file that needs nothing beside it.

use super::words::{about, headline, lines, silent, title, told, verdict, what};
use crate::diff::{Diff, FileDiff, Line, On, ProgramDiff, Text, Verdict};
use crate::report::html::escaped;
use std::fmt::Write;

const HEAD: &str = r"<!doctype html>
<html lang='en'>
<head>
<meta charset='utf-8'>
<meta name='viewport' content='width=device-width, initial-scale=1'>
<title>What changed for the machine</title>
<style>
body { font: 16px/1.45 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem; color: black; background: white; }
h2 { margin: 1.8rem 0 .4rem; font-size: 1.1rem; }
.same { color: darkgreen; } .undecided { color: saddlebrown; } .different { color: darkred; }
ul { list-style: none; padding: 0; } li { margin: .5rem 0; padding-left: .8rem; border-left: 3px solid silver; }
pre, table { font: 14px/1.4 ui-monospace, monospace; }
pre { margin: .2rem 0; white-space: pre-wrap; }
table { border-collapse: collapse; width: 100%; } td { padding: 0 .5rem; white-space: pre-wrap; vertical-align: top; }
td.n { color: dimgray; text-align: right; width: 1%; }
.old { background: mistyrose; } .new { background: honeydew; }
.old mark { background: lightcoral; } .new mark { background: lightgreen; }
</style>
</head>
<body>
";

/// The diff as HTML: the verdict, then what changed in each program, then the lines.
pub fn diff(diff: &Diff) -> String {
    let class = class(diff.verdict);
    let mut out = format!("{HEAD}<h1 class=\"{class}\">{}</h1>\n", escaped(&headline(diff)));
    for note in &diff.notes {
        let _ = writeln!(out, "<p>{}</p>", escaped(note));
    }
    told(diff).for_each(|program| of_program(&mut out, program, diff.tolerance_mm));
    if let Some(text) = silent(diff) {
        let _ = writeln!(out, "<p>{text}</p>");
    }
    diff.files.iter().for_each(|file| of_file(&mut out, file));
    out.push_str("</body>\n</html>\n");
    out
}

fn class(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Same => "same",
        Verdict::Undecided => "undecided",
        Verdict::Different => "different",
    }
}

fn of_program(out: &mut String, program: &ProgramDiff, tolerance: f64) {
    let _ = writeln!(
        out,
        "<section>\n<h2 class=\"{}\">{}: {}</h2>\n<ul>",
        class(program.verdict),
        escaped(&title(program)),
        verdict(program)
    );
    for why in &program.why {
        let _ = writeln!(out, "<li>{}</li>", escaped(why));
    }
    for note in program.structure.iter().flatten() {
        let line = note.new.or(note.old).map(|line| format!("line {line}, ")).unwrap_or_default();
        let _ = writeln!(out, "<li>{line}{}: {}</li>", note.about, escaped(&note.text));
    }
    if let Some(listing) = &program.motion {
        let _ = writeln!(out, "</ul>\n<p>{}</p>\n<ul>", escaped(&about(listing, tolerance)));
        for change in &listing.changes {
            let _ = writeln!(out, "<li>{}: {}", lines(change), escaped(&what(change, listing.inch)));
            for (seen, class) in [(&change.old, "old"), (&change.new, "new")] {
                if let Some(seen) = seen {
                    let _ =
                        writeln!(out, "<pre class=\"{class}\">{}</pre>", escaped(seen.moment.block.trim()));
                }
            }
            out.push_str("</li>\n");
        }
        if listing.left_out > 0 {
            let _ = writeln!(out, "<li>and {} more places</li>", listing.left_out);
        }
        for text in &listing.at_end {
            let _ = writeln!(out, "<li>at the end: {}</li>", escaped(text));
        }
    }
    out.push_str("</ul>\n</section>\n");
}

fn of_file(out: &mut String, file: &FileDiff) {
    let name = |side: &Option<String>| side.as_deref().map_or("nothing".into(), escaped);
    for (level, text) in file.told() {
        let _ = writeln!(out, "<h2>{level}: {} to {}</h2>", name(&file.old), name(&file.new));
        of_text(out, text);
    }
}

fn of_text(out: &mut String, text: &Text) {
    for hunk in &text.hunks {
        out.push_str("<table>\n");
        hunk.lines.iter().for_each(|line| of_line(out, line));
        out.push_str("</table>\n<hr>\n");
    }
    if text.left_out > 0 {
        let _ = writeln!(out, "<p>and {} more changed lines</p>", text.left_out);
    }
}

fn of_line(out: &mut String, line: &Line) {
    let (sign, class) = match line.on {
        On::Both => (" ", ""),
        On::Old => ("-", "old"),
        On::New => ("+", "new"),
    };
    let number = |side: Option<usize>| side.map(|number| number.to_string()).unwrap_or_default();
    let (old, new) = (number(line.old), number(line.new));
    let _ =
        write!(out, "<tr class=\"{class}\"><td class=\"n\">{old}</td><td class=\"n\">{new}</td><td>{sign} ");
    for piece in &line.pieces {
        let text = escaped(&piece.text);
        let marked = piece.changed && line.pieces.len() > 1;
        out.push_str(&if marked { format!("<mark>{text}</mark>") } else { text });
    }
    out.push_str("</td></tr>\n");
}

//! A conversion as one HTML file that needs nothing beside it: to read, print and sign.

use super::{Part, Place, Totals, grade, words};
use crate::diag::Diagnostic;
use crate::library::ProgramReport;
use crate::text::acts;
use std::fmt::Write;

const HEAD: &str = r#"<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Conversion</title>
<style>
body { font: 16px/1.45 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #1c1c1c; background: #fff; }
h3 { margin: 1.6rem 0 .3rem; font-size: 1.05rem; }
.outcome { font-weight: 600; }
.converted { color: #14662f; } .review { color: #7a4b00; } .refused { color: #a11212; }
ul { list-style: none; padding: 0; } li { margin: .7rem 0; padding-left: .8rem; border-left: 3px solid #bbb; }
li.error { border-color: #a11212; } li.review { border-color: #b97700; }
pre { margin: .3rem 0; padding: .3rem .6rem; overflow-x: auto; background: #f3f3f1; color: #1c1c1c; }
td, th { padding: .1rem .8rem .1rem 0; text-align: left; }
</style>
</head>
<body>
<h1>Conversion</h1>
"#;

/// The conversions as HTML: totals, codes, then a section a program with each finding at its line.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let totals = Totals::of(parts);
    let mut out = format!("{HEAD}<p>{totals}</p>\n");
    if !totals.codes.is_empty() {
        out.push_str("<table>\n<tr><th>Code</th><th>Meaning</th><th>Programs</th></tr>\n");
        for (number, count) in &totals.codes {
            let title = crate::diag::Code::find(number).map_or("", crate::diag::Code::title);
            let _ = writeln!(out, "<tr><td>{number}</td><td>{}</td><td>{count}</td></tr>", escaped(title));
        }
        out.push_str("</table>\n");
    }
    for part in parts {
        let _ = writeln!(out, "<h2>{} to {}</h2>", escaped(part.from), escaped(part.to));
        if let Some(advice) = part.advised() {
            let _ = writeln!(out, "<p>{}: {}</p>", escaped(part.to), escaped(advice));
        }
        let indexes = part.indexes();
        for program in &part.conversion.programs {
            head(&mut out, part, program);
            for finding in &program.diagnostics {
                item(&mut out, finding, part.place(program.file, &indexes[program.file], finding));
            }
            out.push_str("</ul>\n</section>\n");
        }
    }
    out.push_str("</body>\n</html>\n");
    out
}

fn head(out: &mut String, part: &Part<'_>, program: &ProgramReport) {
    let words = words(program.outcome);
    let class = words.trim_start_matches("for ");
    let file = escaped(&part.inputs[program.file].name);
    let name = program.name.as_deref().map(escaped).unwrap_or_default();
    let _ =
        writeln!(out, "<section>\n<h3>{file} {name}</h3>\n<p class=\"outcome {class}\">{words}</p>\n<ul>");
}

fn item(out: &mut String, finding: &Diagnostic, place: Place<'_>) {
    let Place { line, column, text } = place;
    let (code, severity) = (finding.code.number(), grade(finding.severity()));
    let _ = writeln!(
        out,
        "<li class=\"{severity}\">{severity} {code}, line {line}, column {column}: {}\n<pre>{}</pre>",
        escaped(&finding.message),
        escaped(&String::from_utf8_lossy(text))
    );
    if let Some(help) = &finding.help {
        let _ = writeln!(out, "<p>{}</p>", escaped(help));
    }
    out.push_str("</li>\n");
}

/// Text as HTML shows it, in elements and in quoted attributes.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            sign if acts(sign) && sign != '\t' => out.extend(sign.escape_default()),
            sign => out.push(sign),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn nothing_of_a_program_is_read_as_html() {
        assert_eq!(escaped("(<script>'x\"&\0)"), "(&lt;script&gt;&#39;x&quot;&amp;\\u{0})");
    }
}

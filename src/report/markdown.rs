//! A conversion as Markdown, for a pull request or a change note.

use super::{Part, Place, Totals, grade, words};
use crate::diag::Diagnostic;
use crate::text::{acts, shown};
use std::fmt::Write;

/// The conversions as Markdown text: totals, then a section a program.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let mut out = format!("# Conversion\n\n{}\n", Totals::of(parts));
    for part in parts {
        let _ = writeln!(out, "\n## {} to {}", escaped(part.from), escaped(part.to));
        if let Some(advice) = part.advised() {
            let _ = writeln!(out, "\n{}: {}", escaped(part.to), escaped(advice));
        }
        let indexes = part.indexes();
        for program in &part.conversion.programs {
            let file = escaped(&part.inputs[program.file].name);
            let name = program.name.as_deref().map(escaped).unwrap_or_default();
            let _ = writeln!(out, "\n### {file} {name}\n\n**{}**", words(program.outcome));
            for finding in &program.diagnostics {
                let place = part.place(program.file, &indexes[program.file], finding);
                item(&mut out, finding, place);
            }
        }
    }
    out
}

fn item(out: &mut String, finding: &Diagnostic, place: Place<'_>) {
    let Place { line, column, text } = place;
    let (code, severity) = (finding.code.number(), grade(finding.severity()));
    let _ =
        writeln!(out, "\n- {severity} {code}, line {line}, column {column}: {}", escaped(&finding.message));
    if let Some(help) = &finding.help {
        let _ = writeln!(out, "  {}", escaped(help));
    }
    // Indented code needs no fence, which a program's text could close.
    let _ = writeln!(out, "\n      {}", shown(&String::from_utf8_lossy(text).replace('\t', " ")));
}

/// Text whose signs Markdown and HTML would read, with each of them taken literally.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign {
            '<' => out.push_str("&lt;"),
            '&' => out.push_str("&amp;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '#' | '|' | '~' | '!' => out.extend(['\\', sign]),
            sign if acts(sign) => out.extend(sign.escape_default()),
            sign => out.push(sign),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn signs_of_programs_stay_signs() {
        assert_eq!(escaped("#1=[#2*3]"), r"\#1=\[\#2\*3\]");
        assert_eq!(escaped("<b>&\n"), r"&lt;b>&amp;\n");
    }
}

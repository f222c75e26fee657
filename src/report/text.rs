//! Diagnostics drawn at their source, and summaries, for people.

use super::{Part, Totals};
use crate::diag::{Code, Diagnostic, Severity};
use crate::library::Outcome;
use miette::{GraphicalReportHandler, LabeledSpan, MietteDiagnostic, NamedSource, Report};
use std::collections::BTreeSet;
use std::fmt::Write;

/// A source file to draw diagnostics on.
pub struct Sheet {
    name: String,
    text: String,
    handler: GraphicalReportHandler,
}

impl Sheet {
    /// The file of this name. Bytes that are no ASCII are drawn as `?`, so that columns stay.
    pub fn new(name: &str, bytes: &[u8]) -> Self {
        // Line ends other than LF would be drawn as part of the line; NUL draws as nothing.
        let draw = |(at, &byte): (usize, &u8)| match byte {
            b'\r' if bytes.get(at + 1) == Some(&b'\n') => ' ',
            b'\r' => '\n',
            b'\n' | b'\t' => byte as char,
            0x20..=0x7e => byte as char,
            _ => '?',
        };
        let text = bytes.iter().enumerate().map(draw).collect();
        Self { name: name.into(), text, handler: handler() }
    }

    /// A diagnostic, drawn.
    pub fn draw(&self, diagnostic: &Diagnostic) -> String {
        let span = diagnostic.span;
        let start = (span.start as usize).min(self.text.len());
        // Only the first line of a place is drawn.
        let end = (span.end as usize).clamp(start, self.text.len());
        let end = start + self.text[start..end].find('\n').unwrap_or(end - start);
        let severity = match diagnostic.severity() {
            Severity::Error => miette::Severity::Error,
            Severity::Review => miette::Severity::Warning,
            Severity::Note => miette::Severity::Advice,
        };
        let mut drawn = MietteDiagnostic::new(diagnostic.code.title())
            .with_code(diagnostic.code.number())
            .with_severity(severity)
            .with_label(LabeledSpan::new(Some(diagnostic.message.to_string()), start, end - start));
        if let Some(help) = &diagnostic.help {
            drawn = drawn.with_help(help.to_string());
        }
        let report =
            Report::new(drawn).with_source_code(NamedSource::new(self.name.clone(), self.text.clone()));
        let mut out = String::new();
        match self.handler.render_report(&mut out, report.as_ref()) {
            Ok(()) => out,
            Err(_) => format!("{}: {}: {}\n", self.name, diagnostic.code.number(), diagnostic.message),
        }
    }
}

fn handler() -> GraphicalReportHandler {
    use std::io::IsTerminal;
    let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let theme =
        if colour { miette::GraphicalTheme::unicode() } else { miette::GraphicalTheme::unicode_nocolor() };
    GraphicalReportHandler::new_themed(theme).with_width(100).with_context_lines(1)
}

/// The page of a code.
pub fn explain(code: Code) -> String {
    let severity = match code.severity() {
        Severity::Error => "error: the program is refused",
        Severity::Review => "review: a person must look at the place",
        Severity::Note => "note: the outcome stands",
    };
    format!("{}: {}\n({severity})\n\n{}\n", code.number(), code.title(), code.page())
}

/// The programs of conversions, a line each, and their count.
pub fn summary(parts: &[Part<'_>]) -> String {
    let mut out = String::new();
    for part in parts {
        if parts.len() > 1 {
            let _ = writeln!(out, "{} to {}:", part.from, part.to);
        }
        list(&mut out, part);
    }
    let _ = writeln!(out, "{}", Totals::of(parts));
    out
}

fn list(out: &mut String, part: &Part<'_>) {
    let width = part.inputs.iter().map(|input| input.name.len()).max().unwrap_or(0).min(48);
    for program in &part.conversion.programs {
        let outcome = match program.outcome {
            Outcome::Converted => "converted",
            Outcome::Review => "review",
            Outcome::Refused => "REFUSED",
        };
        let codes: BTreeSet<&str> = program.diagnostics.iter().map(|d| d.code.number()).collect();
        let codes = codes.into_iter().collect::<Vec<_>>().join(" ");
        let name = program.name.as_deref().unwrap_or("-");
        let file = &part.inputs[program.file].name;
        let _ = writeln!(out, "{}", format!("{outcome:<9}  {file:<width$}  {name:<6} {codes}").trim_end());
    }
}

//! A conversion as JSON. Its keys are a contract: `programs` with `source`, `target`, `program`,
//! `outcome`, `diagnostics`; `totals`.

use super::{Part, Totals};
use crate::diag::{Code, Severity};
use crate::library::Outcome;
use crate::verify;
use serde::Serialize;

#[derive(Serialize)]
struct Report<'a> {
    programs: Vec<Program<'a>>,
    totals: Totals,
}

#[derive(Serialize)]
struct Program<'a> {
    source: String,
    target: Option<String>,
    program: Option<&'a str>,
    from: &'a str,
    to: &'a str,
    outcome: Outcome,
    verdict: Option<verify::Outcome>,
    diagnostics: Vec<Finding<'a>>,
}

#[derive(Serialize)]
struct Finding<'a> {
    code: Code,
    severity: Severity,
    file: String,
    line: u32,
    column: u32,
    message: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<&'a str>,
}

/// The conversions as JSON text.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let programs = parts.iter().flat_map(programs).collect();
    let report = Report { programs, totals: Totals::of(parts) };
    serde_json::to_string_pretty(&report).unwrap_or_default() + "\n"
}

fn programs<'a>(part: &Part<'a>) -> Vec<Program<'a>> {
    let indexes = part.indexes();
    let programs = part.conversion.programs.iter().map(|program| {
        let file = part.inputs[program.file].path.display().to_string();
        let diagnostics = program.diagnostics.iter().map(|d| {
            let (line, column) = indexes[program.file].place(d.span.start);
            Finding {
                code: d.code,
                severity: d.severity(),
                file: file.clone(),
                line,
                column,
                message: &d.message,
                help: d.help.as_deref(),
            }
        });
        let target = part.targets.get(program.file).and_then(Option::as_ref);
        // Another program of the same file may have been written when this one was not.
        let target = target.filter(|_| !program.map.is_empty() || program.outcome != Outcome::Refused);
        Program {
            source: file.clone(),
            target: target.map(|path| path.display().to_string()),
            program: program.name.as_deref(),
            from: part.from,
            to: part.to,
            outcome: program.outcome,
            verdict: program.verdict,
            diagnostics: diagnostics.collect(),
        }
    });
    programs.collect()
}

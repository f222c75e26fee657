//! The family's traps, each with what the makers' rules say it means.
//!
//! Expected IR is written by hand from the rules of the manuals (`facts/`, the tables of
//! `dialects/`). One line is one basic block: its labels, its statements and its end,
//! parted by `|`; sites are left out but for the block-skip level.

mod calls;
mod corpus;
mod expressions;
mod jumps;
mod programs;
mod runs;
mod words;

use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::Control;
use crate::ir::{Module, Program, validate};
use crate::lower::{Lowered, fanuc, haas};
use crate::syntax::{self, Label, parse_file};

/// The control of a name: a dialect, or a dialect with the lines of a profile after a colon.
fn control(name: &str) -> Control {
    let (dialect, profile) = name.split_once(':').unwrap_or((name, ""));
    Control::from_profile(&format!("dialect = \"{dialect}\"\n{profile}"))
        .unwrap_or_else(|faults| panic!("{}", faults[0].message))
}

fn lowered(name: &str, source: &str) -> Lowered {
    let control = control(name);
    let lowered = match control.name() {
        "haas" => {
            let parsed = parse_file(source.as_bytes(), syntax::haas::parse_line);
            haas::lower(&parsed, 0, "O1.nc", &control)
        }
        _ => {
            let parsed = parse_file(source.as_bytes(), syntax::fanuc::parse_line);
            fanuc::lower(&parsed, 0, "O1.nc", &control)
        }
    };
    let module =
        Module { programs: lowered.programs.iter().map(|(p, _)| p.clone()).collect(), ..Module::default() };
    if let Err(breaches) = validate(&module) {
        panic!("{source}: {breaches:?}");
    }
    lowered
}

/// A program in short.
fn shape(program: &Program) -> String {
    let mut lines = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        let labels: String = (block.labels.iter())
            .map(|label| match label {
                Label::Number(number) => format!(" N{number}"),
                Label::Name(name) => format!(" :{name}"),
            })
            .collect();
        let mut parts = vec![format!("{}{labels}:", id.0)];
        for stmt in &block.stmts {
            let skip = stmt.site.skip.map_or(String::new(), |level| format!("/{level} "));
            parts.push(format!("{skip}{}", stmt.kind));
        }
        parts.push(block.term.kind.to_string());
        let first = parts.remove(0);
        lines.push(format!("{first} {}", parts.join(" | ")).replace("block", "b"));
    }
    lines.join("\n")
}

/// The programs of a source are these, one line a block; blank lines part programs.
#[track_caller]
fn means(name: &str, source: &str, expected: &str) {
    let lowered = lowered(name, source);
    let found: Vec<String> = lowered.programs.iter().map(|(program, _)| shape(program)).collect();
    let wanted: Vec<&str> = expected.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    assert_eq!(found.join("\n").lines().collect::<Vec<_>>(), wanted, "{source}");
    let errors = errors_of(&lowered);
    assert!(errors.is_empty(), "{source}: {errors:?}");
}

fn errors_of(lowered: &Lowered) -> Vec<Code> {
    let all = lowered.programs.iter().flat_map(|(_, findings)| findings);
    all.filter(|finding| finding.severity() == Severity::Error).map(|finding| finding.code).collect()
}

/// The source is refused, with these codes and no others of severity error.
#[track_caller]
fn refuses(name: &str, source: &str, codes: &[Code]) {
    assert_eq!(errors_of(&lowered(name, source)), codes, "{source}");
}

/// The source is for review, for these reasons; facts that are not confirmed are left out.
#[track_caller]
fn reviews(name: &str, source: &str, codes: &[Code]) {
    let lowered = lowered(name, source);
    let all = lowered.programs.iter().flat_map(|(_, findings)| findings);
    let found: Vec<Code> = all
        .filter(|f| f.severity() == Severity::Review && f.code != Code::UnconfirmedFact)
        .map(|finding| finding.code)
        .collect();
    assert_eq!(found, codes, "{source}");
}

/// The source rests on this fact, which is common or unconfirmed, said once.
#[track_caller]
fn rests_on(name: &str, source: &str, fact: &str) {
    assert_eq!(told(name, source, fact), 1, "{source}: {fact}");
}

fn told(name: &str, source: &str, fact: &str) -> usize {
    let quoted = format!("'{fact}'");
    let lowered = lowered(name, source);
    let all = lowered.programs.iter().flat_map(|(_, findings)| findings);
    let is_fact = |f: &&Diagnostic| matches!(f.code, Code::UnconfirmedFact | Code::CommonFact);
    all.filter(is_fact).filter(|f| f.message.contains(&quoted)).count()
}

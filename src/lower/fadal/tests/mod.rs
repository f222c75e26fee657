//! What programs mean, written by hand from the manual's rules.

mod blocks;
mod corpus;
mod macros;
mod programs;
mod runs;

use super::lower;
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::Control;
use crate::ir::text::print;
use crate::ir::{Module, SourceInfo};
use crate::syntax::{fadal::parse_line, parse_file};

/// The control, with lines of a machine profile.
fn control(profile: &str) -> Control {
    Control::from_profile(&format!("dialect = \"fadal\"\n{profile}")).unwrap()
}

/// What a source says in the text form, a line each, sites left out; and what was found.
fn lowered(source: &str, control: &Control) -> (Vec<String>, Vec<Diagnostic>) {
    let parsed = parse_file(source.as_bytes(), parse_line);
    let mut module = Module::default();
    let mut found = Vec::new();
    for (mut program, findings) in lower(&parsed, 0, "test", control).programs {
        found.extend(findings);
        program.site = SourceInfo::default();
        for block in &mut program.blocks {
            block.term.site = SourceInfo::default();
            block.stmts.iter_mut().for_each(|stmt| stmt.site = SourceInfo::default());
        }
        module.programs.push(program);
    }
    crate::ir::validate::validate(&module).unwrap_or_else(|faults| panic!("{source}: {faults:?}"));
    let lines = print(&module).lines().map(|line| line.trim().to_owned()).collect();
    (lines, found)
}

/// The statements of a program that has one block and runs off its end.
fn says(source: &str) -> String {
    let (lines, found) = lowered(source, &control(""));
    let errors: Vec<_> = found.iter().filter(|f| f.severity() == Severity::Error).collect();
    assert!(errors.is_empty(), "{source}: {errors:?}");
    let statements = lines.iter().filter(|line| !line.starts_with("program ") && *line != "}");
    let statements: Vec<&str> = statements.map(String::as_str).collect();
    match statements.as_slice() {
        ["block0:", inner @ .., "stray"] => inner.join("; "),
        other => panic!("{source}: {other:?}"),
    }
}

/// The codes that a source is found to deserve, and the facts that it rests on.
fn found(source: &str, profile: &str) -> Vec<String> {
    let (_, found) = lowered(source, &control(profile));
    let fact = |f: &Diagnostic| f.message.split('\'').nth(1).unwrap_or_default().to_owned();
    found
        .iter()
        .map(|f| if f.code == Code::UnconfirmedFact { fact(f) } else { format!("{:?}", f.code) })
        .collect()
}

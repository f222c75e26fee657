//! What the manuals say, checked by running.

mod arguments;
mod digits;
mod flow;
mod lathes;
mod mills;
mod programs;
mod values;

use crate::control::trace::EventKind;
use crate::control::{End, Library, LoadedFile, ProgramRef, Run, Scenario};
use crate::dialect::Control;
use crate::syntax::parse_file;

/// Runs the first program of the first text on a control.
fn run_on(control: &Control, texts: &[&str], scenario: &Scenario) -> Run {
    let entry = control.entry();
    let parsed: Vec<_> = texts.iter().map(|text| parse_file(text.as_bytes(), entry.parse)).collect();
    let files: Vec<LoadedFile<'_>> =
        parsed.iter().map(|parsed| LoadedFile { name: "test.nc", parsed }).collect();
    let execute = entry.execute.expect("the control is emulated");
    execute(&Library::new(&files), ProgramRef::FIRST, control, scenario)
}

fn fanuc(text: &str) -> Run {
    run_on(&Control::plain("fanuc").expect("the table loads"), &[text], &Scenario::default())
}

fn haas(text: &str) -> Run {
    run_on(&Control::plain("haas").expect("the table loads"), &[text], &Scenario::default())
}

/// A Fanuc with parameters set.
fn fanuc_with(parameters: &str, text: &str) -> Run {
    let profile = format!("dialect = \"fanuc\"\n[parameters]\n{parameters}\n");
    run_on(&Control::from_profile(&profile).expect("a profile"), &[text], &Scenario::default())
}

/// The final value of a variable; none for vacant.
fn value(run: &Run, name: &str) -> Option<f64> {
    run.variables.get(name).copied()
}

fn alarm(run: &Run) -> &str {
    match &run.end {
        End::Alarm { stop, .. } => &stop.number,
        other => panic!("no alarm but {other:?}"),
    }
}

/// The ends of all moves.
fn moves(run: &Run) -> Vec<[f64; 3]> {
    let ends = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Rapid { to, .. } | EventKind::Feed { to, .. } | EventKind::Arc { to, .. } => {
            Some([to.0[0], to.0[1], to.0[2]])
        }
        _ => None,
    });
    ends.collect()
}

/// True where a fact was in doubt.
fn doubts(run: &Run, fact: &str) -> bool {
    run.events.iter().any(|event| matches!(&event.what, EventKind::Unsure { fact: found } if found == fact))
}

fn corpus(path: &str) -> String {
    let path = format!("{}/corpus/{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

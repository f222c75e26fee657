//! One program through the whole line: read, converted, verified on the emulated controls.

mod machines;
mod missing;

use super::{File, Program};
use machines::{machine, targets};
use macroglot::control::trace::EventKind;
use macroglot::control::{End, Library, LoadedFile, ProgramRef, Run, Scenario};
use macroglot::diag::{Code, Severity};
use macroglot::dialect::Control;
use macroglot::library::{self, Input, Lock, Options, convert, judge};
use macroglot::syntax::{ParsedFile, parse_file};
use macroglot::verify::{Effort, Outcome, Reason, Witness};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Enough for small programs; a nightly run makes up for it in number.
pub const EFFORT: Effort = Effort {
    fewest: 16,
    telling: 16,
    drawn: 16,
    scenarios: 16,
    tries: 40,
    steps: 2000,
    all_steps: 60_000,
    seed: 1,
    program_seconds: 60.0,
    library_seconds: 600.0,
    allowed_mm: 0.0,
};

/// What became of a program.
#[derive(Default)]
pub struct Trial {
    /// It has a conversion, and runs to its end by itself with something to compare.
    pub useful: bool,
    /// What became of each conversion: to which dialect, and how it was judged.
    pub judged: Vec<(&'static str, Judgement)>,
    /// What is wrong with macroglot, by this program.
    pub faults: Vec<String>,
    /// Why conversions are undecided, by the certificates.
    pub reasons: Vec<Reason>,
    /// Why conversions are refused: to which dialect, the message without numbers.
    pub refusals: Vec<(&'static str, String)>,
    /// How long it took.
    pub took: Duration,
}

/// What became of a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    Refused,
    Same,
    Undecided,
    Different,
}

/// Tries a program.
pub fn run(program: &Program) -> Trial {
    let start = Instant::now();
    let (files, source) = (program.files(), machine(program.dialect, program.metric[0]));
    let mut trial = Trial::default();
    let alive = is_read(&files, source, &mut trial.faults);
    for target in targets(program.dialect, program.metric) {
        let judged = judgement(&files, source, target, &mut trial);
        trial.judged.push((target.entry().name, judged));
    }
    trial.useful = alive && trial.judged.iter().any(|(_, judgement)| *judgement != Judgement::Refused);
    trial.took = start.elapsed();
    trial
}

/// Whether the program does something where its machine runs it; what is not read of it is a fault.
fn is_read(files: &[File], control: &Control, faults: &mut Vec<String>) -> bool {
    let parsed: Vec<ParsedFile<'_>> =
        files.iter().map(|file| parse_file(file.text.as_bytes(), control.entry().parse)).collect();
    for (file, parsed) in files.iter().zip(&parsed) {
        if parsed.print() != file.text.as_bytes() {
            faults.push("bytes are lost".into());
        }
        for error in parsed.blocks.iter().flat_map(|block| &block.errors) {
            let place = &file.text[error.span.start as usize..error.span.end as usize];
            faults.push(format!("not read: {} '{place}' {}", error.code.number(), error.message));
        }
    }
    let named = files.iter().zip(&parsed);
    let loaded: Vec<LoadedFile<'_>> =
        named.map(|(file, parsed)| LoadedFile { name: &file.name, parsed }).collect();
    let execute = control.entry().execute.expect("an emulated control");
    let scenario = Scenario { steps: EFFORT.steps, events: 5000, ..Scenario::default() };
    does_something(&execute(&Library::new(&loaded), ProgramRef::FIRST, control, &scenario))
}

fn does_something(run: &Run) -> bool {
    let moved = |what: &EventKind| {
        matches!(what, EventKind::Rapid { .. } | EventKind::Feed { .. } | EventKind::Arc { .. })
    };
    run.end == End::Ended && (!run.variables.is_empty() || run.events.iter().any(|event| moved(&event.what)))
}

fn judgement(files: &[File], source: &Control, target: &Control, trial: &mut Trial) -> Judgement {
    let Trial { faults, reasons, refusals, .. } = trial;
    let input = |file: &File| Input {
        path: PathBuf::from(&file.name),
        name: file.name.clone(),
        bytes: file.text.clone().into_bytes(),
    };
    let inputs: Vec<Input> = files.iter().map(input).collect();
    let lock = Lock::new(source.name(), target.name());
    let mut made = convert(&inputs, source, target, lock, Options::default());
    let written = made.texts.iter().flatten().cloned().collect::<String>();
    for diagnostic in made.programs.iter().flat_map(|program| &program.diagnostics) {
        if diagnostic.code == Code::Internal {
            faults.push(format!("to {}: {}\n{written}", target.name(), diagnostic.message));
        }
        if diagnostic.severity() == Severity::Error {
            let sort = diagnostic.message.chars().filter(|sign| !sign.is_ascii_digit()).collect();
            refusals.push((target.entry().name, sort));
        }
    }
    if made.programs.iter().all(|program| program.outcome == library::Outcome::Refused) {
        return Judgement::Refused;
    }
    let refused = made.programs.iter().any(|program| program.outcome == library::Outcome::Refused);
    let certificates = judge(&inputs, &mut made, source, target, EFFORT);
    let silent = missing::silent(files, &made);
    faults.extend(silent.into_iter().map(|fault| format!("to {}: {fault}\n{written}", target.name())));
    let mut found = Judgement::Refused;
    let judged = certificates.written.iter().chain(&certificates.withheld);
    for program in judged.flatten().flat_map(|certificate| &certificate.programs) {
        // Run by itself, for its caller is refused: what that gives it is not known, and it is refused too.
        if program.outcome == Outcome::Different && refused && program.run_alone {
            continue;
        }
        if let (Outcome::Different, Some(witness)) = (program.outcome, &program.witness) {
            let what = format!("to {}: differs: {}", target.name(), witness.what);
            let name = program.program.as_deref().unwrap_or("the program");
            faults.push(format!("{what}\n{written}in {name}: {}", shown(witness)));
        }
        if program.outcome == Outcome::Undecided {
            reasons.extend(program.reasons.iter().cloned());
        }
        found = found.max(match program.outcome {
            Outcome::Same => Judgement::Same,
            Outcome::Undecided => Judgement::Undecided,
            Outcome::Different => Judgement::Different,
        });
    }
    found
}

/// A witness without what is the same in all of them.
fn shown(witness: &Witness) -> String {
    let scenario = &witness.scenario;
    let mut text = format!("skip {} with {:?}", scenario.block_skip, scenario.variables);
    for moment in [&witness.source, &witness.target] {
        text += &match moment {
            Some(moment) => format!("\n  line {} '{}' {}", moment.line, moment.block, moment.event),
            None => "\n  nothing more".into(),
        };
    }
    text
}

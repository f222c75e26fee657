//! What the tests of the interpreters share: running text and the corpus, and the events by kind.

use super::library::{Library, LoadedFile, ProgramRef};
use super::trace::{EventKind, Position};
use super::{End, Run, Scenario};
use crate::dialect::{Control, registry};
use crate::syntax::parse_file;
use std::path::Path;

/// Runs the first program of the first file on a dialect's control without a profile.
pub fn run(dialect: &str, files: &[(&str, &[u8])], scenario: &Scenario) -> Run {
    let control = Control::from_profile(&format!("dialect = \"{dialect}\"")).unwrap();
    run_on(&control, files, scenario)
}

/// Runs the first program of the first file on a control.
pub fn run_on(control: &Control, files: &[(&str, &[u8])], scenario: &Scenario) -> Run {
    let parsed: Vec<_> = files.iter().map(|(_, text)| parse_file(text, control.entry().parse)).collect();
    let loaded: Vec<LoadedFile<'_>> =
        files.iter().zip(&parsed).map(|((name, _), parsed)| LoadedFile { name, parsed }).collect();
    let entry = registry::find(control.name()).unwrap();
    entry.execute.unwrap()(&Library::new(&loaded), ProgramRef::FIRST, control, scenario)
}

/// Runs a corpus program, with others of its folder as the library.
pub fn run_corpus(dialect: &str, names: &[&str], scenario: &Scenario) -> Run {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(dialect);
    let texts: Vec<Vec<u8>> = names.iter().map(|name| std::fs::read(folder.join(name)).unwrap()).collect();
    let files: Vec<(&str, &[u8])> = names.iter().copied().zip(texts.iter().map(Vec::as_slice)).collect();
    run(dialect, &files, scenario)
}

/// A scenario with start values of variables.
pub fn given(variables: &[(&str, f64)]) -> Scenario {
    let variables = variables.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    Scenario { variables, ..Scenario::default() }
}

/// A scenario with answers of the operator.
pub fn answering(answers: &[f64]) -> Scenario {
    Scenario { answers: answers.to_vec(), ..Scenario::default() }
}

/// The ends of the straight moves at feed, X, Y and Z.
pub fn feeds(run: &Run) -> Vec<[f64; 3]> {
    let ends = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Feed { to, .. } => Some(xyz(to)),
        _ => None,
    });
    ends.collect()
}

/// The holes, X, Y and bottom.
pub fn holes(run: &Run) -> Vec<[f64; 3]> {
    let holes = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Hole { at, bottom, .. } => Some([at.0[0], at.0[1], *bottom]),
        _ => None,
    });
    holes.collect()
}

/// The lines of output.
pub fn output(run: &Run) -> Vec<&str> {
    let lines = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Output { text } => Some(text.as_str()),
        _ => None,
    });
    lines.collect()
}

/// The facts that mattered and are not confirmed.
pub fn doubts(run: &Run) -> Vec<&str> {
    let facts = run.events.iter().filter_map(|event| match &event.what {
        EventKind::Unsure { fact } => Some(fact.as_str()),
        _ => None,
    });
    facts.collect()
}

/// X, Y and Z of a position.
pub fn xyz(position: &Position) -> [f64; 3] {
    [position.0[0], position.0[1], position.0[2]]
}

/// Panics unless two places are the same but for rounding.
#[track_caller]
pub fn near(found: [f64; 3], expected: [f64; 3]) {
    let apart = found.iter().zip(expected).any(|(a, b)| (a - b).abs() > 1e-6);
    assert!(!apart, "found {found:?}, expected {expected:?}");
}

/// Panics unless the program ran to its end.
#[track_caller]
pub fn ended(run: &Run) {
    assert_eq!(run.end, End::Ended);
}

/// Runs every corpus program of a dialect with bytes changed, dropped, doubled and swapped, and
/// asks only that each run ends by itself or at its bounds. The seed is fixed.
pub fn survives_mutation(dialect: &str, library: &[&str]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(dialect);
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let rest: Vec<(&str, Vec<u8>)> = library.iter().map(|name| (*name, read(name))).collect();
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".nc"))
        .collect();
    names.sort();
    let control = Control::from_profile(&format!("dialect = \"{dialect}\"")).unwrap();
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    eprintln!("seed {state:#x}");
    let mut random = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below.max(1) as u64) as usize
    };
    let scenario =
        Scenario { steps: 400, events: 2_000, answers: vec![3.0, 2.0, 0.25], ..Scenario::default() };
    for name in &names {
        let text = read(name);
        for _ in 0..15 {
            let damaged = damage(&text, &mut random);
            let mut files: Vec<(&str, &[u8])> = vec![(name, &damaged)];
            files.extend(rest.iter().map(|(name, text)| (*name, text.as_slice())));
            let run = run_on(&control, &files, &scenario);
            assert!(run.steps <= 400 && run.events.len() <= 2_001, "{name} runs on");
        }
    }
}

fn damage(text: &[u8], random: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    const BYTES: &[u8] = b"0123456789.-+*/=<>()#:$%GMLPXYZRVNOFHDETIJKAS \n";
    let mut out = text.to_vec();
    for _ in 0..1 + random(4) {
        let at = random(out.len());
        let byte = BYTES.get(random(BYTES.len())).copied().unwrap_or(b' ');
        match random(4) {
            0 if at < out.len() => out[at] = byte,
            1 => out.insert(at.min(out.len()), byte),
            2 if at < out.len() => {
                out.remove(at);
            }
            _ => {
                // A line stands again elsewhere.
                let lines: Vec<&[u8]> = out.split_inclusive(|byte| *byte == b'\n').collect();
                let line = lines.get(random(lines.len())).map_or(Vec::new(), |line| line.to_vec());
                let starts: usize = lines.iter().take(random(lines.len())).map(|line| line.len()).sum();
                out.splice(starts..starts, line);
            }
        }
    }
    out
}

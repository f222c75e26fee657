//! What blocks mean (`tests/lowering/`, in the form of `support/cases.rs`); and lowering takes any program, right or wrong, without a fault of its own: it
//! ends, it does not panic, and what it makes keeps the IR's contract.

#[path = "support/cases.rs"]
mod cases;
#[path = "support/machine.rs"]
mod machine;

use cases::{Case, cases, hold};
use macroglot::diag::{Code, Diagnostic};
use macroglot::dialect::{Control, registry};
use macroglot::ir::{Module, SourceInfo, text, validate};
use macroglot::lower::Lower;
use macroglot::syntax::{Parser, parse_file};
use std::collections::BTreeSet;
use std::path::Path;

/// Mutations start here; a failure prints the one it came from.
const SEED: u64 = 0x9E37_79B9_7F4A_7C15;
/// Mutated versions of each corpus program.
const ROUNDS: usize = 40;

struct Subject {
    name: &'static str,
    control: Control,
    parse: Parser,
    lower: Lower,
}

/// Every dialect.
fn subjects() -> Vec<Subject> {
    let built = |entry: &'static registry::Entry| {
        Some(Subject {
            name: entry.name,
            control: Control::plain(entry.name)?,
            parse: entry.parse,
            lower: entry.lower,
        })
    };
    registry::all().iter().filter_map(built).collect()
}

fn corpus(dialect: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(dialect);
    let mut programs: Vec<(String, Vec<u8>)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "nc"))
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&path).unwrap()))
        .collect();
    programs.sort();
    programs
}

impl Subject {
    /// Lowers a program and says what is wrong with the IR.
    fn faults(&self, name: &str, source: &[u8]) -> Vec<String> {
        let lowered = (self.lower)(&parse_file(source, self.parse), 0, name, &self.control);
        let mut module = Module { names: lowered.names, ..Module::default() };
        module.programs.extend(lowered.programs.into_iter().map(|(program, _)| program));
        validate(&module).err().unwrap_or_default().iter().map(ToString::to_string).collect()
    }
}

/// What is wrong with the IR of a case, if anything is.
fn fault(case: &Case) -> Option<String> {
    let control = machine::machine(&case.from).unwrap_or_else(|error| panic!("{error}"));
    let entry = control.entry();
    let lower = registry::find(entry.name).expect("the dialect").lower;
    let lowered = lower(&parse_file(case.source.as_bytes(), entry.parse), 0, "program.nc", &control);
    let mut module = Module::default();
    let mut reports = BTreeSet::new();
    for (mut program, findings) in lowered.programs {
        // Where things stand is no part of what they mean.
        program.site = SourceInfo::default();
        for block in &mut program.blocks {
            block.stmts.iter_mut().for_each(|stmt| stmt.site.span = Default::default());
            block.term.site.span = Default::default();
        }
        module.programs.push(program);
        reports.extend(findings.iter().map(report));
    }
    let faults = validate(&module).err();
    let wanted = text::parse(&format!("program unnamed file 0 {{\n{}}}\n", case.ir))
        .unwrap_or_else(|error| panic!("{}: {error}", case.name));
    let (wanted, got) = (text::print(&wanted), text::print(&module));
    (faults.is_some() || wanted != got || reports != case.reports).then(|| {
        format!("{}\nwanted {wanted}{:?}\ngot {got}{reports:?}\n{faults:?}", case.source, case.reports)
    })
}

/// A fact by its name, another finding by its code.
fn report(found: &Diagnostic) -> String {
    match found.code {
        Code::UnconfirmedFact => format!("fact {}", found.message.split('\'').nth(1).unwrap()),
        code => code.number().to_owned(),
    }
}

#[test]
fn blocks_mean_what_the_manuals_say() {
    hold(&cases("tests/lowering"), 50, fault);
}

#[test]
fn corpus_programs_lower_to_valid_ir() {
    for subject in subjects() {
        for (name, source) in corpus(subject.name) {
            assert_eq!(subject.faults(&name, &source), [""; 0], "{} {name}", subject.name);
        }
    }
}

#[test]
fn mutated_programs_lower_to_valid_ir() {
    for subject in subjects() {
        let programs = corpus(subject.name);
        for (at, (name, source)) in programs.iter().enumerate() {
            for round in 0..ROUNDS {
                let seed = SEED ^ ((at * ROUNDS + round) as u64);
                let other = &programs[(at + round) % programs.len()].1;
                let mutated = mutate(source, other, seed);
                let faults = subject.faults(name, &mutated);
                let text = String::from_utf8_lossy(&mutated);
                assert_eq!(faults, [""; 0], "{} {name} seed {seed:#x}\n{text}", subject.name);
            }
        }
    }
}

/// Whole lines are lost, doubled, exchanged and taken from another program, and
/// single bytes change to ones that programs are made of.
fn mutate(source: &[u8], other: &[u8], seed: u64) -> Vec<u8> {
    let mut random = Random(seed);
    let mut lines: Vec<Vec<u8>> = source.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
    let foreign: Vec<&[u8]> = other.split(|&b| b == b'\n').collect();
    for _ in 0..1 + random.below(6) {
        let at = random.below(lines.len());
        match random.below(6) {
            0 if lines.len() > 1 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[at].clone()),
            2 => {
                let to = random.below(lines.len());
                lines.swap(at, to);
            }
            3 => lines.insert(at, foreign[random.below(foreign.len())].to_vec()),
            _ if lines[at].is_empty() => {}
            4 => {
                let place = random.below(lines[at].len());
                lines[at].remove(place);
            }
            _ => {
                const BYTES: &[u8] = b"GMVXYZRTPLNO#$0123456789.-+*/=[]() %IDEBQ\xC4";
                let place = random.below(lines[at].len());
                lines[at][place] = BYTES[random.below(BYTES.len())];
            }
        }
    }
    lines.join(&b'\n')
}

/// A small generator of its own, so that seeds mean the same everywhere (splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % limit.max(1) as u64) as usize
    }
}

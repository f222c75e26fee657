//! Programs as `macroglot run` runs them, against what interpreters in another language make of them
//! (`tests/interpreter/`).

#[path = "support/cases.rs"]
mod cases;
mod support;

use cases::{Case, cases, hold};
use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Command;
use support::root;

/// How far a number may lie from the expected one, as a part of it where it is above 1.
const NEAR: f64 = 1e-6;
const PROGRAMS: usize = 120;

/// What a program does: how it ends, its moves, the variables that are left.
#[derive(Debug, Default)]
struct Run {
    end: String,
    moves: Vec<(String, Vec<f64>)>,
    values: BTreeMap<String, f64>,
}

/// What a case says that its program does.
fn wanted(case: &Case) -> Run {
    let moves = case.moves.lines().map(|line| {
        let (kind, numbers) = line.split_once(' ').expect("a kind and a place");
        (kind.to_owned(), numbers.split(' ').map(|number| number.parse().unwrap()).collect())
    });
    Run { end: case.ends.clone(), moves: moves.collect(), values: case.variables.clone() }
}

fn run(program: &str, dialect: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.nc");
    std::fs::write(&path, program).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_macroglot"));
    command.current_dir(root()).arg("run").arg(path).args(["--trace", "json", "--dialect", dialect]);
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let mut found = Run::default();
    for line in text.lines() {
        let event: Value = serde_json::from_str(line).unwrap();
        let place = |key: &str| ["x", "y", "z"].map(|axis| event[key][axis].as_f64().unwrap_or(f64::NAN));
        match event["event"].as_str().unwrap() {
            kind @ ("rapid" | "feed") => {
                let (from, to) = (place("from"), place("to"));
                if from.iter().zip(to).any(|(a, b)| (a - b).abs() > NEAR) {
                    found.moves.push((kind.to_owned(), to.to_vec()));
                }
            }
            "result" => {
                found.end = event["end"].as_str().unwrap().to_owned();
                for (name, value) in event["variables"].as_object().unwrap() {
                    // Locals end with their level.
                    if !name.starts_with('#') || name.len() > "#33".len() {
                        found.values.extend(value.as_f64().map(|value| (name.clone(), value)));
                    }
                }
            }
            _ => {}
        }
    }
    found
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= NEAR * a.abs().max(1.0)
}

/// The first thing in which two runs differ.
fn difference(found: &Run, wanted: &Run) -> Option<String> {
    if found.end != wanted.end {
        return Some(format!("ends by {}, not {}", found.end, wanted.end));
    }
    let same = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_near(*a, *b));
    for at in 0..found.moves.len().max(wanted.moves.len()) {
        match (found.moves.get(at), wanted.moves.get(at)) {
            (Some(a), Some(b)) if a.0 == b.0 && same(&a.1, &b.1) => {}
            (a, b) => return Some(format!("move {at} is {a:?}, not {b:?}")),
        }
    }
    let names = found.values.keys().chain(wanted.values.keys());
    names.map(|name| (name, found.values.get(name), wanted.values.get(name))).find_map(|(name, a, b)| {
        let alike = a.zip(b).is_some_and(|(a, b)| is_near(*a, *b));
        (!alike).then(|| format!("{name} is {a:?}, not {b:?}"))
    })
}

fn check(dialect: &str) {
    let cases = cases(&format!("tests/interpreter/{dialect}.toml"));
    hold(&cases, PROGRAMS, |case| {
        assert_eq!(case.from, dialect);
        difference(&run(&case.source, dialect), &wanted(case))
            .map(|fault| format!("{fault}\n{}", case.source))
    });
}

#[test]
fn fanuc_programs_run_as_another_interpreter_runs_them() {
    check("fanuc");
}

#[test]
fn haas_programs_run_as_another_interpreter_runs_them() {
    check("haas");
}

#[test]
fn fadal_programs_run_as_another_interpreter_runs_them() {
    check("fadal");
}

#[test]
fn cc100_programs_run_as_another_interpreter_runs_them() {
    check("cc100");
}

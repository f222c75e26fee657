//! The moves of programs as `macroglot run` traces them, against lists that the scripts in `tests/motions/`
//! work out from the parts' geometry. Each file of `tests/motions/expected/` says which program runs under
//! which circumstances, and every move that must come of it.

#[path = "motions/converted.rs"]
mod converted;
mod support;

use converted::Converts;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::root;

/// How far a number may lie from the expected one: millimetres, degrees, seconds.
const NEAR: f64 = 1e-6;

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Expectation {
    control: String,
    /// The program's file, then those that it calls.
    run: Vec<String>,
    ends: String,
    /// True where the list says what the spindle does and where the program waits for the operator.
    #[serde(default)]
    turns: bool,
    /// True where places have the C axis too, in degrees, after z.
    #[serde(default)]
    c_axis: bool,
    profile: String,
    scenario: String,
    moves: String,
    /// The conversions that must make the same moves.
    #[serde(default)]
    converts: Vec<Converts>,
}

impl Expectation {
    fn list(&self) -> Vec<Move> {
        self.moves.lines().filter(|line| !line.is_empty()).map(expected).collect()
    }
}

/// A move: its kind, its numbers, and what its feed counts.
#[derive(Debug, PartialEq)]
struct Move {
    kind: String,
    numbers: Vec<f64>,
    mode: String,
}

impl Move {
    fn is_near(&self, other: &Self) -> bool {
        self.is_within(other, NEAR)
    }

    fn is_within(&self, other: &Self, most: f64) -> bool {
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= most;
        (&self.kind, &self.mode, self.numbers.len()) == (&other.kind, &other.mode, other.numbers.len())
            && self.numbers.iter().zip(&other.numbers).all(near)
    }
}

/// A line of an expectation.
fn expected(line: &str) -> Move {
    let mut words = line.split_whitespace();
    let kind = words.next().unwrap_or_default().to_owned();
    let (mut numbers, mut mode) = (Vec::new(), String::new());
    for word in words {
        match word.parse() {
            Ok(number) => numbers.push(number),
            Err(_) => mode = word.to_owned(),
        }
    }
    Move { kind, numbers, mode }
}

/// The move of a line of a trace; none for other events, and for a way of no length.
fn traced(event: &Value, expectation: &Expectation) -> Option<Move> {
    let turns = expectation.turns;
    let number = |key: &str| event[key].as_f64().unwrap_or(f64::NAN);
    let axes: &[&str] = if expectation.c_axis { &["x", "y", "z", "c"] } else { &["x", "y", "z"] };
    let place = |key: &str| -> Vec<f64> {
        axes.iter()
            .map(|axis| event[key][axis].as_f64().unwrap_or(if *axis == "c" { 0.0 } else { f64::NAN }))
            .collect()
    };
    let kind = event["event"].as_str()?;
    let mut numbers = match kind {
        "rapid" | "feed" | "arc" | "thread" | "probe" => place("to"),
        "hole" => place("at"),
        "dwell" => vec![number("seconds")],
        "spindle" if turns => vec![number("speed")],
        "stop" if turns => Vec::new(),
        _ => return None,
    };
    let still = place("from").iter().zip(place("to")).all(|(a, b)| (a - b).abs() <= NEAR);
    match kind {
        "rapid" | "feed" if still => return None,
        "feed" => numbers.push(number("feed")),
        "arc" => {
            numbers.extend(place("centre"));
            numbers.extend([number("sweep"), number("feed")]);
        }
        "thread" => numbers.push(number("lead")),
        "probe" => {
            numbers.extend(place("aim"));
            numbers.push(number("feed"));
        }
        "hole" => numbers.push(number("bottom")),
        _ => {}
    }
    let mode = event["mode"].as_str().or(event["direction"].as_str()).unwrap_or_default().to_owned();
    Some(Move { kind: kind.to_owned(), numbers, mode })
}

/// The moves that the program makes, and how it ends.
fn moves(expectation: &Expectation) -> (Vec<Move>, String) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let mut command = Command::new(env!("CARGO_BIN_EXE_macroglot"));
    command.current_dir(root()).args(["run", "--trace", "json", "--dialect", &expectation.control]);
    command.arg("--machine").arg(write("profile.toml", &expectation.profile));
    command.arg("--scenario").arg(write("scenario.toml", &expectation.scenario));
    let (program, library) = expectation.run.split_first().expect("a program");
    command.arg(program);
    for path in library {
        command.args(["--library", path]);
    }
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let events: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let end = events.last().and_then(|result| result["end"].as_str()).unwrap_or_default().to_owned();
    assert!(!end.is_empty(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
    (events.iter().filter_map(|event| traced(event, expectation)).collect(), end)
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// The first place where the two lists part.
fn difference(found: &[Move], wanted: &[Move]) -> Option<String> {
    difference_by(found, wanted, Move::is_near)
}

fn difference_by(found: &[Move], wanted: &[Move], alike: impl Fn(&Move, &Move) -> bool) -> Option<String> {
    let longest = found.len().max(wanted.len());
    let at = (0..longest).find(|&at| match (found.get(at), wanted.get(at)) {
        (Some(found), Some(wanted)) => !alike(found, wanted),
        _ => true,
    })?;
    Some(format!("move {at} of {longest}\n  expected {:?}\n  found    {:?}", wanted.get(at), found.get(at)))
}

/// All expectations of mills and their files.
fn expectations() -> Vec<(PathBuf, Expectation)> {
    expectations_of("tests/motions/expected")
}

/// Those of a folder.
fn expectations_of(folder: &str) -> Vec<(PathBuf, Expectation)> {
    let folders = files(&root().join(folder));
    let paths = folders.iter().flat_map(|folder| files(folder));
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        let expectation = toml::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        (path, expectation)
    };
    paths.map(read).collect()
}

#[test]
fn programs_move_as_their_geometry_says() {
    let mut counts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    let mut wrong = Vec::new();
    for (path, expectation) in expectations() {
        let wanted = expectation.list();
        let (found, end) = moves(&expectation);
        if let Some(difference) = difference(&found, &wanted) {
            wrong.push(format!("{}: {difference}", path.display()));
        }
        if end != expectation.ends {
            wrong.push(format!("{}: ends by {end}, not {}", path.display(), expectation.ends));
        }
        let count = counts.entry(expectation.control).or_default();
        *count = (count.0 + 1, count.1 + wanted.len());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    eprintln!("programs and moves: {counts:?}");
    assert_eq!(counts.len(), 4);
    assert!(counts.values().all(|(programs, _)| *programs >= 8), "{counts:?}");
    assert!(counts.values().map(|(programs, _)| programs).sum::<usize>() >= 90, "{counts:?}");
}

/// Lathes: single passes, threads, grooves and contours, against lists worked out from the parts.
#[test]
fn lathes_move_as_their_parts_say() {
    lathes_move_as("tests/motions/expected-lathe", 50);
}

/// Lathes with driven tools and a C axis, corners and angles of lines.
#[test]
fn live_tools_move_as_their_parts_say() {
    lathes_move_as("tests/motions/expected-live", 31);
}

/// Holds the lists of a folder, at least so many, against the emulated lathes.
fn lathes_move_as(folder: &str, least: usize) {
    let mut wrong = Vec::new();
    let mut counts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for (path, expectation) in expectations_of(folder) {
        let wanted = expectation.list();
        let (found, end) = moves(&expectation);
        if let Some(difference) = difference(&found, &wanted) {
            wrong.push(format!("{}: {difference}", path.display()));
        }
        if end != expectation.ends {
            wrong.push(format!("{}: ends by {end}, not {}", path.display(), expectation.ends));
        }
        let count = counts.entry(expectation.control).or_default();
        *count = (count.0 + 1, count.1 + wanted.len());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    eprintln!("programs and moves of lathes: {counts:?}");
    assert_eq!(counts.len(), 2);
    assert!(counts.values().map(|(programs, _)| programs).sum::<usize>() >= least, "{counts:?}");
}

/// A list that is wrong in one number, lacks a move or has one too many is found out.
#[test]
fn a_wrong_list_is_found_out() {
    let text = std::fs::read_to_string(root().join("tests/motions/expected/cc100/example4-a.toml")).unwrap();
    let expectation: Expectation = toml::from_str(&text).unwrap();
    let (found, _) = moves(&expectation);
    assert_eq!(difference(&found, &expectation.list()), None);
    for at in 0..found.len() {
        let mut list = expectation.list();
        list.remove(at);
        assert!(difference(&found, &list).is_some(), "without move {at}");
        for number in 0..found[at].numbers.len() {
            let mut list = expectation.list();
            list[at].numbers[number] += 2.0 * NEAR;
            assert!(difference(&found, &list).is_some(), "number {number} of move {at}");
        }
    }
}

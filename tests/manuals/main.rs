//! What the manuals say that their expressions and programs give, row by row: `corpus/*/values.tsv` and the
//! expected results of `corpus/MANIFEST.tsv`. `tests/manuals/*.toml` hold a run on an emulated control for
//! each row, or the reason why no run can check it; their first lines explain them.

mod checks;
mod circumstances;
#[path = "../support/mod.rs"]
mod support;

use checks::{check, end};
use circumstances::run;
use std::collections::BTreeMap;
use support::text;

/// A row of a manual with what checks it.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    /// The dialect.
    control: String,
    row: String,
    given: String,
    #[serde(default)]
    runs: Vec<Check>,
    /// Why no run can check it.
    why: Option<String>,
}

/// A run, and what must hold at its end.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Check {
    /// What the program meets.
    #[serde(default)]
    with: String,
    source: String,
    holds: Vec<String>,
}

/// The rows of a file of `tests/manuals/`.
fn rows(path: &str) -> Vec<Row> {
    let mut file: BTreeMap<String, Vec<Row>> =
        toml::from_str(&text(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    file.remove("row").expect("rows")
}

/// The faults of a row's runs.
fn faults(row: &Row) -> Vec<String> {
    let mut out = Vec::new();
    for Check { with, source, holds } in &row.runs {
        let checks: Vec<&str> = holds.iter().map(String::as_str).collect();
        let run = run(&row.control, with, source);
        let results = checks.iter().map(|one| check(&run, one)).chain([end(&run, &checks)]);
        let place = |fault| format!("{}: {with} {source}\n    {fault}", row.row);
        out.extend(results.filter_map(Result::err).map(place));
    }
    out
}

/// Runs the rows of a file that must be those of the manuals; returns how many no run can check.
fn all_hold(path: &str, manual: &[(String, String)]) -> BTreeMap<String, usize> {
    let rows = rows(path);
    let keys: Vec<(String, String)> =
        rows.iter().map(|row| (row.control.clone(), format!("{}\t{}", row.row, row.given))).collect();
    for key in manual {
        assert!(keys.contains(key), "{path}: no row {key:?}");
    }
    for key in &keys {
        assert!(manual.contains(key), "{path}: a row that the corpus does not have: {key:?}");
    }
    assert_eq!(keys.len(), manual.len(), "{path}: a row stands twice");
    for row in &rows {
        let one = row.runs.is_empty() != row.why.as_ref().is_none_or(String::is_empty);
        assert!(one, "{path}: {} has neither or both of a run and a reason", row.row);
    }
    let wrong: Vec<String> = rows.iter().flat_map(faults).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let mut unchecked = BTreeMap::new();
    for row in rows.iter().filter(|row| row.why.is_some()) {
        *unchecked.entry(row.control.clone()).or_default() += 1;
    }
    unchecked
}

fn columns(path: &str) -> Vec<Vec<String>> {
    text(path).lines().skip(1).map(|line| line.split('\t').map(str::to_owned).collect()).collect()
}

#[test]
fn values_are_the_manuals() {
    let mut manual = Vec::new();
    for dialect in ["fadal", "fanuc", "haas", "cc100"] {
        for row in columns(&format!("corpus/{dialect}/values.tsv")) {
            manual.push((dialect.to_owned(), format!("{}\t{}", row[0], row[1])));
        }
    }
    // A row that stands twice (with and without a parameter) is told apart by its result.
    let unchecked = all_hold("tests/manuals/values.toml", &distinct(manual));
    assert_eq!(unchecked.values().sum::<usize>(), UNCHECKED_VALUES, "{unchecked:?}");
}

/// Rows with the same words get a number.
fn distinct(rows: Vec<(String, String)>) -> Vec<(String, String)> {
    let mut seen: BTreeMap<(String, String), usize> = BTreeMap::new();
    let number = |row: (String, String)| {
        let count = seen.entry(row.clone()).or_default();
        *count += 1;
        if *count == 1 { row } else { (row.0, format!("{} ({count})", row.1)) }
    };
    rows.into_iter().map(number).collect()
}

#[test]
fn programs_give_what_the_manifest_expects() {
    let manifest = columns("corpus/MANIFEST.tsv");
    let header = text("corpus/MANIFEST.tsv");
    let place = |name: &str| {
        header.lines().next().and_then(|line| line.split('\t').position(|column| column == name)).unwrap()
    };
    let (file, expected) = (place("file"), place("expected_result"));
    let manual: Vec<(String, String)> = manifest
        .iter()
        .filter(|row| row[expected] != "-")
        .map(|row| {
            let (dialect, name) = row[file].split_once('/').unwrap();
            (dialect.to_owned(), format!("{name}\t{}", row[expected]))
        })
        .collect();
    let unchecked = all_hold("tests/manuals/programs.toml", &manual);
    assert_eq!(unchecked.values().sum::<usize>(), UNCHECKED_PROGRAMS, "{unchecked:?}");
}

/// Rows of the tables of values that no run can check; each has its reason in the file.
const UNCHECKED_VALUES: usize = 5;

/// Programs whose expected result no run can check.
const UNCHECKED_PROGRAMS: usize = 1;

#[test]
fn wrong_values_are_found_out() {
    let found = run("fadal", "", "#V1=5 | G0 X1. | G81 X2. R0+1. Z-1. F30. | G4 P500 | #PRINT \"A\",V1");
    for (right, wrong) in [
        ("V1=5", "V1=5.00001"),
        ("V2=null", "V1=null"),
        ("holes 1", "holes 2"),
        ("hole 2,0,-1", "hole 2,0,1"),
        ("through 1,0,0", "through 1,0,1"),
        ("last 2,0,0", "last 2,0,1"),
        ("feed 30", "feed 31"),
        ("dwell 0.5", "dwell 5"),
        ("out A5", "out A6"),
        ("letters A 5", "letters A 6"),
        ("went V1=5", "went V1=5,6"),
        ("stops 0", "stops 1"),
        ("still", "speed 100"),
        ("nowrite output[1]", "write output[1]"),
    ] {
        assert_eq!(check(&found, right), Ok(()));
        assert!(check(&found, wrong).is_err(), "{wrong}");
    }
    assert!(end(&found, &["ends alarm"]).is_err() && end(&found, &["alarm X"]).is_err());
}

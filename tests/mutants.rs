//! The list of mutants (`tests/mutants/list.toml`) fits the compiler as it is: each fault still has its place. What the
//! verifier makes of them, `tests/mutants/run` tells.

mod support;

use std::collections::BTreeSet;
use support::text;

#[derive(serde::Deserialize)]
struct List {
    mutant: Vec<Mutant>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Mutant {
    name: String,
    file: String,
    text: String,
    with: String,
    survives: Option<String>,
}

#[test]
fn every_mutant_has_its_place() {
    let list: List = toml::from_str(&text("tests/mutants/list.toml")).unwrap();
    let names: BTreeSet<&str> = list.mutant.iter().map(|mutant| mutant.name.as_str()).collect();
    assert_eq!(names.len(), list.mutant.len(), "a name stands twice");
    for Mutant { name, file, text: old, with, .. } in &list.mutant {
        let compiler = ["lower", "ir", "opt", "legalize", "emit"]
            .iter()
            .any(|room| file.starts_with(&format!("src/{room}/")));
        assert!(compiler, "{name}: {file} is no part of the compiler");
        assert_eq!(text(file).matches(old.as_str()).count(), 1, "{name}: in {file}");
        assert_ne!(old, with, "{name}");
    }
    let found = list.mutant.iter().filter(|mutant| mutant.survives.is_none()).count();
    assert!(found >= 24 && list.mutant.len() >= 25, "{found} of {}", list.mutant.len());
}

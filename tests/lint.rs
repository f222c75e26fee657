//! The rules of the lint: programs that have a fault and programs that nearly have it (`tests/lint/`), what they find in
//! the corpus (`tests/lint/corpus.tsv`), and the page of rules (`docs/lint.md`).

#[path = "support/machine.rs"]
mod machine;
mod support;

use machine::machine;
use macroglot::diag::{Code, Severity};
use macroglot::dialect::{Control, Profile, registry};
use macroglot::library::{Input, gather, understood};
use macroglot::lint::{RULES, lint};
use macroglot::text::LineIndex;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use support::{assert_fresh, root};

/// A library and what rules find in it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    /// A dialect or a machine.
    from: String,
    /// The rules that are tried.
    rules: Vec<String>,
    /// One file.
    #[serde(default)]
    source: String,
    /// Several files, by their names.
    #[serde(default)]
    files: BTreeMap<String, String>,
    /// What is found: `file:line:column code`, the file where there are several.
    #[serde(default)]
    finds: Vec<String>,
    /// What messages say, among other things.
    #[serde(default)]
    says: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    case: Vec<Case>,
}

fn cases() -> Vec<Case> {
    let mut files: Vec<_> =
        std::fs::read_dir(root().join("tests/lint")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    let read = |file: &std::path::PathBuf| {
        let text = std::fs::read_to_string(file).unwrap();
        toml::from_str::<File>(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display())).case
    };
    files.iter().flat_map(read).collect()
}

fn input(name: &str, text: &str) -> Input {
    Input { path: name.into(), name: name.into(), bytes: text.as_bytes().to_vec() }
}

/// What rules find in a library: its file, line and column, and the code; and what is said.
fn found(
    inputs: &[Input],
    control: &Control,
    wanted: &dyn Fn(Code) -> bool,
) -> Vec<(String, usize, usize, Code, String)> {
    let understood = understood(inputs, control);
    let found = lint(inputs, control, &understood.module, wanted);
    let placed = found.into_iter().map(|(file, found)| {
        let (line, column) = LineIndex::new(&inputs[file].bytes).place(found.span.start);
        (inputs[file].name.clone(), line as usize, column as usize, found.code, found.message.to_string())
    });
    placed.collect()
}

#[test]
fn rules_find_faults_and_accuse_nothing_else() {
    let cases = cases();
    let mut faults = Vec::new();
    let mut by_rule: BTreeMap<String, (BTreeSet<&str>, usize)> = BTreeMap::new();
    for case in &cases {
        let control = machine(&case.from).unwrap_or_else(|error| panic!("{error}"));
        let mut inputs: Vec<Input> = case.files.iter().map(|(name, text)| input(name, text)).collect();
        if !case.source.is_empty() {
            inputs.push(input("case.nc", &case.source));
        }
        let codes: Vec<Code> = case.rules.iter().map(|code| Code::find(code).unwrap()).collect();
        let found = found(&inputs, &control, &|code| codes.contains(&code));
        let several = case.files.len() > 1;
        let told: Vec<String> = (found.iter())
            .map(|(file, line, column, code, _)| {
                let file = if several { format!("{file}:") } else { String::new() };
                format!("{file}{line}:{column} {}", code.number())
            })
            .collect();
        let silent: Vec<&String> = (case.says.iter())
            .filter(|says| !found.iter().any(|(.., message)| message.contains(says.as_str())))
            .collect();
        if told != case.finds || !silent.is_empty() {
            let said: Vec<&String> = found.iter().map(|(.., message)| message).collect();
            faults.push(format!(
                "{} ({})\n{}\nwanted {:?}\ngot    {told:?}\nnot said {silent:?}\nsaid {said:#?}\n",
                case.name, case.from, case.source, case.finds
            ));
        }
        for rule in &case.rules {
            let (found, quiet) = by_rule.entry(rule.clone()).or_default();
            if case.finds.iter().any(|finding| finding.ends_with(rule.as_str())) {
                found.insert(&case.from);
            } else {
                *quiet += 1;
            }
        }
    }
    assert!(faults.is_empty(), "{} of {} cases\n\n{}", faults.len(), cases.len(), faults.join("\n"));
    let lacks = RULES
        .iter()
        .map(|rule| rule.code.number())
        .filter(|number| by_rule.get(*number).is_none_or(|(found, quiet)| found.is_empty() || *quiet == 0));
    let lacks: Vec<&str> = lacks.collect();
    assert!(lacks.is_empty(), "no case has what these find, or none nearly has it: {lacks:?}");
}

/// The libraries of the project file, with their machines.
const LIBRARIES: [(&str, &str); 4] =
    [("fadal", ""), ("cc100", ""), ("fanuc", "machines/fanuc-0i.toml"), ("haas", "machines/haas-vf.toml")];

/// The control of a library of the project file.
fn control_of(library: &str, profile: &str) -> Control {
    if profile.is_empty() {
        return Control::plain(library).unwrap();
    }
    let profile = Profile::read(&support::text(profile)).unwrap();
    Control::new(registry::find(library).unwrap(), profile).unwrap()
}

#[test]
fn findings_in_the_corpus_are_these() {
    let mut counts: BTreeMap<Code, BTreeMap<&str, usize>> = BTreeMap::new();
    let mut places = String::new();
    for (library, spec) in LIBRARIES {
        let control = control_of(library, spec);
        let inputs = gather(&[root().join("corpus").join(library)], &[]).programs;
        for (file, line, column, code, message) in found(&inputs, &control, &|_| true) {
            *counts.entry(code).or_default().entry(library).or_default() += 1;
            let _ = writeln!(places, "{}\t{library}/{file}:{line}:{column}\t{message}", code.number());
        }
    }
    let mut lines: Vec<&str> = places.lines().collect();
    lines.sort_unstable();
    let mut out = String::from("rule\tfadal\tcc100\tfanuc\thaas\n");
    for rule in RULES {
        let of = |library: &str| counts.get(&rule.code).and_then(|by| by.get(library)).copied().unwrap_or(0);
        let all = LIBRARIES.map(|(library, _)| of(library).to_string());
        let _ = writeln!(out, "{}\t{}", rule.code.number(), all.join("\t"));
    }
    out.push('\n');
    lines.iter().for_each(|line| {
        let _ = writeln!(out, "{line}");
    });
    assert_fresh("tests/lint/corpus.tsv", &out);
}

#[test]
fn no_text_makes_a_rule_panic() {
    for (library, _) in LIBRARIES {
        let inputs = gather(&[root().join("corpus").join(library)], &[]).programs;
        for entry in registry::all() {
            let control = Control::plain(entry.name).unwrap();
            for input in &inputs {
                found(std::slice::from_ref(input), &control, &|_| true);
            }
            found(&inputs, &control, &|_| true);
        }
    }
}

#[test]
fn the_page_is_fresh() {
    let mut out = String::from(
        "# Rules of the lint\n\nWritten by `UPDATE=1 cargo test --test lint`. `macroglot check` runs those that are on; \
         `--select` asks for others by their codes. `macroglot explain CODE` prints the page of one.\n\n\
         | code | finds | gravity | on |\n|---|---|---|---|\n",
    );
    for rule in RULES {
        let gravity = if rule.code.severity() == Severity::Note { "note" } else { "review" };
        let on = if rule.on { "yes" } else { "no" };
        let _ = writeln!(out, "| {} | {} | {gravity} | {on} |", rule.code.number(), rule.code.title());
    }
    out.push_str("\n## Why\n");
    for rule in RULES {
        let _ = write!(out, "\n### {}: {}\n\n{}\n", rule.code.number(), rule.code.title(), rule.code.page());
    }
    assert_fresh("docs/lint.md", &out);
}

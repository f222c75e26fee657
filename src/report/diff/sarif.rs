//! A diff as SARIF 2.1.0: each place at which the machine does something else is a result at its line.

use super::words::{title, verdict, what};
use crate::diff::{Diff, ProgramDiff, Verdict};
use crate::library::Input;
use crate::report::sarif::uri;
use crate::text::json_pretty;
use crate::verify::{Change, Seen};
use serde_json::{Value, json};
use std::path::Path;

/// The rules: what a result is about.
const RULES: [(&str, &str, &str); 4] = [
    ("diff.motion", "The machine does something else", "error"),
    ("diff.program", "A program is new, gone, or has another number", "error"),
    ("diff.undecided", "No difference was found, but not every way was looked at", "warning"),
    ("diff.structure", "The build of the program changed", "note"),
];

/// The diff as SARIF text; `old` and `new` are the files that were read.
pub fn diff(diff: &Diff, old: &[Input], new: &[Input]) -> String {
    let rules: Vec<Value> = RULES
        .iter()
        .map(|(id, title, level)| {
            json!({ "id": id, "shortDescription": { "text": title }, "defaultConfiguration": { "level": level } })
        })
        .collect();
    let results: Vec<Value> = diff.programs.iter().flat_map(|program| results(program, old, new)).collect();
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": { "name": "macroglot", "version": env!("CARGO_PKG_VERSION"), "rules": rules } },
            "newlineSequences": ["\r\n", "\n", "\r"],
            "results": results,
        }],
    });
    json_pretty(&log) + "\n"
}

fn results(program: &ProgramDiff, old: &[Input], new: &[Input]) -> Vec<Value> {
    let path = |name: &str, on_new: bool| {
        let inputs = if on_new { new } else { old };
        let input = inputs.iter().find(|input| input.name == name);
        input.map_or_else(|| uri(Path::new(name)), |input| uri(&input.path))
    };
    let file = |line: usize| match (&program.new, &program.old) {
        (Some(new), _) => (path(new, true), line),
        (None, Some(old)) => (path(old, false), line),
        (None, None) => (String::new(), line),
    };
    let mut out = Vec::new();
    if program.verdict != Verdict::Same && program.motion.is_none() {
        let rule = if program.verdict == Verdict::Undecided { 2 } else { 1 };
        let text = format!("{}: {}. {}", title(program), verdict(program), program.why.join(". "));
        out.push(result(rule, text.trim(), file(program.line)));
    }
    for note in program.structure.iter().flatten() {
        out.push(result(
            3,
            &format!("{}: {}", note.about, note.text),
            file(note.new.unwrap_or(program.line)),
        ));
    }
    let Some(listing) = &program.motion else { return out };
    let at = |seen: &Seen, on_new| (path(&seen.moment.file, on_new), seen.moment.line as usize);
    let place = |change: &Change| match (&change.new, &change.old) {
        (Some(new), _) => at(new, true),
        (None, Some(old)) if program.new.is_none() => at(old, false),
        _ => file(program.line),
    };
    for change in &listing.changes {
        out.push(result(0, &what(change, listing.inch), place(change)));
    }
    for text in &listing.at_end {
        out.push(result(0, &format!("at the end: {text}"), file(program.line)));
    }
    out
}

fn result(rule: usize, text: &str, (uri, line): (String, usize)) -> Value {
    let (id, _, level) = RULES[rule];
    json!({
        "ruleId": id,
        "ruleIndex": rule,
        "level": level,
        "message": { "text": text },
        "locations": [{ "physicalLocation": {
            "artifactLocation": { "uri": uri },
            "region": { "startLine": line.max(1) },
        }}],
    })
}

//! The first page, the list of programs, and the list of files.

use super::super::text::{folder, left_out_text};
use super::super::{Date, Part, Totals, words};
use super::{Numbers, code, data, escaped, id, link, plural};
use crate::diag::Code;
use crate::library::{Outcome, ProgramReport};
use crate::verify;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Programs that are named of a reason.
const NAMED: usize = 20;

/// Reasons that are named of what was not decided.
const REASONS: usize = 40;

/// The first page: what was converted, by what, for what, and what was not decided.
pub fn first(out: &mut String, parts: &[Part<'_>], date: Date, numbers: &Numbers) {
    let totals = Totals::of(parts);
    out.push_str("<h1 id=\"top\">Conversion report</h1>\n");
    let _ = writeln!(
        out,
        "<p>macroglot {}, {date}</p>\n<nav>{} {} {} {} {} {}</nav>",
        env!("CARGO_PKG_VERSION"),
        link("questions", "Questions"),
        link("index", "All programs"),
        link("programs", "Programs"),
        link("registers", "Registers"),
        link("files", "Files and hashes"),
        link("codes", "What the codes mean"),
    );
    tools(out, &totals);
    let _ = writeln!(out, "<h2>Result</h2>\n<p class=\"outcome\">{totals}</p>");
    outcomes(out, &totals);
    for (at, part) in parts.iter().enumerate() {
        library(out, part, at + 1, parts.len());
    }
    undecided(out, parts, numbers);
    out.push_str(
        "<h2>Signature</h2>\n<p>I have read this report, answered its questions, and agree that the programs are run on the machines \
         named above.</p>\n<div class=\"fields\"><label>Name <input type=\"text\"></label> <label>Date <input type=\"text\"></label> \
         <label>Signature <input type=\"text\" class=\"wide\"></label></div>\n<div class=\"fields\"><label>Not released: <input \
         type=\"text\" class=\"wide\"></label></div>\n",
    );
}

/// What helps to read the page in a browser. It shows only where its script runs.
fn tools(out: &mut String, totals: &Totals) {
    out.push_str(
        "<div id=\"tools\" hidden><input id=\"text\" type=\"search\" placeholder=\"text in a program\" aria-label=\"text\"> \
         <select id=\"outcome\" aria-label=\"outcome\"><option value=\"\">any outcome</option><option>converted</option>\
         <option>accepted</option><option>review</option><option>refused</option></select> <select id=\"code\" aria-label=\"code\"><option value=\"\">any \
         code</option>",
    );
    for (number, count) in &totals.codes {
        let _ = write!(out, "<option value=\"{number}\">{number} ({count})</option>");
    }
    out.push_str(
        "</select> <button id=\"reset\" type=\"button\">Show all</button> <button id=\"fold\" type=\"button\">Fold or open</button> \
         <button id=\"save\" type=\"button\">Save with answers</button> <span id=\"count\"></span> <span class=\"small\">Keys: \
         <kbd>/</kbd> filter, <kbd>n</kbd> <kbd>p</kbd> next and previous program, <kbd>q</kbd> questions</span></div>\n",
    );
}

/// What the outcomes mean.
fn outcomes(out: &mut String, totals: &Totals) {
    let Totals { converted, accepted, review, refused, verified, undecided, different, .. } = totals;
    let judged = verified + undecided + different;
    let [same, looked] = match judged {
        0 => [
            "Nothing was found in the translation that a person must look at.",
            "A person must answer the questions of its codes.",
        ],
        _ => [
            "Both machines did the same in every scenario and down every branch.",
            "No difference was found, but a person must answer the questions of its codes.",
        ],
    };
    let none =
        "Nothing that can be run is written: something in it has no equivalent, or a difference was found.";
    let answered = "As for review, and a person has accepted each thing that was asked: see Accepted, below the questions.";
    let rows = [
        ("converted", *converted, same),
        ("accepted", *accepted, answered),
        ("review", *review, looked),
        ("refused", *refused, none),
    ];
    // Who accepts nothing reads nothing of it.
    let rows = rows.into_iter().filter(|(outcome, count, _)| *outcome != "accepted" || *count > 0);
    out.push_str("<table class=\"list\">\n<tr><th>Outcome<th>Programs<th>What it means\n");
    for (outcome, count, meaning) in rows {
        let _ = writeln!(out, "<tr><td class=\"{outcome}\">{outcome}<td>{count}<td>{meaning}");
    }
    out.push_str("</table>\n");
    if judged == 0 && converted + accepted + review > 0 {
        out.push_str(
            "<p class=\"refused\"><b>No program was verified.</b> The outcomes rest on the translation alone: nothing was run beside \
             its source.</p>\n",
        );
    }
}

fn library(out: &mut String, part: &Part<'_>, number: usize, of: usize) {
    let heading = if of == 1 { "Library".to_owned() } else { format!("Library {number}") };
    let _ = writeln!(out, "<h3>{heading}: {} to {}</h3>\n<table>", escaped(part.from), escaped(part.to));
    for (side, control) in ["From", "To"].into_iter().zip(part.controls) {
        let profile = match &control.profile().file {
            Some(path) => format!("machine profile {}", escaped(&path.display().to_string())),
            None => "no machine profile: its tables alone".to_owned(),
        };
        let hash = verify::Identity::of(control).sha256;
        let _ = writeln!(
            out,
            "<tr><th>{side}<td>{}, {profile}<br><span class=\"hash\">table and profile {hash}</span>",
            escaped(&control.dialect().title)
        );
    }
    let files = data::files(part);
    let written =
        files.iter().filter_map(|file| Some((file.target.as_deref()?, file.target_sha256.as_deref()?)));
    let count = written.clone().count();
    let all = files.iter().map(|file| (file.source.as_str(), file.source_sha256.as_str()));
    let totals = Totals::of(std::slice::from_ref(part));
    let _ = writeln!(
        out,
        "<tr><th>Programs<td>{totals}\n<tr><th>Sources<td>{}<br><span class=\"hash\">{}</span>",
        plural(files.len(), "file"),
        data::together(all)
    );
    let hash = if count > 0 { data::together(written) } else { "nothing".to_owned() };
    let _ = writeln!(
        out,
        "<tr><th>Written<td>{}<br><span class=\"hash\">{hash}</span>\n</table>",
        plural(count, "file")
    );
    if let Some(advice) = part.advised() {
        let _ = writeln!(out, "<p><b>{}: {}</b></p>", escaped(part.to), escaped(advice));
    }
    for note in part.notes {
        let _ = writeln!(out, "<p><b>{}</b></p>", escaped(note));
    }
    let mut told = left_out_text(part.left_out, true);
    folder(&mut told, part.folder);
    if !told.is_empty() {
        let lines: Vec<String> = told.lines().map(escaped).collect();
        let _ = writeln!(out, "<pre>{}</pre>", lines.join("\n"));
    }
}

/// The programs that are written and were not shown to be the same, by the reason.
fn undecided(out: &mut String, parts: &[Part<'_>], numbers: &Numbers) {
    let mut all: BTreeMap<String, Vec<(usize, String)>> = BTreeMap::new();
    for (at, part) in parts.iter().enumerate() {
        let is_copied = part.controls[0].is_same_machine(part.controls[1]);
        for (index, program) in part.programs() {
            if program.outcome == Outcome::Refused || program.verdict == Some(verify::Outcome::Same) {
                continue;
            }
            let place = (numbers.number(at, index), title(part, program));
            let found = program.diagnostics.iter().filter(|finding| finding.code == Code::NotDecided);
            let reasons: BTreeSet<String> = found.map(|finding| finding.message.to_string()).collect();
            let why = match is_copied {
                true => "it stays on its machine: the text is copied, byte for byte",
                false => "it was not verified",
            };
            match reasons.is_empty() {
                true => all.entry(why.to_owned()).or_default().push(place),
                false => reasons.into_iter().for_each(|why| all.entry(why).or_default().push(place.clone())),
            }
        }
    }
    out.push_str("<h3>What was not decided</h3>\n");
    if all.is_empty() {
        out.push_str("<p>Nothing: of every program that was written it was shown that both machines do the same.</p>\n");
        return;
    }
    let mut all: Vec<_> = all.into_iter().collect();
    all.sort_by_key(|(_, programs)| std::cmp::Reverse(programs.len()));
    out.push_str("<ul class=\"facts\">\n");
    for (why, programs) in all.iter().take(REASONS) {
        let named = programs.iter().take(NAMED).map(|(number, title)| link(&id(*number), &escaped(title)));
        let named: Vec<String> = named.collect();
        let more = programs.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        let _ = writeln!(
            out,
            "<li>{}: {} ({}{more})",
            plural(programs.len(), "program"),
            escaped(why),
            named.join(", ")
        );
    }
    if all.len() > REASONS {
        let _ = writeln!(out, "<li>and {} more reasons, which stand at their programs", all.len() - REASONS);
    }
    out.push_str("</ul>\n");
}

/// A program by its file and name.
pub fn title(part: &Part<'_>, program: &ProgramReport) -> String {
    let file = part.inputs.get(program.file).map_or("", |input| &input.name);
    match &program.name {
        Some(name) => format!("{file} {name}"),
        None => file.to_owned(),
    }
}

/// The outcome as a class of the page.
pub fn class(outcome: Outcome) -> &'static str {
    words(outcome).trim_start_matches("for ")
}

/// What the verifier found, in a word.
pub fn verdict(program: &ProgramReport) -> &'static str {
    match program.verdict {
        Some(verify::Outcome::Same) => "the same",
        Some(verify::Outcome::Undecided) => "not decided",
        Some(verify::Outcome::Different) => "different",
        None if program.outcome == Outcome::Refused => "nothing to verify",
        None => "not verified",
    }
}

/// All programs, a line each.
pub fn index(out: &mut String, parts: &[Part<'_>], numbers: &Numbers) {
    out.push_str("<h2 id=\"index\">All programs</h2>\n<table class=\"list\">\n<tr><th>Program<th>Outcome<th>Verified<th>Codes\n");
    for (at, part) in parts.iter().enumerate() {
        if parts.len() > 1 {
            let _ = writeln!(out, "<tr><th colspan=\"4\">{} to {}", escaped(part.from), escaped(part.to));
        }
        for (index, program) in part.programs() {
            let name = id(numbers.number(at, index));
            let _ = writeln!(
                out,
                "<tr data-of=\"{name}\"><td>{}<td class=\"{}\">{}<td>{}<td>{}",
                link(&name, &escaped(&title(part, program))),
                class(program.outcome),
                words(program.outcome),
                verdict(program),
                codes(program).into_iter().map(code).collect::<Vec<_>>().join(" ")
            );
        }
    }
    out.push_str("</table>\n");
}

/// The codes of a program, each once.
pub fn codes(program: &ProgramReport) -> BTreeSet<Code> {
    program.diagnostics.iter().map(|finding| finding.code).collect()
}

/// All files with their hashes.
pub fn files(out: &mut String, parts: &[Part<'_>]) {
    out.push_str(
        "<h2 id=\"files\">Files and hashes</h2>\n<p class=\"small\">SHA-256 of each file. A file with another hash is not the one of \
         this report. The hash of a library on the first page is that of these lines, as <code>sha256sum</code> prints \
         them.</p>\n<table class=\"list\">\n<tr><th>File<th>SHA-256\n",
    );
    for part in parts {
        for file in data::files(part) {
            let _ = writeln!(
                out,
                "<tr><td>source {}<td class=\"hash\">{}",
                escaped(&file.source),
                file.source_sha256
            );
            if let Some(hash) = &file.target_sha256 {
                let target = file.target.as_deref().unwrap_or("standard output");
                let _ = writeln!(out, "<tr><td>written {}<td class=\"hash\">{hash}", escaped(target));
            }
        }
    }
    out.push_str("</table>\n");
}

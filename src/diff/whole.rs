//! A diff from the two libraries to what is said of them.

use super::lines::{Numbered, changed};
use super::normal::{Named, normal};
use super::programs::{Certificates, Changes, certificates, pictured_one, programs};
use super::result::{Diff, FORMAT, FileDiff, Pictured, Verdict};
use super::sides::{Shelf, Texts, file_of, named, texts};
use crate::control::{LoadedFile, ProgramRef};
use crate::dialect::Control;
use crate::library::Input;
use crate::syntax::parse_file;
use crate::text::{Lines, decode};
use crate::verify::{Assumptions, Effort, Job, Side, Spent, SymbolMap, pictured};
use std::collections::BTreeMap;

/// What a diff shows. What the machine does is worked out in any case: it decides.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// The lines.
    pub text: bool,
    /// The lines without what no machine sees.
    pub normalised: bool,
    /// The build of programs.
    pub structure: bool,
    /// The places at which the machine does something else.
    pub motion: bool,
}

/// What is to be compared.
#[derive(Debug)]
pub struct Request<'a> {
    /// The old programs.
    pub old: Shelf<'a>,
    /// The new ones.
    pub new: Shelf<'a>,
    /// What is called what, between two controls.
    pub names: SymbolMap,
    /// What is shown.
    pub levels: Levels,
    /// How much may be done.
    pub effort: Effort,
    /// Places that are listed of a program, at the most.
    pub most: usize,
    /// Whether a run of a program is kept, to be drawn.
    pub picture: bool,
}

/// Works out what changed. None where a control has no emulation.
pub fn diff(request: &Request<'_>) -> Option<Diff> {
    let Request { old, new, levels, effort, .. } = request;
    let (ours, theirs) = (old.parsed(), new.parsed());
    let (our_files, their_files) = (old.loaded(&ours), new.loaded(&theirs));
    let source = Side::new(old.control, old.control.entry().execute?, &our_files);
    let target = Side::new(new.control, new.control.entry().execute?, &their_files);
    let both = named(&source).join(named(&target));
    let texts = [texts(&source, &both), texts(&target, &both)];
    let one_machine = old.control.is_same_machine(new.control);
    let mut names = request.names.clone();
    let changes = Changes::new((&source, &texts[0]), (&target, &texts[1]), one_machine, &mut names);
    let (assumptions, spent) = (Assumptions::new(), Spent::default());
    let job = Job {
        source: &source,
        target: &target,
        names: &names,
        assumptions: &assumptions,
        effort: *effort,
        spent: &spent,
    };
    let certificates = certificates(&job, &changes);
    let programs = programs(&job, &changes, &certificates, *levels, request.most);
    let picture = if request.picture { picture(&job, &changes, &certificates, request.most) } else { None };
    let files = files(request, (&source, &texts[0]), (&target, &texts[1]));
    let verdict = programs.iter().map(|program| program.verdict).max().unwrap_or(Verdict::Same);
    Some(Diff {
        format: FORMAT,
        macroglot: env!("CARGO_PKG_VERSION"),
        from: old.control.name().to_owned(),
        to: new.control.name().to_owned(),
        verdict,
        tolerance_mm: effort.allowed_mm.max(0.0),
        files,
        untouched: changes.untouched(),
        programs,
        renamed: changes.renamed,
        notes: Vec::new(),
        picture,
    })
}

/// A run of a program on both sides.
fn picture(
    job: &Job<'_>,
    changes: &Changes<'_>,
    certificates: &Certificates,
    most: usize,
) -> Option<Box<Pictured>> {
    let (old, new, witness) = pictured_one(changes, certificates)?;
    let is_only = job.source.programs().len() == 1 && job.target.programs().len() == 1;
    let name = |side: &Side<'_>, program: ProgramRef| {
        let file = (side.files.len() > 1).then(|| file_of(side, program)).flatten();
        let name = side.name(program).filter(|_| !is_only).map(ToString::to_string);
        file.into_iter().chain(name).collect::<Vec<_>>().join(" ")
    };
    let (old_name, new_name) = (name(job.source, old), name(job.target, new));
    Some(Box::new(Pictured { old: old_name, new: new_name, runs: pictured(job, old, witness, most)? }))
}

/// What changed in the text of each file. Files go together by name; two single ones whatever their names.
fn files(request: &Request<'_>, old: (&Side<'_>, &Texts), new: (&Side<'_>, &Texts)) -> Vec<FileDiff> {
    let Levels { text, normalised, .. } = request.levels;
    if !text && !normalised {
        return Vec::new();
    }
    let (ours, theirs) = (request.old.inputs, request.new.inputs);
    let single = ours.len() == 1 && theirs.len() == 1;
    let mut pairs: BTreeMap<&str, [Option<usize>; 2]> = BTreeMap::new();
    for (side, inputs) in [ours, theirs].into_iter().enumerate() {
        for (at, input) in inputs.iter().enumerate() {
            let name = if single { "" } else { input.name.as_str() };
            pairs.entry(name).or_default()[side] = Some(at);
        }
    }
    let mut out = Vec::new();
    for [a, b] in pairs.into_values() {
        let bytes = |inputs: &[Input], at: Option<usize>| at.map_or(&[][..], |at| &inputs[at].bytes).to_vec();
        let (was, is) = (bytes(ours, a), bytes(theirs, b));
        if was == is && a.is_some() == b.is_some() {
            continue;
        }
        let of = |(side, texts): (&Side<'_>, &Texts), at: Option<usize>| -> Vec<Numbered> {
            let all = side.programs().iter().filter(|program| Some(program.file) == at);
            let blocks = all.filter_map(|program| texts.get(program)).flatten();
            let told = blocks.filter(|block| !block.text.is_empty());
            told.map(|block| (block.line, block.text.clone())).collect()
        };
        let name = |inputs: &[Input], at: Option<usize>| at.map(|at| inputs[at].path.display().to_string());
        out.push(FileDiff {
            old: name(ours, a),
            new: name(theirs, b),
            text: text.then(|| changed(&raw(&was), &raw(&is))),
            normalised: normalised.then(|| changed(&of(old, a), &of(new, b))),
        });
    }
    out
}

/// The lines of a file, with their numbers.
fn raw(bytes: &[u8]) -> Vec<Numbered> {
    let all = Lines::new(bytes).enumerate();
    let mut lines: Vec<Numbered> =
        all.map(|(at, line)| (at + 1, decode(line.text.of(bytes)).into_owned())).collect();
    // The end of the last line begins no other.
    if lines.last().is_some_and(|(_, text)| text.is_empty()) {
        lines.pop();
    }
    lines
}

/// A file without what no machine sees, a block a line: what `git diff` compares where it is told to.
pub fn normalised(bytes: &[u8], control: &Control) -> Option<String> {
    let parsed = parse_file(bytes, control.entry().parse);
    let files = [LoadedFile { name: "", parsed: &parsed }];
    let side = Side::new(control, control.entry().execute?, &files);
    let mut out = String::new();
    for program in side.programs() {
        let blocks = normal(side.text(*program), bytes, control, &Named::default(), |at| parsed.line_of(at));
        for block in blocks.iter().filter(|block| !block.text.is_empty()) {
            out += &block.text;
            out.push('\n');
        }
    }
    Some(out)
}

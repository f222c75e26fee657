//! The way to another machine and back: each leg verified, and the text the same when it goes the way again.

use super::finding::{Finding, Pages};
use super::groups::{Calls, Group};
use super::{Part, Request, Shelf};
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::Control;
use crate::ir::Module;
use crate::library::{Conversion, Input, Lock, Options, Outcome, ProgramReport, convert, judge_telling};
use crate::text::{LineIndex, Span};
use crate::verify::{self, Effort};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// What a way there and back showed of a group, in a form that is kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Shown {
    code: String,
    /// The file's name in the library.
    file: String,
    /// Bytes of the source.
    at: (u32, u32),
    message: String,
    help: Option<String>,
    /// The code of the reason, if it stands in the source.
    why: Option<String>,
}

/// The findings of all groups that the files which are looked at stand in; and how many ways were taken, and were known.
pub fn findings(
    shelf: &Shelf,
    module: &Module,
    pages: &Pages<'_>,
    request: &Request<'_>,
) -> (Vec<Finding>, [usize; 2]) {
    let calls = Calls::of(module, shelf.inputs.len());
    let wanted: BTreeSet<usize> = (0..shelf.inputs.len()).filter(|at| shelf.wanted[*at]).collect();
    // A program whose callee changed is told of too: it is the one that does something else now.
    let told = calls.up(wanted.iter().copied());
    let groups = calls.groups(&wanted);
    let first = first_groups(&groups, &wanted);
    let homes = homes(&calls, shelf.inputs.len());
    let judged: Vec<[BTreeSet<usize>; 2]> = groups.iter().map(|group| judged(group, &homes, &told)).collect();
    let machines: Vec<Machines<'_>> = shelf.rounds.iter().map(|round| Machines::of(shelf, round)).collect();
    let ways: Vec<(&Group, &Machines<'_>, &[BTreeSet<usize>; 2], usize)> = groups
        .iter()
        .zip(&judged)
        .zip(first)
        .flat_map(|((group, judged), files)| {
            machines.iter().map(move |machines| (group, machines, judged, files))
        })
        .collect();
    let walked = ways.par_iter().map(|(group, machines, judged, files)| {
        let shown = known_or_found(shelf, (group, judged), machines, request);
        (request.done)(*files);
        shown
    });
    let walked: Vec<(Vec<Shown>, bool)> = walked.collect();
    let taken = walked.iter().filter(|(_, known)| !known).count();
    let counts = [taken, walked.len() - taken];
    let place = |name: &str| shelf.inputs.iter().position(|input| input.name == name);
    let shown = walked.into_iter().flat_map(|(shown, _)| shown);
    let found = shown.filter_map(|shown| {
        let file = place(&shown.file).filter(|file| told.contains(file))?;
        // What is wrong with the source itself is told of already.
        let of_source =
            shown.why.as_deref().and_then(Code::find).is_some_and(super::understood::is_of_source);
        if of_source && request.parts.contains(&Part::Read) && shelf.wanted[file] {
            return None;
        }
        let code = Code::find(&shown.code)?;
        Some(pages.at(code, file, Span::new(shown.at.0, shown.at.1), shown.message, shown.help))
    });
    (found.collect(), counts)
}

/// By group, how many of the files that are looked at are in no group before it.
fn first_groups(groups: &[Group], wanted: &BTreeSet<usize>) -> Vec<usize> {
    let mut seen = BTreeSet::new();
    let new = |group: &Group| {
        group.files.iter().filter(|file| wanted.contains(file) && seen.insert(**file)).count()
    };
    groups.iter().map(new).collect()
}

/// By file, the root of the first group of the whole library that holds it.
fn homes(calls: &Calls, files: usize) -> BTreeMap<usize, usize> {
    let mut homes = BTreeMap::new();
    for group in calls.groups(&(0..files).collect()) {
        for file in &group.files {
            homes.entry(*file).or_insert(group.root);
        }
    }
    homes
}

/// The files of a group whose programs are verified by themselves: all that ever are, and those that are told of. A program
/// that several call is one of them in its first group; in the others the runs of its callers go through it.
fn judged(group: &Group, homes: &BTreeMap<usize, usize>, told: &BTreeSet<usize>) -> [BTreeSet<usize>; 2] {
    let here = |file: &&usize| homes.get(*file) == Some(&group.root);
    let all: BTreeSet<usize> = group.files.iter().filter(here).copied().collect();
    let some = all.intersection(told).copied().collect();
    [all, some]
}

/// The machine that programs are for, and one that they go to and come back from.
struct Machines<'a> {
    /// The name of the second.
    name: &'a str,
    home: &'a Control,
    away: &'a Control,
    /// What the profiles of both say.
    profiles: String,
    /// Both, when they know of each other.
    met: OnceLock<(Control, Control)>,
}

impl<'a> Machines<'a> {
    fn of(shelf: &'a Shelf, (name, away): &'a (String, Control)) -> Self {
        let profiles = format!("{:?}\n{:?}", shelf.control.profile(), away.profile());
        Self { name, home: &shelf.control, away, profiles, met: OnceLock::new() }
    }
}

/// What the way of a group shows, and whether that was known.
fn known_or_found(
    shelf: &Shelf,
    (group, [all, some]): (&Group, &[BTreeSet<usize>; 2]),
    machines: &Machines<'_>,
    request: &Request<'_>,
) -> (Vec<Shown>, bool) {
    let inputs: Vec<Input> = group.files.iter().map(|file| shelf.inputs[*file].clone()).collect();
    let effort = format!("{}\n{:?}", machines.name, request.effort);
    let mut parts: Vec<&[u8]> = vec![b"round", machines.profiles.as_bytes(), effort.as_bytes()];
    for input in &inputs {
        parts.extend([input.name.as_bytes(), &input.bytes]);
    }
    let named = |judged: &BTreeSet<usize>| -> Vec<bool> {
        group.files.iter().map(|file| judged.contains(file)).collect()
    };
    let key = |judged: &BTreeSet<usize>| {
        let named: Vec<u8> = named(judged).into_iter().map(u8::from).collect();
        request.cache.key(&[&parts[..], &[&named]].concat())
    };
    // What was found of more programs holds for some of them, too.
    let known = request.cache.get(&key(all)).or_else(|| request.cache.get(&key(some)));
    if let Some(known) = known {
        return (known, true);
    }
    let (home, away) = machines.met.get_or_init(|| met(machines.home, machines.away));
    let way = Way { machine: machines.name, home, away, effort: request.effort };
    let shown = way.walk(&inputs, &named(some));
    request.cache.put(&key(some), &shown);
    (shown, false)
}

/// Two machines that know of each other what their profiles say of both; as they are where that contradicts their tables:
/// what it concerns is refused then.
fn met(home: &Control, away: &Control) -> (Control, Control) {
    let as_they_are = || (home.clone(), away.clone());
    let (home_met, away_met) = Control::meeting(home.clone(), away.clone()).unwrap_or_else(|_| as_they_are());
    let kept = (home_met.clone(), away_met.clone());
    Control::meeting(away_met, home_met).map_or(kept, |(away, home)| (home, away))
}

/// A machine to go to and come back from.
struct Way<'a> {
    machine: &'a str,
    home: &'a Control,
    away: &'a Control,
    effort: Effort,
}

impl Way<'_> {
    /// Takes the files there and back, and there again; the programs of those that are `named` are verified by themselves.
    fn walk(&self, inputs: &[Input], named: &[bool]) -> Vec<Shown> {
        let Self { machine, home, away, effort } = self;
        let mut first = plain(inputs, home, away);
        judge_telling(inputs, &mut first, (home, away), (*effort, named), &|_| ());
        let there = texts_of(inputs, &first);
        let mut second = plain(&there, away, home);
        let is_named =
            |name: &str| inputs.iter().zip(named).any(|(input, named)| *named && input.name == name);
        let named_there: Vec<bool> = there.iter().map(|input| is_named(&input.name)).collect();
        judge_telling(&there, &mut second, (away, home), (*effort, &named_there), &|_| ());
        let mut shown = Vec::new();
        let owners: Vec<Option<usize>> = second
            .programs
            .iter()
            .map(|back| {
                let name = &there[back.file].name;
                let of_file = first.programs.iter().enumerate();
                let of_file = of_file.filter(|(_, program)| inputs[program.file].name == *name);
                let ranges = of_file.map(|(at, program)| (at, program.range.clone()));
                owner(ranges.filter(|(_, range)| !range.is_empty()), place_of(back))
            })
            .collect();
        for (at, program) in first.programs.iter().enumerate() {
            let (start, name) = (start_of(program), &inputs[program.file].name);
            let here = |code, at, message: String, help| shown_at(code, name, at, message, help);
            if let Some(why) = refused(program) {
                let differs = program.verdict == Some(verify::Outcome::Different);
                let code = if differs { Code::RoundDiffers } else { Code::RoundRefused };
                let message = format!("the program does not get to {machine}: {}", why.message);
                let told = here(code, why.span, message, why.help.as_deref());
                shown.push(Shown { why: Some(why.code.number().into()), ..told });
                continue;
            }
            // Its programs on the other machine.
            let back = second.programs.iter().zip(&owners).filter(|(_, owner)| **owner == Some(at));
            let back: Vec<&ProgramReport> = back.map(|(back, _)| back).collect();
            if back.is_empty() && !program.range.is_empty() {
                let message = format!("the program gets to {machine}, and nothing of it comes back");
                shown.push(here(Code::RoundRefused, start, message, None));
                continue;
            }
            if let Some((stays, why)) = back.iter().find_map(|back| Some((back, refused(back)?))) {
                let differs = stays.verdict == Some(verify::Outcome::Different);
                let code = if differs { Code::RoundDiffers } else { Code::RoundRefused };
                let there = &there[stays.file].bytes;
                let (line, _) = LineIndex::new(there).place(why.span.start);
                let text = super::finding::line_of(there, why.span.start as usize);
                let message = format!(
                    "the program gets to {machine} and does not come back: {} (line {line} there, `{text}`)",
                    why.message
                );
                shown.push(here(code, start, message, why.help.as_deref()));
                continue;
            }
            let open = [program].into_iter().chain(back).find(|program| undecided(program));
            if let Some(open) = open.filter(|_| named[program.file]) {
                let why = open.diagnostics.iter().find(|d| d.code == Code::NotDecided);
                let why = why.map_or("", |why| &*why.message);
                let message = format!("no difference was found on the way to {machine} and back, but {why}");
                shown.push(here(Code::RoundUndecided, start, message, None));
            }
        }
        shown.extend(self.changed(inputs, &there, &second));
        shown
    }

    /// The files whose text is another one when what came home goes the way again.
    fn changed(&self, inputs: &[Input], there: &[Input], second: &Conversion) -> Vec<Shown> {
        let home = texts_of(there, second);
        let there_again = texts_of(&home, &plain(&home, self.home, self.away));
        let home_again = texts_of(&there_again, &plain(&there_again, self.away, self.home));
        let both = home.iter().filter_map(|before| {
            let after = home_again.iter().find(|after| after.name == before.name)?;
            let input = inputs.iter().find(|input| input.name == before.name)?;
            let [line, was, is] = first_difference(&before.bytes, &after.bytes)?;
            let message = format!(
                "the text that came back from {} changes when it goes the way again: line {line} is \
                 `{is}`, and was `{was}`",
                self.machine
            );
            let start = Span::new(0, 0);
            Some(shown_at(Code::RoundUnstable, &input.name, start, message, None))
        });
        both.collect()
    }
}

fn plain(inputs: &[Input], source: &Control, target: &Control) -> Conversion {
    convert(inputs, source, target, Lock::new(source.name(), target.name()), Options::default())
}

/// The texts of a conversion as the next one reads them.
fn texts_of(inputs: &[Input], conversion: &Conversion) -> Vec<Input> {
    let written = inputs.iter().zip(&conversion.texts);
    let written = written.filter_map(|(input, text)| {
        let bytes = text.as_ref()?.clone().into_bytes();
        Some(Input { path: input.path.clone(), name: input.name.clone(), bytes })
    });
    written.collect()
}

/// Why a program is not written: the first of the errors.
fn refused(program: &ProgramReport) -> Option<&Diagnostic> {
    let refused = program.outcome == Outcome::Refused;
    let mut errors = program.diagnostics.iter().filter(|d| d.severity() == Severity::Error);
    errors.next().filter(|_| refused)
}

fn undecided(program: &ProgramReport) -> bool {
    program.outcome != Outcome::Refused && program.verdict != Some(verify::Outcome::Same)
}

/// Where a program begins, as far as its report says.
fn start_of(program: &ProgramReport) -> Span {
    program.map.iter().map(|(span, _)| *span).min_by_key(|span| span.start).unwrap_or_default()
}

/// Where a program stood on the other machine: one that is refused has no blocks, but a reason at its place.
fn place_of(back: &ProgramReport) -> usize {
    let place = match back.map.is_empty() {
        true => refused(back).map(|why| why.span).unwrap_or_default(),
        false => start_of(back),
    };
    place.start as usize
}

/// The program, of those of one file with their places in its text, that this place is of: the last one that begins
/// before it, and the first one for a place before all of them.
fn owner(ranges: impl Iterator<Item = (usize, std::ops::Range<usize>)>, place: usize) -> Option<usize> {
    let mut found = None;
    for (at, range) in ranges {
        if found.is_none() || range.start <= place {
            found = Some(at);
        }
    }
    found
}

fn shown_at(code: Code, file: &str, at: Span, message: String, help: Option<&str>) -> Shown {
    let help = help.map(str::to_owned);
    Shown { code: code.number().into(), file: file.into(), at: (at.start, at.end), message, help, why: None }
}

/// The first line in which two texts differ: its number, and how it was and is.
fn first_difference(before: &[u8], after: &[u8]) -> Option<[String; 3]> {
    if before == after {
        return None;
    }
    let lines =
        |bytes: &[u8]| -> Vec<String> { String::from_utf8_lossy(bytes).lines().map(str::to_owned).collect() };
    let (was, is) = (lines(before), lines(after));
    let at = was.iter().zip(&is).take_while(|(was, is)| was == is).count();
    let line = |all: &[String]| all.get(at).cloned().unwrap_or_default();
    Some([(at + 1).to_string(), line(&was), line(&is)])
}

#[cfg(test)]
mod tests {
    use super::super::groups::Calls;
    use super::{BTreeSet, first_difference, homes, judged, owner};

    /// Programs 0 and 1 call 2; 3 stands alone.
    #[test]
    fn what_several_call_is_verified_by_itself_once() {
        let calls = Calls::from_pairs(4, &[(0, 2), (1, 2)]);
        let homes = homes(&calls, 4);
        let of = |wanted: &[usize]| -> Vec<[Vec<usize>; 2]> {
            let wanted: BTreeSet<usize> = wanted.iter().copied().collect();
            let told = calls.up(wanted.iter().copied());
            let groups = calls.groups(&wanted);
            let judged = groups.iter().map(|group| judged(group, &homes, &told));
            judged.map(|both| both.map(|files| files.into_iter().collect())).collect()
        };
        assert_eq!(of(&[0, 1, 2, 3]), [[vec![0, 2], vec![0, 2]], [vec![1], vec![1]], [vec![3], vec![3]]]);
        assert_eq!(of(&[2]), [[vec![0, 2], vec![0, 2]], [vec![1], vec![1]]]);
        assert_eq!(of(&[1]), [[vec![1], vec![1]]]);
        assert_eq!(of(&[0]), [[vec![0, 2], vec![0]]]);
    }

    /// The text begins with the frame of its file, and a refused program may say nothing of its place.
    #[test]
    fn what_comes_back_is_always_of_a_program() {
        let of = |place| owner([(3, 2..40), (4, 40..90)].into_iter(), place);
        assert_eq!([0, 2, 39, 40, 200].map(of), [Some(3), Some(3), Some(3), Some(4), Some(4)]);
        assert_eq!(owner(std::iter::empty(), 7), None);
    }

    #[test]
    fn the_first_difference_is_told() {
        assert_eq!(first_difference(b"a\nb\n", b"a\nb\n"), None);
        assert_eq!(first_difference(b"a\nb\n", b"a\nc\n"), Some(["2".into(), "b".into(), "c".into()]));
        assert_eq!(first_difference(b"a\n", b"a\nc\n"), Some(["2".into(), String::new(), "c".into()]));
    }
}

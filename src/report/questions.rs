//! What a person must look at or answer: each thing once, with the programs that it concerns.
//!
//! A library has one finding at hundreds of places. Who reads them one by one stops reading; so they are gathered by what
//! they say, over all libraries of a run, the gravest and most frequent first.

use super::Part;
use crate::assume::Predicate;
use crate::diag::{Accepted, Code, Diagnostic, Severity};
use crate::dialect::{Control, Settled, Side};
use crate::text::LineIndex;
use foldhash::{HashMap, HashSet};
use std::collections::BTreeMap;
use std::path::Path;
use std::ptr;
use std::sync::Arc;

/// Places that are named of a question.
pub(super) const NAMED: usize = 3;

/// Places that a question keeps.
pub(super) const KEPT: usize = 100;

/// Something that stands at one or more places.
#[derive(Clone, Debug)]
pub struct Question<'a> {
    /// Its code.
    pub code: Code,
    /// What is the matter.
    pub text: &'a str,
    /// What to do about it.
    pub help: Option<&'a str>,
    /// How many programs it concerns.
    pub programs: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
    /// The line of the first of them, and its number.
    pub line: (u32, String),
    /// The first place in each program that it concerns, as far as there is room.
    pub spots: Vec<Spot>,
    /// How much depends on it: 0 is most.
    pub danger: usize,
    /// True for what is decided once for the library, and makes no program one for review.
    pub once: bool,
}

/// A place in a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spot {
    /// The library, by its place in the run.
    pub part: usize,
    /// The program, by its place in the library.
    pub program: usize,
    /// The line.
    pub line: u32,
}

/// A fact that a machine profile can settle.
#[derive(Clone, Debug)]
pub struct Fact<'a> {
    /// What the profile says to settle it.
    pub settled_by: Settled,
    /// What the fact is, and where it counts.
    pub asked: Question<'a>,
}

/// The facts of one machine.
#[derive(Clone, Debug)]
pub struct Machine<'a> {
    /// The control.
    pub control: &'a Control,
    /// In the order of the profile's sections, the most frequent first.
    pub facts: Vec<Fact<'a>>,
}

/// All that is asked of a person.
#[derive(Clone, Debug, Default)]
pub struct Questions<'a> {
    /// What no profile settles: refusals, then reviews, then what is decided once for the library.
    pub open: Vec<Question<'a>>,
    /// What the profiles of machines can settle.
    pub machines: Vec<Machine<'a>>,
    /// What somebody accepted: by who, when and why, and by code.
    pub accepted: Vec<(&'a Accepted, Question<'a>)>,
    /// How many notes there are, which ask nothing.
    pub notes: usize,
}

/// A question while it is gathered.
struct Gathered<'a> {
    finding: &'a Diagnostic,
    /// By file and place in the library: one that goes to two machines is one.
    programs: HashSet<(usize, usize)>,
    places: Vec<String>,
    line: (u32, String),
    spots: Vec<Spot>,
}

impl<'a> Gathered<'a> {
    fn of(finding: &'a Diagnostic) -> Self {
        let (programs, line) = (HashSet::default(), (0, String::new()));
        Self { finding, programs, places: Vec::new(), line, spots: Vec::new() }
    }
}

/// What makes two findings of a part surely one question: the texts and values that they share. A library has few,
/// many times over.
type Same = (Code, [*const u8; 4]);

fn same(finding: &Diagnostic) -> Same {
    fn of<T: ?Sized>(value: Option<&Arc<T>>) -> *const u8 {
        value.map_or(ptr::null(), |value| Arc::as_ptr(value).cast())
    }
    let texts = [Some(&finding.message), finding.help.as_ref()].map(of);
    (finding.code, [texts[0], texts[1], of(finding.assumes.as_ref()), of(finding.accepted.as_ref())])
}

impl<'a> Questions<'a> {
    /// Gathers the findings of conversions; what one answer of a profile settles is one question.
    pub fn of(parts: &[Part<'a>]) -> Self {
        let mut questions = Self::single(parts);
        questions.group();
        questions
    }

    /// Gathers the findings of conversions, with each question of a machine by itself.
    pub fn single(parts: &[Part<'a>]) -> Self {
        let mut all: BTreeMap<Key<'a>, usize> = BTreeMap::new();
        let mut gathered: Vec<Gathered<'a>> = Vec::new();
        let mut controls: Vec<&'a Control> = Vec::new();
        let mut notes = 0;
        let mut paths: HashMap<&'a Path, usize> = HashMap::default();
        for (number, part) in parts.iter().enumerate() {
            let mut numbered = |path: &'a Path| {
                let next = paths.len();
                *paths.entry(path).or_insert(next)
            };
            let files: Vec<usize> = part.inputs.iter().map(|input| numbered(&input.path)).collect();
            let mut known: HashMap<Same, usize> = HashMap::default();
            // The lines of a file are counted when the first place in it is named.
            let mut lines: Option<(usize, LineIndex)> = None;
            for (index, program) in part.programs() {
                for finding in &program.diagnostics {
                    if finding.severity() == Severity::Note {
                        notes += 1;
                        continue;
                    }
                    let at = *known.entry(same(finding)).or_insert_with(|| {
                        *all.entry(key(finding, part, &mut controls)).or_insert_with(|| {
                            gathered.push(Gathered::of(finding));
                            gathered.len() - 1
                        })
                    });
                    let entry = &mut gathered[at];
                    entry.programs.insert((files[program.file], index));
                    let is_known = |spot: &Spot| spot.part == number && spot.program == index;
                    let keeps = entry.spots.len() < KEPT && !entry.spots.last().is_some_and(is_known);
                    if entry.places.len() == NAMED && !keeps {
                        continue;
                    }
                    let file = program.file;
                    if lines.as_ref().is_none_or(|(of, _)| *of != file) {
                        lines = Some((file, LineIndex::new(&part.inputs[file].bytes)));
                    }
                    let Some((_, lines)) = &lines else { continue };
                    let place = part.place(file, lines, finding);
                    if keeps {
                        entry.spots.push(Spot { part: number, program: index, line: place.line });
                    }
                    if entry.places.len() == NAMED {
                        continue;
                    }
                    if entry.places.is_empty() {
                        entry.line = (place.line, String::from_utf8_lossy(place.text).trim().to_owned());
                    }
                    let place = format!("{}:{}", part.inputs[file].name, place.line);
                    if !entry.places.contains(&place) {
                        entry.places.push(place);
                    }
                }
            }
        }
        let mut questions = Self { notes, ..Self::default() };
        questions.machines = controls.iter().map(|control| Machine { control, facts: Vec::new() }).collect();
        for (key, at) in all {
            let finding = gathered[at].finding;
            let Gathered { programs, places, line, spots, .. } =
                std::mem::replace(&mut gathered[at], Gathered::of(finding));
            let (text, help) = (&*finding.message, finding.help.as_deref());
            let (code, programs, danger) = (key.code, programs.len(), danger(finding));
            let once = finding.once;
            let asked = Question { code, text, help, programs, places, line, spots, danger, once };
            match (key.settled, key.accepted) {
                (_, Some(accepted)) => questions.accepted.push((accepted, asked)),
                (Some((machine, settled_by)), None) => {
                    questions.machines[machine].facts.push(Fact { settled_by, asked });
                }
                (None, None) => questions.open.push(asked),
            }
        }
        let order = |question: &Question<'_>| {
            let severity = std::cmp::Reverse(question.code.severity());
            (severity, question.once, question.code, std::cmp::Reverse(question.programs))
        };
        questions.open.sort_by_key(order);
        for machine in &mut questions.machines {
            machine.facts.sort_by_key(|fact| (fact.asked.danger, std::cmp::Reverse(fact.asked.programs)));
        }
        questions.machines.retain(|machine| !machine.facts.is_empty());
        questions
    }

    /// What no profile settles: what is asked of single programs, and what is decided once for the library.
    pub fn of_programs_and_library(&self) -> (&[Question<'a>], &[Question<'a>]) {
        self.open.split_at(self.open.partition_point(|question| !question.once))
    }
}

/// What makes two findings one question.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Key<'a> {
    severity: std::cmp::Reverse<Severity>,
    code: Code,
    /// The machine, by its place in the list, and what its profile says.
    settled: Option<(usize, Settled)>,
    /// Who accepted it.
    accepted: Option<&'a Accepted>,
    /// What it says, and what to do; one fact has other words on either side of a conversion.
    says: Option<(&'a str, Option<&'a str>)>,
}

fn key<'a>(finding: &'a Diagnostic, part: &Part<'a>, controls: &mut Vec<&'a Control>) -> Key<'a> {
    let code = finding.code;
    let settled = settled(finding, part).map(|(control, settled)| {
        let known = controls.iter().position(|other| is_one(other, control));
        let at = known.unwrap_or_else(|| {
            controls.push(control);
            controls.len() - 1
        });
        (at, settled)
    });
    let says = settled.is_none().then(|| (&*finding.message, finding.help.as_deref()));
    let accepted = finding.accepted.as_deref();
    Key { severity: std::cmp::Reverse(finding.severity()), code, settled, accepted, says }
}

/// The machine whose profile settles a finding, and by what.
fn settled<'a>(finding: &Diagnostic, part: &Part<'a>) -> Option<(&'a Control, Settled)> {
    if finding.code == Code::StartUnknown {
        return Some((part.controls[0], Settled::UNITS));
    }
    let fact = finding.fact()?;
    let sides = [Side::Source, Side::Target].into_iter().zip(part.controls);
    let mut all = sides.map(|(side, control)| (side, control, control.settled_by(fact)));
    let (_, control, settled) =
        all.find(|(side, _, settled)| finding.help.as_deref() == Some(&*settled.in_words(*side)))?;
    Some((control, settled))
}

/// True where one profile is both.
fn is_one(one: &Control, other: &Control) -> bool {
    one.name() == other.name() && one.profile().file == other.profile().file
}

/// How much depends on what a finding supposes: 0 is most. First what changes every move of a program, then what changes the
/// tool or its length, the path, which code or variable is meant; then what no run has shown; facts of tables last.
fn danger(finding: &Diagnostic) -> usize {
    match (finding.assumes.as_deref(), finding.code) {
        (Some(Predicate::Unit | Predicate::SetTo(_) | Predicate::Start(_)), _) => 0,
        (
            Some(
                Predicate::Loaded(_)
                | Predicate::Holds(..)
                | Predicate::Tools(_)
                | Predicate::Stands(_)
                | Predicate::Setting(..)
                | Predicate::TurnedSetting(..)
                | Predicate::OfMachine(_),
            ),
            _,
        ) => 1,
        (
            Some(
                Predicate::ShortArcs(_)
                | Predicate::ArcEnds(_)
                | Predicate::Pecks(_)
                | Predicate::Levels(..)
                | Predicate::LengthAxis(_)
                | Predicate::WholeSpeeds(_),
            ),
            _,
        ) => 2,
        (Some(Predicate::Codes { .. } | Predicate::Subscripts(_) | Predicate::Arguments { .. }), _) => 3,
        (Some(Predicate::Main | Predicate::Nesting { .. } | Predicate::Alarms(_)), _) => 4,
        (_, Code::NotDecided | Code::RoundingSensitive) => 5,
        (Some(Predicate::Substitute(_) | Predicate::Unseen), _) | (None, Code::Conditional) => 6,
        (None, _) => 7,
        (Some(Predicate::Fact(_)), _) => 8,
    }
}

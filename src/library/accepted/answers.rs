//! Which questions have an answer in the project file, and what that makes of the programs.

use super::entry::Entry;
use super::questions::{Question, asks, seen_from};
use super::scope::halves;
use crate::diag::Diagnostic;
use crate::library::{Conversion, Input, Outcome, ProgramReport, outcome};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// What a library asks on its way to a machine.
pub struct Asked<'a> {
    /// The library and the machine, by their names in the project file.
    pub way: [&'a str; 2],
    /// Its questions.
    pub questions: Vec<Question>,
    /// Files and programs that are refused: of them nothing is asked now.
    pub refused: BTreeSet<(String, Option<String>)>,
}

impl Asked<'_> {
    /// The programs that are refused.
    pub fn refused(
        inputs: &[Input],
        conversion: &Conversion,
        root: &Path,
    ) -> BTreeSet<(String, Option<String>)> {
        let refused = conversion.programs.iter().filter(|program| program.outcome == Outcome::Refused);
        let name = |program: &ProgramReport| {
            Some((seen_from(&inputs.get(program.file)?.path, root), program.name.clone()))
        };
        refused.filter_map(name).collect()
    }
}

/// What the project file has for a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// Nothing.
    Open,
    /// This entry, by its place in the file.
    Accepted(usize),
    /// This entry, of another text or for other machines.
    Stale(usize),
}

/// Questions with what the project file has for them.
pub struct Answered {
    /// By library and machine, by question.
    pub fits: Vec<Vec<Fit>>,
    /// Entries that are about none of the questions, by their places in the file.
    pub unmatched: Vec<usize>,
}

/// Looks up what is asked. Entries about ways that are not `asked` of are left out, unless the project has no such way:
/// `ways` are all that it has.
pub fn answered(asked: &[Asked<'_>], entries: &[Entry], ways: &BTreeSet<[&str; 2]>) -> Answered {
    let mut about: BTreeMap<[&str; 5], Vec<usize>> = BTreeMap::new();
    entries.iter().enumerate().for_each(|(at, entry)| about.entry(entry.key()).or_default().push(at));
    let about = |asked: &Asked<'_>, question: &Question| {
        let ([library, target], program) = (asked.way, question.name.as_deref().unwrap_or(""));
        let key = [library, target, question.file.as_str(), program, question.code.number()];
        let all = about.get(&key).into_iter().flatten().filter_map(|at| Some((*at, entries.get(*at)?)));
        all.collect::<Vec<(usize, &Entry)>>()
    };
    let mut used = BTreeSet::new();
    let mut fits: Vec<Vec<Fit>> = Vec::with_capacity(asked.len());
    for one in asked {
        let fit = |question: &Question| {
            let mut entries = about(one, question).into_iter();
            let found = entries.find(|(_, entry)| entry.answers(&question.hash, &question.says));
            found.map_or(Fit::Open, |(at, _)| Fit::Accepted(at))
        };
        let found: Vec<Fit> = one.questions.iter().map(fit).collect();
        used.extend(found.iter().filter_map(|fit| match fit {
            Fit::Accepted(at) => Some(*at),
            _ => None,
        }));
        fits.push(found);
    }
    // What is left and says the same is of an earlier text. What reads otherwise is another question.
    for (one, fits) in asked.iter().zip(&mut fits) {
        for (question, fit) in one.questions.iter().zip(fits).filter(|(_, fit)| **fit == Fit::Open) {
            let left = about(one, question).into_iter().filter(|(at, _)| !used.contains(at));
            let mut left = left.filter(|(_, entry)| **entry.says.get_ref() == *question.says);
            if let Some((at, _)) = left.next() {
                used.insert(at);
                *fit = Fit::Stale(at);
            }
        }
    }
    let is_asked = |entry: &Entry| {
        let way = [entry.library(), entry.target()];
        let mut jobs = asked.iter().filter(|one| one.way == way).peekable();
        let program = (entry.file().to_owned(), entry.program().map(str::to_owned));
        if jobs.peek().is_none() {
            !ways.contains(&way)
        } else {
            !jobs.any(|one| one.refused.contains(&program))
        }
    };
    let unmatched = entries.iter().enumerate().filter(|(at, entry)| !used.contains(at) && is_asked(entry));
    let unmatched = unmatched.map(|(at, _)| at).collect();
    Answered { fits, unmatched }
}

impl Fit {
    /// Writes into the programs what has an answer, and what had one.
    pub fn apply(fits: &[Self], questions: &[Question], entries: &[Entry], conversion: &mut Conversion) {
        for (question, fit) in questions.iter().zip(fits) {
            let is_it = |finding: &&mut Diagnostic| {
                let is_said = finding.code == question.code && finding.message == question.says;
                is_said && asks(finding) && finding.once == question.program.is_none()
            };
            let programs = match question.program {
                Some(at) => conversion.programs.get_mut(at..=at),
                None => Some(conversion.programs.as_mut_slice()),
            };
            let programs = programs.unwrap_or_default();
            let all = programs.iter_mut().flat_map(|program| &mut program.diagnostics).filter(is_it);
            match fit.entry(entries) {
                Some((entry, true)) => {
                    let accepted = Arc::new(entry.accepted());
                    all.for_each(|finding| finding.accepted = Some(Arc::clone(&accepted)));
                }
                Some((entry, false)) => {
                    let told = entry.is_stale_for(question);
                    all.for_each(|finding| {
                        let help = finding.help.as_deref().map(|help| format!("{help}. {told}"));
                        finding.help = Some(help.unwrap_or_else(|| told.clone()).into());
                    });
                }
                None => {}
            }
        }
        for program in conversion.programs.iter_mut().filter(|program| program.outcome == Outcome::Review) {
            let is_accepted = program.diagnostics.iter().any(|finding| finding.accepted.is_some());
            if is_accepted && outcome(&program.diagnostics) == Outcome::Converted {
                program.outcome = Outcome::Accepted;
            }
        }
    }

    /// The entry, and whether it is the answer still.
    fn entry(self, entries: &[Entry]) -> Option<(&Entry, bool)> {
        match self {
            Self::Open => None,
            Self::Accepted(at) => Some((entries.get(at)?, true)),
            Self::Stale(at) => Some((entries.get(at)?, false)),
        }
    }
}

impl Entry {
    /// True if it is about this. What a reviewer reads in it is held to what is asked, too.
    pub(super) fn answers(&self, hash: &str, says: &str) -> bool {
        self.hash.get_ref() == hash && self.says.get_ref() == says
    }

    /// What is told where the entry is about another text, or other machines, than the question.
    fn is_stale_for(&self, question: &Question) -> String {
        let (ours, theirs) = (halves(self.hash.get_ref()), halves(&question.hash));
        let of = match (ours.0 == theirs.0, ours.1 == theirs.1) {
            (true, false) => "for other machines: a profile says something else now",
            (false, true) => "for another text of the program, or of what it calls",
            _ => "for another text, and for other machines",
        };
        let accepted = self.accepted();
        format!(
            "It was accepted by {} on {}, {of}: look again, then run `macroglot accept`",
            accepted.who, accepted.when
        )
    }
}

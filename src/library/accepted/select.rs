//! Which questions a person accepts, and what that changes in the project file.

use super::answers::{Answered, Asked, Fit};
use super::edit::Edit;
use super::entry::{Entry, acceptable};
use super::questions::Question;
use crate::diag::{ALL, Code};
use std::collections::BTreeSet;
use toml::value::Datetime;

/// What a person names of what is asked. Each list that is empty takes all.
#[derive(Clone, Debug, Default)]
pub struct Chosen {
    /// Libraries of the project file.
    pub libraries: Vec<String>,
    /// Machines that they are converted to.
    pub targets: Vec<String>,
    /// Files and folders, seen from the project file.
    pub files: Vec<String>,
    /// Programs by their names.
    pub programs: Vec<String>,
    /// Codes, or beginnings of some.
    pub codes: Vec<String>,
}

/// Who accepts, when and why.
#[derive(Clone, Debug)]
pub struct Signer<'a> {
    /// Who.
    pub who: &'a str,
    /// The day.
    pub when: Datetime,
    /// Why, if that is said.
    pub why: Option<&'a str>,
}

impl Chosen {
    /// What is wrong with the codes, if anything is.
    pub fn fault(&self) -> Option<String> {
        self.codes.iter().find_map(|text| {
            let mut meant = ALL.iter().filter(|code| begins(**code, text)).peekable();
            if meant.peek().is_none() {
                return Some(format!(
                    "'{text}' is no code and no beginning of one: `macroglot explain` lists them"
                ));
            }
            let reasons: Vec<_> = meant.map(|code| acceptable(*code)).collect();
            reasons.iter().all(Result::is_err).then(|| reasons.into_iter().find_map(Result::err)).flatten()
        })
    }

    /// True if the way is one of those that are named.
    pub fn takes_way(&self, [library, target]: [&str; 2]) -> bool {
        takes(&self.libraries, |name| name == library) && takes(&self.targets, |name| name == target)
    }

    /// True if the file is one of those that are named, or lies in one of the folders.
    pub fn takes_file(&self, file: &str) -> bool {
        takes(&self.files, |path| {
            path.is_empty()
                || file == path
                || file.strip_prefix(path).is_some_and(|rest| rest.starts_with('/'))
        })
    }

    fn takes(&self, file: &str, program: Option<&str>, code: &str) -> bool {
        self.takes_file(file)
            && takes(&self.programs, |name| Some(name) == program)
            && takes(&self.codes, |text| Code::find(code).is_some_and(|code| begins(code, text)))
    }
}

fn takes(all: &[String], is_it: impl Fn(&str) -> bool) -> bool {
    all.is_empty() || all.iter().any(|one| is_it(one))
}

fn begins(code: Code, text: &str) -> bool {
    let text = text.trim().to_ascii_uppercase();
    text.len() > 2 && code.number().starts_with(&text)
}

/// What accepting makes of the project file: new entries, those that are renewed, and those that match nothing any more.
pub fn edits(
    asked: &[Asked<'_>],
    answered: &Answered,
    entries: &[Entry],
    (chosen, signer): (&Chosen, &Signer<'_>),
) -> Vec<Edit> {
    let mut edits = Vec::new();
    // A shared program may be asked the same in several folders.
    let mut known: BTreeSet<Vec<String>> = BTreeSet::new();
    let taken = |one: &Asked<'_>, question: &Question| {
        chosen.takes_way(one.way)
            && chosen.takes(&question.file, question.name.as_deref(), question.code.number())
    };
    for (one, fits) in asked.iter().zip(&answered.fits) {
        for (question, fit) in one.questions.iter().zip(fits).filter(|(question, _)| taken(one, question)) {
            let entry = question.entry(one.way, signer.who, signer.when, signer.why);
            let key = entry.key().map(str::to_owned).into_iter().chain([question.hash.clone()]);
            let is_new = !matches!(fit, Fit::Accepted(_)) && known.insert(key.collect());
            match (fit, is_new) {
                (Fit::Open, true) => edits.push(Edit::Add(entry)),
                (Fit::Stale(at), true) => edits.push(Edit::Renew(*at, entry)),
                (Fit::Stale(at), false) => edits.push(Edit::Drop(*at)),
                (Fit::Accepted(_), _) | (Fit::Open, false) => {}
            }
        }
    }
    let gone = answered.unmatched.iter().filter(|at| {
        let entry = entries.get(**at);
        entry.is_some_and(|entry| {
            let [library, target, file, _, code] = entry.key();
            chosen.takes_way([library, target]) && chosen.takes(file, entry.program(), code)
        })
    });
    edits.extend(gone.map(|at| Edit::Drop(*at)));
    edits
}

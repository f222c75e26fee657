//! What keeps a repository of programs sound: each is read, understood, goes to other machines and back, and its
//! conversions are of the text that stands there.
//!
//! A check looks at some files of a library and reads the rest of it too: who calls whom decides what a change touches. What
//! takes long, the ways to other machines and back, is done once for a text and kept ([`Cache`]).

mod baseline;
mod cache;
mod filter;
mod finding;
mod fresh;
mod groups;
mod rounds;
mod signed;
mod understood;

pub use baseline::{Baseline, BaselineError};
pub use cache::Cache;
pub use filter::{Allowed, Selection, Suppressed};
pub use finding::Finding;

use crate::dialect::Control;
use crate::library::{Answers, Input, OfPrograms, understood};
use crate::verify::Effort;
use finding::Pages;
use std::path::{Path, PathBuf};

/// A library, and which of its files are looked at.
pub struct Shelf {
    /// All of its files.
    pub inputs: Vec<Input>,
    /// By file: true if it is looked at.
    pub wanted: Vec<bool>,
    /// True if all of the library is looked at.
    pub whole: bool,
    /// The control that its programs are written for.
    pub control: Control,
    /// The machines that its programs are to go to and come back from, by the names that people know them by.
    pub rounds: Vec<(String, Control)>,
    /// Where its conversions stand.
    pub outputs: Vec<Output>,
    /// What somebody accepted of it; none if it is of no project.
    pub answers: Option<Answers>,
}

/// A folder of conversions.
pub struct Output {
    /// The machine that they are for.
    pub machine: String,
    /// The folder.
    pub folder: PathBuf,
    /// What the profiles of both machines say, as the folder's manifest keeps it.
    pub profiles: String,
}

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Part {
    /// Whether each file is read without loss and understood.
    Read,
    /// What a programmer would want to look at again.
    Lint,
    /// Whether programs come through the way to other machines and back.
    Round,
    /// Whether the conversions are of the programs that stand there.
    Fresh,
}

impl Part {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Read, Self::Lint, Self::Round, Self::Fresh];
}

/// What is asked of a check.
pub struct Request<'a> {
    /// The libraries.
    pub shelves: &'a [Shelf],
    /// The folder that files are seen from: the project's.
    pub root: &'a Path,
    /// Signed reports, whose hashes are compared.
    pub signed: &'a [PathBuf],
    /// What is looked at.
    pub parts: &'a [Part],
    /// Which codes are wanted.
    pub selection: &'a Selection,
    /// Findings that somebody has looked at.
    pub allowed: &'a [Allowed],
    /// What earlier checks found.
    pub cache: &'a Cache,
    /// How much the verifier may do.
    pub effort: Effort,
    /// Told whenever a group of programs that call one another is done: how many files of it were looked at.
    pub done: &'a (dyn Fn(usize) + Sync),
}

/// What a check found.
#[derive(Debug, Default)]
pub struct Checked {
    /// The findings, by file and place.
    pub findings: Vec<Finding>,
    /// Findings that the project file allows, and the reasons it gives.
    pub suppressed: Vec<Suppressed>,
    /// Findings that the baseline knows.
    pub known: usize,
    /// The files that were looked at.
    pub files: Vec<PathBuf>,
    /// Folders whose conversions could not be looked at, and why.
    pub not_looked_at: Vec<String>,
    /// Ways there and back that were taken, and that an earlier check had taken.
    pub rounds: [usize; 2],
}

/// Checks the libraries.
pub fn check(request: &Request<'_>) -> Checked {
    let mut checked = Checked::default();
    let mut found: Vec<Finding> = Vec::new();
    for shelf in request.shelves {
        found.extend(of_shelf(shelf, request, &mut checked));
        let looked_at = shelf.inputs.iter().zip(&shelf.wanted).filter(|(_, wanted)| **wanted);
        checked.files.extend(looked_at.map(|(input, _)| input.path.clone()));
    }
    if request.parts.contains(&Part::Fresh) {
        found.extend(request.signed.iter().flat_map(|report| signed::changed(report, request.root)));
    }
    found.retain(|finding| request.selection.wants(finding.code));
    finding::number(&mut found, request.root);
    (checked.findings, checked.suppressed) = filter::allow(found, request.allowed);
    checked.files.sort();
    checked.files.dedup();
    checked
}

fn of_shelf(shelf: &Shelf, request: &Request<'_>, checked: &mut Checked) -> Vec<Finding> {
    let pages = Pages::new(&shelf.inputs);
    let mut found = Vec::new();
    let is = |part| request.parts.contains(&part);
    if is(Part::Read) || is(Part::Lint) || is(Part::Round) {
        let library = understood(&shelf.inputs, &shelf.control);
        if is(Part::Read) {
            let answers = shelf.answers.as_ref();
            let accepted = answers.map(|answers| answers.everywhere(&library, &shelf.inputs, &shelf.control));
            let accepted: OfPrograms = accepted.unwrap_or_default();
            found.extend(understood::findings(shelf, &library, &accepted, &pages));
        }
        if is(Part::Lint) {
            let wanted = |code| request.selection.wants(code);
            let lint = crate::lint::lint(&shelf.inputs, &shelf.control, &library.module, &wanted);
            // What is not understood would be linted for what it is not.
            let sound = understood::sound(&library, shelf.inputs.len());
            let lint = lint.into_iter().filter(|(file, _)| shelf.wanted[*file] && sound[*file]);
            found.extend(lint.map(|(file, diagnostic)| pages.finding(file, &diagnostic)));
        }
        if is(Part::Round) && !shelf.rounds.is_empty() {
            let (rounds, taken) = rounds::findings(shelf, &library.module, &pages, request);
            found.extend(rounds);
            checked.rounds[0] += taken[0];
            checked.rounds[1] += taken[1];
        }
    }
    if is(Part::Fresh) {
        for output in &shelf.outputs {
            match fresh::findings(shelf, output, &pages) {
                Ok(fresh) => found.extend(fresh),
                Err(why) => checked.not_looked_at.push(why),
            }
        }
    }
    found
}

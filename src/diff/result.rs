//! What a diff found: the same values for people and for programs. `docs/diff.md` explains the keys.

use crate::verify::{Listing, Picture};
use serde::Serialize;

/// Version of the shape of a diff in JSON.
pub const FORMAT: u32 = 1;

/// What changed between two files, or two libraries.
#[derive(Clone, Debug, Serialize)]
pub struct Diff {
    /// Version of the shape of this object.
    pub format: u32,
    /// Version of macroglot.
    pub macroglot: &'static str,
    /// The control of the old programs.
    pub from: String,
    /// The control of the new ones.
    pub to: String,
    /// What the change amounts to for the machine.
    pub verdict: Verdict,
    /// Millimetres that places may lie apart and count as the same, over and above what words round.
    pub tolerance_mm: f64,
    /// Files whose text changed.
    pub files: Vec<FileDiff>,
    /// Programs that changed, or that call one that did; those of the old files first.
    pub programs: Vec<ProgramDiff>,
    /// Programs in which nothing changed, nor in what they call.
    pub untouched: usize,
    /// Variables that stand under another name now, in the whole library.
    pub renamed: Vec<Renamed>,
    /// What is to be said of the diff as a whole.
    pub notes: Vec<String>,
    /// A run of a program on both sides, if one was asked for and a program stands on both.
    #[serde(skip)]
    pub picture: Option<Box<Pictured>>,
}

/// A program of both sides, as it is drawn.
#[derive(Clone, Debug)]
pub struct Pictured {
    /// What tells it from other programs of the old side: file and name; empty if there is one alone.
    pub old: String,
    /// The same on the new one.
    pub new: String,
    /// What both do.
    pub runs: Picture,
}

impl Diff {
    /// Of two sides without any program.
    pub fn of_nothing() -> Self {
        Self {
            format: FORMAT,
            macroglot: env!("CARGO_PKG_VERSION"),
            from: String::new(),
            to: String::new(),
            verdict: Verdict::Same,
            tolerance_mm: 0.0,
            files: Vec::new(),
            programs: Vec::new(),
            untouched: 0,
            renamed: Vec::new(),
            notes: Vec::new(),
            picture: None,
        }
    }
}

/// What a change amounts to for the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The machine does the same.
    Same,
    /// No difference was found, but something was not looked at or cannot be said.
    Undecided,
    /// The machine does something else.
    Different,
}

/// A variable that stands under another name now.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Renamed {
    /// The old name.
    pub old: String,
    /// The new name.
    pub new: String,
    /// True for a variable of a call's own; others may be set by an operator, or used by programs that are not here.
    pub local: bool,
}

/// What changed in the text of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileDiff {
    /// The old file; none for one that is new.
    pub old: Option<String>,
    /// The new file; none for one that is gone.
    pub new: Option<String>,
    /// The lines that changed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub text: Option<Text>,
    /// The same of the text with spacing, numbering, spelling of numbers and comments left aside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normalised: Option<Text>,
}

impl FileDiff {
    /// The levels that were asked for, with their names; a normalised text is left out where the same lines changed in it.
    pub fn told(&self) -> impl Iterator<Item = (&'static str, &Text)> {
        let same = self.says_the_same();
        let normalised = self
            .normalised
            .as_ref()
            .filter(|_| !same && (self.text.is_none() || (self.old.is_some() && self.new.is_some())));
        let all = [("text", self.text.as_ref()), ("normalised", normalised)];
        all.into_iter().filter_map(|(level, text)| Some((level, text.filter(|text| !text.is_empty())?)))
    }

    fn says_the_same(&self) -> bool {
        let (Some(text), Some(normalised)) = (&self.text, &self.normalised) else { return false };
        text.left_out == 0 && normalised.left_out == 0 && text.changed().eq(normalised.changed())
    }
}

impl Text {
    /// True where nothing changed.
    pub fn is_empty(&self) -> bool {
        self.hunks.is_empty() && self.left_out == 0
    }

    /// The numbers of the lines that changed.
    fn changed(&self) -> impl Iterator<Item = (Option<usize>, Option<usize>)> + '_ {
        let all = self.hunks.iter().flat_map(|hunk| &hunk.lines);
        all.filter(|line| line.on != On::Both).map(|line| (line.old, line.new))
    }
}

/// Lines that changed, with some about them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Text {
    /// In order.
    pub hunks: Vec<Hunk>,
    /// Changed lines that found no room.
    pub left_out: usize,
}

/// A run of lines with a change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hunk {
    /// The lines, in order.
    pub lines: Vec<Line>,
}

/// A line of a text.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Which side has it.
    pub on: On,
    /// Its number in the old file, where it stands there.
    pub old: Option<usize>,
    /// Its number in the new file.
    pub new: Option<usize>,
    /// Its text in pieces, those marked that changed within the line.
    pub pieces: Vec<Piece>,
}

/// Which side has a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum On {
    /// Both.
    Both,
    /// The old one alone.
    Old,
    /// The new one alone.
    New,
}

/// A part of a line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Piece {
    /// The text.
    pub text: String,
    /// True where the other side has something else.
    pub changed: bool,
}

/// What changed in a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProgramDiff {
    /// Its name; none where it has none.
    pub program: Option<String>,
    /// Its file on the old side; none for a program that is new.
    pub old: Option<String>,
    /// Its file on the new side; none for a program that is gone.
    pub new: Option<String>,
    /// The line that it begins in, on the new side if it stands there.
    pub line: usize,
    /// What it amounts to for the machine.
    pub verdict: Verdict,
    /// Why, in words; empty where the places say it.
    pub why: Vec<String>,
    /// What changed in its build.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub structure: Option<Vec<Note>>,
    /// Where the machine does something else.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Listing>,
}

/// A change in the build of a program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Note {
    /// What it is about: `blocks`, `jump`, `label`, `call`, `variable`, `program`.
    pub about: &'static str,
    /// In words.
    pub text: String,
    /// The line on the old side.
    pub old: Option<usize>,
    /// The line on the new side.
    pub new: Option<usize>,
}

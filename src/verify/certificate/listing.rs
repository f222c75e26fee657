//! All the places at which two programs differ.

use super::moment::Moment;
use crate::control::trace::{EventKind, Place};
use serde::Serialize;

/// Where two programs differ, in all scenarios that were tried.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Listing {
    /// Scenarios that both were run in.
    pub scenarios: usize,
    /// Scenarios in which they differ.
    pub differing: usize,
    /// True where the programs count in inches; lengths here are millimetres all the same.
    pub inch: bool,
    /// The places.
    pub changes: Vec<Change>,
    /// Places that found no room.
    pub left_out: usize,
    /// What differs at the end of the runs, each once.
    pub at_end: Vec<String>,
}

/// A place at which two programs differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// What the old program does; none for what the new one does besides.
    pub old: Option<Seen>,
    /// What the new program does; none for what the old one does besides.
    pub new: Option<Seen>,
    /// What differs, in words.
    pub what: String,
    /// How often that was seen in the first run that showed it.
    pub times: usize,
    /// The number of that run.
    #[serde(skip)]
    pub run: usize,
    /// Places that follow and differ by just as much.
    pub alike: usize,
    /// True where the part's zero was the machine's and all tools had no length: positions are those of the program.
    pub plain: bool,
}

/// Something that a program does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Seen {
    /// Where, and what happened.
    #[serde(flatten)]
    pub moment: Moment,
    /// What happened.
    #[serde(skip)]
    pub what: EventKind,
    /// The block, as the run counts it.
    #[serde(skip)]
    pub at: Place,
    /// The work offset in force.
    pub work: u32,
    /// The number of the tool length in force.
    pub length: u32,
}

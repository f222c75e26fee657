//! What a run amounts to.

use super::machine::ExitState;
use super::trace::{Computed, Event, Nearest, Place, Program, Zero};
use crate::canon::{Func, Op};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A finished run.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// What happened, in order.
    pub events: Vec<Event>,
    /// The programs that ran, by the number that [`Place::program`] holds.
    pub programs: Vec<Program>,
    /// Final values of the variables that are not vacant, by the dialect's own names: `#100`, `V1`, `R3`.
    pub variables: BTreeMap<String, f64>,
    /// How it ended.
    pub end: End,
    /// Blocks that were executed.
    pub steps: u64,
    /// Which branching blocks went which way.
    pub branches: Branches,
    /// True where its arithmetic needed more digits than the scenario or the control leaves it, or than [`FEWER_DIGITS`]
    /// where both leave it all.
    ///
    /// [`FEWER_DIGITS`]: super::FEWER_DIGITS
    #[serde(skip)]
    pub lacked_digits: bool,
    /// The modes in force at its end, however it ended: [`super::machine::GIVEN`].
    #[serde(skip)]
    pub modes: Vec<Op>,
    /// What was in force at its end; none if it did not end by itself.
    #[serde(skip)]
    pub left: Option<ExitState>,
    /// The codes whose numbers it computed: the letter and the number.
    #[serde(skip)]
    pub computed_codes: Vec<Computed<(char, f64)>>,
    /// The numbers of variables that it computed.
    #[serde(skip)]
    pub computed_numbers: Vec<Computed<u32>>,
    /// The arguments that it gave functions which few controls have.
    #[serde(skip)]
    pub arguments: Vec<Computed<(Func, [f64; 2])>>,
    /// The zero points that its moves count from, and how many events came before each; the first
    /// [`super::trace::MOST_ZEROS`].
    #[serde(skip)]
    pub zeros: Vec<(usize, Zero)>,
    /// How near its branches came to their other ways; empty unless the scenario asks for it.
    #[serde(skip)]
    pub nearest: Nearest,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "end", rename_all = "snake_case")]
pub enum End {
    /// By its end code, or after its last block.
    Ended,
    /// At an alarm; the last event says which.
    Alarm {
        /// The block that raised it.
        at: Place,
        /// What the control shows.
        #[serde(flatten)]
        stop: Stop,
    },
    /// The scenario's number of blocks or events was used up: as good as endless.
    StepBudget,
    /// The scenario's time was used up.
    TimeBudget,
    /// It could not be run: a program is not there, a block cannot be read.
    Error {
        /// Where.
        at: Place,
        /// Why.
        text: String,
    },
}

/// Why the control stops with an alarm.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stop {
    /// The alarm's name on the control: `PS0112`, `3001`; empty where no source names it.
    pub number: String,
    /// The number that the program gave it, where it is the program's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program_number: Option<f64>,
    /// What is the matter, or the program's own message.
    pub text: String,
    /// The limit that calls nest deeper than, as the tables name it, and how many levels it allows.
    #[serde(skip)]
    pub nesting: Option<(&'static str, u32)>,
    /// True where the program stops there for whoever runs it, and the target must stop too: a jump finds no block with its
    /// number, a tool is too large for a pocket.
    #[serde(skip)]
    pub for_all: bool,
}

impl Stop {
    /// An alarm of the control itself.
    pub fn alarm(number: &str, text: impl Into<String>) -> Self {
        Self { number: number.into(), program_number: None, text: text.into(), nesting: None, for_all: false }
    }

    /// Calls that nest deeper than a limit of the control.
    pub fn too_deep(number: &str, limit: &'static str, most: u32) -> Self {
        Self { nesting: Some((limit, most)), ..Self::alarm(number, "calls nest too deep") }
    }

    /// A jump to a number that no block has.
    pub fn no_label(number: &str, text: impl Into<String>) -> Self {
        Self { for_all: true, ..Self::alarm(number, text) }
    }

    /// What stops the program for whoever runs it, and no source names.
    pub fn for_all(text: impl Into<String>) -> Self {
        Self { for_all: true, ..Self::unnamed(text) }
    }

    /// True where the control stops by itself: the program raised no alarm, and the target need not stop there.
    pub fn is_of_control(&self) -> bool {
        self.program_number.is_none() && !self.for_all
    }

    /// Its number and what is the matter, as people are told.
    pub fn told(&self) -> String {
        format!("{} {}", self.number, self.text).trim().to_owned()
    }

    /// An alarm that the sources do not name.
    pub fn unnamed(text: impl Into<String>) -> Self {
        Self::alarm("", text)
    }
}

/// A block that chose between ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Branch {
    /// The condition or computed target.
    pub at: Place,
}

/// The ways that each branch took: 0 for false and 1 for true, or the number it computed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Branches(BTreeMap<Place, BTreeSet<i64>>);

impl Branches {
    /// Notes a way. A branch with very many ways (a computed jump) keeps the first hundred.
    pub fn took(&mut self, at: Place, way: i64) {
        let ways = self.0.entry(at).or_default();
        if ways.len() < 100 {
            ways.insert(way);
        }
    }

    /// The branches and their ways, in the order of the source.
    pub fn iter(&self) -> impl Iterator<Item = (Branch, &BTreeSet<i64>)> {
        self.0.iter().map(|(at, ways)| (Branch { at: *at }, ways))
    }

    /// The ways that the branch at a place took.
    pub fn ways(&self, at: Place) -> Option<&BTreeSet<i64>> {
        self.0.get(&at)
    }
}

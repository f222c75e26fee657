//! What happened on the machine: canonical events, the same for every control.
//!
//! Positions are machine coordinates in millimetres (degrees for A, B and C), feeds millimetres
//! per minute or per turn, times seconds, whatever the units of the program. `docs/trace.md`
//! describes the JSON form.

mod event_kind;
mod nearness;

pub use event_kind::*;
pub use nearness::{Nearest, Nearness};

use super::entry::Entry;
use super::outcome::Stop;
use crate::canon::{Func, Op};
use crate::dialect::Row;
use crate::text::Span;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::cell::Cell;
use std::collections::{BTreeMap, HashMap, HashSet};

/// One event and the block that caused it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Event {
    /// The block.
    pub at: Place,
    /// What happened.
    #[serde(flatten)]
    pub what: EventKind,
    /// How far its positions may lie from where exact numbers would have put them, because words have a least
    /// increment; millimetres.
    #[serde(skip)]
    pub rounded: f64,
    /// What else is known of it.
    #[serde(skip)]
    pub told: Told,
    /// For spindle and coolant, as [`crate::canon::Running`] counts them: true if nobody knows whether it runs from
    /// here on.
    #[serde(skip)]
    pub open: [bool; 2],
}

/// What is known of an event besides what happened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Told {
    /// Nothing.
    #[default]
    Plain,
    /// A change of spindle or coolant beside a rapid move or a wait, where no source says which comes first.
    Loose,
    /// A change of spindle or coolant that no code of the program says: what stops the program does it.
    Implied,
    /// What the program found in force when it started.
    Found,
    /// A change to the tool that is in the spindle already.
    SameTool,
    /// A spindle that a drilling cycle stops, turns round, or lets turn again.
    Cycle,
    /// A wait at the bottom of the hole of a drilling cycle.
    Bottom(Op),
    /// A move of the roughing of a contour.
    Pass,
}

/// A place of a library: a program and bytes of its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    /// The program, counted in [`super::Run::programs`].
    pub program: u32,
    /// The bytes in the program's file.
    pub span: Span,
}

impl Serialize for Place {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut place = serializer.serialize_struct("Place", 3)?;
        place.serialize_field("program", &self.program)?;
        place.serialize_field("start", &self.span.start)?;
        place.serialize_field("end", &self.span.end)?;
        place.end()
    }
}

/// A program that ran.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Program {
    /// Its file, counted in the library.
    pub file: usize,
    /// Its name: `O1234`; empty where it has none.
    pub name: String,
    /// What was in force when it was come to first: [`crate::control::machine::GIVEN`].
    #[serde(skip)]
    pub modes: Vec<Op>,
    /// What else was in force each time it was come to.
    #[serde(skip)]
    pub entry: Entry,
}

/// The letter by which computed speeds that are no whole numbers above 0 stand among the computed codes.
pub const ODD_SPEED: char = 's';

/// The letter by which blocks that name a tool length and no place of its axis stand there.
pub const LONE_LENGTH: char = 'l';

/// Something that a run computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Computed<T> {
    /// What came of it.
    pub what: T,
    /// The block.
    pub at: Place,
    /// How many events came before it was computed there first.
    pub before: usize,
}

/// Where a program counts from, in which unit, and in which plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Zero {
    /// Machine coordinates of the work zero in X, Y and Z, with the tool length that is applied; millimetres. A local
    /// shift is left aside: it moves within the work coordinates.
    pub at: [f64; 3],
    /// True where lengths are inches.
    pub inch: bool,
    /// The plane of arcs and of cutter compensation.
    pub plane: Plane,
    /// True where X is a diameter.
    pub diameters: bool,
}

/// Changes of the zero point that a run remembers.
pub const MOST_ZEROS: usize = 1 << 16;

/// Bytes of messages and outputs that a run remembers.
const MOST_TEXT: usize = 16 << 20;

/// Computed codes that a run remembers.
const MOST_CODES: usize = 4096;

/// Computed numbers of variables, and arguments of functions, that a run remembers.
const MOST_NUMBERS: usize = 4096;

/// Events that a run is given room for ahead, at the most.
const MOST_AHEAD: usize = 2048;

thread_local! {
    /// How many events the last run of this thread had: the next one is mostly of the same program. Events are large, and
    /// a list that grows moves them again and again.
    static LAST: Cell<usize> = const { Cell::new(0) };
}

/// The events of a run in the making.
#[derive(Debug)]
pub struct Trace {
    /// The events so far, but those that were taken out.
    pub events: Vec<Event>,
    /// How many were taken out.
    taken: usize,
    /// The block that events belong to.
    pub at: Place,
    /// How far positions may be off by rounding, from now on.
    pub rounded: f64,
    /// True while a contour is roughed.
    pub roughs: bool,
    /// For spindle and coolant: true if nobody knows whether a stop has ended it, and no code has said since what runs.
    pub open: [bool; 2],
    /// How many of the events are more than a dwell, a mode, or what the program keeps for itself.
    happened: usize,
    limit: usize,
    /// Bytes of messages and outputs that are still kept.
    room: usize,
    full: bool,
    /// Where each fact that nobody confirmed mattered.
    doubted: HashMap<String, HashSet<Place>>,
    /// Codes whose number was computed, with their letter, and how many events came before each.
    computed_codes: BTreeMap<(char, u64, Place), usize>,
    /// Numbers of variables that were computed, and how many events came before each.
    computed_numbers: BTreeMap<(u32, Place), usize>,
    /// Arguments of functions that few controls have, and how many events came before each.
    arguments: BTreeMap<(Func, u64, u64, Place), usize>,
    /// Zero points, and how many events came before each was in force.
    pub zeros: Vec<(usize, Zero)>,
    /// How near branches came to their other ways, if the scenario asks for it.
    pub nearness: Option<Box<Nearness>>,
    /// Matters that the machine's profile confirms.
    confirmed: Vec<String>,
}

impl Trace {
    /// An empty trace that keeps at most so many events.
    pub fn new(limit: usize, confirmed: &[String]) -> Self {
        Self {
            events: Vec::with_capacity(LAST.get().min(limit).min(MOST_AHEAD)),
            taken: 0,
            at: Place::default(),
            rounded: 0.0,
            roughs: false,
            open: [false; 2],
            happened: 0,
            limit,
            room: MOST_TEXT,
            full: false,
            doubted: HashMap::new(),
            computed_codes: BTreeMap::new(),
            computed_numbers: BTreeMap::new(),
            arguments: BTreeMap::new(),
            zeros: Vec::new(),
            nearness: None,
            confirmed: confirmed.to_vec(),
        }
    }

    /// The events of a run that came to its end.
    pub(super) fn into_events(self) -> Vec<Event> {
        LAST.set(self.events.len());
        self.events
    }

    /// Notes a comparison of two numbers, for [`Nearness`].
    pub fn compared(&mut self, a: f64, b: f64, holds: bool) {
        if let Some(nearness) = &mut self.nearness {
            nearness.compared(a, b, holds);
        }
    }

    /// Notes which way the branch at a place went, for [`Nearness`].
    pub fn branched(&mut self, at: Place, holds: bool) {
        if let Some(nearness) = &mut self.nearness {
            nearness.branched(at, holds);
        }
    }

    /// Records an event of the present block.
    pub fn push(&mut self, what: EventKind) {
        let text = match &what {
            EventKind::Message { text } | EventKind::Output { text } => text.len(),
            _ => 0,
        };
        match self.room.checked_sub(text) {
            Some(room) if self.count() < self.limit => {
                self.room = room;
                self.happened += usize::from(what.happens());
                self.events.push(self.event(what));
            }
            _ => self.full = true,
        }
    }

    /// Adds to the last event what is known of it.
    pub fn tell(&mut self, told: Told) {
        if let Some(event) = self.events.last_mut().filter(|_| !self.full) {
            event.told = told;
        }
    }

    /// How many events there were so far that are more than a dwell, a mode, or what the program keeps for itself.
    pub fn happened(&self) -> usize {
        self.happened
    }

    /// How many events there were so far.
    fn count(&self) -> usize {
        self.taken + self.events.len()
    }

    /// Takes the events out, but the last one: it may still be told of, and says where the run is.
    pub fn take(&mut self) -> Vec<Event> {
        let last = self.events.pop();
        let events = std::mem::replace(&mut self.events, Vec::from_iter(last));
        self.taken += events.len();
        events
    }

    /// True when an event found no room: the run must end.
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Records the zero point that the next moves count from.
    pub fn zero(&mut self, zero: Zero) {
        if self.zeros.last().is_none_or(|(_, last)| *last != zero) && self.zeros.len() < MOST_ZEROS {
            self.zeros.push((self.count(), zero));
        }
    }

    /// Records a speed that was computed and is no whole number above 0.
    pub fn odd_speed(&mut self, speed: f64) {
        if speed.fract() != 0.0 || speed <= 0.0 {
            self.computed_code(ODD_SPEED, speed);
        }
    }

    /// Records that a block names a tool length and no place of its axis.
    pub fn lone_length(&mut self) {
        self.computed_code(LONE_LENGTH, 0.0);
    }

    /// Records a code whose number was computed.
    pub fn computed_code(&mut self, letter: char, number: f64) {
        if self.computed_codes.len() < MOST_CODES {
            let before = self.count();
            self.computed_codes.entry((letter, number.to_bits(), self.at)).or_insert(before);
        }
    }

    /// The codes whose numbers were computed, with where, and how many events came before each.
    pub fn computed_codes(&self) -> Vec<Computed<(char, f64)>> {
        let code = |((letter, bits, at), before): (&(char, u64, Place), &usize)| Computed {
            what: (*letter, f64::from_bits(*bits)),
            at: *at,
            before: *before,
        };
        self.computed_codes.iter().map(code).collect()
    }

    /// Records the number of a variable that was computed.
    pub fn computed_number(&mut self, number: u32) {
        if self.computed_numbers.len() < MOST_NUMBERS {
            let before = self.count();
            self.computed_numbers.entry((number, self.at)).or_insert(before);
        }
    }

    /// The numbers of variables that were computed, with where, and how many events came before each.
    pub fn computed_numbers(&self) -> Vec<Computed<u32>> {
        let number = |((what, at), before): (&(u32, Place), &usize)| Computed {
            what: *what,
            at: *at,
            before: *before,
        };
        self.computed_numbers.iter().map(number).collect()
    }

    /// Records the arguments of a function; of one with a single one, the second is 0.
    pub fn argument(&mut self, function: Func, a: f64, b: f64) {
        if self.arguments.len() < MOST_NUMBERS {
            let before = self.count();
            self.arguments.entry((function, a.to_bits(), b.to_bits(), self.at)).or_insert(before);
        }
    }

    /// The arguments of functions, with where, and how many events came before each.
    pub fn arguments(&self) -> Vec<Computed<(Func, [f64; 2])>> {
        let value = |((function, a, b, at), before): (&(Func, u64, u64, Place), &usize)| Computed {
            what: (*function, [*a, *b].map(f64::from_bits)),
            at: *at,
            before: *before,
        };
        self.arguments.iter().map(value).collect()
    }

    /// Records that a fact mattered that nobody confirmed; once for each block.
    pub fn doubt(&mut self, fact: &str) {
        if self.full || self.confirmed.iter().any(|name| name == fact) {
            return;
        }
        // Most were noted here before: a loop comes by again and again.
        let is_new = match self.doubted.get_mut(fact) {
            Some(places) => places.insert(self.at),
            None => self.doubted.insert(fact.into(), HashSet::from([self.at])).is_none(),
        };
        if is_new {
            self.push(EventKind::Unsure { fact: fact.into() });
        }
    }

    /// Records a row of a table that mattered, where no source confirms it.
    pub fn rest_on(&mut self, row: &impl Row) {
        if !row.origin().is_settled() {
            self.doubt(&row.fact());
        }
    }

    /// Records an alarm.
    pub fn alarm(&mut self, stop: &Stop) {
        // The alarm is the one event that a full trace still takes.
        self.events.push(self.event(EventKind::Alarm(stop.clone())));
    }

    fn event(&self, what: EventKind) -> Event {
        let told = if self.roughs { Told::Pass } else { Told::Plain };
        Event { at: self.at, what, rounded: self.rounded, told, open: self.open }
    }
}

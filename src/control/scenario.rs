//! The circumstances of a run: all that a program meets from outside.

use super::entry::Entry;
use super::table::Table;
use crate::canon::{CycleSetting, Group, Op, Sys};
use crate::dialect::OneTable;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// How many axes a position has: X Y Z A B C U V W E.
pub const AXES: usize = 10;

/// A position: one value an axis in the common order, millimetres, or degrees for A, B and C.
pub type Axes = [f64; AXES];

/// The circumstances of a run. [`Scenario::default`] is a machine at its reference position
/// with all offsets zero, no variable set, and a probe that never touches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scenario {
    /// Start values of variables, by the dialect's own names: `#100`, `V1`, `R3`. Absent ones are
    /// as after power-on.
    pub variables: BTreeMap<String, f64>,
    /// True where the program runs as one that was called: its return ends the run.
    pub called: bool,
    /// True for inch, false for metric at the start; none for what the profile says.
    pub inch: Option<bool>,
    /// What is in force at the start, where that is not what power-on leaves: planes, feed modes, absolute or
    /// incremental.
    pub modes: Vec<Op>,
    /// What else is in force then.
    pub entry: Entry,
    /// The groups of which that is in force which the machine's profile says under `[start]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub as_stated: Vec<Group>,
    /// Machine position at the start.
    pub start: Axes,
    /// Work offsets, by common number: 1 to 6, 101 and up.
    pub work_offsets: Table<Axes>,
    /// Shift of all work offsets.
    pub external_shift: Axes,
    /// The tool table: offset values by number.
    pub tools: Table<Tool>,
    /// How the rows stand in both tables, where one machine has one number a row for lengths and radii; none if neither has.
    #[serde(skip)]
    pub one_table: Option<Arc<SharedRows>>,
    /// The tool in the spindle at the start.
    pub tool: u32,
    /// The first and second reference position, machine coordinates.
    pub references: [Axes; 2],
    /// The third and the fourth.
    pub more_references: [Axes; 2],
    /// What each probe move meets, in order; after the last one all miss.
    pub probes: Vec<Probe>,
    /// What the operator answers, in order; after the last one 0. A stop whose message names a variable
    /// (`#100 DEPTH`) takes an answer too, into that variable, while there are any.
    pub answers: Vec<f64>,
    /// True where that holds for texts too that are only shown before a stop, as the control of the other side has messages.
    #[serde(skip)]
    pub sets_named: bool,
    /// Settings of the control that are another than its profile says, by name: lengths in the unit of the control.
    #[serde(skip)]
    pub settings: BTreeMap<String, f64>,
    /// What cycles are left to take from settings of their machines, on both sides: it counts alike there.
    #[serde(skip)]
    pub left: BTreeSet<CycleSetting>,
    /// The unit that a control is set to which takes a code for the other one for a fault, true for inches; none for that of its profile.
    #[serde(skip)]
    pub set_to_inch: Option<bool>,
    /// Seed of what programs that stand in the machine change; 0 if they change nothing.
    #[serde(skip)]
    pub outside: u64,
    /// True where they leave other modes too.
    #[serde(skip)]
    pub outside_modes: bool,
    /// State that the machine does not model, by name and subscripts: inputs, settings, parameters. Else 0.
    pub state: Vec<StateValue>,
    /// True where inputs change while the program waits for them: it reads one, and nothing else happens for long.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub inputs_change: bool,
    /// Before which look at its inputs they change, counted from 1: a look ends where something happens. None if before
    /// none.
    #[serde(skip)]
    pub inputs_change_at: Option<u32>,
    /// Date, as yyyymmdd.
    pub date: f64,
    /// Time of day, as hhmmss.
    pub time: f64,
    /// By how much a timer moves on each time it is read, milliseconds, over and above the
    /// time that dwells and feed moves take.
    pub tick_ms: f64,
    /// Block-skip switches that are on: bit n for `/n`, `/` alone is bit 1.
    pub block_skip: u32,
    /// True where an optional stop stops.
    pub optional_stop: bool,
    /// Distance from the last depth at which a peck begins, and by which a chip break goes back, millimetres.
    pub peck_clearance: f64,
    /// True where writes of variables that outlive the program stand in the trace.
    pub variable_events: bool,
    /// Significant decimal digits that arithmetic keeps in place of the control's own, to find
    /// programs that depend on the last digit.
    pub digits: Option<u32>,
    /// Where `digits` are fewer than a result needs, it is not rounded but off by one of the last of them, to a side
    /// that is drawn with this seed; seeds 2n and 2n+1 draw opposite sides.
    #[serde(skip)]
    pub last_digits: Option<u64>,
    /// True where `digits` are those of functions alone: sums, products and quotients come to what doubles make of them.
    #[serde(skip)]
    pub functions_only: bool,
    /// True where a control of which no source says whether it rounds computed words to the least increment is to
    /// do so; else it leaves them as they are.
    pub rounds_words: bool,
    /// True where the run is to tell how near its branches came to their other ways.
    #[serde(skip)]
    pub nearness: bool,
    /// Most blocks that are executed.
    pub steps: u64,
    /// Most events that are recorded.
    pub events: usize,
    /// Most time, milliseconds; none for no bound.
    pub milliseconds: Option<u64>,
}

/// A row of the tool table, millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tool {
    /// Length.
    pub length: f64,
    /// Wear of the length.
    pub length_wear: f64,
    /// Radius.
    pub radius: f64,
    /// Wear of the radius.
    pub radius_wear: f64,
}

/// What a probe move meets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Probe {
    /// Nothing: the move goes to its end.
    Miss,
    /// A surface at this part of the way, 0 to 1.
    Part(f64),
    /// A surface: the move ends at this machine position.
    At(Axes),
}

/// A value of machine state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateValue {
    /// Which quantity.
    pub state: Sys,
    /// Its subscripts.
    #[serde(default)]
    pub subscripts: Vec<u32>,
    /// Its value, in the units of the program where it is a length.
    pub value: f64,
}

/// The rows of a table that has one number for lengths and radii, and of one that holds them apart: the number of a row is the
/// length and the radius of that row.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedRows {
    /// By what the number is divided to be the radius: 1, or 2 where it is a diameter.
    pub per: f64,
    /// Which rows hold lengths and which radii, as far as the profile says it.
    pub rows: OneTable,
}

impl Scenario {
    /// The four reference positions, in order.
    pub fn reference_positions(&self) -> [Axes; 4] {
        let ([first, second], [third, fourth]) = (self.references, self.more_references);
        [first, second, third, fourth]
    }
}

impl Default for Scenario {
    fn default() -> Self {
        Self {
            variables: BTreeMap::new(),
            settings: BTreeMap::new(),
            left: BTreeSet::new(),
            set_to_inch: None,
            outside: 0,
            outside_modes: false,
            called: false,
            sets_named: false,
            inch: None,
            modes: Vec::new(),
            entry: Entry::default(),
            as_stated: Vec::new(),
            start: [0.0; AXES],
            work_offsets: Table::default(),
            external_shift: [0.0; AXES],
            tools: Table::default(),
            one_table: None,
            tool: 0,
            references: [[0.0; AXES]; 2],
            more_references: [[0.0; AXES]; 2],
            probes: Vec::new(),
            answers: Vec::new(),
            state: Vec::new(),
            inputs_change: false,
            inputs_change_at: None,
            date: 20_260_101.0,
            time: 120_000.0,
            tick_ms: 1.0,
            block_skip: 0,
            optional_stop: true,
            peck_clearance: 1.0,
            variable_events: false,
            digits: None,
            last_digits: None,
            functions_only: false,
            rounds_words: false,
            nearness: false,
            steps: 1_000_000,
            events: 1_000_000,
            milliseconds: Some(10_000),
        }
    }
}

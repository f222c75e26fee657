//! What programs take from outside: variables, state of the machine, answers and switches.

use crate::canon::Sys;
use crate::control::scenario::SharedRows;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What a program takes from outside.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    /// The variables that are read before the text writes them.
    pub variables: Vec<Input>,
    /// Variables that conditions hold against each other, by place in `variables`.
    pub pairs: Vec<(usize, usize)>,
    /// Numbers that the program's conditions name, and their neighbours.
    pub numbers: Vec<f64>,
    /// State of the machine that the program reads, and the numbers that it is compared with.
    pub cells: BTreeMap<(Sys, Vec<u32>), Vec<f64>>,
    /// The switches that skip blocks, `/` alone as 1.
    pub skips: BTreeSet<u8>,
    /// True where the operator is asked.
    pub asks: bool,
    /// True where a text that is shown before a stop is its message on the other control, and the operator sets what it names.
    pub sets_named: bool,
    /// True for each of A, B and C that a program of the library moves.
    pub rotary: [bool; 3],
    /// True where the sign of an absolute angle is the way of its axis: then the way hangs on where the axis stands, and
    /// conversions hold for one that stands at 0.
    pub turns_by_sign: bool,
    /// Where the target's profile says that the second reference position is, along X, Y and Z: millimetres, X of a lathe a diameter.
    pub second_home: [Option<f64>; 3],
    /// How far over the last depth a peck begins on the machine whose profile says it, millimetres: the other is taken to be set so.
    pub peck_clearance: Option<f64>,
    /// True where tools are not worn: a program may read the wear, or a round pocket takes a tool's radius off by itself, and the
    /// target keeps no wear apart, so that the shop's table there holds both in one number.
    pub unworn: bool,
    /// The same of their lengths.
    pub unworn_lengths: bool,
    /// How rows stand in both tables, where one machine has one number a row for lengths and radii.
    pub one_table: Option<Arc<SharedRows>>,
    /// True where Z of all work offsets is 0, as the source's profile says.
    pub zero_is_home: bool,
    /// True if the control has tool offsets past 99.
    pub many_tools: bool,
    /// The unit that the machine must be set to, where the program checks it: true for inch.
    pub inch: Option<bool>,
    /// The unit that the program selects first: true for inch.
    pub selected: Option<bool>,
}

/// A variable that a run is started with.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// True where it may be vacant.
    pub nullable: bool,
    /// The numbers that it is compared with, and their neighbours; those are the values worth trying.
    pub values: Vec<f64>,
    /// True for a register of the target that no variable of the source has: the name is the target's.
    pub theirs: bool,
}

/// Numbers that are tried in each variable besides its own, at the most.
const MORE: usize = 24;

impl Inputs {
    /// Has these numbers tried too: any variable may be what they are computed from.
    pub fn try_also(&mut self, numbers: &[f64]) {
        for input in &mut self.variables {
            let new: Vec<f64> = numbers.iter().copied().filter(|n| !input.values.contains(n)).collect();
            input.values.extend(new.into_iter().take(MORE));
        }
        self.numbers.extend(numbers);
    }
}

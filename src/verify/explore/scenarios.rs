//! The circumstances that a program is tried in.

use super::inputs::{Input, Inputs};
use super::random::Random;
use crate::canon::Sys;
use crate::control::Scenario;
use crate::control::scenario::{Axes, Probe, StateValue, Tool};
use crate::verify::sides::Effort;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Proposes scenarios, the telling ones first.
pub struct Proposals {
    inputs: Inputs,
    random: Random,
    effort: Effort,
    count: usize,
    /// Single values that are still to be tried, by variable, and the ground state of the others.
    singles: Vec<(usize, Option<f64>, usize)>,
    /// The same on the other ground states, for ways that were not gone until then.
    again: Vec<(usize, Option<f64>, usize)>,
    /// Pairs of variables that are compared with each other, and by how much the second is to be more.
    pairs: Vec<(usize, usize, f64)>,
    /// Answers of the operator that are still to be tried.
    answers: Vec<f64>,
    /// What is in registers that the target alone has, in the last scenario.
    theirs: BTreeMap<String, f64>,
    /// Block-skip switches, one setting after the other.
    skips: Vec<u32>,
}

/// The value of a variable that another one is held against.
const PAIRED: f64 = 5.0;

/// Answers that the operator has ready.
const ANSWERS: u32 = 48;

/// The ground states that come before anything is drawn, at the least: each setting of the skip switches comes in them.
const GROUNDS: usize = 8;

/// The ground states that a single value is tried on if ways are left: all others 0, vacant, and negative.
const OTHER_GROUNDS: [usize; 3] = [4, 0, 5];

/// The first answers to questions that are one and the same, where an answer is tried; a loop until a sensible one ends.
const SAME_ANSWERS: u32 = 4;

/// Every switch that skips blocks.
const ALL_SKIPS: u32 = 0x3fe;

impl Proposals {
    /// Proposals for a program.
    pub fn new(inputs: &Inputs, effort: Effort) -> Self {
        // Each variable's first value, then each one's second: what there is no time for tells least.
        let mut ranked = Vec::new();
        for (at, input) in inputs.variables.iter().enumerate() {
            let vacant = input.nullable.then_some(None);
            let values = vacant.into_iter().chain(input.values.iter().copied().map(Some));
            ranked.extend(values.enumerate().map(|(rank, value)| (rank, at, value)));
        }
        ranked.sort_by_key(|(rank, at, _)| (*rank, *at));
        let others =
            ranked.iter().flat_map(|(_, at, value)| OTHER_GROUNDS.map(|ground| (*at, *value, ground)));
        let again = others.rev().collect();
        let ground = |rank: usize| if rank % 2 == 1 { 7 } else { 1 };
        let singles = ranked.iter().rev().map(|(rank, at, value)| (*at, *value, ground(*rank))).collect();
        let apart = |(a, b): &(usize, usize)| [0.0, 1.0, -1.0].map(|more| (*a, *b, more));
        let pairs = inputs.pairs.iter().flat_map(apart).collect();
        let answers = if inputs.asks { inputs.numbers.iter().rev().copied().collect() } else { Vec::new() };
        let (random, theirs, skips) = (Random::new(effort.seed), BTreeMap::new(), skips(inputs));
        let inputs = inputs.clone();
        Self { inputs, random, effort, count: 0, singles, pairs, answers, theirs, skips, again }
    }

    /// What is in registers that the target alone has, in the last scenario.
    pub fn theirs(&self) -> &BTreeMap<String, f64> {
        &self.theirs
    }

    /// The settings of the switches that skip blocks.
    pub fn skips(&self) -> &[u32] {
        &self.skips
    }

    fn grounds(&self) -> usize {
        GROUNDS.max(self.skips.len())
    }

    /// True while those come that every program is compared in, whether they reach anything new or not.
    pub fn are_telling(&self) -> bool {
        let tried = self.singles.is_empty() && self.pairs.is_empty() && self.answers.is_empty();
        self.count <= self.grounds() || !tried
    }

    /// The next scenario, for the source.
    pub fn next(&mut self) -> Option<Scenario> {
        if self.count >= self.effort.tries {
            return None;
        }
        let count = self.count;
        self.count += 1;
        let (mut variables, mut theirs) = (BTreeMap::new(), BTreeMap::new());
        let is_ground = count < self.grounds();
        let drawn = !is_ground && (count % 4 == 1 || (self.singles.is_empty() && count % 2 == 1));
        let pair = if is_ground || drawn { None } else { self.pairs.pop() };
        let single = if is_ground || drawn || pair.is_some() {
            None
        } else {
            self.singles.pop().or_else(|| self.again.pop())
        };
        let answer = if is_ground || single.is_some() { None } else { self.answers.pop() };
        for (at, input) in self.inputs.variables.iter().enumerate() {
            let ordinal = at as f64 + 1.0;
            let ground = single.map_or(count, |(_, _, ground)| ground);
            let value = match (single, ground) {
                // Nothing but the two, so that what other variables decide is out of the way.
                _ if pair.is_some() => pair.and_then(|(a, b, more)| match at {
                    at if at == a => Some(PAIRED),
                    at if at == b => Some(PAIRED + more),
                    _ => None,
                }),
                (Some((which, value, _)), _) if which == at => value,
                (_, 0) => None,
                (_, 1) => Some(ordinal),
                // Small counts, which loops end at.
                (_, 2) => Some((at % 3) as f64 + 2.0),
                (_, 3) => Some((self.inputs.variables.len() - at) as f64),
                (_, 4) => Some(0.0),
                (_, 5) => Some(-ordinal * 2.0 - 0.25),
                (_, 6) => Some(101.0 + ordinal * 7.3),
                (_, 7) => Some(ordinal * 1.375 + 0.123),
                _ => draw(&mut self.random, &self.inputs.numbers, input),
            };
            // A variable that is never vacant holds something: what a program finds at first is 0.
            if let Some(value) = value.or((!input.nullable).then_some(0.0)) {
                let side = if input.theirs { &mut theirs } else { &mut variables };
                side.insert(input.name.clone(), value);
            }
        }
        self.theirs = theirs;
        let mut scenario = self.around(variables, count);
        if let Some(answer) = answer {
            scenario.answers.iter_mut().take(SAME_ANSWERS as usize).for_each(|first| *first = answer);
        }
        Some(scenario)
    }

    /// A machine around start values.
    fn around(&mut self, variables: BTreeMap<String, f64>, count: usize) -> Scenario {
        let mut scenario = machine(&mut self.random);
        // Macros ask whether a cutter fits, and stop with an alarm of their own if it is too big.
        if count % SMALL_CUTTERS == SMALL_CUTTERS - 1 {
            scenario
                .tools
                .values_mut()
                .for_each(|tool| tool.radius = (tool.radius / SMALLER * 1000.0).round() / 1000.0);
        }
        if self.inputs.unworn {
            scenario.tools.values_mut().for_each(|tool| tool.radius_wear = 0.0);
        }
        if self.inputs.unworn_lengths {
            scenario.tools.values_mut().for_each(|tool| tool.length_wear = 0.0);
        }
        if self.inputs.zero_is_home {
            scenario.work_offsets.values_mut().for_each(|axes| axes[2] = 0.0);
        }
        scenario.sets_named = self.inputs.sets_named;
        // What stands for the second reference position of the source is that position.
        for (axis, place) in self.inputs.second_home.into_iter().enumerate() {
            scenario.references[1][axis] = place.unwrap_or(scenario.references[1][axis]);
        }
        scenario.peck_clearance = self.inputs.peck_clearance.unwrap_or(scenario.peck_clearance);
        self.tables(&mut scenario, count);
        scenario.one_table.clone_from(&self.inputs.one_table);
        // The number of a row is now as large as a length, now as a radius.
        if let Some(shared) = scenario.one_table.as_ref().filter(|_| count % 2 == 1) {
            scenario.tools.values_mut().for_each(|tool| tool.length = tool.radius * shared.per);
        }
        // The machine has those rotary axes that its programs name.
        for axis in (3..6).filter(|axis| self.inputs.turns_by_sign || !self.inputs.rotary[axis - 3]) {
            scenario.start[axis] = 0.0;
        }
        if self.inputs.turns_by_sign && self.inputs.rotary.contains(&true) {
            scenario.work_offsets.values_mut().for_each(|offset| offset[3..6].fill(0.0));
        }
        scenario.variables = variables;
        scenario.block_skip = self.skips.get(count % self.skips.len().max(1)).copied().unwrap_or(0);
        let near =
            if self.inputs.numbers.is_empty() { vec![0.0, 1.0, 2.5] } else { self.inputs.numbers.clone() };
        scenario.answers = (0..ANSWERS)
            .map(|at| match count {
                // An empty answer, then ones that a loop until a sensible answer takes.
                0 => f64::from(at % 4),
                1 => f64::from(at) + 1.0,
                _ if self.random.one_in(2) => self.random.between(-20, 20),
                _ => self.random.pick(&near).copied().unwrap_or(1.0),
            })
            .collect();
        scenario.probes =
            match count % 3 {
                0 => Vec::new(),
                1 => (0..32).map(|at| Probe::Part(0.25 + 0.5 * f64::from(at % 7) / 7.0)).collect(),
                _ => (0..32)
                    .map(|_| {
                        if self.random.one_in(3) {
                            Probe::Miss
                        } else {
                            Probe::Part(self.random.between(0, 1))
                        }
                    })
                    .collect(),
            };
        if count > 0 {
            scenario.state = self.cells(count);
        }
        // Programs that stand in the machine leave all as it was, or what they find anywhere.
        scenario.outside = if count % 2 == 1 { count as u64 } else { 0 };
        scenario.optional_stop = count.is_multiple_of(2);
        scenario.steps = self.effort.steps;
        scenario.events = usize::try_from(self.effort.steps).unwrap_or(usize::MAX);
        scenario
    }

    /// Now and then a tool of more than two digits, if the control has such, small tools and near offsets: conditions name sizes and places too.
    fn tables(&mut self, scenario: &mut Scenario, count: usize) {
        if count % 4 == 2 && self.inputs.many_tools {
            let row = scenario.tools.get(&scenario.tool).copied().unwrap_or_default();
            scenario.tool *= 101;
            scenario.tools.insert(scenario.tool, row);
        }
        if count % 3 == 2 {
            self.places(scenario, count / 3);
        }
        if count % 5 == 3 {
            let near = self.random.pick(&self.inputs.numbers).copied().unwrap_or(0.0).abs();
            for (number, tool) in scenario.tools.iter_mut() {
                // Smaller than the number that a condition names, or larger, in millimetres or inches.
                let share = if count % 10 == 8 { 25.4 / 4.0 } else { 1.0 / 50.0 };
                let size = near * f64::from(*number) * share;
                let length = if size > 10.0 * STEP { steps(size / STEP) } else { size };
                *tool = Tool { length, radius: size / 2.0, ..Tool::default() };
            }
        }
    }

    /// Offsets that conditions name: near the numbers that they are held against, in millimetres or inches.
    fn places(&self, scenario: &mut Scenario, count: usize) {
        for ((state, subscripts), values) in &self.inputs.cells {
            let Some(value) = values.get(count / 2 % values.len().max(1)) else { continue };
            let plain = *value;
            let value = value * if count.is_multiple_of(2) { 1.0 } else { 25.4 };
            match (state, subscripts.as_slice()) {
                // The tool in the spindle, or the last one called, which a condition asks for.
                (Sys::ActiveTool, []) | (Sys::Address, [ADDRESS_T]) => {
                    let is_one = plain.fract() == 0.0 && (1.0..=99.0).contains(&plain);
                    scenario.tool = if is_one { plain as u32 } else { scenario.tool };
                }
                (Sys::WorkOffset, [number, axis]) => {
                    let axes = scenario.work_offsets.entry(*number).or_default();
                    if let Some(own) = axes.get_mut((*axis as usize).wrapping_sub(1)) {
                        *own = value;
                    }
                }
                (Sys::LengthGeometry | Sys::ToolOffset, [number]) => {
                    scenario.tools.entry(*number).or_default().length = value;
                }
                (Sys::LengthWear, [number]) => {
                    scenario.tools.entry(*number).or_default().length_wear = value;
                }
                _ => {}
            }
        }
    }

    /// Inputs, counters and the like, one way or the other.
    fn cells(&mut self, count: usize) -> Vec<StateValue> {
        let mut out = Vec::new();
        for (at, ((state, subscripts), values)) in self.inputs.cells.iter().enumerate() {
            let value = match state {
                Sys::Input | Sys::InputInverted | Sys::Output if count < GROUNDS => ((at + count) % 2) as f64,
                Sys::Input | Sys::InputInverted | Sys::Output => f64::from(u8::from(self.random.one_in(2))),
                Sys::TimerMs
                | Sys::TimerHours
                | Sys::CycleSeconds
                | Sys::Date
                | Sys::ShortDate
                | Sys::Time => continue,
                _ => {
                    let near = if values.is_empty() { &self.inputs.numbers } else { values };
                    self.random.pick(near).copied().unwrap_or(1.0).round().abs()
                }
            };
            out.push(StateValue { state: *state, subscripts: subscripts.clone(), value });
        }
        out
    }
}

/// A value of a variable, where any will do.
fn draw(random: &mut Random, numbers: &[f64], input: &Input) -> Option<f64> {
    let value = match random.below(8) {
        0 if input.nullable => return None,
        0 | 1 => random.between(-50, 50),
        2 => random.below(10) as f64,
        3 => random.pick(numbers).copied().unwrap_or(0.0),
        4 => random.between(0, 10),
        _ => {
            let near = random.pick(&input.values).copied();
            near.unwrap_or_else(|| random.below(6) as f64)
        }
    };
    Some(value)
}

/// The settings of the switches that skip blocks: none, all, and where there are several each by itself.
fn skips(inputs: &Inputs) -> Vec<u32> {
    let each = inputs.skips.iter().map(|switch| 1_u32.checked_shl(u32::from(*switch)).unwrap_or(0));
    match inputs.skips.len() {
        0 => vec![0],
        1 => vec![0, ALL_SKIPS, 0],
        _ => [0, ALL_SKIPS].into_iter().chain(each).collect(),
    }
}

/// One in so many machines has small cutters, and how many times smaller they are: half a millimetre across and less.
const SMALL_CUTTERS: usize = 3;
const SMALLER: f64 = 40.0;

/// Millimetres that are a whole number of least increments in inches too: 0.005 inch.
const STEP: f64 = 0.127;

/// The number of the letter T among the letters of words.
const ADDRESS_T: u32 = 20;

/// So many of them, the nearest whole number.
fn steps(count: f64) -> f64 {
    count.round() * 127.0 / 1000.0
}

/// A machine whose every number is its own, so that no two offsets can be mistaken for each other. Where it stands and by
/// how much offsets shift it are words in either unit, so that a place which is read back can be said.
fn machine(random: &mut Random) -> Scenario {
    let mut scenario = MACHINE.clone();
    scenario.start = far(-79.0 - 8.0 * random.between(0, 5), -26.0);
    scenario.tool = 1 + random.below(9) as u32;
    scenario
}

/// What is the same in each of them: runs share its tables.
static MACHINE: LazyLock<Scenario> = LazyLock::new(|| {
    // A program that returns is one that others call, and a main one that returns would never end.
    let mut scenario = Scenario { called: true, ..Scenario::default() };
    // Work offsets far below the reference position, as on real machines.
    for number in (1..=6).chain(101..=148) {
        let n = f64::from(number);
        scenario.work_offsets.insert(number, far(-2400.0 - 29.0 * n, -137.0 - n));
    }
    for number in 1..=99 {
        let n = f64::from(number);
        let tool = Tool {
            length: steps(600.0 + 13.0 * n),
            length_wear: steps(n),
            radius: 2.0 + 0.257 * n,
            radius_wear: 0.003 * n,
        };
        scenario.tools.insert(number, tool);
    }
    scenario.references[1] = far(-394.0, -91.0);
    scenario.more_references = [far(-447.0, -83.0), far(-521.0, -67.0)];
    scenario
});

/// A place whose every coordinate is another.
fn far(base: f64, step: f64) -> Axes {
    std::array::from_fn(|axis| if axis < 6 { steps(base + step * (axis as f64 + 1.0)) } else { 0.0 })
}

//! The circumstances that a program is tried in.

use super::inputs::{Input, Inputs};
use super::names::class_of;
use super::random::Random;
use super::{Effort, Names, Side};
use crate::canon::Sys;
use crate::control::scenario::{AXES, Axes, Probe, StateValue, Tool};
use crate::control::trace::Happening;
use crate::control::{Run, Scenario};
use crate::dialect::{Control, Units};
use std::collections::BTreeMap;

/// Proposes scenarios, the telling ones first.
pub struct Proposals<'i> {
    inputs: &'i Inputs,
    random: Random,
    effort: Effort,
    count: usize,
    /// Single values that are still to be tried, by variable and by which of the two ground states.
    singles: Vec<(usize, Option<f64>, bool)>,
    /// Pairs of variables that are compared with each other, and by how much the second is to be more.
    pairs: Vec<(usize, usize, f64)>,
}

/// The value of a variable that another one is held against.
const PAIRED: f64 = 5.0;

/// Answers that the operator has ready.
const ANSWERS: u32 = 48;

/// The ground states that come before anything is drawn.
const GROUNDS: usize = 8;

impl<'i> Proposals<'i> {
    /// Proposals for a program.
    pub fn new(inputs: &'i Inputs, effort: Effort) -> Self {
        // Each variable's first value, then each one's second: what there is no time for tells least.
        let mut ranked = Vec::new();
        for (at, input) in inputs.variables.iter().enumerate() {
            let vacant = input.nullable.then_some(None);
            let values = vacant.into_iter().chain(input.values.iter().copied().map(Some));
            ranked.extend(values.enumerate().map(|(rank, value)| (rank, at, value)));
        }
        ranked.sort_by_key(|(rank, at, _)| (*rank, *at));
        let singles = ranked.into_iter().map(|(rank, at, value)| (at, value, rank % 2 == 1)).rev().collect();
        let apart = |(a, b): &(usize, usize)| [0.0, 1.0, -1.0].map(|more| (*a, *b, more));
        let pairs = inputs.pairs.iter().flat_map(apart).collect();
        Self { inputs, random: Random::new(effort.seed), effort, count: 0, singles, pairs }
    }

    /// True while those come that every program is compared in, whether they reach anything new or not.
    pub fn are_telling(&self) -> bool {
        self.count <= GROUNDS || !self.singles.is_empty() || !self.pairs.is_empty()
    }

    /// The next scenario, for the source.
    pub fn next(&mut self) -> Option<Scenario> {
        if self.count >= self.effort.tries {
            return None;
        }
        let count = self.count;
        self.count += 1;
        let mut variables = BTreeMap::new();
        let drawn = count >= GROUNDS && (count % 4 == 1 || self.singles.is_empty());
        let pair = if count < GROUNDS || drawn { None } else { self.pairs.pop() };
        let single = if count < GROUNDS || drawn || pair.is_some() { None } else { self.singles.pop() };
        for (at, input) in self.inputs.variables.iter().enumerate() {
            let ordinal = at as f64 + 1.0;
            let ground = match single {
                Some((_, _, true)) => 7,
                Some((_, _, false)) => 1,
                None => count,
            };
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
                _ => self.draw(input),
            };
            // A variable that is never vacant holds something: what a program finds at first is 0.
            if let Some(value) = value.or((!input.nullable).then_some(0.0)) {
                variables.insert(input.name.clone(), value);
            }
        }
        Some(self.around(variables, count))
    }

    fn draw(&mut self, input: &Input) -> Option<f64> {
        let value = match self.random.below(8) {
            0 if input.nullable => return None,
            0 | 1 => self.random.between(-50, 50),
            2 => self.random.below(10) as f64,
            3 => self.random.pick(&self.inputs.numbers).copied().unwrap_or(0.0),
            4 => self.random.between(0, 10),
            _ => {
                let near = self.random.pick(&input.values).copied();
                near.unwrap_or_else(|| self.random.below(6) as f64)
            }
        };
        Some(value)
    }

    /// A machine around start values.
    fn around(&mut self, variables: BTreeMap<String, f64>, count: usize) -> Scenario {
        let mut scenario = machine(&mut self.random);
        self.tables(&mut scenario, count);
        // The machine has those rotary axes that its programs name.
        for axis in (3..6).filter(|axis| !self.inputs.rotary[axis - 3]) {
            scenario.start[axis] = 0.0;
        }
        scenario.variables = variables;
        if self.inputs.skips && count % 3 == 1 {
            scenario.block_skip = 0x3fe;
        }
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
            scenario.state = self.cells();
        }
        scenario.optional_stop = count.is_multiple_of(2);
        scenario.steps = self.effort.steps;
        scenario.events = usize::try_from(self.effort.steps).unwrap_or(usize::MAX);
        scenario
    }

    /// Now and then a tool of more than two digits, and small tools: conditions name sizes of tools too.
    fn tables(&mut self, scenario: &mut Scenario, count: usize) {
        if count % 4 == 2 {
            scenario.tool *= 101;
        }
        if count % 5 == 3 {
            let near = self.random.pick(&self.inputs.numbers).copied().unwrap_or(0.0).abs();
            for (number, tool) in &mut scenario.tools {
                // Smaller than the number that a condition names, or larger, in millimetres or inches.
                let share = if count % 10 == 8 { 25.4 / 4.0 } else { 1.0 / 50.0 };
                let size = near * f64::from(*number) * share;
                let length = if size > 10.0 * STEP { steps(size / STEP) } else { size };
                *tool = Tool { length, radius: size / 2.0, ..Tool::default() };
            }
        }
    }

    /// Inputs, counters and the like, one way or the other.
    fn cells(&mut self) -> Vec<StateValue> {
        let mut out = Vec::new();
        for (state, subscripts) in &self.inputs.cells {
            let value = match state {
                Sys::Input | Sys::InputInverted | Sys::Output => f64::from(u8::from(self.random.one_in(2))),
                Sys::TimerMs | Sys::TimerHours | Sys::CycleSeconds | Sys::Date | Sys::Time => continue,
                _ => self.random.pick(&self.inputs.numbers).copied().unwrap_or(1.0).round().abs(),
            };
            out.push(StateValue { state: *state, subscripts: subscripts.clone(), value });
        }
        out
    }
}

/// Millimetres that are a whole number of least increments in inches too: 0.005 inch.
const STEP: f64 = 0.127;

/// So many of them, the nearest whole number.
fn steps(count: f64) -> f64 {
    count.round() * 127.0 / 1000.0
}

/// A machine whose every number is its own, so that no two offsets can be mistaken for each other. Where it stands and by
/// how much offsets shift it are words in either unit, so that a place which is read back can be said.
fn machine(random: &mut Random) -> Scenario {
    // A program that returns is one that others call, and a main one that returns would never end.
    let mut scenario = Scenario { called: true, ..Scenario::default() };
    let axes = |base: f64, step: f64| -> Axes {
        let mut out = [0.0; AXES];
        for (axis, value) in out.iter_mut().take(6).enumerate() {
            *value = steps(base + step * (axis as f64 + 1.0));
        }
        out
    };
    // Work offsets far below the reference position, as on real machines.
    for number in (1..=6).chain(101..=148) {
        let n = f64::from(number);
        scenario.work_offsets.insert(number, axes(-2400.0 - 29.0 * n, -137.0 - n));
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
    scenario.references[1] = axes(-394.0, -91.0);
    scenario.start = axes(-79.0 - 8.0 * random.between(0, 5), -26.0);
    scenario.tool = 1 + random.below(9) as u32;
    scenario
}

/// Both machines are set to the unit of the one that states any: what a program does not say itself is for
/// the shop to see to, or what it checks ([`super::inputs::Inputs::inch`]).
pub fn unit(side: &Side<'_>, other: &Side<'_>) -> Option<bool> {
    side.control.units().or(other.control.units()).map(|units| units == Units::Inch)
}

/// The same circumstances on the target: variables by their names there. One that has none is left out.
///
/// A register that nothing has set yet may be vacant there: a conversion that is run first has to see to it, one that
/// is `called` finds what its callers left.
pub fn on_target(
    scenario: &Scenario,
    names: &Names,
    (source, target): (&Side<'_>, &Side<'_>),
    called: bool,
) -> Scenario {
    let mut out = scenario.clone();
    out.inch = unit(target, source).or(scenario.inch);
    out.variables.clear();
    for (name, value) in &scenario.variables {
        let nullable = class_of(source.control, name).is_some_and(|class| class.nullable);
        if *value == 0.0 && !nullable && !called {
            continue;
        }
        if let Some(name) = names.variable(name, source.control, target.control) {
            out.variables.insert(name, *value);
        }
    }
    // What a program that is called finds its callers have seen to, whether it is known to read it or not.
    if called {
        let never_vacant =
            |name: &String| class_of(source.control, name).is_some_and(|class| !class.nullable);
        let all = names.variables.keys().cloned().chain(banked(names, source.control));
        for name in all.filter(|name| never_vacant(name)) {
            if let Some(there) = names.variable(&name, source.control, target.control) {
                out.variables.entry(there).or_insert(0.0);
            }
        }
    }
    // Emulations take more blocks than what they stand for.
    out.steps = scenario.steps.saturating_mul(20);
    out
}

/// The variables that computed numbers may reach, which are named all at once.
fn banked<'n>(names: &'n Names, control: &'n Control) -> impl Iterator<Item = String> + 'n {
    let letters = names.variables.keys().filter_map(|name| name.strip_suffix("(..)"));
    letters.flat_map(|letter| {
        let rows = control.classes().iter().filter(move |row| row.name == letter);
        rows.flat_map(|row| row.first..=row.last).map(move |number| format!("{letter}{number}"))
    })
}

/// How many answers a run took: behind the last one of the scenario they were 0.
pub fn asked(run: &Run) -> usize {
    run.events.iter().filter(|event| matches!(event.what, Happening::Asked { .. })).count()
}

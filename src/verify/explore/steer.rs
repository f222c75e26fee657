//! A search for circumstances in which a branch goes the way that it never went.
//!
//! One input after the other is changed a little. Where that brings the numbers of the condition nearer to each other, the
//! search goes on in that direction: to where they would meet if the distance were linear, and in strides that double. What
//! it finds is tried like any scenario, so a wrong turn costs a run and nothing else.

use super::inputs::Inputs;
use crate::canon::Sys;
use crate::control::Scenario;
use crate::control::scenario::Probe;
use std::collections::BTreeMap;

/// The circumstances of a run: a scenario, and what is in registers that the target alone has.
#[derive(Clone, Debug)]
pub struct Circumstances {
    /// What both sides meet.
    pub scenario: Scenario,
    /// What is in registers of the target alone.
    pub theirs: BTreeMap<String, f64>,
}

/// One number that a program takes from outside.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A variable, and whether it is one that the target alone has.
    Variable(String, bool),
    /// A value of machine state, by place.
    State(usize),
    /// An answer of the operator, by place.
    Answer(usize),
    /// A work offset: its number, and the axis from 0.
    Work(u32, usize),
    /// The length of a tool.
    Length(u32),
    /// The radius of a tool.
    Radius(u32),
    /// How far a probe move gets, by place.
    Probe(usize),
    /// Where the machine stands at the start: the axis from 0.
    Start(usize),
}

/// Answers and probe moves that are steered.
const FIRST: usize = 4;
/// Inputs that are steered, at the most.
const MOST_INPUTS: usize = 40;

/// The inputs of a program, those first that conditions ask most.
pub fn inputs_of(inputs: &Inputs, scenario: &Scenario) -> Vec<Input> {
    let variables = inputs.variables.iter().map(|input| Input::Variable(input.name.clone(), input.theirs));
    let cells = inputs.cells.keys().filter_map(|(state, subscripts)| match (state, subscripts.as_slice()) {
        (Sys::WorkOffset, [number, axis]) => Some(Input::Work(*number, (*axis as usize).checked_sub(1)?)),
        (Sys::LengthGeometry | Sys::ToolOffset | Sys::LengthWear, [number]) => Some(Input::Length(*number)),
        (Sys::RadiusGeometry | Sys::RadiusWear, [number]) => Some(Input::Radius(*number)),
        _ => None,
    });
    let state = (0..scenario.state.len()).map(Input::State);
    let answers = (0..if inputs.asks { FIRST.min(scenario.answers.len()) } else { 0 }).map(Input::Answer);
    let probes = (0..FIRST.min(scenario.probes.len())).map(Input::Probe);
    let start = (0..3).map(Input::Start);
    variables.chain(answers).chain(cells).chain(state).chain(probes).chain(start).take(MOST_INPUTS).collect()
}

impl Input {
    fn get(&self, from: &Circumstances) -> f64 {
        let Circumstances { scenario, theirs } = from;
        let found = match self {
            Input::Variable(name, false) => scenario.variables.get(name).copied(),
            Input::Variable(name, true) => theirs.get(name).copied(),
            Input::State(at) => scenario.state.get(*at).map(|state| state.value),
            Input::Answer(at) => scenario.answers.get(*at).copied(),
            Input::Work(number, axis) => {
                scenario.work_offsets.get(number).and_then(|axes| axes.get(*axis)).copied()
            }
            Input::Length(number) => scenario.tools.get(number).map(|tool| tool.length),
            Input::Radius(number) => scenario.tools.get(number).map(|tool| tool.radius),
            Input::Probe(at) => match scenario.probes.get(*at) {
                Some(Probe::Part(part)) => Some(*part),
                _ => Some(1.0),
            },
            Input::Start(axis) => scenario.start.get(*axis).copied(),
        };
        found.unwrap_or(0.0)
    }

    /// The same circumstances with another value here; none where it cannot be.
    fn set(&self, from: &Circumstances, value: f64) -> Option<Circumstances> {
        // What nobody would enter proves nothing.
        if !value.is_finite() || value.abs() > 1e6 {
            return None;
        }
        let mut out = from.clone();
        let scenario = &mut out.scenario;
        match self {
            Input::Variable(name, theirs) => {
                let all = if *theirs { &mut out.theirs } else { &mut scenario.variables };
                all.insert(name.clone(), value);
            }
            Input::State(at) => scenario.state.get_mut(*at)?.value = value.round().abs(),
            Input::Answer(at) => *scenario.answers.get_mut(*at)? = value,
            Input::Work(number, axis) => {
                *scenario.work_offsets.entry(*number).or_default().get_mut(*axis)? = value
            }
            Input::Length(number) => scenario.tools.entry(*number).or_default().length = value,
            Input::Radius(number) => scenario.tools.entry(*number).or_default().radius = value.abs(),
            Input::Probe(at) => {
                *scenario.probes.get_mut(*at)? =
                    if (0.0..=1.0).contains(&value) { Probe::Part(value) } else { Probe::Miss };
            }
            Input::Start(axis) => *scenario.start.get_mut(*axis)? = value,
        }
        Some(out)
    }

    /// The first step away from where it is.
    fn step(&self) -> f64 {
        if matches!(self, Input::Probe(_)) { 0.25 } else { 1.0 }
    }
}

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attempt {
    /// The branch went the way.
    Reached,
    /// It came so near; none where it did not come to the branch.
    Near(Option<f64>),
    /// No more runs.
    Stop,
}

/// A search from one start.
pub struct Steer<'s> {
    best: Circumstances,
    /// How near it came to the way.
    distance: f64,
    runs: usize,
    attempt: &'s mut dyn FnMut(&Circumstances) -> Attempt,
}

/// The search ended: at the way or not.
struct Ended;

impl<'s> Steer<'s> {
    /// A search that begins where a run came so near, and makes so many runs at the most.
    pub fn new(
        best: Circumstances,
        distance: f64,
        runs: usize,
        attempt: &'s mut dyn FnMut(&Circumstances) -> Attempt,
    ) -> Self {
        Self { best, distance, runs, attempt }
    }

    /// Searches; whoever makes the attempts knows whether it came there.
    pub fn run(mut self, inputs: &[Input]) {
        let mut live: Vec<&Input> = inputs.iter().collect();
        loop {
            let before = self.distance;
            let mut matter = Vec::new();
            for input in live {
                match self.along(input) {
                    Ok(true) => matter.push(input),
                    Ok(false) => {}
                    Err(Ended) => return,
                }
            }
            if self.distance >= before || matter.is_empty() {
                return;
            }
            live = matter;
        }
    }

    /// Changes one input as long as that helps. False where it changes nothing.
    fn along(&mut self, input: &Input) -> Result<bool, Ended> {
        let mut matters = false;
        for step in [1.0, -1.0, 0.125, -0.125, 0.004, -0.004].map(|part| part * input.step()) {
            let (from, far) = (input.get(&self.best), self.distance);
            let Some(near) = self.at(input, from + step)? else { continue };
            matters |= near != far;
            if near < far {
                self.meet(input, from, step, far, near)?;
                self.stride(input, step)?;
                return Ok(true);
            }
            if !matters && step < 0.0 {
                return Ok(false);
            }
        }
        Ok(matters)
    }

    /// Tries where the numbers would meet if the distance were linear, and to either side of it.
    fn meet(&mut self, input: &Input, from: f64, step: f64, far: f64, near: f64) -> Result<(), Ended> {
        let root = from + step * far / (far - near);
        let root = (root * 1e6).round() / 1e6;
        for beside in [0.0, step, -step, step * 0.001, -step * 0.001] {
            self.at(input, root + beside)?;
        }
        if root.fract() != 0.0 {
            self.at(input, root.floor())?;
            self.at(input, root.ceil())?;
        }
        Ok(())
    }

    /// Goes on in the same direction, in strides that double.
    fn stride(&mut self, input: &Input, step: f64) -> Result<(), Ended> {
        let mut stride = 2.0 * step;
        loop {
            let before = self.distance;
            self.at(input, input.get(&self.best) + stride)?;
            if self.distance >= before {
                return Ok(());
            }
            stride *= 2.0;
        }
    }

    /// Runs with another value of an input, and keeps it if that comes nearer. How near; none if not to the branch.
    fn at(&mut self, input: &Input, value: f64) -> Result<Option<f64>, Ended> {
        let Some(circumstances) = input.set(&self.best, value) else { return Ok(None) };
        self.runs = self.runs.checked_sub(1).ok_or(Ended)?;
        match (self.attempt)(&circumstances) {
            Attempt::Reached | Attempt::Stop => Err(Ended),
            Attempt::Near(near) => {
                if let Some(near) = near.filter(|near| *near < self.distance) {
                    (self.best, self.distance) = (circumstances, near);
                }
                Ok(near)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(values: &[(&str, f64)]) -> Circumstances {
        let variables = values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        Circumstances { scenario: Scenario { variables, ..Scenario::default() }, theirs: BTreeMap::new() }
    }

    fn variables(names: &[&str]) -> Vec<Input> {
        names.iter().map(|name| Input::Variable((*name).to_owned(), false)).collect()
    }

    /// Runs needed until `distance` is 0 or less; none if it never is.
    fn runs(values: &[(&str, f64)], distance: impl Fn(&dyn Fn(&str) -> f64) -> f64) -> Option<usize> {
        let names: Vec<&str> = values.iter().map(|(name, _)| *name).collect();
        let of = |from: &Circumstances| distance(&|name: &str| from.scenario.variables[name]);
        let (mut count, mut found) = (0, None);
        let first = start(values);
        let far = of(&first);
        let mut attempt = |at: &Circumstances| {
            count += 1;
            let near = of(at);
            if near <= 0.0 {
                found = Some(count);
                return Attempt::Reached;
            }
            Attempt::Near(Some(near))
        };
        Steer::new(first, far, 200, &mut attempt).run(&variables(&names));
        found
    }

    #[test]
    fn a_linear_condition_is_met_at_once() {
        // 3 x = 1234.5, with a variable beside it that does not matter.
        assert!(runs(&[("a", 7.0), ("x", 1.0)], |v| (3.0 * v("x") - 1234.5).abs()).is_some_and(|n| n < 12));
    }

    #[test]
    fn a_curve_is_come_to_in_steps() {
        assert!(runs(&[("x", 1.0)], |v| 50_000.0 - v("x") * v("x")).is_some_and(|n| n < 60));
    }

    #[test]
    fn two_variables_are_met_one_after_the_other() {
        let distance = |v: &dyn Fn(&str) -> f64| (v("x") - 40.0).abs() + (v("y") * 2.0 + 10.5).abs();
        assert!(runs(&[("x", 0.0), ("y", 0.0)], distance).is_some_and(|n| n < 120));
    }

    #[test]
    fn what_cannot_be_ends() {
        assert_eq!(runs(&[("x", 0.0)], |_| 1.0), None);
        assert_eq!(runs(&[("x", 0.0)], |v| v("x").abs() + 1.0), None);
        assert_eq!(runs(&[("x", 0.0)], |_| f64::MAX), None);
    }
}

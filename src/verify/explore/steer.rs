//! A search for circumstances in which a branch goes the way that it never went.
//!
//! One input after the other is changed a little. Where that brings the numbers of the condition nearer to each other, the
//! search goes on in that direction: to where they would meet if the distance were linear, and in strides that double. If
//! little changes tell nothing, as under FIX or in a count of digits, it tries large ones, what nothing ever set, and what
//! the program compares an input with. What it finds is tried like any scenario, so a wrong turn costs a run and nothing else.

mod outside;

pub use outside::{Circumstances, Input, inputs_of};

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

/// A distance that the last bits of two numbers make.
const HAIR: f64 = 1e-9;

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

    /// Searches, group by group; `values` says what may be tried of an input. Whoever makes the attempts knows whether it
    /// came there.
    pub fn run(mut self, groups: &[Vec<Input>], values: &dyn Fn(&Input) -> Vec<f64>) {
        loop {
            let before = self.distance;
            for inputs in groups {
                loop {
                    match self.descend(inputs).and_then(|()| self.leap(inputs, values)) {
                        Err(Ended) => return,
                        Ok(true) => {}
                        Ok(false) => break,
                    }
                }
            }
            if self.distance >= before {
                return;
            }
        }
    }

    /// Goes nearer in small steps, input by input, as long as any of them helps.
    fn descend(&mut self, inputs: &[Input]) -> Result<(), Ended> {
        let mut live: Vec<&Input> = inputs.iter().collect();
        loop {
            let before = self.distance;
            let mut matter = Vec::new();
            for input in live {
                if self.along(input)? {
                    matter.push(input);
                }
            }
            if self.distance >= before || matter.is_empty() {
                return Ok(());
            }
            live = matter;
        }
    }

    /// Tries large changes of one input after the other. True where one of them came nearer.
    fn leap(&mut self, inputs: &[Input], values: &dyn Fn(&Input) -> Vec<f64>) -> Result<bool, Ended> {
        let before = self.distance;
        for input in inputs {
            let from = input.get(&self.best);
            if let Some(unset) = input.unset(&self.best) {
                self.attempt(unset)?;
            }
            let step = input.step();
            let far = [100.0, -100.0, 6.0, -6.0, 1000.0, -1000.0].map(|times| from + step * times);
            let ends = [from * 10.0, from * 1000.0, -from, 0.0];
            let all = values(input).into_iter().chain(ends).chain(far);
            for to in all.filter(|to| *to != from) {
                self.at(input, to)?;
                if self.distance < before {
                    return Ok(true);
                }
            }
        }
        Ok(self.distance < before)
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
        // A sum of two numbers of few digits may be off by a last bit.
        if self.distance < HAIR {
            let met = input.get(&self.best);
            self.at(input, met.next_up())?;
            self.at(input, met.next_down())?;
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

    /// Runs with another value of an input.
    fn at(&mut self, input: &Input, value: f64) -> Result<Option<f64>, Ended> {
        let Some(circumstances) = input.set(&self.best, value) else { return Ok(None) };
        // Between two whole numbers there is none.
        if input.get(&circumstances) == input.get(&self.best) {
            return Ok(None);
        }
        self.attempt(circumstances)
    }

    /// Runs in other circumstances, and keeps them if that comes nearer. How near; none if not to the branch.
    fn attempt(&mut self, circumstances: Circumstances) -> Result<Option<f64>, Ended> {
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
    use crate::control::Scenario;
    use std::collections::BTreeMap;

    fn start(values: &[(&str, f64)]) -> Circumstances {
        let variables = values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        Circumstances::new(Scenario { variables, ..Scenario::default() }, BTreeMap::new())
    }

    fn variables(names: &[&str]) -> Vec<Input> {
        names.iter().map(|name| Input::Variable((*name).to_owned(), false)).collect()
    }

    /// Runs needed until `distance` is 0 or less; none if it never is.
    fn runs(values: &[(&str, f64)], distance: impl Fn(&dyn Fn(&str) -> f64) -> f64) -> Option<usize> {
        let names: Vec<&str> = values.iter().map(|(name, _)| *name).collect();
        let value =
            |from: &Circumstances, name: &str| from.scenario.variables.get(name).copied().unwrap_or(0.0);
        let of = |from: &Circumstances| distance(&|name: &str| value(from, name));
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
        Steer::new(first, far, 200, &mut attempt).run(&[variables(&names)], &|_| Vec::new());
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
    fn what_only_large_changes_move_is_leapt_to() {
        // The digits of a number, and a part of the day.
        let digits = |x: f64| if x < 1.0 { 0.0 } else { x.log10().floor() + 1.0 };
        assert!(runs(&[("y", 3.0), ("x", 2.0)], |v| 5.0 - digits(v("x"))).is_some_and(|n| n < 90));
        assert!(runs(&[("x", 120.0)], |v| (v("x") / 500.0).trunc() - 3.0 + 6.0).is_some_and(|n| n < 90));
    }

    #[test]
    fn what_cannot_be_ends() {
        assert_eq!(runs(&[("x", 0.0)], |_| 1.0), None);
        assert_eq!(runs(&[("x", 0.0)], |v| v("x").abs() + 1.0), None);
        assert_eq!(runs(&[("x", 0.0)], |_| f64::MAX), None);
    }
}

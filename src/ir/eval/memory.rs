//! A plain environment: variables and state in maps.

use super::{Alarm, AtanRange, Env, Value};
use crate::canon::Sys;
use crate::ir::{Bank, Class, Var};
use std::collections::BTreeMap;

/// Variables, machine state and switches, all set by hand.
///
/// A variable that was never set is vacant where its class may be, else 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// What was set.
    pub vars: BTreeMap<Var, Value>,
    /// State of the machine, by its subscripts rounded to whole numbers.
    pub state: BTreeMap<(Sys, Vec<i64>), Value>,
    /// Block-skip switches that are on.
    pub switches: Vec<u8>,
    /// The least increment of the address at hand.
    pub increment: Option<f64>,
    /// The range of the arc tangent of two arguments.
    pub atan: AtanRange,
}

impl Memory {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets a variable; a class that is never vacant gets 0 instead.
    pub fn set(&mut self, var: Var, value: Value) {
        let kept = if var.class.nullable() { value } else { Some(value.unwrap_or(0.0)) };
        self.vars.insert(var, kept);
    }

    /// The variable that a computed number means: 1 to 33 are local, 500 to 999 retained,
    /// the others up to 499 common.
    pub fn numbered(bank: Bank, number: u32) -> Result<Var, Alarm> {
        let class = match (bank, number) {
            (Bank::Global, _) => Class::Global,
            (Bank::Parametric, _) => Class::Parametric,
            (Bank::Numbered, 1..=33) => Class::Local,
            (Bank::Numbered, 100..=499) => Class::Common,
            (Bank::Numbered, 500..=999) => Class::Retained,
            (Bank::Numbered, _) => return Err(Alarm::Variable),
        };
        Ok(Var { class, number })
    }

    /// The key of a piece of state.
    pub fn key(state: Sys, subscripts: &[f64]) -> (Sys, Vec<i64>) {
        (state, subscripts.iter().map(|s| s.round() as i64).collect())
    }
}

impl Env for Memory {
    fn var(&self, var: Var) -> Value {
        let unset = if var.class.nullable() { None } else { Some(0.0) };
        self.vars.get(&var).copied().unwrap_or(unset)
    }

    fn indirect(&self, bank: Bank, number: u32) -> Result<Value, Alarm> {
        // Number 0 is the one that is always vacant.
        if (bank, number) == (Bank::Numbered, 0) {
            return Ok(None);
        }
        Ok(self.var(Self::numbered(bank, number)?))
    }

    fn system(&self, state: Sys, subscripts: &[f64]) -> Result<Value, Alarm> {
        self.state.get(&Self::key(state, subscripts)).copied().ok_or(Alarm::State(state))
    }

    fn switch(&self, number: u8) -> bool {
        self.switches.contains(&number)
    }

    fn increment(&self) -> Result<f64, Alarm> {
        self.increment.ok_or(Alarm::Address)
    }

    fn atan_range(&self) -> AtanRange {
        self.atan
    }
}

//! The variables V and R, and what SET sets.

use crate::control::scenario::Scenario;
use std::collections::BTreeMap;

/// The last V.
const LAST_V: usize = 100;
/// The last R.
const LAST_R: usize = 9;

/// A numbered variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Register {
    /// V1 to V100.
    V(usize),
    /// R0 to R9.
    R(usize),
}

/// The variable that cycles take their retract plane from, and arcs their radius.
pub(super) const PLANE: Register = Register::R(0);

impl Register {
    /// The variable of a name and a number; none if there is no such.
    pub fn new(name: &str, number: u32) -> Option<Self> {
        let number = number as usize;
        match name {
            "V" if (1..=LAST_V).contains(&number) => Some(Register::V(number)),
            "R" if number <= LAST_R => Some(Register::R(number)),
            _ => None,
        }
    }
}

impl std::fmt::Display for Register {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Register::V(number) => write!(f, "V{number}"),
            Register::R(number) => write!(f, "R{number}"),
        }
    }
}

/// The variables; none of a value is one that nothing has set since power-on.
#[derive(Clone, Debug)]
pub(super) struct Registers {
    v: [Option<f64>; LAST_V + 1],
    r: [Option<f64>; LAST_R + 1],
    /// Angles are radians.
    pub radians: bool,
    /// Places that RND keeps; none before any SET.
    pub places: Option<u8>,
}

impl Registers {
    pub fn new(scenario: &Scenario) -> Self {
        let mut registers =
            Self { v: [None; LAST_V + 1], r: [None; LAST_R + 1], radians: false, places: None };
        for (name, value) in &scenario.variables {
            let parts = name.split_at_checked(1).map(|(name, number)| (name, number.parse().ok()));
            if let Some((name, Some(number))) = parts
                && let Some(register) = Register::new(name, number)
            {
                registers.set(register, *value);
            }
        }
        registers
    }

    /// The value; none if nothing has set it.
    pub fn get(&self, register: Register) -> Option<f64> {
        *match register {
            Register::V(number) => self.v.get(number)?,
            Register::R(number) => self.r.get(number)?,
        }
    }

    pub fn set(&mut self, register: Register, value: f64) {
        let cell = match register {
            Register::V(number) => self.v.get_mut(number),
            Register::R(number) => self.r.get_mut(number),
        };
        if let Some(cell) = cell {
            *cell = Some(value);
        }
    }

    /// What CLEAR alone does; returns the variables that held something.
    pub fn clear_all(&mut self) -> Vec<String> {
        let held =
            self.v.iter().enumerate().skip(1).filter(|(_, value)| value.is_some_and(|value| value != 0.0));
        let held = held.map(|(number, _)| Register::V(number).to_string()).collect();
        self.v = [Some(0.0); LAST_V + 1];
        held
    }

    /// The variables that were set, by name.
    pub fn all(&self) -> BTreeMap<String, f64> {
        let named = |name: char, cells: &[Option<f64>], first: usize| {
            let set = cells.iter().enumerate().skip(first);
            set.filter_map(|(number, value)| value.map(|value| (format!("{name}{number}"), value)))
                .collect::<Vec<_>>()
        };
        let mut all = named('V', &self.v, 1);
        all.extend(named('R', &self.r, 0));
        all.into_iter().collect()
    }
}

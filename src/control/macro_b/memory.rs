//! Variables.

use super::numeric::Value;
use std::collections::{BTreeMap, HashMap};

/// Locals of a level: #1 to #33.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Locals {
    values: [Value; 34],
    /// By how much each may be off.
    off: [f32; 34],
}

impl Default for Locals {
    fn default() -> Self {
        Self { values: [None; 34], off: [0.0; 34] }
    }
}

impl Locals {
    /// Those that are not vacant.
    pub fn values(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.values.iter().enumerate().filter_map(|(number, value)| Some((number, (*value)?)))
    }

    /// Sets a local, which may be off by so much; false where there is none of this number.
    pub fn set(&mut self, number: usize, value: Value, off: f64) -> bool {
        match (self.values.get_mut(number), self.off.get_mut(number)) {
            (Some(place), Some(error)) => {
                // Seven digits of an error are more than enough.
                (*place, *error) = (value, off as f32);
                true
            }
            _ => false,
        }
    }
}

/// Common and retained variables up to here lie in a row.
const NEAR: usize = 1000;

/// The variables of a control.
#[derive(Debug)]
pub struct Memory {
    /// Locals of each level, the innermost last.
    pub levels: Vec<Locals>,
    near: Vec<Value>,
    far: HashMap<u32, Value>,
    /// By how much shared variables may be off, where that is not zero.
    off: HashMap<u32, f64>,
    /// Names given by SETVN.
    pub names: HashMap<String, u32>,
}

impl Memory {
    /// The start values, by names like `#100`; names that are none are left out.
    pub fn new(start: &BTreeMap<String, f64>) -> Self {
        let mut memory = Self {
            levels: vec![Locals::default()],
            near: vec![None; NEAR],
            far: HashMap::new(),
            off: HashMap::new(),
            names: HashMap::new(),
        };
        for (name, value) in start {
            let Some(number) = name.trim().strip_prefix('#').and_then(|digits| digits.parse().ok()) else {
                continue;
            };
            memory.put(number, *value);
        }
        memory
    }

    /// Sets a variable by hand; a local in the level that runs.
    pub fn put(&mut self, number: u32, value: f64) {
        match number {
            1..=33 => self.set_local(number as usize, Some(value), 0.0),
            _ => self.set(number, Some(value), 0.0),
        }
    }

    pub fn local(&self, number: usize) -> Value {
        self.levels.last().and_then(|locals| locals.values.get(number)).copied().flatten()
    }

    /// By how much a local may be off.
    pub fn local_off(&self, number: usize) -> f64 {
        self.levels.last().and_then(|locals| locals.off.get(number)).map_or(0.0, |off| f64::from(*off))
    }

    pub fn set_local(&mut self, number: usize, value: Value, off: f64) {
        if let Some(locals) = self.levels.last_mut() {
            locals.set(number, value, off);
        }
    }

    pub fn get(&self, number: u32) -> Value {
        match self.near.get(number as usize) {
            Some(value) => *value,
            None => self.far.get(&number).copied().flatten(),
        }
    }

    /// By how much a shared variable may be off.
    pub fn off(&self, number: u32) -> f64 {
        if self.off.is_empty() { 0.0 } else { self.off.get(&number).copied().unwrap_or(0.0) }
    }

    pub fn set(&mut self, number: u32, value: Value, off: f64) {
        match self.near.get_mut(number as usize) {
            Some(place) => *place = value,
            None => {
                self.far.insert(number, value);
            }
        }
        if off > 0.0 {
            self.off.insert(number, off);
        } else if !self.off.is_empty() {
            self.off.remove(&number);
        }
    }

    /// All that are not vacant, by name; locals are those of the outermost level.
    pub fn dump(&self) -> BTreeMap<String, f64> {
        let locals = self.levels.first().into_iter().flat_map(|locals| locals.values.iter().enumerate());
        let row = locals.chain(self.near.iter().enumerate());
        let near = row.filter_map(|(number, value)| value.map(|value| (format!("#{number}"), value)));
        let far =
            self.far.iter().filter_map(|(number, value)| value.map(|value| (format!("#{number}"), value)));
        near.chain(far).collect()
    }
}

//! Variables.

use super::numeric::Value;
use std::collections::{BTreeMap, HashMap};

/// Locals of a level: #1 to #33.
pub type Locals = [Value; 34];

/// Common and retained variables up to here lie in a row.
const NEAR: usize = 1000;

/// The variables of a control.
#[derive(Debug)]
pub struct Memory {
    /// Locals of each level, the innermost last.
    pub levels: Vec<Locals>,
    near: Vec<Value>,
    far: HashMap<u32, Value>,
    /// Names given by SETVN.
    pub names: HashMap<String, u32>,
}

impl Memory {
    /// The start values, by names like `#100`; names that are none are left out.
    pub fn new(start: &BTreeMap<String, f64>) -> Self {
        let mut memory = Self {
            levels: vec![[None; 34]],
            near: vec![None; NEAR],
            far: HashMap::new(),
            names: HashMap::new(),
        };
        for (name, value) in start {
            let Some(number) = name.trim().strip_prefix('#').and_then(|digits| digits.parse().ok()) else {
                continue;
            };
            match number {
                1..=33 => memory.set_local(number as usize, Some(*value)),
                _ => memory.set(number, Some(*value)),
            }
        }
        memory
    }

    pub fn local(&self, number: usize) -> Value {
        self.levels.last().and_then(|locals| locals.get(number)).copied().flatten()
    }

    pub fn set_local(&mut self, number: usize, value: Value) {
        if let Some(place) = self.levels.last_mut().and_then(|locals| locals.get_mut(number)) {
            *place = value;
        }
    }

    pub fn get(&self, number: u32) -> Value {
        match self.near.get(number as usize) {
            Some(value) => *value,
            None => self.far.get(&number).copied().flatten(),
        }
    }

    pub fn set(&mut self, number: u32, value: Value) {
        match self.near.get_mut(number as usize) {
            Some(place) => *place = value,
            None => {
                self.far.insert(number, value);
            }
        }
    }

    /// All that are not vacant, by name; locals are those of the outermost level.
    pub fn dump(&self) -> BTreeMap<String, f64> {
        let locals = self.levels.first().into_iter().flat_map(|locals| locals.iter().enumerate());
        let near = self.near.iter().enumerate();
        let row = locals.chain(near).filter_map(|(number, value)| Some((format!("#{number}"), (*value)?)));
        let far = self.far.iter().filter_map(|(number, value)| Some((format!("#{number}"), (*value)?)));
        row.chain(far).collect()
    }
}

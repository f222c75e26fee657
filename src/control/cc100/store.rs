//! The variables: V1 to V99 and VA to VZ.

use crate::control::scenario::Scenario;
use crate::syntax::{Index, VarRef};
use std::collections::BTreeMap;

const NUMBERS: usize = 99;
const LETTERS: usize = 26;

/// The place of a variable in the store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell(usize);

impl Cell {
    /// The place of `V5` or `VX`; none if there is no such variable.
    pub fn of(variable: &VarRef) -> Option<Self> {
        match variable.index {
            Index::Number(number) => Self::numbered(number),
            Index::Letter(letter) => Self::lettered(letter),
            _ => None,
        }
    }

    /// The place of `V5`.
    pub fn numbered(number: u32) -> Option<Self> {
        let number = number as usize;
        (1..=NUMBERS).contains(&number).then(|| Cell(number - 1))
    }

    fn lettered(letter: char) -> Option<Self> {
        letter.is_ascii_uppercase().then(|| Cell(NUMBERS + (letter as usize - 'A' as usize)))
    }

    pub fn name(self) -> String {
        match u8::try_from(self.0.saturating_sub(NUMBERS)) {
            Ok(letter) if self.0 >= NUMBERS => format!("V{}", char::from(b'A' + letter)),
            _ => format!("V{}", self.0 + 1),
        }
    }
}

/// The values; none is one that nothing has set since power-on.
#[derive(Clone, Debug)]
pub(super) struct Store([Option<f64>; NUMBERS + LETTERS]);

impl Store {
    pub fn new(scenario: &Scenario) -> Self {
        let mut store = Store([None; NUMBERS + LETTERS]);
        for (name, value) in &scenario.variables {
            let rest = name.strip_prefix('V').unwrap_or_default();
            let mut chars = rest.chars();
            let letter = chars.next().filter(|_| chars.next().is_none()).and_then(Cell::lettered);
            let cell = letter.or_else(|| rest.parse().ok().and_then(Cell::numbered));
            if let Some(cell) = cell {
                store.set(cell, *value);
            }
        }
        store
    }

    /// The value; none if nothing has set it.
    pub fn get(&self, cell: Cell) -> Option<f64> {
        self.0.get(cell.0).copied().flatten()
    }

    pub fn set(&mut self, cell: Cell, value: f64) {
        if let Some(place) = self.0.get_mut(cell.0) {
            *place = Some(value);
        }
    }

    /// The variables that were set, by name.
    pub fn all(&self) -> BTreeMap<String, f64> {
        let set = self.0.iter().enumerate();
        set.filter_map(|(at, value)| value.map(|value| (Cell(at).name(), value))).collect()
    }
}

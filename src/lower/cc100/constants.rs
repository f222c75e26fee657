//! Variables that only ever hold one number.
//!
//! Law: where every assignment to a variable in a program gives it the same
//! constant, a read behind one of them yields that constant. Side condition: the
//! read does follow one, and no other program writes the variable in between;
//! neither is looked at here, so whoever uses this says so to the reader.
//! Counter-example: `G=V30` before `V30=22` reads what was left there.

use crate::lower::common::constant;
use crate::syntax::{Block, Index, ItemKind, VarRef, for_each_item};
use std::collections::HashMap;

/// A variable as it is written: number, or letter.
type Key = (Option<u32>, Option<char>);

/// The variables of a program that only ever hold one number.
#[derive(Debug, Default)]
pub struct Constants(HashMap<Key, Option<f64>>);

impl Constants {
    /// Looks through all assignments of a program.
    pub fn of(blocks: &[Block]) -> Self {
        let mut all = Self::default();
        for block in blocks {
            for_each_item(&block.items, &mut |item| match &item.kind {
                ItemKind::Assign { target, value, .. } => all.note(target, constant(value)),
                ItemKind::Step { target, .. } | ItemKind::Timer(target) => all.note(target, None),
                ItemKind::Transfer { cells, .. } => {
                    cells.iter().filter(|cell| !cell.store).for_each(|cell| all.note(&cell.variable, None));
                }
                ItemKind::Input { targets, .. } => targets.iter().for_each(|target| all.note(target, None)),
                _ => {}
            });
        }
        all
    }

    /// The number that the variable holds once it is assigned.
    pub fn value(&self, variable: &VarRef) -> Option<f64> {
        self.0.get(&key(variable)?).copied().flatten()
    }

    fn note(&mut self, variable: &VarRef, value: Option<f64>) {
        let Some(key) = key(variable) else { return };
        let known = self.0.entry(key).or_insert(value);
        if *known != value {
            *known = None;
        }
    }
}

fn key(variable: &VarRef) -> Option<Key> {
    match variable.index {
        Index::Number(number) => Some((Some(number), None)),
        Index::Letter(letter) => Some((None, Some(letter))),
        _ => None,
    }
}

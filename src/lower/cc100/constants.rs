//! Variables of which the text says what number they hold.
//!
//! Law: a read holds the constant of the last assignment before it, where no label stands between them, at which
//! jumps and calls arrive, and no call. Where more than assignments stands between, the number may be one that an
//! operator edits: whoever takes it for good says so.
//!
//! Law: where every assignment to a variable in a program gives it the same
//! constant, a read after one of them yields that constant. Side condition: the
//! read does follow one, and no other program writes the variable in between;
//! neither is looked at here, so whoever uses this says so to the reader.
//! Counter-example: `G=V30` before `V30=22` reads what was left there.

use crate::lower::common::constant;
use crate::syntax::{Block, Expr, ExprKind, Index, ItemKind, VarRef, for_each_item};
use std::collections::HashMap;

/// A variable as it is written: number, or letter.
type Key = (Option<u32>, Option<char>);

/// The variables of a program whose numbers are known.
#[derive(Debug, Default)]
pub struct Constants {
    /// Those that are assigned, and the number where it is always the same.
    all: HashMap<Key, Option<f64>>,
    /// Those that hold a number for certain at the place that is read, and whether that was given just before it.
    here: HashMap<Key, (f64, bool)>,
}

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
        self.all.get(&key(variable)?).copied().flatten()
    }

    /// The number that a value is for certain here.
    pub fn sure(&self, value: &Expr) -> Option<f64> {
        constant(value).or_else(|| Some(self.held(value)?.0))
    }

    /// True where the number that a value is here was not given to its variable just before.
    pub fn is_given_above(&self, value: &Expr) -> bool {
        self.held(value).is_some_and(|(_, near)| !near)
    }

    fn held(&self, value: &Expr) -> Option<(f64, bool)> {
        match &value.kind {
            ExprKind::Variable(variable) => self.here.get(&key(variable)?).copied(),
            _ => None,
        }
    }

    /// Goes on after an item.
    pub fn follow(&mut self, item: &ItemKind) {
        match item {
            ItemKind::Assign { target, value, .. } => {
                let value = constant(value).map(|number| (number, true)).or_else(|| self.held(value));
                self.hold(target, value);
            }
            ItemKind::Word(_) | ItemKind::Comment(_) => {
                self.here.values_mut().for_each(|(_, near)| *near = false)
            }
            ItemKind::Step { target, .. } | ItemKind::Timer(target) => self.hold(target, None),
            ItemKind::Transfer { cells, .. } => cells.iter().for_each(|cell| self.hold(&cell.variable, None)),
            ItemKind::Input { .. } | ItemKind::Label(_) => self.forget(),
            _ => {}
        }
    }

    /// Goes on where control may come from elsewhere.
    pub fn forget(&mut self) {
        self.here.clear();
    }

    fn hold(&mut self, variable: &VarRef, value: Option<(f64, bool)>) {
        match (key(variable), value) {
            (Some(key), Some(value)) => drop(self.here.insert(key, value)),
            (Some(key), None) => drop(self.here.remove(&key)),
            (None, _) => self.forget(),
        }
    }

    fn note(&mut self, variable: &VarRef, value: Option<f64>) {
        let Some(key) = key(variable) else { return };
        let known = self.all.entry(key).or_insert(value);
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

//! What the heads of an earlier conversion say of a library: where its values were kept, and what holds none of anybody's.

use super::head_text::Head;
use std::collections::{BTreeMap, BTreeSet};

/// What heads say. A person may have edited them: whoever uses it must be right whatever it says.
#[derive(Debug, Default)]
pub(in crate::legalize) struct Earlier {
    /// What the value of a register was called on the control that it came from, by the register's name.
    pub held: BTreeMap<String, String>,
    /// The numbers that programs without one had, by program.
    pub numbers: BTreeMap<usize, u32>,
    /// By program: the names of registers for values in between.
    pub between: Vec<BTreeSet<String>>,
}

impl Earlier {
    /// Nothing, of so many programs.
    pub fn of(programs: usize) -> Self {
        Self { between: vec![BTreeSet::new(); programs], ..Self::default() }
    }

    /// Adds what a comment at the head of a program says. What the first program says of a register holds for all.
    pub fn add(&mut self, program: usize, head: &Head) {
        for (register, name) in &head.held {
            self.held.entry(register.clone()).or_insert_with(|| name.clone());
        }
        if let Some(between) = self.between.get_mut(program) {
            between.extend(head.between.iter().cloned());
        }
    }

    /// True where heads say anything: an earlier conversion wrote the library.
    pub fn is_written(&self) -> bool {
        !self.held.is_empty() || !self.numbers.is_empty() || self.has_between()
    }

    /// True where some program has registers for values in between.
    pub fn has_between(&self) -> bool {
        self.between.iter().any(|between| !between.is_empty())
    }
}

//! Draws codes beside moves, what is found by computed numbers, and what cannot be converted.

use super::{Draw, GIVEN, GIVENS};
use crate::generate::{Kind, Step};

impl Draw<'_, '_> {
    /// A block with one to three codes of the machine.
    pub(super) fn beside(&mut self) -> Kind {
        let block = self.source.below(16);
        let codes = (0..1 + self.source.below(6) / 2).map(|_| self.source.below(16)).collect();
        Kind::Beside { block, value: self.value(1), codes }
    }

    /// A computed jump to one of two or three places.
    pub(super) fn jump(&mut self) -> Kind {
        let given = GIVEN + self.source.below(GIVENS);
        self.tested.push(given);
        let arms = (0..2 + self.source.below(2)).map(|_| self.steps(2)).collect();
        self.tested.pop();
        Kind::Jump { given, form: self.source.below(6), arms }
    }

    /// A computed call.
    pub(super) fn far(&mut self) -> Kind {
        let (first, many) = (self.callable.0, self.callable.1 - self.callable.0);
        let subs = [first + self.source.below(many), first + self.source.below(many)];
        Kind::Far { subs, given: GIVEN + self.source.below(GIVENS), form: self.source.below(8) }
    }

    /// Puts what cannot be converted into one of the subprograms.
    pub(super) fn spoil(&mut self, subs: &mut [Vec<Step>]) {
        let which = self.source.below(subs.len());
        let step = self.step(Kind::Unknown);
        if let Some(steps) = subs.get_mut(which) {
            steps.insert(self.source.below(steps.len() + 1), step);
        }
    }
}

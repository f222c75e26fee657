//! Which variables a write by a computed number leaves alone.
//!
//! Law: it writes one of the numbers that its number may be: those that are followed from where it is assigned, and where these
//! leave it open, those of the run that its constant part lies in, which [`super::report`] tells and the verifier watches.
//! Counter-example: `#[#1]=0`, which may write any.

use super::numbers::{Numbers, Table};
use crate::dialect::Control;
use crate::ir::analysis::{Ranges, Summaries, Values, Vars};
use crate::ir::{Bank, BlockId, Expr, Program, Var};
use std::cell::RefCell;

/// What the computed numbers of a program may write.
pub(in crate::legalize) struct Written<'p> {
    ranges: Ranges<'p>,
    numbers: RefCell<Numbers<'p>>,
    /// True where what is supposed of a number is told.
    supposes: bool,
}

impl<'p> Written<'p> {
    /// Of a program of the library that `summaries` are of; `standard` where no work offset but one of the standard six is in force.
    pub fn in_program(
        program: &'p Program,
        summaries: &'p Summaries,
        standard: bool,
        (source, target): (&'p Control, &'p Control),
    ) -> Self {
        let numbers = Numbers::new(source, target, Table::default());
        let supposes =
            !numbers.all_alike() && !crate::legalize::variables::subscript_chains::takes_none(target);
        Self {
            ranges: Ranges::of_offsets(program, summaries, standard),
            numbers: RefCell::new(numbers),
            supposes,
        }
    }

    /// True where the variable of this number, at a statement of a block, is surely another one than `var`.
    pub fn misses(&self, (id, at): (BlockId, usize), bank: Bank, number: &Expr, var: Var) -> bool {
        if !Vars::bank(bank).contains(&var.class) {
            return true;
        }
        if bank != Bank::Numbered {
            return false;
        }
        let values = self.ranges.at(id, at, number);
        let may_be = values.numbers();
        if !may_be.contains(var.number) {
            return true;
        }
        let exact = matches!(values, Values::Few(_));
        let (finding, sure) = self.numbers.borrow_mut().judge(number, &may_be, exact);
        let run = finding.filter(|_| self.supposes && !sure).and_then(|finding| finding.run());
        run.is_some_and(|(first, last)| !(first..=last).contains(&var.number))
    }
}

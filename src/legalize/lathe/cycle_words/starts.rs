//! Where cycles begin, where the words of the blocks before are computed.
//!
//! A word says a place for as long as the variables that it was computed from keep their values.

use super::super::place::{Place, Told};
use super::super::tap_products::is_kept;
use super::super::thread_loops::counts;
use crate::canon::Role;
use crate::ir::analysis::{Summaries, Vacancy};
use crate::ir::{Block, Expr, NcItem, Place as Target, Program, Stmt, StmtKind};
use std::collections::{BTreeSet, VecDeque};

/// The computed words of places, of the last blocks that have any.
#[derive(Default)]
pub(super) struct Starts {
    /// How many blocks were come to.
    count: u32,
    said: VecDeque<(u32, [Option<Expr>; 2])>,
    /// Those of which a word may have no value.
    vacant: BTreeSet<u32>,
}

/// A place that was said before so many others is not known.
const KEPT: usize = 64;

impl Starts {
    /// Takes a statement before the place does; `vacant` says that a word of it may have no value.
    pub(super) fn step(&mut self, stmt: &Stmt, vacant: bool, place: &mut Place) {
        self.count = self.count.wrapping_add(1);
        place.comes_to(self.count);
        let said = |role: Role| {
            let word = stmt.kind.nc()?.word(role).filter(|word| word.constant().is_none())?;
            (is_kept(word) && !counts(word)).then(|| word.clone())
        };
        let words = [said(Role::X), said(Role::Z)];
        if words.iter().any(Option::is_some) {
            self.said.truncate(KEPT - 1);
            self.said.push_front((self.count, words));
            self.vacant.extend(vacant.then_some(self.count));
        }
        match stmt.kind.target() {
            Some(Target::Var(var)) => {
                for word in self.said.iter_mut().flat_map(|(_, words)| words) {
                    let mut named = false;
                    word.iter().for_each(|word| word.variables(&mut |found| named |= found == *var));
                    word.take_if(|_| named);
                }
            }
            Some(_) => self.said.clear(),
            None => {}
        }
    }

    /// True where a word that says where the tool stands may have no value.
    pub(super) fn may_be_vacant(&self, place: &Place) -> bool {
        let (x, z) = place.told();
        [x, z].into_iter().flatten().any(|told| matches!(told, Told::Block(at) if self.vacant.contains(&at)))
    }

    /// X and Z of where the tool stands, as far as they are known.
    pub(super) fn at(&self, place: &Place) -> [Option<Expr>; 2] {
        let (x, z) = place.told();
        let value = |told: Option<Told>, axis: usize| match told? {
            Told::Number(number) => Some(Expr::Number(number)),
            Told::Block(block) => {
                let (_, words) = self.said.iter().find(|(at, _)| *at == block)?;
                words.get(axis)?.clone()
            }
        };
        [value(x, 0), value(z, 1)]
    }
}

/// For each block and statement whether a word of it may have no value.
pub(super) fn vacant(program: &Program, summaries: &Summaries) -> Vec<Vec<bool>> {
    let vacancy = Vacancy::of(program, summaries, &BTreeSet::new());
    let of_stmt = |id, at: usize, stmt: &Stmt| {
        let StmtKind::Nc(nc) = &stmt.kind else { return false };
        let mut words = nc.items.iter().filter_map(|item| match item {
            NcItem::Word(_, value) => Some(value),
            _ => None,
        });
        words.any(|word| word.may_be_vacant() && vacancy.may_yield_vacant(id, at, word))
    };
    let of_block = |(id, block): (_, &Block)| {
        block.stmts.iter().enumerate().map(|(at, stmt)| of_stmt(id, at, stmt)).collect()
    };
    program.ids().zip(&program.blocks).map(of_block).collect()
}

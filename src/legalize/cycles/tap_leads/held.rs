//! Taps at a speed that the program computes.
//!
//! Law: what a speed word says goes to a temporary first, as a whole number, and a tap that comes after it turns at that speed and leads by its
//! feed over it. Side condition: on every way to the tap a speed word of the same program is the last one, of this run of
//! it, and it is above 0, as the feed is, as far as the numbers of the program say. Counter-example: a speed that a called
//! program says, whose temporaries are its own, and one that an operator enters: a lead over a speed of 0 is none.

use crate::canon::{Func, Op, Role};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::analysis::{Ranges, Summaries, Vacancy};
use crate::ir::{
    BinOp, Block, BlockId, Expr, Module, Nc, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Var,
};
use std::collections::BTreeSet;

/// Whose speed word was the last one, by the number of its program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Held {
    In(usize),
    Unknown,
}

impl Held {
    /// After a statement of a program, whose speed may be `open`: left out, where it is vacant.
    pub fn step(&mut self, index: usize, stmt: &Stmt, open: bool) {
        match &stmt.kind {
            StmtKind::ModalCall(_) => *self = Self::Unknown,
            StmtKind::Nc(nc) if nc.has(Op::SurfaceSpeed) || nc.has(Op::TurnsPerMinute) => {
                *self = Self::Unknown;
            }
            StmtKind::Nc(nc) => match nc.word(Role::Speed) {
                // A block that is skipped leaves the speed that was there, and the temporary too.
                Some(_) if open => *self = Self::Unknown,
                Some(_) if stmt.site.skip.is_none() => *self = Self::In(index),
                _ => {}
            },
            _ => {}
        }
    }
}

impl Lattice for Held {
    fn join(&mut self, other: &Self) -> bool {
        let joined = if self == other { *self } else { Self::Unknown };
        std::mem::replace(self, joined) != joined
    }
}

/// Blocks of a program whose speed, or the feed of a tap, may be vacant or not above 0.
pub(super) type Open = BTreeSet<(BlockId, usize)>;

/// These blocks of every program.
pub(super) fn open(module: &Module, summaries: &Summaries) -> Vec<Open> {
    let asked = |nc: &Nc, role| role == Role::Speed || role == Role::Feed && nc.ops().any(Op::is_tap);
    let none = BTreeSet::new();
    let of = |program: &Program| {
        let mut open = Vacancy::of(program, summaries, &none).absent(&asked);
        let mut vars = BTreeSet::new();
        program.variables(&mut |var| _ = vars.insert(var));
        let ranges = Ranges::of_constants(program, summaries, vars);
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                let above = |value: &Expr| {
                    let bounds = ranges.at(id, at, value).bounds();
                    bounds.is_some_and(|(least, _)| least > 0.0)
                };
                let words = nc.items.iter().filter_map(|item| match item {
                    NcItem::Word(role, value) if asked(nc, *role) => Some(value),
                    _ => None,
                });
                if !words.into_iter().all(above) {
                    open.insert((id, at));
                }
            }
        }
        open
    };
    module.programs.iter().map(of).collect()
}

/// Whose it is at every block of a library.
pub(super) struct HeldSpeeds<'o>(pub &'o [Open]);

impl Follow for HeldSpeeds<'_> {
    type Known = Held;

    fn outside(&self, _: usize) -> Held {
        Held::Unknown
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, held: &mut Held) {
        enter(id, held);
        let open = |at| self.0.get(index).is_some_and(|open| open.contains(&(id, at)));
        block.stmts.iter().enumerate().for_each(|(at, stmt)| held.step(index, stmt, open(at)));
    }

    fn lose(&self, held: &mut Held) {
        *held = Held::Unknown;
    }
}

/// A program that begins has no temporaries of an earlier run.
pub(super) fn enter(id: BlockId, held: &mut Held) {
    if id == BlockId(0) {
        *held = Held::Unknown;
    }
}

/// Gives a tap the speed in the temporary, and the lead that its feed makes of it; false if its feed is not known.
pub(super) fn give(nc: &mut Nc, speed: Var, feed: Option<f64>) -> bool {
    let feed = match nc.word(Role::Feed) {
        Some(feed) => Some(feed.clone()),
        None => feed.map(Expr::Number),
    };
    let Some(feed) = feed.filter(|feed| feed.constant().is_none_or(|feed| feed > 0.0)) else { return false };
    super::by_lead_now(nc, Expr::binary(BinOp::Div, feed, Expr::Var(speed)), Expr::Var(speed));
    true
}

/// Puts what each speed word of a program says into the temporary before its block. The taps at these places have it
/// by now, and their own speed words are given.
pub(super) fn hold(program: &mut Program, speed: Var, own: &[(BlockId, usize, Expr)], open: &Open) {
    for (id, block) in (0..).map(BlockId).zip(&mut program.blocks) {
        let stmts = std::mem::take(&mut block.stmts);
        for (at, mut stmt) in stmts.into_iter().enumerate() {
            let tap = own.iter().find(|(block, place, _)| (*block, *place) == (id, at));
            let value = match (&mut stmt.kind, tap) {
                (_, Some((.., value))) => Some(value.clone()),
                (StmtKind::Nc(nc), None) if !open.contains(&(id, at)) => {
                    // A tap that says no speed of its own has the temporary by now.
                    let said = word_mut(nc).filter(|value| **value != Expr::Var(speed));
                    said.map(|value| std::mem::replace(value, Expr::Var(speed)))
                }
                _ => None,
            };
            if let Some(value) = value {
                // Speeds are whole.
                let value = match value.constant() {
                    Some(number) if number.fract() == 0.0 => value,
                    _ => Expr::Call(Func::Round, [value].into()),
                };
                let kind = StmtKind::Assign { target: Place::Var(speed), value };
                let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
                block.stmts.push(Stmt { kind, site });
            }
            block.stmts.push(stmt);
        }
    }
}

fn word_mut(nc: &mut Nc) -> Option<&mut Expr> {
    nc.items.iter_mut().find_map(|item| match item {
        NcItem::Word(Role::Speed, value) => Some(value),
        _ => None,
    })
}

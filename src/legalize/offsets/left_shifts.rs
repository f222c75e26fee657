//! Local shifts that are in force at the end of a run.
//!
//! Law: where the source's end clears them, a shift of 0 before the end leaves the target without one too, whatever its own
//! end does. Where the source's end keeps them, or nobody says, the program rests on both controls. Side condition: a shift may be in
//! force there on some way; a shift of 0 where none is changes nothing. Counter-example: `G52 X10.`, `M30`, and a next program
//! that selects G54 and goes to X0.

use crate::canon::{Op, Role};
use crate::dialect::{Machine, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

const CLEARS: Question = Question::EndClearsLocal;
/// The axes that a local shift has words for.
pub(super) const AXES: [Role; 6] = [Role::X, Role::Y, Role::Z, Role::A, Role::B, Role::C];

/// True if the library shifts so, between two mills of which one table at least says what an end does.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let (source, target) = (context.source, context.target);
    features.op(Op::LocalShift)
        && [source, target].iter().all(|control| control.machine() == Machine::Mill)
        && !source.is_same_machine(target)
        && [source, target].iter().any(|control| control.behaviour(CLEARS).is_some())
}

/// Ends shifts before the end of a run, or says what it rests on; true if a shift was ended.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let known = OverCalls::of(module, &Shifts);
    let clears = context.source.is(CLEARS) && !context.target.is(CLEARS);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let place = (index, BlockId(at as u32));
            let Some(Shifted(mut axes)) = known.at(place.0, place.1).copied() else { continue };
            block.stmts.iter().for_each(|stmt| step(stmt, &mut axes));
            if !matches!(block.term.kind, TermKind::End { .. }) || axes == [false; 6] {
                continue;
            }
            let span = block.term.site.span;
            if !clears {
                for (control, is_source) in [(context.source, true), (context.target, false)] {
                    match control.behaviour(CLEARS) {
                        Some(_) if is_source => context.rests_on_source(index, span, CLEARS),
                        Some(_) => context.rests_on_target(index, span, CLEARS),
                        None => {}
                    }
                }
                context.must_agree(index, span, CLEARS);
                continue;
            }
            changed = true;
            context.rests_on_source(index, span, CLEARS);
            let words = AXES.into_iter().zip(axes).filter(|(_, on)| *on);
            let words = words.map(|(role, _)| NcItem::Word(role, Expr::Number(0.0)));
            let items = [NcItem::Op(Op::LocalShift)].into_iter().chain(words).collect();
            // A block of its own: the end may act before the words of its block.
            let site = SourceInfo::default();
            block.stmts.push(Stmt { kind: StmtKind::Nc(Nc { items }), site });
        }
    }
    changed
}

/// The axes that may be shifted on some way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shifted([bool; 6]);

impl Lattice for Shifted {
    fn join(&mut self, other: &Self) -> bool {
        let joined = std::array::from_fn(|axis| self.0[axis] || other.0[axis]);
        std::mem::replace(&mut self.0, joined) != joined
    }
}

struct Shifts;

impl Follow for Shifts {
    type Known = Shifted;

    fn outside(&self, _: usize) -> Shifted {
        Shifted([false; 6])
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, shifted: &mut Shifted) {
        block.stmts.iter().for_each(|stmt| step(stmt, &mut shifted.0));
    }

    fn lose(&self, _: &mut Shifted) {}
}

/// True for the value of no shift.
pub(super) fn is_none(value: &Expr) -> bool {
    matches!(value, Expr::Increments(0.0)) || value.constant() == Some(0.0)
}

/// Takes the shift of a statement.
fn step(stmt: &Stmt, axes: &mut [bool; 6]) {
    let Some(nc) = stmt.kind.nc() else { return };
    if nc.has(Op::ShiftCancel) && stmt.site.skip.is_none() {
        *axes = [false; 6];
    }
    if !nc.has(Op::LocalShift) {
        return;
    }
    for (role, on) in AXES.into_iter().zip(axes) {
        let Some(value) = nc.word(role) else { continue };
        *on = if is_none(value) { *on && stmt.site.skip.is_some() } else { true };
    }
}

//! The cutter radius that the word of the tool length picks.
//!
//! Law: where a length picks the radius of the same row, lowering names that radius beside it. It is left out where
//! nothing looks at it: compensation is known to be off there, and on every way on another word names a radius
//! before a code starts compensation without one. Side condition: after a call and a return anything may look that
//! the library has. Counter-example to leaving it out: `H2 Z.1`, then `G41 X1.` in a block without a D.

use crate::canon::{Group, Op, Role};
use crate::dialect::Question;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Steps, solve};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, Stmt, StmtKind, TermKind};
use crate::legalize::Context;

const FACT: Question = Question::LengthWordPicksRadius;

/// Leaves out what nothing looks at, and says on what the rest rests.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if !context.source.is(FACT) {
        return;
    }
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    let elsewhere = stmts().filter_map(|stmt| stmt.kind.nc()).any(looks);
    let compensates = stmts().filter_map(|stmt| stmt.kind.nc()).any(compensates);
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let rules = LookedAt { elsewhere };
        let ends = solve(&rules, program, &Cfg::of(program));
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let mut live = ends.at(id).copied().unwrap_or_default();
            rules.first(id, block, &mut live);
            let mut state = facts.at(index, id);
            let off = block.stmts.iter().map(|stmt| {
                let off = state.op(Group::RadiusComp) == Some(Op::RadiusOff);
                state.step(stmt);
                off || !compensates
            });
            let off: Vec<bool> = off.collect();
            for (stmt, off) in block.stmts.iter_mut().zip(off).rev() {
                let behind = live;
                let (span, skipped) = (stmt.site.span, stmt.site.skip.is_some());
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                live = before(nc, skipped, behind);
                if !comes_with_length(nc) {
                    continue;
                }
                if behind || !off {
                    context.rests_on_source(index, span, FACT);
                } else {
                    nc.items.retain(|item| !matches!(item, NcItem::Word(Role::RadiusOffset, _)));
                }
            }
        }
    }
}

/// True for a block that may start compensation.
fn compensates(nc: &Nc) -> bool {
    nc.items
        .iter()
        .any(|item| matches!(item, NcItem::Op(Op::RadiusLeft | Op::RadiusRight) | NcItem::Code('G', _)))
}

/// True for a block that may start compensation by a radius that was named before.
fn looks(nc: &Nc) -> bool {
    compensates(nc) && nc.word(Role::RadiusOffset).is_none()
}

/// True where the radius stands as lowering names that of a length, and the block does not compensate by it.
fn comes_with_length(nc: &Nc) -> bool {
    let pair = nc.items.windows(2).any(|two| match two {
        [NcItem::Word(Role::LengthOffset, length), NcItem::Word(Role::RadiusOffset, radius)] => {
            length == radius
        }
        [NcItem::Op(Op::LengthOff), NcItem::Word(Role::RadiusOffset, Expr::Number(none))] => *none == 0.0,
        _ => false,
    });
    pair && !compensates(nc)
}

/// Whether the radius in force before a block may be looked at, where that of after it may.
fn before(nc: &Nc, skipped: bool, behind: bool) -> bool {
    if nc.word(Role::RadiusOffset).is_some() { skipped && behind } else { behind || looks(nc) }
}

/// What blocks do to whether the radius in force may be looked at; `elsewhere`: in what is called, and by callers.
struct LookedAt {
    elsewhere: bool,
}

impl Analysis for LookedAt {
    type State = bool;
    const DIRECTION: Direction = Direction::Backward;

    /// At the end of each block.
    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, bool)> {
        (0..cfg.len() as u32).map(|id| (BlockId(id), false)).collect()
    }

    fn block(&self, id: BlockId, block: &Block, looked_at: &mut bool) {
        self.stmts(id, block, looked_at);
    }
}

impl Steps for LookedAt {
    fn first(&self, _: BlockId, block: &Block, looked_at: &mut bool) {
        let leaves = matches!(block.term.kind, TermKind::Call { .. } | TermKind::Return { .. });
        *looked_at |= leaves && self.elsewhere;
    }

    fn stmt(&self, _: (BlockId, usize), stmt: &Stmt, looked_at: &mut bool) {
        if let Some(nc) = stmt.kind.nc() {
            *looked_at = before(nc, stmt.site.skip.is_some(), *looked_at);
        }
    }
}

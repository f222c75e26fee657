//! Taps in feed per turn, for a target without that mode.
//!
//! Law: a tap that feeds p a turn at S turns a minute feeds S * p a minute. Side conditions: all that cuts while the mode
//! is in force are taps; each of them begins with a speed and a feed that are known numbers, and neither changes until it
//! ends; what cuts after the mode has a feed of its own. Counter-example: a cut in feed per turn whose speed the operator
//! or another block changes. Where a side condition fails the mode stays, and is refused as a code that the target lacks.

use super::tap_leads::{Speed, Speeds};
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::features::Features;
use crate::legalize::moves::inverse_feeds::{goes, needs_no_feed};
use crate::legalize::{Context, Modal};
use std::collections::BTreeMap;

/// True if there are taps and feeds per turn, and the target has no code for the mode.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::FeedPerTurn)
        && features.any_op(Op::is_tap)
        && context.target.code_for(Op::FeedPerTurn, &BTreeMap::new()).is_none()
}

/// Says the taps of programs in feed per minute, where all side conditions hold.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let speeds = OverCalls::of(module, &Speeds);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let turns = |stmt: &Stmt| stmt.kind.has_op(Op::FeedPerTurn);
        if !program.blocks.iter().any(|block| block.stmts.iter().any(turns)) {
            continue;
        }
        let starts: Vec<(Modal, Speed)> = program
            .ids()
            .map(|id| (facts.at(index, id), speeds.at(index, id).copied().unwrap_or(Speed::Unknown)))
            .collect();
        if let Some(feeds) = feeds(program, &starts) {
            rewrite(program, &starts, feeds.into_iter());
            changed = true;
        }
    }
    changed
}

fn by_turn(state: &Modal) -> bool {
    state.op(Group::FeedMode) == Some(Op::FeedPerTurn)
}

/// The feed per minute of each tap that begins in feed per turn, in order; none where a side condition fails.
fn feeds(program: &Program, starts: &[(Modal, Speed)]) -> Option<Vec<f64>> {
    let mut found = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        let (mut state, mut speed) = starts.get(id.0 as usize)?.clone();
        for stmt in &block.stmts {
            state.step(stmt);
            speed.step(stmt);
            let Some(nc) = stmt.kind.nc() else {
                if by_turn(&state) && !matches!(stmt.kind, StmtKind::Comment | StmtKind::Assign { .. }) {
                    return None;
                }
                continue;
            };
            let skips = stmt.site.skip.is_some();
            if nc.has(Op::FeedPerTurn) || by_turn(&state) {
                if skips || !by_turn(&state) {
                    return None;
                }
                found.extend(turned(nc, &state, speed)?);
            } else if cuts(nc, &state) && nc.word(Role::Feed).is_none() && state.feed().is_none() {
                return None;
            }
        }
        let open = state.op(Group::FeedMode).is_none() || by_turn(&state);
        match block.term.kind {
            TermKind::End { .. } | TermKind::Jump(_) | TermKind::Branch { .. } => {}
            _ if open => return None,
            _ => {}
        }
    }
    Some(found)
}

/// The feed per minute of a tap that a block in feed per turn begins; nothing in the inner value for a block that begins
/// none. None where the block may not be so.
fn turned(nc: &Nc, state: &Modal, speed: Speed) -> Option<Option<f64>> {
    if nc.word(Role::Lead).is_some() {
        return None;
    }
    if nc.ops().any(Op::is_tap) {
        let feed = nc.word(Role::Feed).map_or(state.feed(), Expr::constant)?;
        let Speed::Known(speed) = speed else { return None };
        let surface = state.op(Group::SpeedMode) == Some(Op::SurfaceSpeed);
        return (feed > 0.0 && speed > 0.0 && !surface).then(|| Some((feed * speed * 1e6).round() / 1e6));
    }
    let taps = state.op(Group::Cycle).is_some_and(Op::is_tap);
    let counts = |item: &NcItem| matches!(item, NcItem::Word(Role::Feed | Role::Speed, _) | NcItem::Code(..));
    let fits = if taps { !nc.items.iter().any(counts) } else { !cuts(nc, state) };
    fits.then_some(None)
}

/// True where a block may cut at the feed in force.
fn cuts(nc: &Nc, state: &Modal) -> bool {
    let rapid = state.op(Group::Motion) == Some(Op::Rapid) && state.op(Group::Cycle) == Some(Op::CycleOff);
    nc.ops().any(Op::is_cycle) || goes(nc) && !rapid && !nc.ops().any(needs_no_feed)
}

/// Puts feed per minute in place of feed per turn.
fn rewrite(program: &mut Program, starts: &[(Modal, Speed)], mut feeds: impl Iterator<Item = f64>) {
    for (id, block) in (0..).map(BlockId).zip(&mut program.blocks) {
        let Some((mut state, _)) = starts.get(id.0 as usize).cloned() else { continue };
        for stmt in &mut block.stmts {
            state.step(stmt);
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            if !by_turn(&state) {
                continue;
            }
            for item in &mut nc.items {
                if *item == NcItem::Op(Op::FeedPerTurn) {
                    *item = NcItem::Op(Op::FeedPerMinute);
                }
            }
            nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Feed, _)));
            if nc.ops().any(Op::is_tap) {
                nc.items.extend(feeds.next().map(|feed| NcItem::Word(Role::Feed, Expr::Number(feed))));
            }
            if nc.items.is_empty() {
                stmt.kind = StmtKind::Comment;
            }
        }
    }
}

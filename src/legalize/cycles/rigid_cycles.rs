//! Rigid taps that are cycles of their own on one of the two controls.
//!
//! Law: such a cycle is a plain tap where all taps of the target are rigid, and a plain tap after the code for rigid taps where
//! the target has that one. The other way round, a tap that is rigid on the source becomes the target's cycle where its plain taps
//! are not. A code that only gets the spindle ready for such a cycle goes with it, and is written with it. Side conditions, else the tap is refused: the
//! speed is known for the code; the code for rigid taps stands in the way to the tap with no label between; a left-hand tap has no
//! such cycle. Counter-example: a plain tap in a rigid holder, which takes up no difference between feed and turns.

use super::rigid_taps::{SPEED, Told, always, code, ready, speed_word, told_before};
use super::tap_leads::{Speed, Speeds};
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{Block, BlockId, Module, Nc, NcItem, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

const PLAIN: Told = (
    "the tap is rigid here, and the target's are rigid by a code of their own, for which its table has none",
    "say what the target's code is under [[site]] in its machine profile, or tap with a holder that gives way",
);

const APART: Told = (
    "a label or a jump stands between the code for a rigid tap and the tap, so that it is not known which taps are rigid",
    "write the code right before the block of the tap",
);

const UNUSED: Told = (
    "this code gets the spindle ready for a rigid tap, and the next tap of the program is none",
    "take the code out, or write the rigid cycle",
);

/// True where taps are rigid by a cycle of their own on one side alone, or a code gets the spindle ready for them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let lacks = !has(context.target, Op::CycleTapRigid);
    context.target.machine() == Machine::Mill
        && (features.op(Op::TapReady)
            || features.op(Op::CycleTapRigid) && lacks
            || features.any_op(Op::is_tap) && by_cycle(context.target))
}

/// True where plain taps are not rigid, and no code makes them so.
fn by_cycle(control: &Control) -> bool {
    let by_code = control.behaviour(Question::TapRigid).is_some_and(|row| row.value == "code");
    by_code && !has(control, Op::RigidTaps)
}

fn has(control: &Control, op: Op) -> bool {
    control.code_for(op, &BTreeMap::new()).is_some()
}

/// Writes each rigid tap in the way of the target.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let speeds = OverCalls::of(module, &Speeds);
    let lacks = !has(context.target, Op::CycleTapRigid);
    let (all, by_cycle) = (always(context.source), by_cycle(context.target));
    // A parameter may make every tap of the source rigid.
    let said = context.source.behaviour(Question::TapRigid).map(|row| row.value.as_str());
    let unknown = !matches!(said, Some("always" | "code"));
    let (plain, coded) = (always(context.target), has(context.target, Op::RigidTaps));
    let rigid = context.features.op(Op::CycleTapRigid);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let waits = program.blocks.iter().any(ends_waiting);
        let readies = readies(&program.blocks, rigid);
        let mut found = Vec::new();
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let (mut state, mut speed) =
                (facts.at(index, id), speeds.at(index, id).copied().unwrap_or(Speed::Unknown));
            let mut asked = false;
            let stmts = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::replace(&mut block.stmts, stmts) {
                state.step(&stmt);
                speed.step(&stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else {
                    block.stmts.push(stmt);
                    continue;
                };
                if nc.has(Op::TapReady) && lacks {
                    changed = true;
                    nc.items.retain(|item| *item != NcItem::Op(Op::TapReady));
                    if nc.items.is_empty() {
                        stmt.kind = StmtKind::Comment;
                        if !stmt.site.comments.is_empty() || stmt.site.sequence.is_some() {
                            block.stmts.push(stmt);
                        }
                        continue;
                    }
                }
                asked |= nc.has(Op::RigidTaps);
                let taps = nc.ops().any(Op::is_tap);
                if nc.has(Op::CycleTapRigid) && lacks && (plain || coded) {
                    changed = true;
                    become_of(nc, Op::CycleTapRigid, Op::CycleTap);
                    let turns = state.op(Group::SpeedMode) != Some(Op::SurfaceSpeed);
                    match speed_word(speed, &stmt, context.target) {
                        _ if plain => {}
                        Some(speed) if turns => {
                            block.stmts.push(code(speed, &stmt));
                            told_before(&mut stmt, block.stmts.last());
                        }
                        _ => found.push((span, SPEED)),
                    }
                } else if taps && by_cycle && (all || asked) && !nc.has(Op::CycleTapRigid) {
                    changed |= become_of(nc, Op::CycleTap, Op::CycleTapRigid);
                    found.extend((!nc.has(Op::CycleTapRigid) || lacks).then_some((span, PLAIN)));
                    if !asked && has(context.target, Op::TapReady) {
                        changed = true;
                        block.stmts.push(ready(&stmt));
                    }
                } else if taps && by_cycle && waits && !nc.has(Op::CycleTapRigid) {
                    found.push((span, APART));
                } else if taps && by_cycle && unknown {
                    context.rests_on_source(index, span, Question::TapRigid);
                }
                asked &= !taps;
                block.stmts.push(stmt);
            }
        }
        found.extend(readies.into_iter().map(|span| (span, UNUSED)));
        for (span, (what, help)) in found {
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
        }
    }
    changed
}

/// Puts one operation in the place of another; false if it is not there.
fn become_of(nc: &mut Nc, from: Op, to: Op) -> bool {
    let mut found = false;
    for item in nc.items.iter_mut().filter(|item| **item == NcItem::Op(from)) {
        (*item, found) = (NcItem::Op(to), true);
    }
    found
}

/// True where the code for a rigid tap stands in a block, and its tap does not.
fn ends_waiting(block: &Block) -> bool {
    let mut waits = false;
    for nc in block.stmts.iter().filter_map(|stmt| stmt.kind.nc()) {
        waits = (waits || nc.has(Op::RigidTaps)) && !nc.ops().any(Op::is_tap);
    }
    waits
}

/// The codes that get the spindle ready for a rigid tap and are followed, in the text, by another tap; or by none, if the library
/// has no rigid one: that of a subroutine may stand before the code.
fn readies(blocks: &[Block], rigid: bool) -> Vec<crate::text::Span> {
    let mut open = None;
    let mut found = Vec::new();
    for stmt in blocks.iter().flat_map(|block| &block.stmts) {
        let Some(nc) = stmt.kind.nc() else { continue };
        if nc.has(Op::TapReady) {
            found.extend(open.replace(stmt.site.span));
        }
        if nc.ops().any(Op::is_tap) {
            found.extend(open.take().filter(|_| !nc.has(Op::CycleTapRigid)));
        }
    }
    found.extend(open.filter(|_| !rigid));
    found
}

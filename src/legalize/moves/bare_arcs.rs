//! Moves under an arc mode that name neither centre nor radius, or both.
//!
//! Law: such a block is what the control makes of it: a straight move, an alarm, the last radius. Where the source goes straight, the block
//! is written as a straight feed move, and the next arc names its code again. Where the tables of
//! both controls give the same other answer it stays as it is, for review where no maker confirms it; where they do not,
//! no other control can be told.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BlockId, Module, Nc, NcItem, Stmt, StmtKind};
use crate::legalize::Context;

/// Writes straight moves out, refuses other arcs that say nothing about their curve, and reports those that say it twice; true if
/// something was written.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let answer = |control: &crate::dialect::Control| {
        control
            .behaviour(Question::ArcWithoutCentre)
            .map(|row| row.value.clone())
            .filter(|value| value != "unknown")
    };
    let (here, there) = (answer(context.source), answer(context.target));
    let straight = here.as_deref() == Some("straight");
    let facts = context.modal_facts(module);
    let (mut bare, mut arcs) = (Vec::new(), Vec::new());
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for (number, stmt) in block.stmts.iter().enumerate() {
                let nc = stmt.kind.nc();
                // Words alone leave the motion as it is.
                if state.may_call() || !nc.is_some_and(Nc::is_words) {
                    state.step(stmt);
                }
                let Some(nc) = nc else { continue };
                let Some(arc) = state.op(Group::Motion).filter(|op| is_arc(*op)) else { continue };
                let span = stmt.site.span;
                if is_double(nc) {
                    let what = "an arc with both a centre and a radius: no source says which one counts. \
                                Leave one of them out";
                    context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
                }
                if drills(nc, state.op(Group::Cycle)) || context.is_faulty(index, span) {
                    continue;
                }
                let place = (index, at, number);
                if !is_bare(nc) {
                    let own = nc.ops().any(|op| op.group() == Group::Motion);
                    arcs.extend((!own && nc.moves() && says_curve(nc)).then_some((place, arc)));
                } else if straight {
                    bare.push(place);
                } else if here.is_some() && here == there {
                    context.rests_on_source(index, span, Question::ArcWithoutCentre);
                    context.rests_on_target(index, span, Question::ArcWithoutCentre);
                } else {
                    let what = "no source says what a move under an arc code does without centre and \
                                radius: write I, J, K or R, or G1";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                }
            }
        }
    }
    let changed = !bare.is_empty();
    for (index, at, number) in bare {
        let stmt = &mut module.programs[index].blocks[at].stmts[number];
        let span = stmt.site.span;
        name(stmt, Op::Linear);
        context.add_once(index, STRAIGHT, Diagnostic::new(Code::WrittenOut, span, STRAIGHT));
    }
    for ((index, at, number), arc) in arcs.into_iter().filter(|_| changed) {
        name(&mut module.programs[index].blocks[at].stmts[number], arc);
    }
    changed
}

const STRAIGHT: &str = "a move under an arc code without centre and radius goes straight to its end, as the source's profile says: it is written as a \
     straight feed move";

/// Names the code of a move in its block.
fn name(stmt: &mut Stmt, op: Op) {
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    nc.items.retain(|item| !matches!(item, NcItem::Op(own) if own.group() == Group::Motion));
    nc.items.insert(0, NcItem::Op(op));
}

fn is_arc(op: Op) -> bool {
    matches!(op, Op::ArcCw | Op::ArcCcw)
}

const CENTRE: [Role; 3] = [Role::ArcI, Role::ArcJ, Role::ArcK];

fn has_centre(nc: &Nc) -> bool {
    CENTRE.iter().any(|role| nc.word(*role).is_some())
}

fn says_curve(nc: &Nc) -> bool {
    has_centre(nc) || nc.word(Role::ArcRadius).is_some()
}

fn is_double(nc: &Nc) -> bool {
    has_centre(nc) && nc.word(Role::ArcRadius).is_some()
}

/// True for the place of a hole: a cycle is in force after the block, and no code of a move stands in it.
fn drills(nc: &Nc, after: Option<Op>) -> bool {
    after.is_some_and(Op::is_cycle) && !nc.ops().any(|op| op.group() == Group::Motion)
}

fn is_bare(nc: &Nc) -> bool {
    let elsewhere = [Op::ReferenceReturn, Op::MachineOnce];
    nc.moves()
        && !has_centre(nc)
        && nc.word(Role::ArcRadius).is_none()
        && !nc.ops().any(|op| {
            // The axis words of a cycle are its own, whatever interpolation is in force.
            elsewhere.contains(&op) || op.is_lathe_cycle() || op.is_lathe_setup() || op.takes_axes()
        })
}

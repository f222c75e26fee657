//! M, S and T alone in a block while a turning, threading or facing pass is in force.
//!
//! Law: a control that makes the pass once more for such a block gets no word; for another target the end of the pass is written beside it. Side
//! condition: the end is a number, told in the same run of blocks. Counter-example: `X40. M8`, which makes a pass on every control.

use crate::canon::{Group, Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if there are such passes and a table asks what they do.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let controls = [context.source, context.target];
    let asks = controls.iter().any(|control| control.behaviour(Question::PassAlone).is_some());
    asks && features.any_op(Op::is_pass)
}

/// Writes the ends, and says what rests on the controls; true where something was written.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let again = repeats(context.source) && !repeats(context.target);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            let mut end = None;
            for stmt in &mut block.stmts {
                state.step(stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if !state.op(Group::Motion).is_some_and(Op::is_pass) {
                    end = None;
                    continue;
                }
                if !switches_alone(nc) {
                    if nc.items.iter().any(is_end) {
                        end = end_of(nc);
                    }
                    continue;
                }
                context.rests_on_source(index, span, Question::PassAlone);
                context.rests_on_target(index, span, Question::PassAlone);
                if let Some(end) = end.clone().filter(|_| again) {
                    nc.items.push(end);
                    changed = true;
                } else {
                    context.must_agree(index, span, Question::PassAlone);
                }
            }
        }
    }
    changed
}

/// True where it is known to make the pass once more.
fn repeats(control: &Control) -> bool {
    control.behaviour(Question::PassAlone).is_some_and(|row| row.value == "repeats")
}

/// The word that makes the same pass again, if it is a number.
fn end_of(nc: &Nc) -> Option<NcItem> {
    let item = nc.items.iter().rev().find(|item| is_end(item))?;
    matches!(item, NcItem::Word(_, value) if value.constant().is_some()).then(|| item.clone())
}

fn is_end(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(Role::X | Role::StepX, _))
}

/// True for M, S or T without an axis, or another code than a wait or one of motion.
fn switches_alone(nc: &Nc) -> bool {
    let told = nc.ops().any(|op| op != Op::Dwell && op.group() != Group::Motion)
        || nc.word(Role::Speed).is_some()
        || nc.word(Role::Tool).is_some();
    let passes = nc.names_axis() || nc.word(Role::Taper).is_some() || nc.word(Role::TaperZ).is_some();
    told && !passes && !nc.ops().any(|op| op.group() == Group::Motion || op == Op::ReferenceReturn)
}

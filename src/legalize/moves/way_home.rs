//! Z0 without a tool length, which is the way home on machines whose lengths are measured from there.
//!
//! Law: where the profile of the source says so (`length.off.zero`), a rapid move to Z0 with no length in force becomes a move to
//! Z0 in machine coordinates. Z of each work offset is 0 there. Where nobody says what it is, it is asked. Side conditions: no other
//! axis in the block, absolute coordinates, no shift of the work beside its offset; else a person has to look.
//! Counter-example: `G0 G49 Z0` on a machine whose lengths are gauge lengths, which takes the nose of the spindle to the part.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::{Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::assumptions::shop::are_mills;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

const QUESTION: Question = Question::LengthOffZero;

/// True for mills whose programs use tool lengths and cancel them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let lengths = features.op(Op::LengthPlus) || features.op(Op::LengthMinus);
    let answer = context.source.behaviour(QUESTION).map(|row| row.value.clone());
    are_mills(context)
        && lengths
        && features.op(Op::LengthOff)
        && answer.as_deref() != Some("offset")
        && !context.source.is_same_machine(context.target)
}

const BESIDE: &str = "Z0 without a tool length is home on the old machine, and something else stands in the block: write G53 Z0 into a \
                      block of its own before it";

/// Writes the moves, or asks.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    let facts = context.modal_facts(module);
    let home = context.source.behaviour(QUESTION).is_some_and(|row| row.value == "home");
    let features = Features::of(&module.programs);
    let shifted =
        [Op::SetPosition, Op::LocalShift, Op::ScaleOn, Op::MirrorOn].iter().any(|op| features.op(*op));
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        state.step(&stmt);
        if let StmtKind::Nc(nc) = &mut stmt.kind
            && goes_home(nc, state)
        {
            let span = stmt.site.span;
            if !home {
                context.unconfirmed(index, Side::Source, span, QUESTION.fact(), QUESTION.meaning());
            } else if shifted || !is_plain(nc) {
                context.add(index, Diagnostic::new(Code::Conditional, span, BESIDE));
            } else {
                let at = nc.items.iter().position(|item| matches!(item, NcItem::Word(..))).unwrap_or(0);
                nc.items.insert(at, NcItem::Op(Op::MachineOnce));
                changed = true;
            }
        }
        out.push(stmt);
    });
    changed
}

/// True for a rapid move to Z0 in a work offset, with no length in force.
fn goes_home(nc: &Nc, state: &Modal) -> bool {
    nc.word(Role::Z).and_then(Expr::constant) == Some(0.0)
        && state.op(Group::LengthComp) == Some(Op::LengthOff)
        && state.op(Group::Motion) == Some(Op::Rapid)
        && state.op(Group::Distance) != Some(Op::Incremental)
        && state.op(Group::WorkOffset) != Some(Op::ShiftCancel)
        && !nc.has(Op::MachineOnce)
        && !nc.ops().any(|op| op.takes_axes() || op.is_return() || op.is_cycle())
}

/// True for a block that may become one in machine coordinates.
fn is_plain(nc: &Nc) -> bool {
    nc.items.iter().all(|item| match item {
        NcItem::Op(op) => {
            matches!(op, Op::Rapid | Op::LengthOff | Op::Absolute | Op::CycleOff)
                || matches!(op.group(), Group::Spindle | Group::Coolant)
        }
        NcItem::Word(role, _) => {
            matches!(role, Role::Z | Role::LengthOffset | Role::RadiusOffset | Role::Speed)
        }
        NcItem::Code(..) => false,
    })
}

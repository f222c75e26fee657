//! Places and increments in one block, on a target whose code for one of the two counts for the whole block.
//!
//! Law: an axis that goes some way from where it is goes to the place that was named last, plus that way. Side condition: the
//! program has named that place in words that still have the value they had then. Counter-example: `G90 X2. G91 Y1.` after a
//! call, where nobody knows Y: it is refused.

use crate::canon::{Group, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Machine;
use crate::ir::analysis::Summaries;
use crate::ir::analysis::programmed::Programmed;
use crate::ir::{BinOp, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True between mills, if a block has both.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.source.machine() == Machine::Mill && Role::STEPS.iter().any(|(_, step)| features.role(*step))
}

/// Makes places of the increments; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let summaries = Summaries::of(module);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let starts = Programmed::of(program, &summaries, &|id| facts.at(index, id));
        for (id, block) in program.ids().zip(program.blocks.iter_mut()).collect::<Vec<_>>() {
            let mut state = facts.at(index, id);
            let mut here = starts.at(id).cloned();
            for stmt in &mut block.stmts {
                let turned = state.op(Group::Rotation).is_some_and(|op| op != crate::canon::Op::RotateOff);
                if let StmtKind::Nc(nc) = &mut stmt.kind
                    && nc.items.iter().any(is_step)
                {
                    let known = here.as_ref().filter(|_| !turned).map(Programmed::axes).unwrap_or_default();
                    if !to_places(nc, &known) {
                        let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, BOTH);
                        context.add(index, finding.with_help(HELP));
                    }
                    changed = true;
                }
                state.step(stmt);
                if let Some(here) = &mut here {
                    here.step(stmt, &state, &summaries);
                }
            }
        }
    }
    changed
}

fn is_step(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(role, _) if role.is_step())
}

/// Makes places of increments; false where one of the axes is at no known place.
fn to_places(nc: &mut Nc, known: &[Option<Expr>; 2]) -> bool {
    let mut all = true;
    for item in &mut nc.items {
        let NcItem::Word(role, by) = item else { continue };
        let Some((whole, _)) = Role::STEPS.into_iter().find(|(_, step)| step == role) else { continue };
        *role = whole;
        let from = match whole {
            Role::X => known[0].clone(),
            Role::Y => known[1].clone(),
            _ => None,
        };
        match from {
            Some(from) => *by = plus(from, by.clone()),
            None => all = false,
        }
    }
    all
}

fn plus(from: Expr, by: Expr) -> Expr {
    match (from.constant(), by.constant()) {
        (Some(from), Some(by)) => Expr::Number(((from + by) * 1e6).round() / 1e6),
        _ => Expr::binary(BinOp::Add, from, by),
    }
}

const BOTH: &str = "G90 counts for some words of this block, and G91 for others, and where the tool stands is not known here: on the \
                    target one of the two counts for the whole block";
const HELP: &str = "write the block with one of the two, or name X and Y as places right before it";

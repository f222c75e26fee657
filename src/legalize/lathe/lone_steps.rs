//! Increments of an axis for which the target has no letter, and no mode either.
//!
//! Law: a word that moves its axis by some way moves it to where the block before ended, plus that way. Side condition: the target has a variable
//! for where the block before ended, and the block moves by its words. Counter-example: `V-4.` beside a pass, whose words are no places.

use super::steps::has_letters;
use crate::canon::{Op, Role, Sys};
use crate::dialect::Control;
use crate::ir::{BinOp, Expr, Nc, NcItem, Program, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where an increment has no letter on a target that has letters for others.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let target = context.target;
    has_letters(target) && Role::STEPS.iter().any(|(_, step)| features.role(*step) && lacks(target, *step))
}

fn lacks(control: &Control, step: Role) -> bool {
    control.dialect().words.iter().all(|row| row.role != step)
}

/// Makes places of them; true if there were any.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let target = context.target;
    if target.system_runs(Sys::EndPosition).next().is_none() {
        return false;
    }
    let mut changed = false;
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        if moves(nc) {
            changed |= to_places(nc, target);
        }
    }
    changed
}

/// True for a block whose words say where the tool goes.
fn moves(nc: &Nc) -> bool {
    !nc.ops().any(|op| {
        let cycle = op.is_lathe_cycle() || op.is_lathe_setup() || op.is_pass() || op.is_cycle();
        cycle || op.acts_with_words() || op == Op::MachineOnce
    })
}

fn to_places(nc: &mut Nc, target: &Control) -> bool {
    let mut changed = false;
    for item in &mut nc.items {
        let NcItem::Word(role, value) = item else { continue };
        let pair = Role::STEPS.into_iter().find(|(_, step)| step == role && lacks(target, *step));
        let Some((whole, number)) = pair.and_then(|(whole, _)| Some((whole, whole.axis_number()?))) else {
            continue;
        };
        let here = Expr::System(Sys::EndPosition, [Expr::Number(f64::from(number))].into());
        let to = match value.constant() {
            Some(0.0) => here,
            Some(by) if by < 0.0 => Expr::binary(BinOp::Sub, here, Expr::Number(-by)),
            _ => Expr::binary(BinOp::Add, here, value.clone()),
        };
        *item = NcItem::Word(whole, to);
        changed = true;
    }
    changed
}

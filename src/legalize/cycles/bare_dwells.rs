//! Dwells without a time, on a target whose word for the time means something else by itself.
//!
//! Law: a dwell without a time waits for none, and so does one of 0. Where the letter of the time has another meaning
//! elsewhere (`F`, a feed), a control may take what that was last for the time, so 0 is written. Side condition: none.
//! Counter-example: `G1 X5 F100`, `G4`, which may wait a hundred seconds.

use crate::canon::{Op, Role};
use crate::ir::{Expr, NcItem, Program, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

/// True if the library waits, and every letter of the time has another meaning by itself.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::Dwell) && time(context).is_some()
}

/// The role that 0 is written in.
fn time(context: &Context<'_>) -> Option<Role> {
    let target = context.target;
    let code = target.code_for(Op::Dwell, &BTreeMap::new())?;
    let letters = [Role::DwellS, Role::DwellMs].map(|role| (role, target.letter(role, Some(code))));
    let other = |role, (letter, comma)| target.word(letter, comma).is_some_and(|row| row.role != role);
    let there = || letters.iter().filter_map(|(role, letter)| Some((*role, (*letter)?)));
    let (role, _) = there().next()?;
    there().all(|(role, letter)| other(role, letter)).then_some(role)
}

/// Gives dwells a time; true if one had none.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let Some(role) = time(context) else { return false };
    let mut changed = false;
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        if let StmtKind::Nc(nc) = &mut stmt.kind
            && nc.has(Op::Dwell)
            && nc.word(Role::DwellS).or(nc.word(Role::DwellMs)).is_none()
        {
            nc.items.push(NcItem::Word(role, Expr::Number(0.0)));
            changed = true;
        }
    }
    changed
}

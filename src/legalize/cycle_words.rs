//! The words of drilling cycles that one control's code takes and the other's does not.
//!
//! Law: what a cycle is told lasts for the cycles behind it, until cycles are cancelled, and a cycle does nothing with
//! a word that its code does not take. So where only the target's code takes a dwell, it is told one of 0, and the
//! dwell of before is told again where the next code that takes one has none of its own. A word that only the
//! source's code takes is refused, and so is a dwell of before that only the source's code takes; a dwell of 0 is left
//! out. Side condition: which cycle is in force is known. Counter-example: `G82 P500 .. G83`, where the source's G83
//! takes no P and the target's waits half a second.

use super::{Context, ModalFacts};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, StmtKind};
use std::collections::BTreeMap;

/// The words of a cycle but for its planes, which every cycle has.
pub const ROLES: [Role; 8] = [
    Role::CycleDwell,
    Role::CycleQ,
    Role::CycleI,
    Role::CycleJ,
    Role::PeckFirst,
    Role::PeckLess,
    Role::PeckLeast,
    Role::PeckClear,
];

/// Fits the words of cycles to what the target's codes take.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = ModalFacts::of(module, &context.entry);
    for (index, program) in module.programs.iter_mut().enumerate() {
        // The dwell of before in the order of the text, and whether it was taken away on the target.
        let (mut last, mut away): (Option<Expr>, bool) = (None, false);
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                let before = state.op(Group::Cycle);
                state.step(stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                let Some(op) = state.op(Group::Cycle) else { continue };
                if !op.is_cycle() {
                    (last, away) = (None, false);
                    continue;
                }
                if before == Some(Op::CycleOff) {
                    (last, away) = (None, false);
                }
                for role in untaken(nc, op, context.target) {
                    let what = format!("the target's code for this cycle ({op}) takes no such word ({role})");
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                }
                last = nc.word(Role::CycleDwell).cloned().or(last);
                let [own, others] =
                    [context.source, context.target].map(|control| takes(control, op, Role::CycleDwell));
                let begins = nc.ops().any(Op::is_cycle) && nc.word(Role::CycleDwell).is_none();
                let waits = last.as_ref().is_some_and(|dwell| dwell.constant() != Some(0.0));
                if begins && own && !others && waits {
                    let what = format!(
                        "the dwell of the cycle before lasts into this one ({op}), and the target's code takes none"
                    );
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                }
                if !begins || !others {
                    away &= nc.word(Role::CycleDwell).is_none();
                    continue;
                }
                let dwell = match (own, &last) {
                    (false, _) if before != Some(Op::CycleOff) => Expr::Number(0.0),
                    (true, Some(last)) if away => last.clone(),
                    _ => continue,
                };
                away = !own;
                if own && dwell.constant().is_none() {
                    let what = "the dwell of the cycle before it: what it is computed from may have changed";
                    context.add(index, Diagnostic::new(Code::Conditional, span, what));
                }
                nc.items.push(NcItem::Word(Role::CycleDwell, dwell));
            }
        }
    }
}

/// True where the code that the control has for a cycle takes a word.
fn takes(control: &Control, op: Op, role: Role) -> bool {
    control.code_for(op, &BTreeMap::new()).is_some_and(|row| row.takes(role))
}

/// The words of a block that the target's code does not take. A dwell of 0 is left out.
fn untaken(nc: &mut Nc, op: Op, target: &Control) -> Vec<Role> {
    let Some(row) = target.code_for(op, &BTreeMap::new()) else { return Vec::new() };
    let none = |item: &NcItem| matches!(item, NcItem::Word(Role::CycleDwell, value) if value.constant() == Some(0.0));
    nc.items.retain(|item| row.takes(Role::CycleDwell) || !none(item));
    ROLES.into_iter().filter(|role| nc.word(*role).is_some() && !row.takes(*role)).collect()
}

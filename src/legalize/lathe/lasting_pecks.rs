//! Holes of a lathe without a peck of their own, in a cycle that had one (docs/lathe.md Q7).
//!
//! Law: where a control has one code for holes with pecks and without, a hole without Q is drilled in one go, or with the peck of its cycle, as
//! the profile of the source says; what no source confirms is asked once. Where the peck lasts, it is written into each of its holes. Side
//! condition: it is a number, told on the only way to the hole. Counter-example: `C90.` after a label, in a cycle that another block began.

use super::holes::{drills, tells_by_step};
use super::straight::{entered_straight, returns_into};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Expr, Module, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

/// True where the source has one code for all drilling along an axis, and some hole has a peck.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(|op| matches!(op, Op::FaceHole | Op::SideHole))
        && features.role(Role::CycleQ)
        && tells_by_step(context.source)
}

/// What is known of the peck of the cycle in force.
#[derive(Clone, Debug, Default)]
struct Known {
    /// Whether a hole of it had one; none if that is not known.
    had: Option<bool>,
    /// The one that was told last, if that is a number.
    peck: Option<Expr>,
}

/// Writes pecks that last, and asks how long they do.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let answer = context.source.behaviour(Question::HolePeckLasts).map(|row| row.value.clone());
    let lasts = answer.as_deref() == Some("lasts");
    let both = tells_by_step(context.target);
    let facts = context.modal_facts(module);
    let numbers_are_entered = returns_into(module);
    let (mut found, mut lost) = (BTreeSet::new(), BTreeSet::new());
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let straight = entered_straight(program);
        let mut known = Known::default();
        for ((id, block), straight) in program.ids().zip(&mut program.blocks).zip(straight) {
            let mut state = facts.at(index, id);
            if !straight || numbers_are_entered {
                known = Known::default();
            }
            for stmt in &mut block.stmts {
                let fresh = state.op(Group::Cycle) == Some(Op::CycleOff);
                state.step(stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                let Some(Op::FaceHole | Op::SideHole) = drills(nc, &state) else { continue };
                if fresh {
                    known = Known { had: Some(false), peck: None };
                }
                if let Some(peck) = nc.word(Role::CycleQ) {
                    let number = Some(peck.clone())
                        .filter(|peck| matches!(peck, Expr::Number(_) | Expr::Increments(_)));
                    let none = matches!(peck, Expr::Number(0.0) | Expr::Increments(0.0));
                    known = Known { had: Some(!none), peck: number };
                    if stmt.site.skip.is_some() {
                        known = Known::default();
                    }
                } else if known.had != Some(false) {
                    found.insert((index, span));
                    match known.peck.clone().filter(|_| lasts) {
                        Some(peck) => {
                            nc.items.push(NcItem::Word(Role::CycleQ, peck));
                            changed = true;
                        }
                        None if lasts => drop(lost.insert((index, span))),
                        None => {}
                    }
                }
            }
        }
    }
    for (index, span) in found {
        context.rests_on_source(index, span, Question::HolePeckLasts);
        if both && !lasts {
            context.must_agree(index, span, Question::HolePeckLasts);
        }
    }
    for (index, span) in lost {
        let told = Diagnostic::new(Code::NoEquivalent, span, LOST).with_help("write Q into this block");
        context.add_once(index, LOST, told);
    }
    changed
}

const LOST: &str =
    "the peck of this hole is that of an earlier one of its cycle, which is computed or not known here";

//! Tapping by speed and lead, where the target's cycle takes speed and feed.
//!
//! Law: a tap that turns S times a minute and advances the lead p each turn feeds S * p a minute. Side conditions:
//! the block has both words; feed is per minute on the target. Counter-example: under feed per turn the
//! feed word is the lead itself. The feed that was in force is said again where the cycle ends, for the source's
//! tap leaves it alone; where it is not a known number, that is a review diagnostic.

use super::{Context, ModalFacts};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{BinOp, BlockId, Expr, Module, Nc, NcItem, StmtKind};

const STAYS: &str = "the feed of the tapping cycle stays in force behind it: write the feed again there";

/// Gives tapping cycles a feed for their lead.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if context.target.behaviour("cycle.tap.feed").is_some_and(|row| row.value == "lead") {
        return;
    }
    let taps = |nc: &Nc| nc.ops().any(is_tap) && nc.word(Role::Lead).is_some();
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    if !stmts().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if taps(nc))) {
        return;
    }
    let facts = ModalFacts::of(module, &context.entry);
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                let tapped = state.op(Group::Cycle).is_some_and(is_tap);
                let feed = state.feed();
                state.step(stmt);
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if !nc.ops().any(is_tap) {
                    let ends = tapped && !state.op(Group::Cycle).is_some_and(is_tap);
                    if ends && nc.word(Role::Feed).is_none() {
                        match feed {
                            Some(feed) => nc.items.push(NcItem::Word(Role::Feed, Expr::Number(feed))),
                            None => {
                                context.add(index, Diagnostic::new(Code::Conditional, stmt.site.span, STAYS))
                            }
                        }
                    }
                    continue;
                }
                let (speed, lead) = (nc.word(Role::Speed).cloned(), nc.word(Role::Lead).cloned());
                let Some(lead) = lead else { continue };
                let (code, what) = match speed {
                    Some(speed) if state.op(Group::FeedMode) != Some(Op::FeedPerTurn) => {
                        set_feed(nc, speed, lead);
                        (
                            Code::Conditional,
                            "the cycle's feed is its speed times its lead, in feed per minute",
                        )
                    }
                    _ => (
                        Code::NoEquivalent,
                        "a tapping cycle without a speed beside its lead, or in feed per turn",
                    ),
                };
                context.add(index, Diagnostic::new(code, stmt.site.span, what));
            }
        }
    }
}

fn is_tap(op: Op) -> bool {
    matches!(op, Op::CycleTap | Op::CycleTapLeft | Op::CycleTapRigid | Op::CycleTapByLead)
}

fn set_feed(nc: &mut Nc, speed: Expr, lead: Expr) {
    let feed = match (speed.constant(), lead.constant()) {
        (Some(speed), Some(lead)) => Expr::Number(speed * lead),
        _ => Expr::Binary(BinOp::Mul, Box::new(speed), Box::new(lead)),
    };
    for item in &mut nc.items {
        match item {
            NcItem::Op(op) if *op == Op::CycleTapByLead => *op = Op::CycleTap,
            NcItem::Word(role, value) if *role == Role::Lead => {
                *role = Role::Feed;
                *value = feed.clone();
            }
            _ => {}
        }
    }
}

//! Tapping by speed and lead, where the target's cycle takes speed and feed.
//!
//! Law: a tap that turns S times a minute and advances the lead p each turn feeds S * p a minute. Side conditions:
//! the block has both words; feed is per minute on the target. Counter-example: under feed per turn the
//! feed word is the lead itself. The feed that was in force is said again where the cycle ends, for the source's
//! tap leaves it alone. Where it is not a known number, the target reads it before the tap and says that, if it can and
//! every way to the end of the cycle came by the reading; else that is a review diagnostic. A tap that is told no lead is refused: the
//! feed that is in force was meant for something else.

mod kept;

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BinOp, BlockId, Expr, Module, Nc, NcItem, StmtKind, Stmts};
use crate::legalize::Context;
use kept::{Does, Kept};

const STAYS: &str = "the feed of the tapping cycle stays in force after it: write the feed again there";

/// Gives tapping cycles a feed for their lead.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    leadless(module, context);
    if !context.features.role(Role::Lead) {
        return;
    }
    if context.target.behaviour(Question::CycleTapFeed).is_some_and(|row| row.value == "lead") {
        return;
    }
    let taps = |nc: &Nc| nc.ops().any(Op::is_tap) && nc.word(Role::Lead).is_some();
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    if !stmts().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if taps(nc))) {
        return;
    }
    let facts = context.modal_facts(module);
    let kept = Kept::of(module, &facts, context.target);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let register = kept.register(index);
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let (mut state, mut in_force) = (facts.at(index, id), kept.at(index, id));
            let stmts = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::replace(&mut block.stmts, stmts) {
                let does = kept.step(&stmt, &mut state, &mut in_force);
                let span = stmt.site.span;
                if let StmtKind::Nc(nc) = &mut stmt.kind {
                    if nc.ops().any(Op::is_tap)
                        && let Some((code, what)) = give_feed(nc, state.op(Group::FeedMode))
                    {
                        context.add(index, Diagnostic::new(code, span, what));
                    }
                    let feed = match (does, register) {
                        (Does::Says(feed), _) => Some(Expr::Number(feed)),
                        (Does::SaysHeld, Some(register)) => Some(Expr::Var(register)),
                        _ => None,
                    };
                    nc.items.extend(feed.map(|feed| NcItem::Word(Role::Feed, feed)));
                }
                match (does, register) {
                    (Does::Reads, Some(register)) => block.stmts.push(Kept::reading(register, &stmt)),
                    (Does::Fails, _) => context.add(index, Diagnostic::new(Code::Conditional, span, STAYS)),
                    _ => {}
                }
                block.stmts.push(stmt);
            }
        }
    }
}

/// Refuses taps that are told no lead on a control that takes it from them: it would be a feed that was meant for something else.
fn leadless(module: &Module, context: &mut Context<'_>) {
    let by_lead = |row: &str| row == "lead";
    if !context.source.behaviour(Question::CycleTapFeed).is_some_and(|row| by_lead(&row.value)) {
        return;
    }
    let what = "this tap is told no lead, so it is not known how far it goes in a turn";
    let help = "write the lead into its block (Q); if F is its feed and S its speed, the machine has another format than its \
                profile says";
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if nc.ops().any(Op::is_tap) && nc.word(Role::Lead).is_none() {
                let told = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what);
                context.add(index, told.with_help(help));
            }
        }
    }
}

/// Gives a tap by its lead a feed, and says on what condition.
fn give_feed(nc: &mut Nc, mode: Option<Op>) -> Option<(Code, &'static str)> {
    let (speed, lead) = (nc.word(Role::Speed).cloned(), nc.word(Role::Lead).cloned()?);
    Some(match speed {
        Some(speed) if mode != Some(Op::FeedPerTurn) => {
            set_feed(nc, speed, lead);
            (Code::Conditional, "the cycle's feed is its speed times its lead, in feed per minute")
        }
        _ => (
            Code::NoEquivalent,
            "a tapping cycle by its lead, without a speed in its block or in feed \
                                   per turn",
        ),
    })
}

fn set_feed(nc: &mut Nc, speed: Expr, lead: Expr) {
    let feed = match (speed.constant(), lead.constant()) {
        (Some(speed), Some(lead)) => Expr::Number(speed * lead),
        _ => Expr::binary(BinOp::Mul, speed, lead),
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

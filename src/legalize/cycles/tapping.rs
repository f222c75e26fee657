//! Tapping by speed and lead, where the target's cycle takes speed and feed.
//!
//! Law: a tap that turns S times a minute and advances the lead p each turn feeds S * p a minute. Side conditions:
//! the block has both words; feed is per minute. Where nobody names how feeds count, they count so, as in all other blocks, unless
//! the library has a code for another way. Counter-example: under feed per turn the feed word is the lead itself.
//! Under feed per turn the lead is the feed as it stands. A tap whose block says no speed turns by the one in force.
//! A later hole that changes one of the two gets the feed of both, where its block follows the cycle's own.
//! The feed that was in force is said again where the cycle ends, for the source's tap leaves it alone. Where it is not a known
//! number, the target reads it before the tap and says that, if it can and every way to the end of the cycle came by the
//! reading; else what cuts by it is a review diagnostic. A feed that is left at the end of a run is told once for a library.

mod kept;
mod touched;

use super::rigid_taps::{speed_word, told_before};
use super::tap_leads::{Speed, Speeds, by_lead};
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{BinOp, BlockId, Expr, Module, Nc, NcItem, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::text::Span;
use kept::{Does, Ends, Kept};

const ONLY: &str = "a tapping cycle by its lead, and its speed is not known here, or it is not in feed per minute: write S into its block";

const UNDER: &str = "a speed or a lead under a tapping cycle that an earlier block told the other: write the cycle again with both";

const SKIPPED: &str = "a tap by its lead with a block skip: which feed is in force after it hangs on the switch. Write it without the skip";

const IN_MINUTES: &str = "the cycle's feed is its speed times its lead, in feed per minute: write G94 before it, if that is in force here";

const STAYS: &str =
    "the feed of a tapping cycle before this may still be in force here: write the feed again";

const LEFT: &str = "the feed of a tapping cycle is left in force at the end of the run, on the source the one from before it: the next \
     program must write F before it cuts";

/// Gives tapping cycles a feed for their lead.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if context.target.behaviour(Question::CycleTapFeed).is_some_and(|row| row.value == "lead") {
        return;
    }
    let taps = |nc: &Nc| nc.ops().any(Op::is_tap) && nc.word(Role::Lead).is_some();
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    if !stmts().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if taps(nc))) {
        return;
    }
    let by_lead = by_lead(context.source);
    let one_mode = !context.features.any_op(|op| matches!(op, Op::FeedPerTurn | Op::FeedInverse));
    let facts = context.modal_facts(module);
    let kept = Kept::of(module, &facts, context.target, by_lead);
    let speeds = OverCalls::of(module, &Speeds);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let register = kept.register(index);
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let (mut state, mut in_force) = (facts.at(index, id), kept.at(index, id));
            let mut speed = speeds.at(index, id).copied().unwrap_or(Speed::Unknown);
            let (mut told, mut leads) = (None, true);
            let stmts = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::replace(&mut block.stmts, stmts) {
                let was = state.op(Group::Cycle);
                let does = kept.step(&stmt, &mut state, &mut in_force);
                let span = stmt.site.span;
                let stays = was.is_some_and(Op::is_tap) && state.op(Group::Cycle) == was;
                let skipped = stmt.site.skip.is_some();
                let after = speed.after(&stmt);
                let before = std::mem::replace(&mut speed, after);
                let in_force = speed_word(speed, &stmt, context.target);
                if let StmtKind::Nc(nc) = &mut stmt.kind {
                    let faster = nc.word(Role::Speed).is_some()
                        && (by_lead || leads && (before != speed || speed == Speed::Unknown));
                    if skipped && taps(nc) && !by_lead {
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, SKIPPED));
                    }
                    if nc.ops().any(Op::is_tap) {
                        told = Told::of(nc).filter(|_| !skipped);
                        leads = nc.word(Role::Lead).is_some() || skipped && leads;
                    } else if stays
                        && (faster || nc.word(Role::Lead).is_some())
                        && (skipped || !told.as_mut().is_some_and(|told: &mut Told| told.changes(nc)))
                    {
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, UNDER));
                    }
                    if nc.ops().any(Op::is_tap)
                        && let Some((code, what)) =
                            give_feed(nc, in_force, state.op(Group::FeedMode), one_mode)
                    {
                        context.add(index, Diagnostic::new(code, span, what));
                    }
                    let feed = match (does, register) {
                        (Does::Says(feed), _) => Some(Expr::Number(feed)),
                        (Does::SaysHeld, Some(register)) => Some(Expr::Var(register)),
                        _ => None,
                    };
                    nc.items.extend(feed.map(|feed| NcItem::Word(Role::Feed, feed)));
                    told_before(&mut stmt, block.stmts.last());
                }
                match (does, register) {
                    (Does::Reads, Some(register)) => read(&mut block.stmts, Kept::reading(register, &stmt)),
                    (Does::Fails, _) => context.add(index, of_tap_feed(span, STAYS)),
                    _ => {}
                }
                block.stmts.push(stmt);
            }
            let span = block.term.site.span;
            match kept.ends(index, id, &block.term.kind, in_force) {
                Some(Ends::Run) => context.add_once(index, LEFT, of_tap_feed(span, LEFT).asked_once()),
                Some(Ends::Unknown) => context.add(index, of_tap_feed(span, STAYS)),
                None => {}
            }
        }
    }
}

/// A finding about the feed that a tap leaves. What differs by it at the end of a run is told so, and not again.
fn of_tap_feed(span: Span, what: &'static str) -> Diagnostic {
    Diagnostic::new(Code::Conditional, span, what).assuming(Predicate::Substitute(Op::CycleTapByLead))
}

/// The speed and the lead of a tap that follows no code of its own to be rigid, as its block tells both.
struct Told {
    speed: f64,
    lead: f64,
}

impl Told {
    fn of(nc: &Nc) -> Option<Self> {
        let number = |role| nc.word(role).and_then(Expr::constant);
        let told = Self { speed: number(Role::Speed)?, lead: number(Role::Lead)? };
        nc.has(Op::CycleTapByLead).then_some(told)
    }

    /// Gives the block of a later hole the feed of its speed and its lead; false if one of them is computed.
    fn changes(&mut self, nc: &mut Nc) -> bool {
        for (role, value) in [(Role::Speed, &mut self.speed), (Role::Lead, &mut self.lead)] {
            match nc.word(role).map(Expr::constant) {
                Some(Some(number)) => *value = number,
                Some(None) => return false,
                None => {}
            }
        }
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Lead | Role::Feed, _)));
        nc.items.push(NcItem::Word(Role::Feed, Expr::Number(self.speed * self.lead)));
        true
    }
}

/// Puts the reading of the feed before the tap that comes next, and before the code that makes it rigid.
fn read(stmts: &mut Stmts, reading: Stmt) {
    let coded = stmts.last().is_some_and(|stmt| stmt.kind.has_op(Op::RigidTaps));
    stmts.insert(stmts.len() - usize::from(coded), reading);
}

/// Gives a tap by its lead a feed; else says why not, or on what condition.
fn give_feed(
    nc: &mut Nc,
    in_force: Option<Expr>,
    mode: Option<Op>,
    one_mode: bool,
) -> Option<(Code, &'static str)> {
    let (speed, lead) = (nc.word(Role::Speed).cloned().or(in_force), nc.word(Role::Lead).cloned()?);
    if mode == Some(Op::FeedPerTurn) && !nc.has(Op::CycleTapByLead) {
        set_feed(nc, Expr::Number(1.0), lead);
        return None;
    }
    let Some(speed) = speed.filter(|_| matches!(mode, None | Some(Op::FeedPerMinute))) else {
        return Some((Code::NoEquivalent, ONLY));
    };
    set_feed(nc, speed, lead);
    (mode.is_none() && !one_mode).then_some((Code::Conditional, IN_MINUTES))
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

//! Taps of a lathe in feed a minute, where the target's take the lead.
//!
//! Law: a tap that feeds f a minute at S turns advances f / S each turn, so it is the same in feed a turn with that as F. Side conditions: S and F
//! are known numbers before the cycle and the lead has six decimals, or F is a product with S as a factor; and the block that ends the cycle
//! follows on every way: it gets the feed of before again. Counter-example: a jump out of the cycle. What is left in feed a minute `holes`
//! refuses for a live tool.

use super::straight::entered_straight;
use super::tap_products::{assigns, is_kept, is_whole, without};
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::Vacancy;
use crate::ir::{BinOp, BlockId, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// True where a library taps, and the target's taps take the lead.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let has = |op| context.target.code_for(op, &BTreeMap::new()).is_some();
    features.any_op(is_tap) && has(Op::FaceTapLive) && !has(Op::FaceTap)
}

fn is_tap(op: Op) -> bool {
    matches!(op, Op::FaceTap | Op::SideTap)
}

/// Gives taps their lead.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let summaries = context.summaries(module);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let states: Vec<Modal> = program.ids().map(|id| facts.at(index, id)).collect();
        let mut found = taps(program, &states);
        if found.iter().any(|tap| tap.lead.may_be_vacant()) {
            // A word without a value would be left out, where a product with it is 0.
            let vacancy = Vacancy::of(program, &summaries, &BTreeSet::new());
            for Tap { at: (block, at), lead, .. } in &mut found {
                if vacancy.may_yield_vacant(BlockId(*block as u32), *at, lead) {
                    let product = [std::mem::replace(lead, Expr::Vacant), Expr::Number(1.0)];
                    *lead = Expr::Binary(BinOp::Mul, Box::new(product));
                }
            }
        }
        changed |= !found.is_empty();
        for Tap { at, lead, end, feed, rounds } in found {
            if let Some((span, speed)) = place(program, at).zip(rounds) {
                let told = Diagnostic::new(Code::Conditional, span, ROUNDS).with_help(ROUNDS_HELP);
                let told = told.assuming(Predicate::WholeSpeeds(vec![speed]));
                context.add(index, told.asked_once());
            }
            if let Some(nc) = words(program, at) {
                say(nc, Op::FeedPerTurn, lead);
            }
            if let Some(nc) = end.and_then(|end| words(program, end)) {
                end_with(nc, feed);
            }
        }
    }
    changed
}

/// A place: a block, and a statement in it.
type At = (usize, usize);

/// A cycle of taps: where it begins, its lead, the block that ends it if one does, the feed a minute, and where S stands if it may have to be rounded.
struct Tap {
    at: At,
    lead: Expr,
    end: Option<At>,
    feed: Expr,
    rounds: Option<Span>,
}

/// The cycles of taps whose lead is known.
fn taps(program: &Program, states: &[Modal]) -> Vec<Tap> {
    let straight = entered_straight(program);
    let (mut found, mut speed): (Vec<Tap>, Option<(Expr, Span)>) = (Vec::new(), None);
    for (number, (block, state)) in program.blocks.iter().zip(states).enumerate() {
        let mut state = state.clone();
        if !straight[number] {
            speed = None;
        }
        for (at, stmt) in block.stmts.iter().enumerate() {
            let before = state.op(Group::Cycle);
            state.step(stmt);
            let Some(nc) = stmt.kind.nc() else {
                speed = speed.filter(|(speed, _)| is_quiet(stmt) && !assigns(stmt, speed));
                continue;
            };
            if let Some(value) = nc.word(Role::Speed) {
                let value = worked_out(value).map_or_else(|| value.clone(), Expr::Number);
                speed = (stmt.site.skip.is_none() && is_kept(&value)).then_some((value, stmt.site.span));
            }
            let begins = before == Some(Op::CycleOff) && stmt.site.skip.is_none() && nc.ops().any(is_tap);
            let surface = state.op(Group::SpeedMode) == Some(Op::SurfaceSpeed);
            if !begins || surface || state.op(Group::FeedMode) != Some(Op::FeedPerMinute) {
                continue;
            }
            let feed = match nc.word(Role::Feed) {
                Some(word) => Some(worked_out(word).map_or_else(|| word.clone(), Expr::Number)),
                None => state.feed().map(Expr::Number),
            };
            let Some((feed, (speed, said))) = feed.filter(is_kept).zip(speed.as_ref()) else { continue };
            let lead = match (feed.constant(), speed.constant()) {
                (Some(feed), Some(speed)) => lead(feed, speed).map(Expr::Number),
                _ => without(&feed, speed),
            };
            let end = end((number, at), (&state, &feed), program, &straight);
            if let Some((lead, end)) = lead.zip(end) {
                let rounds = (!is_whole(speed)).then_some(*said);
                found.push(Tap { at: (number, at), lead, end, feed, rounds });
            }
        }
    }
    found
}

/// A value that is a number, or one times or over another.
fn worked_out(value: &Expr) -> Option<f64> {
    match value {
        Expr::Binary(op @ (BinOp::Mul | BinOp::Div), parts) => {
            let (a, b) = (worked_out(&parts[0])?, worked_out(&parts[1])?);
            match op {
                BinOp::Mul => Some(a * b),
                _ => (b != 0.0).then(|| a / b),
            }
        }
        value => value.constant(),
    }
}

/// The lead, if it has no more than six decimals.
fn lead(feed: f64, speed: f64) -> Option<f64> {
    if speed <= 0.0 {
        return None;
    }
    let lead = (feed / speed * 1e6).round() / 1e6;
    (lead > 0.0 && (lead * speed - feed).abs() < 1e-9 * feed).then_some(lead)
}

/// The block that ends a cycle which begins at a place, none in the inner value where the program ends first; none where a way leads
/// elsewhere, or something counts the feed before, or changes what it is worked out from.
fn end(
    (number, at): At,
    (state, feed): (&Modal, &Expr),
    program: &Program,
    straight: &[bool],
) -> Option<Option<At>> {
    let mut state = state.clone();
    for (block, stmts) in program.blocks.iter().enumerate().skip(number) {
        if block > number && !*straight.get(block)? {
            return None;
        }
        let first = if block == number { at + 1 } else { 0 };
        for (place, stmt) in stmts.stmts.iter().enumerate().skip(first) {
            let Some(nc) = stmt.kind.nc() else {
                if !is_quiet(stmt) || assigns(stmt, feed) {
                    return None;
                }
                continue;
            };
            state.step(stmt);
            if stmt.site.skip.is_some() {
                return None;
            }
            if !state.op(Group::Cycle).is_some_and(is_tap) {
                return Some(Some((block, place)));
            }
            let counts = |item: &NcItem| match item {
                NcItem::Op(op) => op.group() == Group::FeedMode,
                NcItem::Word(role, _) => matches!(role, Role::Feed | Role::Speed),
                NcItem::Code(..) => true,
            };
            if nc.items.iter().any(counts) {
                return None;
            }
        }
        match stmts.term.kind {
            TermKind::End { .. } => return Some(None),
            TermKind::Jump(to) if to == BlockId(block as u32 + 1) => {}
            _ => return None,
        }
    }
    None
}

/// True for what changes neither the feed nor the cycle.
fn is_quiet(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::Comment | StmtKind::Assign { .. })
}

fn words(program: &mut Program, (block, at): At) -> Option<&mut Nc> {
    match &mut program.blocks.get_mut(block)?.stmts.get_mut(at)?.kind {
        StmtKind::Nc(nc) => Some(nc),
        _ => None,
    }
}

/// Puts a mode of the feed and a feed into a block, in the place of those that it has.
fn say(nc: &mut Nc, mode: Op, feed: Expr) {
    let other = |item: &NcItem| match item {
        NcItem::Op(op) => op.group() == Group::FeedMode,
        NcItem::Word(role, _) => *role == Role::Feed,
        NcItem::Code(..) => false,
    };
    nc.items.retain(|item| !other(item));
    nc.items.insert(0, NcItem::Op(mode));
    nc.items.push(NcItem::Word(Role::Feed, feed));
}

/// Brings the feed a minute back, but for what the block says itself.
fn end_with(nc: &mut Nc, feed: Expr) {
    if nc.ops().any(|op| op.group() == Group::FeedMode) {
        return;
    }
    let own = nc.word(Role::Feed).cloned();
    say(nc, Op::FeedPerMinute, feed);
    if let (Some(own), Some(NcItem::Word(_, value))) = (own, nc.items.last_mut()) {
        *value = own;
    }
}

fn place(program: &Program, (block, at): At) -> Option<Span> {
    Some(program.blocks.get(block)?.stmts.get(at)?.site.span)
}

const ROUNDS: &str = "F of this tap is a product with S, so its lead is the other factor, as S has no part of a turn; where S is no whole number above 0, the \
                      control rounds it, and the tap of the source had another lead";
const ROUNDS_HELP: &str = "make sure that S is a whole number; the target's cycle is given the lead itself";

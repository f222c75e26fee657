//! Tapping by speed and feed, where the target's cycle takes speed and lead.
//!
//! Law: a tap that feeds f a minute at S turns advances f / S each turn. Side conditions: both are known numbers where the
//! cycle begins, or stand in its block, and the feed counts per minute. The speed word of the target's cycle takes the place of
//! its feed, so the feed that was in force is said again where the cycle ends. A subprogram taps at the speed of its callers.
//! Where the program computes the speed, a temporary holds it ([`held`]).
//! Counter-example: one that a second program calls at another speed.

mod held;

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Class, Expr, Module, Nc, NcItem, Stmt, StmtKind, Var};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::rewrite::highest_temp;
use held::{Held, HeldSpeeds};

/// True if there are taps by feed, and the target's are by lead.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(Op::is_tap) && by_lead(context.target) && !by_lead(context.source)
}

pub(super) fn by_lead(control: &Control) -> bool {
    control.behaviour(Question::CycleTapFeed).is_some_and(|row| row.value == "lead")
}

/// Gives tapping cycles a lead for their feed.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let speeds = OverCalls::of(module, &Speeds);
    let open = held::open(module, &context.summaries(module));
    let computed = OverCalls::of(module, &HeldSpeeds(&open));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut found = Vec::new();
        let temp = Var { class: Class::Temp, number: highest_temp(program) + 1 };
        let (mut holds, mut own) = (false, Vec::new());
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let mut modal = facts.at(index, id);
            let mut speed = speeds.at(index, id).copied().unwrap_or(Speed::Unknown);
            let mut held = computed.at(index, id).copied().unwrap_or(Held::Unknown);
            held::enter(id, &mut held);
            for (place, stmt) in block.stmts.iter_mut().enumerate() {
                let vacant = open[index].contains(&(id, place));
                held.step(index, stmt, vacant);
                let (was, told) = (modal.op(Group::Cycle), speed);
                modal.step(stmt);
                speed.step(stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if nc.ops().any(Op::is_tap) {
                    let says = nc.word(Role::Speed).cloned();
                    if nc.word(Role::Lead).is_some() {
                        // It has its lead.
                        if !told_speed(nc, speed) {
                            found.push((Code::NoEquivalent, span, SPEED));
                        }
                    } else if held == Held::In(index)
                        && !vacant
                        && is_computed(nc, speed)
                        && modal.op(Group::FeedMode) != Some(Op::FeedPerTurn)
                        && held::give(nc, temp, modal.feed())
                    {
                        holds = true;
                        own.extend(says.map(|value| (id, place, value)));
                    } else if let Err(why) = give_lead(nc, speed, modal.feed(), modal.op(Group::FeedMode)) {
                        found.push((Code::NoEquivalent, span, why));
                    }
                } else if was.is_some_and(Op::is_tap)
                    && nc.word(Role::Feed).is_some()
                    && modal.op(Group::Cycle) == was
                {
                    found.push((
                        Code::NoEquivalent,
                        span,
                        "a feed under a tapping cycle: write the cycle again with it",
                    ));
                } else if was.is_some_and(Op::is_tap)
                    && nc.word(Role::Speed).is_some()
                    && modal.op(Group::Cycle) == was
                    && (told != speed || told == Speed::Unknown)
                {
                    found.push((
                        Code::NoEquivalent,
                        span,
                        "a speed under a tapping cycle: write the cycle again with it",
                    ));
                } else if was.is_none_or(Op::is_tap)
                    && modal.op(Group::Cycle).is_some_and(|op| !op.is_tap())
                    && nc.word(Role::Feed).is_none()
                {
                    match modal.feed() {
                        Some(feed) => nc.items.push(NcItem::Word(Role::Feed, Expr::Number(feed))),
                        None if was.is_some() => found.push((Code::Conditional, span, STAYS)),
                        None => {}
                    }
                }
            }
        }
        if holds {
            held::hold(program, temp, &own, &open[index]);
        }
        for (code, span, what) in found {
            context.add_once(index, what, Diagnostic::new(code, span, what));
        }
    }
}

const STAYS: &str =
    "the tapping cycle took the place of the feed that was in force: write the feed again after it";

/// Gives a tap by feed its lead.
fn give_lead(nc: &mut Nc, speed: Speed, feed: Option<f64>, mode: Option<Op>) -> Result<(), &'static str> {
    if mode == Some(Op::FeedPerTurn) {
        return Err("a tapping cycle in feed per turn: write it in feed per minute");
    }
    let Speed::Known(speed) = speed else {
        return Err(
            "a tapping cycle whose speed is not known here, or is not the same for all who call this program: write S before it in \
                    this program",
        );
    };
    let Some(feed) = nc.word(Role::Feed).map_or(feed, Expr::constant) else {
        return Err("a tapping cycle whose feed is not known here: write F in its block");
    };
    if speed <= 0.0 || feed <= 0.0 {
        return Err("a tapping cycle needs a speed and a feed above 0");
    }
    by_lead_now(nc, Expr::Number(feed / speed), Expr::Number(speed));
    Ok(())
}

/// True if the speed is computed, or the feed that stands in the block.
fn is_computed(nc: &Nc, speed: Speed) -> bool {
    speed == Speed::Said || nc.word(Role::Feed).is_some_and(|feed| feed.constant().is_none())
}

const SPEED: &str = "a tapping cycle by its lead, and its speed is not known here: write S into its block";

/// Gives a tap by its lead the speed in force, where its block has none; false if it is not known.
fn told_speed(nc: &mut Nc, speed: Speed) -> bool {
    for item in &mut nc.items {
        if *item == NcItem::Op(Op::CycleTap) {
            *item = NcItem::Op(Op::CycleTapByLead);
        }
    }
    match speed {
        _ if nc.word(Role::Speed).is_some() => {}
        Speed::Known(speed) => nc.items.push(NcItem::Word(Role::Speed, Expr::Number(speed))),
        _ => return false,
    }
    true
}

/// Makes a tap by feed one by lead.
fn by_lead_now(nc: &mut Nc, lead: Expr, speed: Expr) {
    nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Feed | Role::Speed, _)));
    for item in &mut nc.items {
        if *item == NcItem::Op(Op::CycleTap) {
            *item = NcItem::Op(Op::CycleTapByLead);
        }
    }
    nc.items.push(NcItem::Word(Role::Lead, lead));
    nc.items.push(NcItem::Word(Role::Speed, speed));
}

/// The speed of the spindle, as the last word has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::legalize) enum Speed {
    Known(f64),
    /// The program says one on every way, which is computed, or another one each time.
    Said,
    /// The last word may be a speed of the surface, which is none of turns.
    Surface,
    Unknown,
}

impl Speed {
    /// The speed after a statement.
    pub(super) fn after(mut self, stmt: &Stmt) -> Self {
        self.step(stmt);
        self
    }

    pub(in crate::legalize) fn step(&mut self, stmt: &Stmt) {
        let StmtKind::Nc(nc) = &stmt.kind else {
            if matches!(stmt.kind, StmtKind::ModalCall(_)) {
                self.lose();
            }
            return;
        };
        let skipped = stmt.site.skip.is_some();
        if nc.has(Op::SurfaceSpeed) {
            *self = Self::Surface;
        } else if *self == Self::Surface && nc.has(Op::TurnsPerMinute) && !skipped {
            // S counts turns from here on; which turns there are without one is another question.
            *self = Self::Unknown;
        }
        if *self == Self::Surface {
            return;
        }
        if let Some(value) = nc.word(Role::Speed) {
            let now = value.constant().map_or(Self::Said, Self::Known);
            *self = if skipped { self.either(now) } else { now };
        }
    }
}

impl Speed {
    /// After what nobody sees; a speed of the surface may be in force there still.
    pub(in crate::legalize) fn lose(&mut self) {
        *self = self.either(Self::Unknown);
    }

    pub(in crate::legalize) fn either(self, other: Self) -> Self {
        match (self, other) {
            (Self::Surface, _) | (_, Self::Surface) => Self::Surface,
            (Self::Unknown, _) | (_, Self::Unknown) => Self::Unknown,
            _ if self == other => self,
            _ => Self::Said,
        }
    }
}

impl Lattice for Speed {
    fn join(&mut self, other: &Self) -> bool {
        let joined = self.either(*other);
        std::mem::replace(self, joined) != joined
    }
}

/// The speed at every block of a library: a program that is called begins with that of its callers.
pub(in crate::legalize) struct Speeds;

impl Follow for Speeds {
    type Known = Speed;

    fn outside(&self, _: usize) -> Speed {
        Speed::Unknown
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, speed: &mut Speed) {
        block.stmts.iter().for_each(|stmt| speed.step(stmt));
    }

    fn lose(&self, speed: &mut Speed) {
        speed.lose();
    }
}

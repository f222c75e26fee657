//! Drilling cycles as the moves that they are, on a target whose cycles take no planes.
//!
//! Law: a hole is a rapid move over it, one to the retract plane, the cut to the bottom (in steps or at once), and the
//! way out to the plane that the cycle returns to; after the cycle the interpolation of before it is in force again. So each
//! block that drills becomes these moves, a repeat a loop of them, and what stores a cycle, picks its return plane or ends
//! it becomes nothing. What the cycle was told is followed over jumps and calls; where ways differ it is kept in registers.
//! Planes in incremental words stay distances, or count from the plane that the cycle began at.
//!
//! Side conditions, each refused by name: which cycle is in force, the return plane, absolute or incremental and, where
//! it is needed, the plane that the cycle began at are known from the text; how far over the last depth a step begins is
//! known, from its word or the source's profile. Cycles that tap, orient the spindle or wait for the operator are refused.
//! Of a peck drill whose numbers are computed, steps that end less than 0.00001 above the bottom are not made apart from the last
//! one, and the bottom must be below the retract plane. Counter-example: `G81 R2.` where some callers say G98 and
//! others G99.

mod chosen;
mod drill;
mod flow;
mod library;
mod moves;
mod pen;

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Units};
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::analysis::{Modal, ModalFacts};
use crate::ir::{
    BinOp, BlockId, Builder, Class, Cond, Expr, Nc, NcItem, Place, Program, Relation, SourceInfo, Stmt,
    StmtKind, TermKind, Var,
};
use crate::legalize::Context;
use crate::legalize::cycles::needless_waits;
use crate::legalize::rewrite::{Part as Piece, rebuild};
use crate::text::Span;
use chosen::Chosen;
pub(super) use drill::keeps_height;
use drill::{Cycle, Drill, Height, Known, Runs, Told, tells, unplaced};
use flow::{Vacancies, says_motion, step};
pub use library::run;
pub(super) use library::{write_cycles, write_programs};
pub(super) use moves::has_moves;
use moves::{CLEAR, Hole, Part, counts, hole, lifts, may_end_at_feed, mixes, of_unplaced};
use pen::{Pen, push};
use std::collections::BTreeMap;

/// True if no cycle of the target is told a retract plane.
pub fn replaces(target: &Control) -> bool {
    let cycles = target.dialect().codes.iter().filter(|row| row.op.is_cycle());
    !cycles
        .into_iter()
        .any(|row| target.letter(Role::CycleR, target.code_for(row.op, &BTreeMap::new())).is_some())
}

struct Writer<'w, 'c> {
    index: usize,
    facts: &'w ModalFacts,
    flow: &'w OverCalls<Known>,
    rules: Runs,
    /// What is told by registers.
    held: [bool; 6],
    /// The number of the first of them.
    first: u32,
    temps: u32,
    vacancies: &'w Vacancies,
    /// The unit that the library names or checks, where it is one: true for inch.
    inch: Option<bool>,
    /// True if a word of the block at hand may be vacant.
    vacant: bool,
    /// What is written; all of it if none.
    chosen: Option<&'w Chosen>,
    context: &'w mut Context<'c>,
}

/// The line of a profile that says how far over the last depth a peck begins, with a value that is common.
const CLEARANCE: &str = "behaviour.cycle.peck.clearance=1";

const MIXED: &str = "a drilling cycle is in force on some of the ways to this block, and the target has no cycles: end it with G80 on every way";
const FROZEN: &str = "the planes of this cycle were told under the other of G90 and G91, and whether they keep their meaning is not \
     known: tell them again in this block";
const LIFTED: &str = "the retract plane of this cycle moves, and its bottom was told by an increment in a block before: write Z again beside R";
const MOTION: &str = "which interpolation is in force after this cycle is not known, and the target is in rapid traverse: write G0 or G1 \
     in the next move";
const KEPT: &str =
    "the motion code from before this cycle is taken to be in force again after it, as on most controls";
const BELOW: &str = "the bottom of this peck drill is taken to lie below its retract plane";
const INITIALLY: &str =
    "no program names G98 or G99: this cycle is taken to return to the initial plane, as after power-on";
const COUNT: &str = "a repeat of this cycle is taken to be a whole number, 0 or more";
const VACANT: &str = "if a word of this cycle is vacant, the source leaves it out, and the target takes the value before it: make sure that it \
     has a value";
const REPEAT: &str = "a repeated cycle in incremental words: write its planes in absolute coordinates, or return to the initial plane";

impl Writer<'_, '_> {
    fn refuse(&mut self, span: Span, what: &'static str) {
        let found = Diagnostic::new(Code::NoEquivalent, span, what);
        let found = if what == CLEAR { found.lacking(CLEARANCE) } else { found };
        self.context.add_once(self.index, what, found);
    }

    fn review(&mut self, span: Span, what: &'static str) {
        self.context.add_once(self.index, what, Diagnostic::new(Code::Conditional, span, what));
    }

    fn program(&mut self, program: &mut Program) {
        let any = program.blocks.iter().flat_map(|block| &block.stmts).any(|stmt| stmt.kind.nc().is_some());
        if !any {
            return;
        }
        let (mut known, mut modal): (Option<Known>, Modal) = (None, Modal::unknown());
        let mut ends: Vec<Vec<bool>> = program.blocks.iter().map(says_motion).collect();
        let (mut says, mut vacant, mut chosen) = (Vec::new(), Vec::new(), Vec::new());
        rebuild(program, &mut |builder, part| match part {
            Piece::Start(id) => {
                known = self.flow.at(self.index, id).cloned();
                modal = self.facts.at(self.index, id);
                says = ends.get_mut(id.index()).map(std::mem::take).unwrap_or_default();
                says.reverse();
                vacant = self.vacancies.at(self.index, id).iter().rev().copied().collect();
                chosen = self
                    .chosen
                    .map(|all| all.at(self.index, id).iter().rev().copied().collect())
                    .unwrap_or_default();
            }
            Piece::Term(_) => part.keep(builder),
            Piece::Stmt(stmt) => {
                let next = says.pop().unwrap_or(false);
                self.vacant = vacant.pop().unwrap_or(true);
                let stays = !chosen.pop().unwrap_or(self.chosen.is_none());
                let (before, was) = (known.clone(), modal.clone());
                modal.step(&stmt);
                if let Some(known) = &mut known {
                    step(&stmt, known, &modal, self.rules, self.vacant);
                }
                let is_nc = stmt.kind.nc().is_some() && !stays;
                let (Some(before), Some(after), true) = (before, &known, is_nc) else {
                    return builder.push(stmt.kind, stmt.site);
                };
                self.statement(builder, stmt, (&before, after), (&was, &modal), next);
            }
        });
    }

    fn statement(
        &mut self,
        builder: &mut Builder,
        stmt: Stmt,
        (before, after): (&Known, &Known),
        (was, modal): (&Modal, &Modal),
        says_motion: bool,
    ) {
        let Stmt { kind, site } = stmt;
        let StmtKind::Nc(mut nc) = kind else { return builder.push(kind, site) };
        let span = site.span;
        nc.items.retain(|item| {
            self.chosen.is_some() || !matches!(item, NcItem::Op(Op::ReturnR | Op::ReturnInitial))
        });
        if nc.has(Op::CycleOff) && matches!(before.cycle, Cycle::On(_) | Cycle::Maybe(_) | Cycle::Mixed) {
            self.end(&mut nc, was, (span, says_motion), may_end_at_feed(&before.cycle));
        }
        match &after.cycle {
            Cycle::Mixed if nc.moves() || nc.ops().any(Op::is_cycle) => self.refuse(span, MIXED),
            Cycle::On(drill) => return self.drill(builder, (nc, site), (drill, before), modal),
            _ => {}
        }
        push(builder, nc.items, site);
    }

    /// Ends a cycle: the interpolation of before it counts again. A bored hole may have left the feed in force.
    fn end(&mut self, nc: &mut Nc, was: &Modal, (span, says_motion): (Span, bool), at_feed: bool) {
        nc.items.retain(|item| self.chosen.is_some() || *item != NcItem::Op(Op::CycleOff));
        let named = nc.ops().any(|op| op.group() == Group::Motion);
        match was.op(Group::Motion) {
            _ if named => {}
            Some(Op::Rapid) if !at_feed || says_motion && !nc.moves() => {}
            Some(Op::Rapid) => nc.items.insert(0, NcItem::Op(Op::Rapid)),
            Some(op) => {
                self.review(span, KEPT);
                nc.items.insert(0, NcItem::Op(op));
            }
            None if nc.moves() || !says_motion => self.review(span, MOTION),
            None => {}
        }
    }

    /// A block under a cycle in force.
    fn drill(
        &mut self,
        builder: &mut Builder,
        (nc, site): (Nc, SourceInfo),
        (drill, before): (&Drill, &Known),
        modal: &Modal,
    ) {
        let span = site.span;
        let begins = nc.ops().any(Op::is_cycle);
        let count = nc.word(Role::Repeat).cloned();
        self.tell(builder, &nc, (before, begins), span);
        let words = nc.items.iter().filter(|item| !tells(item)).cloned().collect::<Vec<_>>();
        if let Some(0.0) = count.as_ref().and_then(Expr::constant) {
            self.context.rests_on_source(self.index, span, Question::CycleL0Stores);
            return self.stored(builder, words, site);
        }
        let across = || [Role::X, Role::Y].into_iter().filter_map(|role| nc.word(role));
        if begins && across().next().is_none() && !nc.has(Op::CycleHere) {
            self.context.rests_on_source(self.index, span, of_unplaced(&nc, self.context.source));
        }
        if !self.rules.drills(&nc) {
            return push(builder, words, site);
        }
        if self.vacant {
            self.review(span, VACANT);
        }
        let frozen = self.context.source.is(Question::CyclePlanesFrozen);
        if !frozen && mixes(drill, modal) {
            self.refuse(span, FROZEN);
        }
        if lifts(&nc, before, drill) {
            self.refuse(span, LIFTED);
        }
        let stands = match &before.cycle {
            Cycle::On(drill) => (drill.height, before.z),
            _ => (Height::Initial, before.z),
        };
        let repeats = count.filter(|count| count.constant() != Some(1.0));
        let stands = match &repeats {
            Some(_) => (stands.0, None),
            None => stands,
        };
        let dwells = drill.op.is_some_and(|op| needless_waits::waits(op, self.context.source));
        let clear = self.clearance(modal);
        let back = self.rules.back(modal);
        if modal.op(Group::ReturnPlane).is_none() && back.is_some() {
            let found = Diagnostic::new(Code::Conditional, span, INITIALLY).asked_once();
            self.context.add_once(self.index, INITIALLY, found);
        }
        let found = hole(drill, stands, (modal, back), self.first, (clear, dwells));
        let found = match found {
            Ok(found) => found,
            Err(what) => {
                self.refuse(span, what);
                return push(builder, words, site);
            }
        };
        let relative = !found.switch && modal.op(Group::Distance) == Some(Op::Incremental);
        if repeats.is_some() && relative && (stands.0, back) != (Height::Initial, Some(Op::ReturnInitial)) {
            self.refuse(span, REPEAT);
        }
        let skipped = self.unless_unplaced(builder, &nc);
        let Some(count) = repeats else {
            self.moves(builder, words, found, site);
            return skipped.into_iter().for_each(|after| builder.start(after));
        };
        if count.constant().is_none_or(|count| count < 0.0 || count.fract() != 0.0) {
            self.review(span, COUNT);
        }
        let left = self.temp();
        let aside = || SourceInfo { span, ..SourceInfo::default() };
        let set = |value| StmtKind::Assign { target: Place::Var(left), value };
        builder.push(set(count), aside());
        let (head, body, after) = (builder.fresh(), builder.fresh(), builder.fresh());
        builder.start(head);
        let cond = Cond::Compare(Relation::Greater, Expr::Var(left), Expr::Number(0.0));
        builder.end(
            TermKind::Branch { cond: Box::new(cond), then: body, otherwise: after },
            SourceInfo::default(),
        );
        builder.start(body);
        self.moves(builder, words, found, site);
        builder
            .push(set(Expr::binary(BinOp::Sub, Expr::Var(left), Expr::Number(1.0))), SourceInfo::default());
        builder.end(TermKind::Jump(head), SourceInfo::default());
        builder.start(after);
        skipped.into_iter().for_each(|after| builder.start(after));
    }

    /// A block whose count of 0 keeps it from drilling: its position is gone to, or left out.
    fn stored(&mut self, builder: &mut Builder, mut words: Vec<NcItem>, site: SourceInfo) {
        let place = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis());
        if words.iter().any(place) {
            self.context.rests_on_source(self.index, site.span, Question::CycleL0Moves);
            if self.context.source.is(Question::CycleL0Moves) {
                words.insert(0, NcItem::Op(Op::Rapid));
            } else {
                words.retain(|item| !place(item));
            }
        }
        push(builder, words, site);
    }

    /// Goes past the hole where every word of its place is vacant: the block has none then.
    fn unless_unplaced(&self, builder: &mut Builder, nc: &Nc) -> Option<BlockId> {
        let place = unplaced(nc).filter(|_| self.vacant)?;
        let vacant = |word: &Expr| Cond::Compare(Relation::Equal, word.clone(), Expr::Vacant);
        let mut all: Vec<Cond> = place.iter().map(|word| vacant(word)).collect();
        let cond = if all.len() == 1 { all.swap_remove(0) } else { Cond::And(all) };
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, SourceInfo::default());
        builder.start(otherwise);
        Some(then)
    }

    /// How far over the last depth the source begins a step, in the program's unit.
    fn clearance(&self, modal: &Modal) -> Option<f64> {
        let by = self.context.source.peck_clearance()?;
        let own = self.context.source.units().or(self.context.target.units());
        let inch = match modal.op(Group::Units) {
            Some(op) => op == Op::Inch,
            None => self.inch.or(own.map(|own| own == Units::Inch))?,
        };
        // No digits that the control does not resolve.
        Some(if inch { (by / 25.4 * 1e5).round() / 1e5 } else { by })
    }

    /// Puts what a block tells the cycle into the registers that holes take it from.
    fn tell(&mut self, builder: &mut Builder, nc: &Nc, (before, begins): (&Known, bool), span: Span) {
        let aside = || SourceInfo { span, ..SourceInfo::default() };
        for what in Told::ALL {
            let target = what.register(self.first);
            let word = match what.role() {
                Some(role) => nc.word(role).cloned(),
                None => before.begins_at().map(Expr::Number).filter(|_| begins),
            };
            let Some(word) = word else { continue };
            // A count of a unit that nobody knows is refused already.
            if !self.held[what as usize] || counts(&word) {
                continue;
            }
            if word.may_be_vacant() && self.vacant {
                self.review(span, VACANT);
            }
            let value =
                if word.may_be_vacant() { Expr::binary(BinOp::Add, word, Expr::Number(0.0)) } else { word };
            builder.push(StmtKind::Assign { target: Place::Var(target), value }, aside());
        }
    }

    fn temp(&mut self) -> Var {
        self.temps += 1;
        Var { class: Class::Temp, number: self.temps }
    }

    /// Lays down the moves of a hole. The feed stands with the first cut.
    fn moves(&mut self, builder: &mut Builder, mut words: Vec<NcItem>, hole: Hole, site: SourceInfo) {
        let span = site.span;
        let aside = || SourceInfo { span, ..SourceInfo::default() };
        let is_feed = |item: &NcItem| matches!(item, NcItem::Word(Role::Feed, _));
        let feed: Vec<NcItem> = words.iter().filter(|item| is_feed(item)).cloned().collect();
        words.retain(|item| !is_feed(item));
        words.insert(0, NcItem::Op(Op::Rapid));
        push(builder, words, site);
        let mut pen = Pen { builder, span, feeds: Some(false), feed, absolute: hole.switch };
        for part in hole.parts {
            match part {
                Part::Move(feed, to) => pen.go(feed, to),
                Part::Words(items) => push(pen.builder, items, aside()),
                Part::Pecks { retract, bottom, peck, clear, out } => {
                    self.review(span, BELOW);
                    let temps = [self.temp(), self.temp(), self.temp(), self.temp()];
                    pen.pecks((retract, bottom, peck), clear, out, temps);
                }
            }
        }
        if hole.switch {
            push(pen.builder, vec![NcItem::Op(Op::Incremental)], aside());
        }
    }
}

//! The words of drilling cycles that one control's code takes and the other's does not.
//!
//! Law: what a cycle is told lasts for the cycles after it, until cycles are cancelled, and a cycle does nothing with
//! a word that its code does not take. So where only the target's code takes a dwell, it is told one of 0, and the
//! dwell of before is told again where the next code that takes one has none of its own. A word that only the
//! source's code takes is refused, and so is a dwell of before that only the source's code takes; a dwell of 0 is left
//! out, and that of a bore too, which is told. Side conditions: which cycle is in force is known, and which dwell lasts into it on every way; a person looks where
//! the letter of that dwell means something else beside the next code. Counter-example: `G82 P500 .. G83`, where the
//! source's G83 takes no P and the target's waits half a second.

use super::{bore_waits, fine_shifts, needless_waits, peck_clear};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, solve};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, Stmt, StmtKind, TermKind};
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;
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
    let facts = context.modal_facts(module);
    let parts = parts(module, context);
    let dwells = dwells(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let rules = Rules { index, facts: &facts, parts, dwells, context };
        let starts = solve(&rules, program, &Cfg::of(program));
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let mut state = facts.at(index, id);
            let mut lasting = starts.at(id).cloned().unwrap_or_default();
            for stmt in &mut block.stmts {
                let before = state.op(Group::Cycle);
                state.step(stmt);
                let here = lasting.clone();
                lasting.step(stmt, before, state.op(Group::Cycle), context);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                let Some(op) = state.op(Group::Cycle).filter(|op| op.is_cycle()) else { continue };
                needless_waits::fit(nc, op, context);
                fine_shifts::fit((nc, span), (before, op), index, context);
                let here = if before == Some(Op::CycleOff) { Lasting::default() } else { here };
                let begins = begins(nc);
                for role in untaken(nc, op, context.target) {
                    refuse(index, (nc, span), (op, role), (&state, context));
                }
                if !begins {
                    continue;
                }
                let [own, others] = waits(op, context);
                let dwell = match (own, others, here.dwell) {
                    (true, false, Dwell::Is(Some(dwell)))
                        if bore_waits::is_bore(op, context.target) && dwell.constant() != Some(0.0) =>
                    {
                        bore_waits::left_out(index, span, (op, Some(&dwell)), context);
                        continue;
                    }
                    (true, false, Dwell::Many) if bore_waits::is_bore(op, context.target) => {
                        bore_waits::left_out(index, span, (op, None), context);
                        continue;
                    }
                    (true, false, Dwell::Is(Some(dwell))) if dwell.constant() != Some(0.0) => {
                        let what = format!(
                            "the dwell of an earlier cycle is still in force in this one ({op}), and the \
                             target's code takes no dwell"
                        );
                        let told = Diagnostic::new(Code::NoEquivalent, span, what);
                        let told = needless_waits::told(told, op, context);
                        context.add(index, told);
                        continue;
                    }
                    (true, false, Dwell::Many) => {
                        let what = format!(
                            "the dwell of an earlier cycle may still be in force in this one ({op}), and \
                             the target's code takes no dwell: make sure that it is 0"
                        );
                        context.add(index, Diagnostic::new(Code::Conditional, span, what));
                        continue;
                    }
                    (false, false, dwell)
                        if dwell != Dwell::Is(None) && letter_is_another(op, context.target) =>
                    {
                        let what = format!(
                            "the dwell of an earlier cycle may still be in force here, and beside the target's code for \
                             this cycle ({op}) its letter means something else: write G80 before this cycle"
                        );
                        context.add(index, Diagnostic::new(Code::Conditional, span, what));
                        continue;
                    }
                    (false, true, _) if before != Some(Op::CycleOff) => Expr::Number(0.0),
                    (true, true, Dwell::Is(Some(dwell))) if here.away => dwell,
                    (true, true, Dwell::Many) if here.away => {
                        let what = "it depends on the path which dwell of the earlier cycles is still in \
                                    force here: write P into this block";
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                        continue;
                    }
                    _ => continue,
                };
                if own && dwell.constant().is_none() {
                    let what = "the dwell of an earlier cycle is still in force here, and the variables \
                                that it is computed from may have changed: write P into this block";
                    context.add(index, Diagnostic::new(Code::Conditional, span, what));
                }
                nc.items.push(NcItem::Word(Role::CycleDwell, dwell));
            }
        }
    }
}

/// Refuses a word that the target's code does not take, but for a clearance that the target's machine has by itself, and for the wait
/// of a bore, which is left out.
fn refuse(
    index: usize,
    (nc, span): (&mut Nc, Span),
    (op, role): (Op, Role),
    (state, context): (&Modal, &mut Context<'_>),
) {
    if role == Role::CycleDwell && bore_waits::is_bore(op, context.target) {
        bore_waits::left_out(index, span, (op, nc.word(role)), context);
        return nc.items.retain(|item| !matches!(item, NcItem::Word(Role::CycleDwell, _)));
    }
    let told = Diagnostic::new(Code::NoEquivalent, span, word_too_much(op, role, context));
    let needed = if role == Role::PeckClear { peck_clear::fit(nc, state, context) } else { None };
    match needed {
        None if role == Role::CycleDwell && needless_waits::question(op).is_some() => {
            let told = needless_waits::told(told, op, context);
            context.add(index, told);
        }
        None => context.add(index, told.with_help(TOO_MUCH_HELP)),
        Some(needed) if nc.word(role).is_some() => {
            let setting = format!("behaviour.{}={needed}", Question::CyclePeckClearance);
            context.add(index, told.with_help(peck_clear::help(needed)).lacking_there(setting));
        }
        Some(_) => {}
    }
}

/// The dwell that cycles were told before.
#[derive(Clone, Debug, PartialEq)]
enum Dwell {
    /// This one, or none.
    Is(Option<Expr>),
    /// Not the same on all ways here.
    Many,
}

/// What lasts from cycle to cycle.
#[derive(Clone, Debug, PartialEq)]
struct Lasting {
    dwell: Dwell,
    /// True where the target may have been told another one.
    away: bool,
}

impl Default for Lasting {
    fn default() -> Self {
        Self { dwell: Dwell::Is(None), away: false }
    }
}

impl Lasting {
    /// Takes a statement's effect; the cycles in force before and after it are known or not.
    fn step(&mut self, stmt: &Stmt, before: Option<Op>, behind: Option<Op>, context: &Context<'_>) {
        let StmtKind::Nc(nc) = &stmt.kind else { return };
        let old = stmt.site.skip.map(|_| self.clone());
        match behind {
            Some(op) if op.is_cycle() => {
                if before == Some(Op::CycleOff) {
                    *self = Self::default();
                }
                let [own, others] = waits(op, context);
                if let Some(dwell) = nc.word(Role::CycleDwell) {
                    // What the target's code does not take, it does not keep.
                    let away = !others || needless_waits::left_out(op, context);
                    *self = Self { dwell: Dwell::Is(Some(dwell.clone())), away };
                } else if begins(nc) && others && (own || before != Some(Op::CycleOff)) {
                    self.away = !own;
                }
            }
            Some(_) => *self = Self::default(),
            None => {}
        }
        if let Some(old) = old {
            self.join(&old);
        }
    }
}

impl Lattice for Lasting {
    fn join(&mut self, other: &Self) -> bool {
        let old = self.clone();
        if self.dwell != other.dwell {
            self.dwell = Dwell::Many;
        }
        self.away |= other.away;
        *self != old
    }
}

/// What blocks of a program do to what lasts.
struct Rules<'r> {
    index: usize,
    facts: &'r ModalFacts,
    /// True where any block of the library tells the target another dwell than the source.
    parts: bool,
    /// True where some block of the library names a dwell of a cycle.
    dwells: bool,
    context: &'r Context<'r>,
}

impl Rules<'_> {
    fn unknown(&self) -> Lasting {
        let dwell = if self.dwells { Dwell::Many } else { Dwell::Is(None) };
        Lasting { dwell, away: self.parts }
    }
}

impl Analysis for Rules<'_> {
    type State = Lasting;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Lasting)> {
        let cycle = |id: BlockId| self.facts.at(self.index, id).op(Group::Cycle);
        // Who calls it under a cycle has told that something.
        let under = |root: BlockId| root != BlockId(0) || cycle(root).is_some_and(Op::is_cycle);
        let roots = cfg.roots().iter().copied();
        roots.map(|root| (root, if under(root) { self.unknown() } else { Lasting::default() })).collect()
    }

    fn block(&self, id: BlockId, block: &Block, lasting: &mut Lasting) {
        let mut state = self.facts.at(self.index, id);
        for stmt in &block.stmts {
            let before = state.op(Group::Cycle);
            state.step(stmt);
            lasting.step(stmt, before, state.op(Group::Cycle), self.context);
        }
        if matches!(block.term.kind, TermKind::Call { .. }) {
            *lasting = self.unknown();
        }
    }
}

/// True where any block of a library names a dwell of a cycle: where none does none lasts.
fn dwells(module: &Module) -> bool {
    let mut stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    stmts.any(|stmt| stmt.kind.nc().is_some_and(|nc| nc.word(Role::CycleDwell).is_some()))
}

/// True where any block of a library tells the target another dwell than the source.
fn parts(module: &Module, context: &Context<'_>) -> bool {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    stmts.into_iter().any(|stmt| {
        let StmtKind::Nc(nc) = &stmt.kind else { return false };
        if !nc.ops().any(Op::is_cycle) {
            return nc.word(Role::CycleDwell).is_some();
        }
        nc.ops().filter(|op| op.is_cycle()).any(|op| match waits(op, context) {
            [own, others] if begins(nc) => !own && others,
            [_, others] => !others || needless_waits::left_out(op, context),
        })
    })
}

/// True for a block that begins a cycle and tells it no dwell.
fn begins(nc: &Nc) -> bool {
    nc.ops().any(Op::is_cycle) && nc.word(Role::CycleDwell).is_none()
}

/// Whether the source's code for a cycle takes a dwell, and the target's.
pub(super) fn sides(op: Op, context: &Context<'_>) -> [bool; 2] {
    [context.source, context.target].map(|control| takes(control, op, Role::CycleDwell))
}

/// As [`sides`]; false of a source where this cycle needs no wait.
fn waits(op: Op, context: &Context<'_>) -> [bool; 2] {
    let [own, others] = sides(op, context);
    [own && !needless_waits::left_out(op, context), others]
}

/// True where the letter of a dwell is that of another word beside the control's code for a cycle.
fn letter_is_another(op: Op, control: &Control) -> bool {
    let row = control.code_for(op, &BTreeMap::new());
    let mut others =
        row.into_iter().flat_map(|row| &row.words).filter(|(_, role)| **role != Role::CycleDwell);
    let dwells = |letter: &str| {
        let mut codes = control.dialect().codes.iter().filter(|row| row.op.is_cycle());
        codes.any(|row| row.words.get(letter) == Some(&Role::CycleDwell))
    };
    others.any(|(letter, _)| dwells(letter))
}

/// True where the code that the control has for a cycle takes a word.
pub(super) fn takes(control: &Control, op: Op, role: Role) -> bool {
    control.code_for(op, &BTreeMap::new()).is_some_and(|row| row.takes(role))
}

const TOO_MUCH_HELP: &str =
    "take the word out if the part does not need it, or write this hole as moves (G0 and G1) in the source";

/// A word of the source's cycle that the target's has nothing like, by the codes and the letter that the programmer knows.
fn word_too_much(op: Op, role: Role, context: &Context<'_>) -> String {
    let rows = [context.source, context.target].map(|control| control.code_for(op, &BTreeMap::new()));
    let [Some(ours), Some(theirs)] = rows else {
        return format!("the target's code for this cycle ({op}) does not take this word ({role})");
    };
    let letter = ours.words.iter().find(|(_, found)| **found == role).map(|(letter, _)| letter.as_str());
    let word = letter.map_or_else(|| format!("a word ({role})"), ToOwned::to_owned);
    format!("{word} beside {} of the source: {} of the target has nothing like it", ours.code, theirs.code)
}

/// The words of a block that the target's code does not take. A dwell of 0 is left out.
fn untaken(nc: &mut Nc, op: Op, target: &Control) -> Vec<Role> {
    let Some(row) = target.code_for(op, &BTreeMap::new()) else { return Vec::new() };
    let none = |item: &NcItem| matches!(item, NcItem::Word(Role::CycleDwell, value) if value.constant() == Some(0.0));
    nc.items.retain(|item| row.takes(Role::CycleDwell) || !none(item));
    ROLES.into_iter().filter(|role| nc.word(*role).is_some() && !row.takes(*role)).collect()
}

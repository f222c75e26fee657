//! The unit of lengths, where it comes from the control and not from the program.
//!
//! Law: a program that names no unit runs in the one its control is set to. Where the source's is known (the shop's
//! profile or a check of the unit says it), the target is told at the head of each main program that comes to a length
//! before it names a unit, itself or in what it calls. Side conditions: where it is not known, the target must be set
//! as the source was; where the target is set to the other unit, its tables must be kept for this one. Both are a
//! review diagnostic. Where programs of the source can select a unit, what runs before one that names none does so on both
//! controls: those that are set alike need nothing.

pub(in crate::legalize) mod exit;

use super::mains::{head, mains, returns, uncalled};
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Settled, Side, Units};
use crate::ir::analysis::CallGraph;
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::dataflow::{Lattice, reached_among};
use crate::ir::{BlockId, Callee, Expr, Module, NcItem, Place, Program, StmtKind, TermKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::layout::emptied::drop_emptied;
use crate::legalize::moves::increments::units_named;
use crate::legalize::{Context, ModalFacts, Setting, calls_of};
use crate::text::Span;
use exit::ExitUnit;
use std::collections::BTreeSet;
use std::sync::Arc;

/// False where the unit is known at the start and stays so: nothing names it, checks it or may leave another.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let check = |op| matches!(op, Op::CheckInch | Op::CheckMetric);
    let others = [Feature::Emptied, Feature::Code, Feature::Modal, Feature::Call, Feature::LocalCall];
    let entry = &context.entry;
    entry.op(Group::Units).is_none()
        || entry.may_call()
        || features.any_op(|op| op.group() == Group::Units || check(op))
        || others.into_iter().any(|thing| features.has(thing))
}

/// Tells the target the unit of each main program.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    let (ours, theirs) = (context.source.units(), context.target.units());
    let selected =
        theirs.filter(|units| context.target.code_for(selection(*units), &Default::default()).is_some());
    let checked: Vec<Option<Units>> =
        module.programs.iter_mut().map(|program| take_checks(program, selected, &mut changed)).collect();
    if changed {
        context.forget();
    }
    if ours.is_some() && ours == theirs && selects_unit(context.source) {
        return changed;
    }
    let mut entry = context.entry.clone();
    entry.one_unit = ExitUnit::of_library(module, context).is_one();
    let known =
        entry.op(Group::Units).is_some() || module.programs.iter().flat_map(units_named).next().is_some();
    let facts =
        if known { context.modal_facts_from(module, &entry) } else { Arc::new(ModalFacts::unknown()) };
    let called = context.called(module);
    let open = open(module, &facts, &called, true);
    let mut heads = mains(module, &called);
    if let Some(units) = ours.filter(|units| theirs.is_some_and(|theirs| theirs != *units)) {
        heads.extend(lone(module, units, &called));
    }
    for root in heads.into_iter().filter(|&root| open[root]) {
        // One that may also be called has the unit of its caller then.
        let alone = !(called.is_guessed(root) && returns(&module.programs[root]));
        let Some(units) = ours.or(checked[root]).filter(|_| alone) else {
            let finding = match lost(module, &facts, root) {
                Some((span, why)) => Diagnostic::new(
                    Code::Conditional,
                    span,
                    format!("{why}: set the target to the old machine's unit, or name the unit after it"),
                ),
                None if !alone => {
                    let what = "the program names no unit and may be called: it runs in its caller's";
                    Diagnostic::new(Code::Conditional, module.programs[root].site.span, what)
                }
                None => {
                    let what = format!(
                        "{}: the target must be set to the unit of the old machine",
                        unnamed(context.source)
                    );
                    Diagnostic::new(Code::StartUnknown, module.programs[root].site.span, what)
                        .with_help(Settled::UNITS.in_words(Side::Source))
                }
            };
            context.add_once(root, "units", finding.assuming(Predicate::Unit));
            continue;
        };
        let op = selection(units);
        if theirs == Some(units) && context.target.code_for(op, &Default::default()).is_none() {
            continue;
        }
        if theirs.is_some_and(|theirs| theirs != units) {
            let what = "the program selects the source's unit, and the target is set to the other one: \
                        enter the target's offsets for this program's unit";
            let span = module.programs[root].site.span;
            let finding = Diagnostic::new(Code::Conditional, span, what).assuming(Predicate::Unit);
            context.add_once(root, "units", finding);
        }
        head(&mut module.programs[root], vec![NcItem::Op(op)]);
        changed = true;
    }
    changed
}

/// True where a program can select the unit.
fn selects_unit(control: &Control) -> bool {
    [Op::Inch, Op::Metric].iter().any(|op| control.code_for(*op, &Default::default()).is_some())
}

/// The code that selects a unit.
fn selection(units: Units) -> Op {
    if units == Units::Inch { Op::Inch } else { Op::Metric }
}

/// Takes the checks of the unit out of a program; the unit that all of them check. The first one that checks the unit which
/// the target is set to, and can select, selects it.
fn take_checks(program: &mut Program, selected: Option<Units>, changed: &mut bool) -> Option<Units> {
    let (mut inch, mut metric) = (false, false);
    for block in &mut program.blocks {
        let mut any = false;
        for stmt in &mut block.stmts {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            nc.items.retain_mut(|item| {
                let (units, seen) = match item {
                    NcItem::Op(Op::CheckInch) => (Units::Inch, &mut inch),
                    NcItem::Op(Op::CheckMetric) => (Units::Metric, &mut metric),
                    _ => return true,
                };
                let first = !std::mem::replace(seen, true) && selected == Some(units);
                *item = NcItem::Op(selection(units));
                first
            });
            any |= nc.items.is_empty();
        }
        if any {
            *changed |= drop_emptied(block);
        }
    }
    *changed |= inch || metric;
    match (inch, metric) {
        (true, false) => Some(Units::Inch),
        (false, true) => Some(Units::Metric),
        _ => None,
    }
}

/// That a program of this control names no unit, with the codes that would.
fn unnamed(source: &Control) -> String {
    let code = |op| source.code_for(op, &Default::default()).map(|row| row.code.as_str());
    match (code(Op::Inch), code(Op::Metric)) {
        (Some(inch), Some(metric)) => format!("no {inch} or {metric}"),
        _ => "the program does not name its unit".to_owned(),
    }
}

/// Where a program that named its unit no longer knows it, and why.
fn lost(module: &Module, facts: &ModalFacts, root: usize) -> Option<(Span, &'static str)> {
    let program = &module.programs[root];
    for id in with_subroutines(program) {
        let Some(block) = program.block(id) else { continue };
        let mut state = facts.at(root, id);
        for stmt in &block.stmts {
            let before = state.op(Group::Units);
            state.step(stmt);
            if before.is_some() && state.op(Group::Units).is_none() {
                let computed = match &stmt.kind {
                    StmtKind::Nc(nc) => nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _))),
                    _ => false,
                };
                let why = if computed {
                    "the code computed here may select another unit"
                } else {
                    "the modal call that runs here may leave another unit"
                };
                return Some((stmt.site.span, why));
            }
        }
        if let TermKind::Call { next, .. } = &block.term.kind
            && state.op(Group::Units).is_some()
            && facts.at(root, *next).op(Group::Units).is_none()
        {
            return Some((block.term.site.span, "the program called here may leave another unit"));
        }
    }
    None
}

/// Which programs come to a length while no unit is named, themselves or in what they call then; to one that is not 0, unless `zeros` count.
pub(super) fn open(module: &Module, facts: &ModalFacts, called: &CalledPrograms, zeros: bool) -> Vec<bool> {
    let mut open = vec![false; module.programs.len()];
    let mut calls: Vec<BTreeSet<(usize, bool)>> = vec![BTreeSet::new(); open.len()];
    for (index, program) in module.programs.iter().enumerate() {
        let own = &mut calls[index];
        let mut enter = |callees: &[usize]| own.extend(callees.iter().map(|callee| (*callee, false)));
        for id in with_subroutines(program) {
            // What it calls says no more of one that is open itself.
            let Some(block) = program.block(id).filter(|_| !open[index]) else { break };
            let is_named = match facts.unit_all_through(index, id, block) {
                Some(Setting::Known(..)) => true,
                Some(Setting::Unknown) => {
                    open[index] |= block.stmts.iter().any(|stmt| has_length(&stmt.kind, zeros));
                    false
                }
                None => {
                    let mut state = facts.at(index, id);
                    for stmt in &block.stmts {
                        // A modal call that the block sets off comes after it.
                        let before = state.op(Group::Units);
                        state.step(stmt);
                        if before.or(state.op(Group::Units)).is_none() {
                            open[index] |= has_length(&stmt.kind, zeros);
                            if let StmtKind::ModalCall(call) = &stmt.kind {
                                enter(called.by((index, id), call));
                            }
                        }
                    }
                    state.op(Group::Units).is_some()
                }
            };
            if !is_named {
                open[index] |= reads_length(|f| block.term.kind.exprs(f));
                if let TermKind::Call { call, .. } = &block.term.kind {
                    enter(called.by((index, id), call));
                }
            }
        }
    }
    CallGraph::new(calls).bottom_up(&mut open, |mine, callee, _| mine.join(callee));
    open
}

/// The blocks that a program can run, those of its subroutines too.
fn with_subroutines(program: &Program) -> impl Iterator<Item = BlockId> + use<> {
    let all = reached_among(program.blocks.len(), [0], |at, go| {
        let Some(block) = program.blocks.get(at) else { return };
        block.term.kind.each_successor(&mut |to| go(to.index()));
        calls_of(block).for_each(|call| {
            if let Callee::Block(entry) = call.callee {
                go(entry.index());
            }
        });
    });
    program.ids().zip(all).filter(|(_, reached)| *reached).map(|(id, _)| id)
}

/// True for a statement in which the unit counts; one whose lengths are 0 is one if `zeros` count.
fn has_length(kind: &StmtKind, zeros: bool) -> bool {
    match kind {
        StmtKind::Nc(nc)
            if nc.items.iter().any(|item| match item {
                NcItem::Word(role, value) => in_unit(*role) && (zeros || value.constant() != Some(0.0)),
                _ => false,
            }) =>
        {
            true
        }
        StmtKind::Assign { target: Place::System(state, _), .. } if state.is_length() => true,
        kind => reads_length(|f| kind.exprs(f)),
    }
}

fn in_unit(role: Role) -> bool {
    role.is_length() || matches!(role, Role::Feed | Role::Lead)
}

fn reads_length(each: impl FnOnce(&mut dyn FnMut(&Expr))) -> bool {
    let mut any = false;
    each(&mut |e| {
        e.walk(&mut |e| {
            any |= matches!(e, Expr::Increments(n) if *n != 0.0)
                || matches!(e, Expr::System(state, _) if state.is_length())
        })
    });
    any
}

/// The programs that others call whom the library has not, where nothing in it names another unit than this one: what
/// calls them on the target may be in the unit that the target is set to.
fn lone(module: &Module, units: Units, called: &CalledPrograms) -> Vec<usize> {
    if module.programs.iter().flat_map(units_named).any(|named| named != units) {
        return Vec::new();
    }
    let mains: BTreeSet<usize> = mains(module, called).into_iter().collect();
    let is_named = |root: &usize| module.programs[*root].name.is_some();
    uncalled(module, called).into_iter().filter(|root| !mains.contains(root)).filter(is_named).collect()
}

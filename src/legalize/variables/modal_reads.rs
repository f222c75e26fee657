//! Modal codes that are read, where the target has no variable for them.
//!
//! Laws: what is in force of a group is a constant where every way to the place names the same operation, and the unit where the target
//! is set to one, and has no code for another; else, on a
//! target that tests codes, it is the number on the source of the code that the target finds in force. Side conditions of
//! the second: the group is one whose codes stay as the source wrote them, so no motion codes where cycles are written
//! out; and what the program may find in force at its start is in force on the target too, which the code that the
//! operator's machine starts in says. Counter-example: `#1=#4001` under G81, where the target stands in G0 or G1.

use crate::canon::{Group, Op, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Units};
use crate::ir::analysis::Setting;
use crate::ir::{Cond, Expr, Module, Program, Relation, TermKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal, Position, PreStatement, Rewriter, rewrite_program};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// G54 to G59.
const STANDARD_OFFSETS: u32 = 6;

/// True if the library reads state.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.has(Feature::System)
}

/// Replaces modal codes that are read; true if there are any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    context.count(module);
    let cycles = context.features.any_op(Op::is_cycle);
    let changed = known(module, context);
    let tests = context.target.system_run(Sys::CodeTest).is_some();
    tests && tested(module, cycles, context) || changed
}

/// True where state may be read.
pub(super) fn may_read(index: usize, context: &Context<'_>) -> bool {
    context.may_concern(index, |features| features.has(Feature::System))
}

/// The group that is read, by its common number, and what is added to its code; none for one that the target can read.
pub(super) fn group_of(e: &Expr, target: &Control) -> Option<(Group, f64)> {
    let (number, more) = match e {
        Expr::System(Sys::Modal, subscripts) => (subscripts.first()?.constant()?, 0.0),
        Expr::System(Sys::ModalMotionPlus1, _) => (1.0, 1.0),
        _ => return None,
    };
    let there = target.system_address(Sys::Modal, &[number as u32]).is_some();
    if there || (more > 0.0 && target.system_run(Sys::ModalMotionPlus1).is_some()) {
        return None;
    }
    let group = Group::ALL.iter().find(|group| group.number().is_some_and(|n| f64::from(n) == number))?;
    Some((*group, more))
}

/// The codes of a group: their operations and numbers on the source, and the work offset that they select.
fn codes(group: Group, source: &Control) -> Vec<(Op, Option<u32>, f64)> {
    let mut found = Vec::new();
    for row in source.dialect().codes.iter().filter(|row| row.op.group() == group && row.preferred) {
        let Some(head) = row.head().filter(|head| head.letter == 'G') else { continue };
        if row.code.contains(' ') {
            continue;
        }
        let first = row.fixed.values().next().map(|number| *number as u32);
        let last = row.through.unwrap_or(head.number() as u32);
        match row.op {
            Op::SelectWork => {
                let numbers = head.number() as u32..=last;
                found.extend(
                    (0..)
                        .zip(numbers)
                        .map(|(at, number)| (row.op, first.map(|first| first + at), f64::from(number))),
                );
            }
            op => found.push((op, None, head.number())),
        }
    }
    found
}

/// True where a word beside a code selects additional work offsets too: then it is not known which code did.
fn has_words(source: &Control) -> bool {
    let mut rows = source.dialect().codes.iter().filter(|row| row.op == Op::SelectWork);
    rows.any(|row| row.code.contains(' '))
}

/// The number of what is in force, where the text says it.
pub(super) fn number_of(state: &Modal, group: Group, source: &Control) -> Option<f64> {
    let Setting::Known(op, offset) = state.of(group) else { return None };
    // What cancels a length may be another code to the variable.
    if group == Group::LengthComp && state.length_lost.may_be() {
        return None;
    }
    if op == Op::SelectWork && offset.is_none_or(|offset| offset > STANDARD_OFFSETS) && has_words(source) {
        return None;
    }
    let mut all = codes(group, source).into_iter();
    let (_, _, number) = all.find(|(other, selects, _)| {
        *other == op && (op != Op::SelectWork || (offset.is_some() && *selects == offset))
    })?;
    Some(number)
}

/// The number of the unit in force, of a target that is set to one unit and has no code for another.
fn unit(group: Group, source: &Control, target: &Control) -> Option<f64> {
    let has = |op| target.code_for(op, &BTreeMap::new()).is_some();
    let fixed = group == Group::Units && !has(Op::Inch) && !has(Op::Metric);
    let units = target.units().filter(|_| fixed)?;
    let op = if units == Units::Inch { Op::Inch } else { Op::Metric };
    codes(group, source).into_iter().find(|(other, ..)| *other == op).map(|(.., number)| number)
}

/// Puts constants where the text says what is in force.
fn known(module: &mut Module, context: &Context<'_>) -> bool {
    let mut changed = false;
    let facts = context.modal_facts(module);
    let (source, target) = (context.source, context.target);
    for (index, program) in
        module.programs.iter_mut().enumerate().filter(|(index, _)| may_read(*index, context))
    {
        for (id, block) in (0..).map(crate::ir::BlockId).zip(&mut program.blocks) {
            let mut state = facts.at(index, id);
            let mut put = |e: &mut Expr, state: &Modal| {
                e.walk_mut(&mut |e| {
                    if let Some((group, more)) = group_of(e, target)
                        && let Some(number) =
                            number_of(state, group, source).or_else(|| unit(group, source, target))
                    {
                        *e = Expr::Number(number + more);
                        changed = true;
                    }
                });
            };
            for stmt in &mut block.stmts {
                stmt.kind.exprs_mut(&mut |e| put(e, &state));
                state.step(stmt);
            }
            block.term.kind.exprs_mut(&mut |e| put(e, &state));
        }
    }
    changed
}

/// Puts tests where it does not.
fn tested(module: &mut Module, cycles: bool, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    let (source, target) = (context.source, context.target);
    for (index, program) in module.programs.iter_mut().enumerate() {
        if !may_read(index, context) {
            continue;
        }
        let mut found: Vec<Span> = Vec::new();
        changed |= rewrite_program(
            program,
            |e| matches!(e, Expr::System(Sys::Modal | Sys::ModalMotionPlus1, _)),
            &mut |e, _: Position, rewriter: &mut Rewriter<'_>| {
                let Some((group, more)) = group_of(&e, target) else { return e };
                if !matches!(group, Group::Distance | Group::WorkOffset) && (group != Group::Motion || cycles)
                {
                    return e;
                }
                let Some((last, tests)) = tests(group, source, target) else { return e };
                found.push(rewriter.span);
                let value = rewriter.materialize(Expr::Number(last + more));
                for (number, code) in tests {
                    let test = Expr::System(Sys::CodeTest, [Expr::Number(code)].into());
                    let cond = Cond::Compare(Relation::Equal, test, Expr::Number(0.0));
                    rewriter.first(PreStatement::When(cond, value, Expr::Number(number + more)));
                }
                Expr::Var(value)
            },
        );
        for span in found {
            let what = "a modal code that the program may have found in force is read: what is in force on the target \
                        when the program starts must be what would be in force on the source";
            context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
        }
    }
    changed
}

/// The number on the source that is left if no test holds, and those of the tests with the numbers that they test.
fn tests(group: Group, source: &Control, target: &Control) -> Option<(f64, Vec<(f64, f64)>)> {
    let there = codes(group, target);
    let mut tests = Vec::new();
    let mut left = None;
    for (op, offset, number) in codes(group, source) {
        let same = there.iter().find(|(other, selects, _)| *other == op && *selects == offset);
        // What the target lacks is never in force there.
        let Some((.., code)) = same else { continue };
        match target.system_address(Sys::CodeTest, &[*code as u32]) {
            Some(_) => tests.push((number, *code)),
            None if left.is_none() => left = Some(number),
            None => return None,
        }
    }
    let left = left.or_else(|| tests.pop().map(|(number, _)| number))?;
    Some((left, tests))
}

/// The blocks in which modal codes are only compared, with numbers that are the target's now.
pub(super) fn compared(program: &mut Program, controls: (&Control, &Control)) -> BTreeSet<Span> {
    let mut found = BTreeSet::new();
    for term in program.blocks.iter_mut().map(|block| &mut block.term) {
        if let TermKind::Branch { cond, .. } = &mut term.kind
            && compare_there(cond, controls)
        {
            found.insert(term.site.span);
        }
    }
    // What stands after THEN is in the same block.
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        let mut reads = false;
        stmt.kind.exprs(&mut |e| reads |= reads_modal(e));
        if reads {
            found.remove(&stmt.site.span);
        }
    }
    found
}

/// Compares the codes in force with the target's numbers where the source's are other ones: `#4001 EQ 90` of one system of G codes
/// is `#4001 EQ 77` of another. True if that settles every modal code that the condition reads.
fn compare_there(cond: &mut Cond, (source, target): (&Control, &Control)) -> bool {
    match cond {
        Cond::Compare(Relation::Equal | Relation::NotEqual, a, b) => {
            let (read, number) = if is_modal(a) { (&*a, b) } else { (&*b, a) };
            let (Expr::System(Sys::Modal, subscripts), Some(value)) = (read, number.constant()) else {
                return !reads_modal(read) && !reads_modal(number);
            };
            let group = subscripts.first().and_then(Expr::constant);
            let there = |group| {
                let settled = number_there(group, value, source, target).map(|there| (there, true));
                settled.or_else(|| additional_there(group, value, source, target).map(|there| (there, false)))
            };
            let Some((there, settles)) = group.and_then(there) else { return false };
            *number = Expr::Number(there);
            settles
        }
        Cond::Compare(_, a, b) => !reads_modal(a) && !reads_modal(b),
        // Each is looked at.
        Cond::And(all) | Cond::Or(all) => {
            all.iter_mut().map(|cond| compare_there(cond, (source, target))).fold(true, |all, one| all & one)
        }
        Cond::Not(inner) => compare_there(inner, (source, target)),
        Cond::Switch(_) => true,
    }
}

fn is_modal(e: &Expr) -> bool {
    matches!(e, Expr::System(Sys::Modal, _))
}

fn reads_modal(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |part| found |= is_modal(part));
    found
}

/// The number on the target of what the source has as this number of a group.
fn number_there(group: f64, number: f64, source: &Control, target: &Control) -> Option<f64> {
    let group = *Group::ALL.iter().find(|own| own.number().is_some_and(|own| f64::from(own) == group))?;
    let (op, offset, _) = codes(group, source).into_iter().find(|(.., own)| *own == number)?;
    let mut there = codes(group, target).into_iter();
    there.find(|(other, selects, _)| *other == op && *selects == offset).map(|(.., number)| number)
}

/// The number on the target of the code that selects an additional work offset by a word, where the source has this number for
/// it. That it is what is read there no maker's text says, so it settles nothing.
fn additional_there(group: f64, number: f64, source: &Control, target: &Control) -> Option<f64> {
    Group::WorkOffset.number().filter(|own| f64::from(*own) == group)?;
    let head = |control: &Control| {
        let mut rows = control.dialect().codes.iter().filter(|row| row.op == Op::SelectWork && row.preferred);
        rows.find(|row| row.code.contains(' ')).and_then(|row| row.head()).map(|head| head.number())
    };
    head(source).filter(|own| *own == number)?;
    head(target)
}

/// True for a condition that tests a code, which such a target takes as it stands.
pub(in crate::legalize) fn is_test(cond: &Cond) -> bool {
    matches!(cond, Cond::Compare(_, Expr::System(Sys::CodeTest, _), b) if b.constant() == Some(0.0))
}

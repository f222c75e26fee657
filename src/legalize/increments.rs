//! Numbers without a decimal point, where the target does not count them as the source does.
//!
//! Law: n increments are `n * increment` of the unit in force, for an angle of a degree. Side condition: the unit is known, from the
//! text or from a machine profile (a program that is called from both units has none); else the number keeps its form only where both controls count alike.

use super::{Context, ModalFacts, Setting};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{BareLength, Control, Units};
use crate::ir::{Block, BlockId, Call, Expr, Module, NcItem, Program, StmtKind, TermKind};

/// Converts counts of increments that the target reads otherwise.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let (source, target) = (context.source, context.target);
    let keeps = |local: u32| kept_by(local, source, target);
    each(module, context, counts, &mut |kind, units| match kind {
        Counted::Stmt(StmtKind::Nc(nc)) => nc.items.iter_mut().all(|item| match item {
            NcItem::Word(role, value) => word(value, *role, units, source, target),
            _ => true,
        }),
        Counted::Stmt(StmtKind::ModalCall(call)) => arguments(call, units, source, keeps),
        Counted::Call(call) => arguments(call, units, source, keeps),
        Counted::Stmt(_) => true,
    })
}

/// Converts those of the arguments of modal calls: they count in the unit where the call is opened, and
/// the moves behind which the macro runs may be in the other one.
pub(super) fn of_modal_calls(module: &mut Module, context: &mut Context<'_>) {
    let source = context.source;
    let modal = |block: &Block| block.stmts.iter().any(|s| matches!(s.kind, StmtKind::ModalCall(_)));
    each(module, context, modal, &mut |kind, units| match kind {
        Counted::Stmt(StmtKind::ModalCall(call)) => arguments(call, units, source, |_| false),
        _ => true,
    });
}

/// What may have counts of increments in it.
enum Counted<'m> {
    Stmt(&'m mut StmtKind),
    Call(&'m mut Call),
}

/// Takes what stands in the chosen blocks through `convert`, with the unit that is known there; what it cannot
/// convert is reported once a program. True where there are such blocks.
fn each(
    module: &mut Module,
    context: &mut Context<'_>,
    chosen: impl Fn(&Block) -> bool,
    convert: &mut dyn FnMut(Counted<'_>, Option<Units>) -> bool,
) -> bool {
    let source = context.source;
    let mut entry = context.entry.clone();
    if let (Setting::Unknown, Some(units)) = (entry.of(Group::Units), source.units()) {
        entry.start_in(if units == Units::Inch { Op::Inch } else { Op::Metric });
    }
    // Where no program names a unit, it is the machine's all through.
    let known = context.entry.op(Group::Units).is_some() || module.programs.iter().any(names_unit);
    let facts = if known { ModalFacts::of(module, &entry) } else { ModalFacts::unknown() };
    // The machine's unit is in force all through only where no program of the library names the other one.
    let machine = source.units().filter(|units| {
        let mut ops = module.programs.iter().flat_map(units_named);
        ops.all(|named| named == *units)
    });
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        // A program that names one unit throughout is in it wherever it is entered.
        let named = unit_named(program);
        let mut unknown = None;
        for (at, block) in program.blocks.iter_mut().enumerate().filter(|(_, block)| chosen(block)) {
            changed = true;
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                state.step(stmt);
                let units = unit(&state.of(Group::Units)).or(named).or(machine);
                if !convert(Counted::Stmt(&mut stmt.kind), units) {
                    unknown.get_or_insert(stmt.site.span);
                }
            }
            let units = unit(&state.of(Group::Units)).or(named).or(machine);
            if let TermKind::Call { call, .. } = &mut block.term.kind
                && !convert(Counted::Call(call), units)
            {
                unknown.get_or_insert(block.term.site.span);
            }
        }
        if let Some(span) = unknown {
            let what = "a number without a decimal point counts increments whose size depends on the unit in force, which is not known here";
            let help = "name the unit in the program (G20, G21) or in the machine profile of the source";
            context.add_once(
                index,
                "increments",
                Diagnostic::new(Code::NoEquivalent, span, what).with_help(help),
            );
        }
    }
    changed
}

/// True where a block has a count of increments.
fn counts(block: &Block) -> bool {
    let mut any = false;
    let mut look = |e: &Expr| {
        any |= match e {
            Expr::Negate(inner) => matches!(**inner, Expr::Increments(_)),
            e => matches!(e, Expr::Increments(_)),
        }
    };
    block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
    block.term.kind.exprs(&mut look);
    any
}

fn unit(setting: &Setting) -> Option<Units> {
    match setting {
        Setting::Known(Op::Inch, _) => Some(Units::Inch),
        Setting::Known(Op::Metric, _) => Some(Units::Metric),
        _ => None,
    }
}

/// The one unit that a program names.
fn unit_named(program: &Program) -> Option<Units> {
    let mut all = units_named(program);
    let first = all.next()?;
    all.all(|other| other == first).then_some(first)
}

/// True where a program selects a unit.
pub(super) fn names_unit(program: &Program) -> bool {
    units_named(program).next().is_some()
}

pub(super) fn units_named(program: &Program) -> impl Iterator<Item = Units> + '_ {
    let ncs = program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| match &stmt.kind {
        StmtKind::Nc(nc) => Some(nc),
        _ => None,
    });
    ncs.flat_map(|nc| nc.ops()).filter_map(|op| match op {
        Op::Inch => Some(Units::Inch),
        Op::Metric => Some(Units::Metric),
        _ => None,
    })
}

/// Converts a word where it must be; false where it must be and cannot.
fn word(value: &mut Expr, role: Role, units: Option<Units>, source: &Control, target: &Control) -> bool {
    let bare = if role == Role::Feed { target.bare_feed() } else { target.bare_length() };
    if bare == BareLength::Increments && same_increments(source, target) && role != Role::Feed {
        return true;
    }
    convert(value, role.is_angle(), units, source)
}

/// True where a number without a point counts the same behind this argument's letter on both controls.
fn kept_by(local: u32, source: &Control, target: &Control) -> bool {
    let letter = target.argument_letter(local);
    let bare = letter.map_or(BareLength::Unknown, |letter| target.bare_argument(letter));
    bare == BareLength::Increments && same_increments(source, target)
}

/// Converts the arguments of a call, but those whose local says that they are kept; false where one cannot be.
fn arguments(call: &mut Call, units: Option<Units>, source: &Control, kept: impl Fn(u32) -> bool) -> bool {
    let mut good = true;
    for argument in call.arguments.iter_mut().filter(|argument| !kept(argument.local)) {
        let word = source.argument_letter(argument.local).and_then(|letter| source.word(letter, false));
        let angle = word.is_some_and(|row| row.role.is_angle());
        good &= convert(&mut argument.value, angle, units, source);
    }
    good
}

fn same_increments(source: &Control, target: &Control) -> bool {
    let (a, b) = (source.numbers(), target.numbers());
    (a.increment_mm, a.increment_inch, a.increment_degrees)
        == (b.increment_mm, b.increment_inch, b.increment_degrees)
}

fn convert(value: &mut Expr, angle: bool, units: Option<Units>, source: &Control) -> bool {
    let inner = match value {
        Expr::Negate(inner) => inner.as_mut(),
        other => other,
    };
    let Expr::Increments(count) = inner else { return true };
    // Zero is zero in every unit.
    let per_unit = match units {
        _ if *count == 0.0 => 1.0,
        _ if angle => 1.0 / source.numbers().increment_degrees,
        Some(Units::Metric) => 1.0 / source.numbers().increment_mm,
        Some(Units::Inch) => 1.0 / source.numbers().increment_inch,
        None => return false,
    };
    // Dividing by a whole number gives the decimal that a person would write.
    *inner = Expr::Number(*count / per_unit.round());
    true
}

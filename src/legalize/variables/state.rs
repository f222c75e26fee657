//! Machine state that the target keeps in another form, or not at all.
//!
//! Laws: a diameter is twice a radius; a modal code plus one is the code and one; the seconds since
//! cycle start are a millisecond timer, set to 0 where the main program starts, over a thousand. A position whose
//! frame no source settles is taken as the work position, with a review diagnostic from lowering. The wear of a tool is 0 where
//! the target's table has one number that holds size and wear.

pub(in crate::legalize) mod additional;
mod ends;
mod findings;

use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::{Control, Question, Row};
use crate::ir::{BinOp, Expr, Module, Nc, NcItem, Place, Stmt, StmtKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::offsets::tool_word;
use crate::legalize::variables::{cycle_seconds, modal_reads};
use crate::legalize::{Context, Position, Rewriter, rewrite_program};
use crate::text::Span;
use findings::Finding;
use std::collections::BTreeSet;
use thin_vec::ThinVec;

/// States that the target may hold in each other's stead, and by what the first is multiplied to give the second.
pub(super) const SCALED: &[(Sys, Sys, f64)] = &[
    (Sys::RadiusGeometry, Sys::DiameterGeometry, 2.0),
    (Sys::RadiusWear, Sys::DiameterWear, 2.0),
    (Sys::DiameterGeometry, Sys::RadiusGeometry, 0.5),
    (Sys::DiameterWear, Sys::RadiusWear, 0.5),
    (Sys::CycleSeconds, Sys::TimerMs, 1000.0),
    (Sys::AxisPosition, Sys::WorkPosition, 1.0),
    (Sys::DiameterOrRadius, Sys::DiameterGeometry, 1.0),
    (Sys::DiameterOrRadius, Sys::RadiusGeometry, 0.5),
    (Sys::RadiusGeometry, Sys::DiameterOrRadius, 2.0),
    (Sys::DiameterGeometry, Sys::DiameterOrRadius, 1.0),
    (Sys::DiameterOrRadiusWear, Sys::DiameterWear, 1.0),
    (Sys::DiameterOrRadiusWear, Sys::RadiusWear, 0.5),
    (Sys::RadiusWear, Sys::DiameterOrRadiusWear, 2.0),
    (Sys::DiameterWear, Sys::DiameterOrRadiusWear, 1.0),
];

/// True where state is used.
pub fn concerns(features: &Features) -> bool {
    features.has(Feature::System) || features.op(Op::WriteRadius) || features.op(Op::WriteRadiusWear)
}

/// Rewrites machine state to what the target has; gives the programs that have any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> Vec<usize> {
    let (source, target) = (context.source, context.target);
    let (mut timed, mut changed) = (BTreeSet::new(), Vec::new());
    let additional = additional::may_select(module, context);
    let plain = ends::plain(module, context);
    for (index, program) in module.programs.iter_mut().enumerate() {
        if !context.may_concern(index, concerns) {
            continue;
        }
        changed.push(index);
        let mut found = Vec::<(Span, Finding)>::new();
        let compared = modal_reads::compared(program, (source, target));
        if !additional {
            additional::stop_reads(program, (source, target), &mut found);
        }
        rewrite_program(
            program,
            |e| matches!(e, Expr::System(..)),
            &mut |e, _: Position, rewriter: &mut Rewriter<'_>| match e {
                Expr::System(state, subscripts) => {
                    timed.extend((state == Sys::CycleSeconds).then_some(index));
                    read(state, subscripts, (source, target), rewriter.span, &mut found)
                }
                other => other,
            },
        );
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            write(stmt, (source, target), &mut found);
        }
        found.retain(|(span, finding)| {
            !matches!(finding, Finding::Renumbered(..)) || !compared.contains(span)
        });
        for (span, finding) in &mut found {
            if let Finding::Frame(Sys::EndPosition) = finding
                && plain.contains(&(index, *span))
            {
                *finding = Finding::Frame(Sys::WorkPosition);
            }
            if let Finding::Renumbered(code, true) = finding
                && !additional
            {
                *finding = Finding::NeverNamed(std::mem::take(code));
            }
        }
        found.into_iter().for_each(|(span, finding)| finding.report(index, span, context));
    }
    if !timed.is_empty() && target.system_run(Sys::CycleSeconds).is_none() {
        changed.extend(cycle_seconds::start(module, timed, context));
    }
    changed
}

fn wired(state: Sys) -> bool {
    use Sys::*;
    matches!(state, Input | InputWord | Output | OutputWord | Analog | InputInverted | OutputInverted)
}

/// The target's run of variables for a state with these subscripts.
fn held<'c>(
    state: Sys,
    subscripts: &[Expr],
    target: &'c Control,
) -> Option<&'c crate::dialect::SystemVariable> {
    let constants: Option<Vec<u32>> =
        subscripts.iter().map(|s| s.constant().filter(|n| *n >= 0.0).map(|n| n as u32)).collect();
    match constants {
        Some(constants) => target.system_address(state, &constants).map(|(_, _, row)| row),
        None => target.system_run(state),
    }
}

/// False for what only one control has, whose numbers mean nothing on another.
fn shared(state: Sys, source: &Control, target: &Control) -> bool {
    state != Sys::Other || source.name() == target.name()
}

fn note(state: Sys, row: &crate::dialect::SystemVariable, span: Span, found: &mut Vec<(Span, Finding)>) {
    if !row.origin.is_confirmed() {
        let note = row.origin.note.as_deref().map(|note| format!(": {note}")).unwrap_or_default();
        found.push((span, Finding::Unconfirmed(state, row.fact(), note)));
    }
    if wired(state) {
        found.push((span, Finding::Wiring));
    }
}

fn read(
    state: Sys,
    subscripts: ThinVec<Expr>,
    (source, target): (&Control, &Control),
    span: Span,
    found: &mut Vec<(Span, Finding)>,
) -> Expr {
    if let Some(row) = held(state, &subscripts, target).filter(|_| shared(state, source, target)) {
        note(state, row, span, found);
        let factor = settled((state, state), 1.0, (source, target), span, found);
        if let (Sys::Modal, Some(group)) = (state, subscripts.first().and_then(Expr::constant)) {
            let code = crate::legalize::codes::by_number::renumbered(group, source, target);
            let of_offsets = Group::WorkOffset.number().is_some_and(|number| f64::from(number) == group);
            found.extend(code.map(|code| (span, Finding::Renumbered(code, of_offsets))));
        }
        return scaled(Expr::System(state, subscripts), 1.0 / factor);
    }
    for (_, other, factor) in SCALED.iter().filter(|(from, ..)| *from == state) {
        if let Some(row) = held(*other, &subscripts, target) {
            note(*other, row, span, found);
            let value = Expr::System(*other, subscripts);
            return scaled(value, 1.0 / settled((state, *other), *factor, (source, target), span, found));
        }
    }
    match state {
        Sys::ModalMotionPlus1 if held(Sys::Modal, &[Expr::Number(1.0)], target).is_some() => {
            binary(BinOp::Add, Expr::System(Sys::Modal, [Expr::Number(1.0)].into()), 1.0)
        }
        Sys::Modal
            if subscripts.first().and_then(Expr::constant) == Some(1.0)
                && held(Sys::ModalMotionPlus1, &[], target).is_some() =>
        {
            binary(BinOp::Sub, Expr::System(Sys::ModalMotionPlus1, ThinVec::new()), 1.0)
        }
        Sys::Address
            if subscripts.first().and_then(Expr::constant) == Some(f64::from(tool_word::ADDRESS_T))
                && held(Sys::ActiveTool, &[], target).is_some() =>
        {
            found.push((span, Finding::ToolWord));
            Expr::System(Sys::ActiveTool, ThinVec::new())
        }
        Sys::WorkPosition | Sys::EndPosition | Sys::MachinePosition
            if held(Sys::AxisPosition, &subscripts, target).is_some()
                && (state == Sys::MachinePosition) == is_machine_frame(target) =>
        {
            found.push((span, Finding::Frame(state)));
            Expr::System(Sys::AxisPosition, subscripts)
        }
        Sys::ActiveTool if tool_word::stands_in(target) => {
            Expr::System(Sys::Address, [Expr::Number(f64::from(tool_word::ADDRESS_T))].into())
        }
        Sys::LengthWear | Sys::RadiusWear | Sys::DiameterWear | Sys::DiameterOrRadiusWear
            if holds_wear(state, &subscripts, target) =>
        {
            found.push((span, Finding::Worn(state)));
            Expr::Number(0.0)
        }
        Sys::Pi => Expr::Number(std::f64::consts::PI),
        Sys::Euler => Expr::Number(std::f64::consts::E),
        Sys::Empty => Expr::Vacant,
        _ => {
            if let Some(own) = own(state, &subscripts, source) {
                found.push((span, own));
                return Expr::Number(0.0);
            }
            let row = held(state, &subscripts, source).filter(|_| state == Sys::Modal);
            let note = row.and_then(|row| row.origin.note.clone());
            found.push((span, Finding::Missing(state, note, row.and_then(|row| unstated(row, source)))));
            Expr::Number(0.0)
        }
    }
}

/// True where a table has a tool's size, and no wear beside it.
fn holds_wear(state: Sys, subscripts: &[Expr], target: &Control) -> bool {
    let sizes: &[Sys] = match state {
        Sys::LengthWear => &[Sys::LengthGeometry, Sys::ToolOffset],
        _ => &[Sys::RadiusGeometry, Sys::DiameterGeometry, Sys::DiameterOrRadius],
    };
    let wears: &[Sys] = match state {
        Sys::LengthWear => &[Sys::LengthWear],
        _ => &[Sys::RadiusWear, Sys::DiameterWear, Sys::DiameterOrRadiusWear],
    };
    sizes.iter().any(|size| held(*size, subscripts, target).is_some())
        && !wears.iter().any(|wear| target.system_runs(*wear).next().is_some())
}

/// The setting by which a variable may be another one, where the profile does not state it.
fn unstated(row: &crate::dialect::SystemVariable, control: &Control) -> Option<String> {
    let (name, _) = row.when.as_deref()?.split_once('=')?;
    let short = name.strip_prefix("setting.")?;
    (!control.profile().settings.contains_key(short)).then(|| name.to_owned())
}

/// True for a control whose one kind of position is known to be in machine coordinates.
fn is_machine_frame(control: &Control) -> bool {
    control.behaviour(Question::PositionFrame).is_some_and(|row| row.value == "machine")
}

/// True where a control's cutter table holds radii; none if that is a setting which nobody stated.
fn holds_radii(control: &Control) -> Option<bool> {
    match control.behaviour(Question::RadiusOffsetTable)?.value.as_str() {
        "radius" => Some(true),
        "diameter" => Some(false),
        _ => None,
    }
}

/// By what a state is multiplied to give the other, where that hangs on what the cutter table of either
/// control holds. Factors are those of a table of diameters.
fn settled(
    (state, other): (Sys, Sys),
    factor: f64,
    (source, target): (&Control, &Control),
    span: Span,
    found: &mut Vec<(Span, Finding)>,
) -> f64 {
    let either = |state| matches!(state, Sys::DiameterOrRadius | Sys::DiameterOrRadiusWear);
    let ours = if either(state) { holds_radii(source) } else { Some(false) };
    let theirs = if either(other) { holds_radii(target) } else { Some(false) };
    // Where one of the two is stated, the other table is taken to hold diameters; where neither is, both to hold the same.
    let open = match (ours, theirs) {
        (Some(_), Some(_)) => (either(state) || either(other)).then_some(Finding::TablesHold),
        (Some(_), None) => Some(Finding::TargetTable),
        (None, None) => Some(Finding::Table(other)),
        (None, Some(_)) if either(other) => Some(Finding::Table(Sys::RadiusGeometry)),
        (None, Some(_)) => Some(Finding::Table(other)),
    };
    found.extend(open.map(|finding| (span, finding)));
    match (ours.unwrap_or(false), theirs.unwrap_or(false)) {
        (true, false) => 2.0 * factor,
        (false, true) => 0.5 * factor,
        _ => factor,
    }
}

/// A value times a factor; a division where the factor is a fraction whose inverse is exact.
fn scaled(value: Expr, factor: f64) -> Expr {
    if let Some(number) = value.constant() {
        return Expr::Number(number * factor);
    }
    match factor {
        1.0 => value,
        f if f < 1.0 && (1.0 / f).fract() == 0.0 => binary(BinOp::Div, value, 1.0 / f),
        f => binary(BinOp::Mul, value, f),
    }
}

fn binary(op: BinOp, a: Expr, b: f64) -> Expr {
    Expr::binary(op, a, Expr::Number(b))
}

fn write(stmt: &mut Stmt, (source, target): (&Control, &Control), found: &mut Vec<(Span, Finding)>) {
    let span = stmt.site.span;
    if let StmtKind::Nc(nc) = &mut stmt.kind
        && writes_radius(nc)
    {
        return write_radius(nc, (source, target), span, found);
    }
    let StmtKind::Assign { target: Place::System(state, subscripts), value } = &mut stmt.kind else { return };
    if let Some(row) = held(*state, subscripts, target).filter(|_| shared(*state, source, target)) {
        note(*state, row, span, found);
        let factor = settled((*state, *state), 1.0, (source, target), span, found);
        *value = scaled(std::mem::replace(value, Expr::Vacant), factor);
        if !row.access.contains('w') {
            found.push((span, Finding::ReadOnly(*state)));
        }
        return;
    }
    for (_, other, factor) in SCALED.iter().filter(|(from, ..)| from == state) {
        if let Some(row) = held(*other, subscripts, target).filter(|row| row.access.contains('w')) {
            note(*other, row, span, found);
            let factor = settled((*state, *other), *factor, (source, target), span, found);
            *value = scaled(std::mem::replace(value, Expr::Vacant), factor);
            *state = *other;
            return;
        }
    }
    let missing = || Finding::Missing(*state, None, None);
    found.push((span, own(*state, subscripts, source).unwrap_or_else(missing)));
}

/// A variable that only the source's control has: one of its own, or the last value of a letter.
fn own(state: Sys, subscripts: &[Expr], source: &Control) -> Option<Finding> {
    let letter = match state {
        Sys::Other => None,
        Sys::Address | Sys::AddressNow => Some(subscripts.first()?.constant().filter(|n| *n >= 1.0)? as u8),
        _ => return None,
    };
    let numbers: Option<Vec<u32>> = subscripts.iter().map(|s| s.constant().map(|n| n as u32)).collect();
    let (name, number, row) = source.system_address(state, &numbers?)?;
    let letter = letter.and_then(|letter| (b'A'..=b'Z').nth(usize::from(letter) - 1));
    let last = letter.map(|letter| match state {
        Sys::AddressNow => format!("the {} of its block", char::from(letter)),
        _ => format!("the last {}", char::from(letter)),
    });
    Some(Finding::Own(format!("{name}{}", number?), row.origin.note.clone().or(last)))
}

/// By what a number of the source's cutter table is multiplied to be one of the target's; none if nobody stated
/// what either holds. Where one of them is stated, the other is taken to hold diameters.
pub(in crate::legalize) fn table_factor(source: &Control, target: &Control) -> Option<f64> {
    let (ours, theirs) = (holds_radii(source), holds_radii(target));
    ours.or(theirs)?;
    Some(match (ours.unwrap_or(false), theirs.unwrap_or(false)) {
        (true, false) => 2.0,
        (false, true) => 0.5,
        _ => 1.0,
    })
}

/// True for a cell of a cutter table whose number on the target is another one, as one table holds radii and the other diameters.
pub(super) fn tables_differ(state: Sys, source: &Control, target: &Control) -> bool {
    matches!(state, Sys::DiameterOrRadius | Sys::DiameterOrRadiusWear)
        && table_factor(source, target).is_some_and(|factor| factor != 1.0)
}

/// True for a block that writes into the cutter table: the size or its wear, both as the table has them.
pub(in crate::legalize) fn writes_radius(nc: &Nc) -> bool {
    nc.has(Op::WriteRadius) || nc.has(Op::WriteRadiusWear)
}

/// What a block writes into the cutter table, as the target's table holds it.
fn write_radius(
    nc: &mut Nc,
    (source, target): (&Control, &Control),
    span: Span,
    found: &mut Vec<(Span, Finding)>,
) {
    match (holds_radii(source), holds_radii(target)) {
        (None, None) => return found.push((span, Finding::Table(Sys::DiameterOrRadius))),
        (None, Some(_)) => found.push((span, Finding::Table(Sys::RadiusGeometry))),
        (Some(_), None) => found.push((span, Finding::TargetTable)),
        (Some(_), Some(_)) => {}
    }
    found.push((span, Finding::TablesHold));
    let factor = table_factor(source, target).unwrap_or(1.0);
    for item in &mut nc.items {
        if let NcItem::Word(Role::OffsetValue, value) = item {
            *value = scaled(std::mem::replace(value, Expr::Vacant), factor);
        }
    }
}

//! Coordinates that are mirrored, turned or scaled.
//!
//! Laws: an axis that is mirrored about the work zero is mirrored about 0 on a control that mirrors about the coordinate
//! in its word; about 0 both do the same. Side conditions: codes that choose or leave the frame of coordinates may stand
//! under a rotation, and scaling may stand with a drilling cycle, only where that is known of both controls; where it is
//! not, the place is for review. Where it ends: a mirror about another coordinate than the work zero is refused where
//! the target mirrors about the zero, and one by a sign is written as that. The end of mirroring names no axes where a control is not known to take them and the block
//! ends all; and where the target is not known to end all by the code
//! alone, it names those that the library mirrors, in a block of its own. An angle or a factor that is not written, which each control takes from a setting of its
//! own, is written out where the source's profile has it, and refused where not.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Row, Side};
use crate::ir::analysis::behind::behind;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::Context;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

const ABOUT: Question = Question::MirrorAbout;
const OFF: Question = Question::MirrorOffAxes;
const BARE: Question = Question::MirrorOffBare;
const FRAME: Question = Question::ShapeFrameCodes;
const SCALE: Question = Question::ScaleReachesCycle;

/// Mirrors about the zero what the source mirrors so, and tells what no source says of shaped coordinates.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let mirrored = mirrored(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            for at in (0..block.stmts.len()).rev() {
                let stmt = &mut block.stmts[at];
                let span = stmt.site.span;
                if let StmtKind::Nc(nc) = &mut stmt.kind {
                    mirror_off(nc, &mirrored, (index, span), context);
                }
                if let Some(beside) = name_axes(stmt, &mirrored, index, context) {
                    block.stmts.insert(at + 1, beside);
                }
            }
        }
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let span = stmt.site.span;
            if let StmtKind::Nc(nc) = &mut stmt.kind
                && nc.has(Op::MirrorOn)
            {
                if axes(nc).next().is_none() {
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, NO_AXIS).with_help(NAME_IT));
                }
                if !about_zero(nc) {
                    mirror(nc, index, span, context);
                }
                by_sign(nc, index, span, context);
            }
            if let StmtKind::Nc(nc) = &mut stmt.kind {
                write_out(nc, context.source);
            }
            if let Some((what, op, role)) = stmt.kind.nc().and_then(from_setting)
                && context.source.name() != context.target.name()
            {
                let finding = Diagnostic::new(Code::NoEquivalent, span, what);
                context.add(index, by_setting(finding, context.source, op, role));
            }
            if let Some(nc) = stmt.kind.nc().filter(|nc| scales(nc)) {
                let counts_parts =
                    [context.source, context.target].iter().any(|control| control.scale_parts() != Some(1.0));
                if counts_parts && nc.items.iter().any(is_computed_factor) {
                    context.add_once(index, COMPUTED, Diagnostic::new(Code::Conditional, span, COMPUTED));
                }
                if context.target.scale_parts().is_none() {
                    context.rests_on_target(index, span, Question::ScalePoint);
                }
            }
        }
    }
    let shapes = [(Op::RotateOn, Op::RotateOff), (Op::ScaleOn, Op::ScaleOff), (Op::MirrorOn, Op::MirrorOff)];
    let mut found: Vec<(usize, Span, Question)> = Vec::new();
    for (on, off) in shapes {
        behind(
            module,
            |stmt| stmt.kind.has_op(on),
            |stmt| stmt.kind.has_op(off),
            |index, stmt| {
                let Some(nc) = stmt.kind.nc() else { return };
                if nc.ops().any(is_of_frame) {
                    found.push((index, stmt.site.span, FRAME));
                }
                if on == Op::ScaleOn && nc.ops().any(Op::is_cycle) {
                    found.push((index, stmt.site.span, SCALE));
                }
            },
        );
    }
    for (index, span, question) in found {
        if !agree(question, context) {
            context.rests_on_source(index, span, question);
            context.rests_on_target(index, span, question);
        }
    }
}

const COMPUTED: &str = "the scale factor is computed, and no source says whether a control takes its value or counts parts of it, as it does \
     with a number without a point: make sure that both take the value";

const NO_AXIS: &str = "this begins to mirror and names no axis: no page says what it does, and on most controls it mirrors nothing or is an alarm";
const NAME_IT: &str = "name the axis that the machine mirrors here, with 0 beside it";

/// The axes that the library mirrors.
fn mirrored(module: &Module) -> BTreeSet<Role> {
    let blocks = module.programs.iter().flat_map(|program| &program.blocks);
    let codes = blocks.flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
    codes.filter(|nc| nc.has(Op::MirrorOn)).flat_map(axes).collect()
}

fn axes(nc: &Nc) -> impl Iterator<Item = Role> {
    nc.items.iter().filter_map(|item| match item {
        NcItem::Word(role, _) => role.is_axis().then_some(*role),
        NcItem::Op(_) | NcItem::Code(..) => None,
    })
}

/// Lets the end of mirroring be that of all axes where it names all, and a control is not known to end those alone that it names.
fn mirror_off(
    nc: &mut Nc,
    mirrored: &BTreeSet<Role>,
    (index, span): (usize, Span),
    context: &mut Context<'_>,
) {
    let open = |control: &Control| control.behaviour(OFF).is_some_and(|row| row.value != "named");
    let (ours, theirs) = (open(context.source), open(context.target));
    let named: BTreeSet<Role> = axes(nc).collect();
    if !nc.has(Op::MirrorOff) || named.is_empty() || !ours && !theirs {
        return;
    }
    if named.is_superset(mirrored) {
        nc.items.retain(|item| !matches!(item, NcItem::Word(role, _) if role.is_axis()));
        return;
    }
    if context.source.is_same_machine(context.target) {
        return;
    }
    if ours {
        context.rests_on_source(index, span, OFF);
    }
    if theirs {
        context.rests_on_target(index, span, OFF);
    }
}

/// Names the axes whose mirroring a block ends, where the target is not known to end all by the code alone. Gives the codes that
/// stand beside it, for a block of their own after it: they must not take the axes for a move.
fn name_axes(
    stmt: &mut Stmt,
    mirrored: &BTreeSet<Role>,
    index: usize,
    context: &mut Context<'_>,
) -> Option<Stmt> {
    let span = stmt.site.span;
    let StmtKind::Nc(nc) = &mut stmt.kind else { return None };
    if !nc.has(Op::MirrorOff) || axes(nc).next().is_some() {
        return None;
    }
    let ends_all = |control: &Control| control.behaviour(BARE).is_none_or(|row| row.value == "all");
    if !ends_all(context.source) && !context.source.is_same_machine(context.target) {
        context.rests_on_source(index, span, BARE);
    }
    if ends_all(context.target) {
        return None;
    }
    let off = NcItem::Op(Op::MirrorOff);
    let items = nc.items.iter().filter(|item| **item != off).cloned().collect();
    nc.items = vec![off];
    // Where the library mirrors none, what may be in force is what the operator or another library left.
    let usual = BTreeSet::from([Role::X, Role::Y, Role::Z]);
    let named = if mirrored.is_empty() { &usual } else { mirrored };
    nc.items.extend(named.iter().map(|role| NcItem::Word(*role, Expr::Number(0.0))));
    let beside = Nc { items };
    let site = SourceInfo { span, skip: stmt.site.skip, ..SourceInfo::default() };
    (!beside.items.is_empty()).then_some(Stmt { kind: StmtKind::Nc(beside), site })
}

/// Writes what a block takes from a setting of its control, where the profile has it.
fn write_out(nc: &mut Nc, control: &Control) {
    let value = match from_setting(nc) {
        Some((_, _, role @ Role::Angle)) => control.bare_angle().map(|angle| (role, angle)),
        Some((_, _, role)) => control.bare_factor().map(|factor| (role, factor)),
        None => None,
    };
    nc.items.extend(value.map(|(role, value)| NcItem::Word(role, Expr::Number(value))));
}

/// What a block takes from a setting of the control, in words.
fn from_setting(nc: &Nc) -> Option<(&'static str, Op, Role)> {
    let has = |is_it: fn(Role) -> bool| {
        nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if is_it(*role)))
    };
    if nc.has(Op::RotateOn) && !has(|role| role == Role::Angle) {
        let what = "the angle of this rotation is not written: the control takes it from a setting of its own, and another control from another";
        Some((what, Op::RotateOn, Role::Angle))
    } else if nc.has(Op::ScaleOn) && !has(Role::is_scale) {
        let what = "the factor of this scaling is not written: the control takes it from a setting of its own, and another control from another";
        Some((what, Op::ScaleOn, Role::Scale))
    } else {
        None
    }
}

/// Names the setting of the source that the value stands in.
fn by_setting(finding: Diagnostic, control: &Control, op: Op, role: Role) -> Diagnostic {
    let Some((row, _)) = control.left_out(op, role) else {
        return finding.with_help("write the value that the setting of the old machine has");
    };
    let (kind, number) = row.name.split_once('.').unwrap_or(("setting", &row.name));
    let help = format!(
        "write the value into the block; or write in the profile of the {}, under [{kind}s]: {number} = \"...\" ({})",
        control.dialect().title,
        row.meaning
    );
    Diagnostic { setting: Some(row.name.as_str().into()), ..finding.with_help(help) }
}

fn is_computed_factor(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(role, value) if role.is_scale() && value.constant().is_none())
}

/// True for a block that begins scaling by a factor of its own.
fn scales(nc: &Nc) -> bool {
    let factor = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_scale());
    nc.has(Op::ScaleOn) && nc.items.iter().any(factor)
}

/// True where both controls are one, or are known to do the same.
fn agree(question: Question, context: &Context<'_>) -> bool {
    let (source, target) = (answer(context.source, question), answer(context.target, question));
    context.source.name() == context.target.name()
        && context.source.behaviour(question) == context.target.behaviour(question)
        || source.is_some() && source == target
}

/// A control's answer, where a source confirms it.
fn answer(control: &Control, question: Question) -> Option<&str> {
    let row = control.behaviour(question)?;
    (row.origin().is_confirmed() && row.value != "unknown").then_some(row.value.as_str())
}

fn about_zero(nc: &Nc) -> bool {
    nc.items.iter().all(|item| match item {
        NcItem::Word(role, value) => !role.is_axis() || value.constant() == Some(0.0),
        _ => true,
    })
}

/// A mirror that names another coordinate than 0.
fn mirror(nc: &mut Nc, index: usize, span: Span, context: &mut Context<'_>) {
    if agree(ABOUT, context) {
        return;
    }
    let is_zero = |control: &Control| {
        control.behaviour(ABOUT).is_some_and(|row| ["zero", "sign"].contains(&row.value.as_str()))
    };
    context.rests_on_source(index, span, ABOUT);
    if is_zero(context.source) {
        for item in &mut nc.items {
            if let NcItem::Word(role, value) = item
                && role.is_axis()
            {
                *value = Expr::Number(0.0);
            }
        }
    } else if is_zero(context.target) {
        let title = &context.target.dialect().title;
        let what = format!(
            "{title} mirrors about the work zero, but the program mirrors about another \
                            coordinate"
        );
        let help = "shift the work offset so that its zero lies there, and mirror about 0";
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
    } else {
        context.rests_on_target(index, span, ABOUT);
    }
}

/// Writes the sign that mirrors an axis about zero, where the target takes one.
fn by_sign(nc: &mut Nc, index: usize, span: Span, context: &mut Context<'_>) {
    if context.target.code_for(Op::MirrorOn, &BTreeMap::new()).is_none() {
        return;
    }
    let row = context.target.behaviour(ABOUT);
    match row.map(|row| row.value.as_str()) {
        Some("sign") => {
            for item in &mut nc.items {
                if let NcItem::Word(role, value) = item
                    && role.is_axis()
                    && value.constant() == Some(0.0)
                {
                    *value = Expr::Number(-1.0);
                }
            }
        }
        // About 0 a place and the zero are one.
        Some("unknown") if row.is_some_and(|row| row.one_of.iter().any(|one| one == "sign")) => {
            let finding = Diagnostic::new(Code::NoEquivalent, span, UNSAID);
            let help = context.target.to_settle(ABOUT.fact(), Side::Target);
            let setting = format!("behaviour.{}=sign", ABOUT.name());
            context.add_once(index, UNSAID, finding.with_help(help).lacking_there(setting));
        }
        _ => {}
    }
}

const UNSAID: &str =
    "no source says what the number beside the target's code for mirroring means: a place, or a sign";

/// True for a code that chooses or leaves the frame of coordinates.
fn is_of_frame(op: Op) -> bool {
    matches!(op.group(), Group::Plane | Group::WorkOffset)
        || matches!(op, Op::LocalShift | Op::SetPosition | Op::MachineOnce | Op::ReferenceFrom)
        || matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::Home)
}

//! Operations whose nearest relative on the target changes nothing that is measured on the part.
//!
//! Each row is a condition that a reviewer must accept: another coolant, corners that are rounded or stopped at
//! otherwise. Nothing that moves an axis, changes an offset or a mode of coordinates has a row here. Modes of quality are
//! left out with a note, unless the target has the same one: both controls follow the path within the tolerance that they are set to.

use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Expr, Nc, NcItem, Program, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::layout::emptied::drop_emptied;
use crate::text::Span;
use std::collections::BTreeMap;

/// An operation, what stands for it (nothing: it is left out), and what a reviewer must accept.
const ROWS: &[(Op, Option<Op>, &str)] = &[
    (Op::Mist, Some(Op::Flood), "the target has no mist coolant: flood coolant is switched on instead"),
    (Op::Flood, Some(Op::Mist), "the target has no flood coolant: mist coolant is switched on instead"),
    (
        Op::ExactStop,
        None,
        "exact stop is dropped: the target has no such code, and rounds corners or stops at them as it is set",
    ),
    (
        Op::ExactStopOnce,
        None,
        "exact stop at the end of a block is dropped: the target has no such code, and rounds corners or stops at them as it is set",
    ),
    (
        Op::CuttingMode,
        None,
        "the end of exact stop is dropped: the target has no such code, and rounds corners or stops at them as it is set",
    ),
    (
        Op::RampsOff,
        None,
        "acceleration ramps off is dropped: the target has no such code, and rounds corners or stops at \
         them as it is set",
    ),
    (
        Op::RampsOn,
        None,
        "acceleration ramps on is dropped: the target has no such code, and rounds corners or stops at \
         them as it is set",
    ),
    (
        Op::AxisGain,
        None,
        "a gain of the axes is dropped: the target has no such code, and its axes follow their path as closely as they \
         are set to",
    ),
    (
        Op::StrokeCheckOff,
        None,
        "the end of the stored stroke check is dropped: the target has no code for one, and watches its travel by settings alone",
    ),
    (
        Op::ScaleOff,
        None,
        "the end of scaling is dropped: the target has no code for scaling, and none may be in force there",
    ),
    (
        Op::MirrorOff,
        None,
        "the end of the mirror image is dropped: the target has no code for one, and none may be in force there",
    ),
];

/// True where an operation with a row stands, or a block that it may have left empty.
pub fn concerns(features: &Features) -> bool {
    features.has(Feature::Emptied)
        || features.op(Op::PathQuality)
        || ROWS.iter().any(|(op, ..)| features.op(*op))
}

/// Leaves out a mode of quality, with the words that belong to it. Beside axis words it would be something else: those
/// say where to go, or for which axes it is. A word of the arc in force would stay, and a centre alone is a full circle.
fn drop_quality(nc: &mut Nc, index: usize, span: Span, context: &mut Context<'_>) -> bool {
    let is_mode = |item: &NcItem| *item == NcItem::Op(Op::PathQuality);
    if !nc.items.iter().any(is_mode) {
        return false;
    }
    // The same mode on a relative of the control: it is written there.
    let mode = nc.word(Role::Quality).and_then(Expr::constant);
    let operands: BTreeMap<Role, f64> = mode.map(|mode| (Role::Quality, mode)).into_iter().collect();
    if mode.is_some() && context.target.code_for(Op::PathQuality, &operands).is_some() {
        return false;
    }
    let of_arc = |role: Role| matches!(role, Role::ArcI | Role::ArcJ | Role::ArcK | Role::ArcRadius);
    let axes = nc.names_axis();
    if axes || nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if of_arc(*role))) {
        let what = match axes {
            true => {
                "a mode of quality stands beside axis words: it is not known whether they are a move or its axes"
            }
            false => {
                "a mode of quality stands beside words of an arc: it is not known whether they are its own"
            }
        };
        let help = "write the mode in a block of its own";
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
        return false;
    }
    nc.items.retain(|item| !is_mode(item) && !matches!(item, NcItem::Word(role, _) if is_of_mode(*role)));
    let what = "a mode of how smoothly or how fast a path is followed is dropped: the target follows it as it is set";
    let told = Diagnostic::new(Code::QualityDropped, span, what);
    context.add_once(index, what, told.assuming(Predicate::Substitute(Op::PathQuality)));
    true
}

/// True for a word of a mode of quality.
fn is_of_mode(role: Role) -> bool {
    matches!(role, Role::Builder | Role::Quality | Role::Act1 | Role::Act2)
}

/// Puts substitutes in the place of operations that the target lacks.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let has = |op: Op| context.target.code_for(op, &BTreeMap::new()).is_some();
    let rows: Vec<_> = ROWS.iter().filter(|(op, other, _)| !has(*op) && other.is_none_or(has)).collect();
    let mut changed = false;
    for block in &mut program.blocks {
        for stmt in &mut block.stmts {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            changed |= drop_quality(nc, index, stmt.site.span, context);
            for (op, other, what) in &rows {
                let Some(at) = nc.items.iter().position(|item| *item == NcItem::Op(*op)) else {
                    continue;
                };
                // Words of axes that are mirrored would be a move.
                if op.group() == Group::Mirror && nc.names_axis() {
                    continue;
                }
                changed = true;
                match other {
                    Some(other) => nc.items[at] = NcItem::Op(*other),
                    None => drop(nc.items.remove(at)),
                }
                let told = Diagnostic::new(Code::Conditional, stmt.site.span, *what);
                // Whether it will do is a question of the machine, not of a program.
                context.add_once(index, what, told.assuming(Predicate::Substitute(*op)).asked_once());
            }
        }
        changed |= drop_emptied(block);
    }
    changed
}

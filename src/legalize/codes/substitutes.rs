//! Operations whose nearest relative on the target changes nothing that is measured on the part.
//!
//! Each row is a condition that a reviewer must accept: another coolant, corners that are rounded or stopped at
//! otherwise. Nothing that moves an axis, changes an offset or a mode of coordinates has a row here.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::ir::{NcItem, Program, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::layout::emptied::drop_emptied;
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
    features.has(Feature::Emptied) || ROWS.iter().any(|(op, ..)| features.op(*op))
}

/// Puts substitutes in the place of operations that the target lacks.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let has = |op: Op| context.target.code_for(op, &BTreeMap::new()).is_some();
    let rows: Vec<_> = ROWS.iter().filter(|(op, other, _)| !has(*op) && other.is_none_or(has)).collect();
    let mut changed = false;
    for block in &mut program.blocks {
        for stmt in &mut block.stmts {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
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
                context.add_once(index, what, Diagnostic::new(Code::Conditional, stmt.site.span, *what));
            }
        }
        changed |= drop_emptied(block);
    }
    changed
}

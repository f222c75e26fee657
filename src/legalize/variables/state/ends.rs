//! Where the end of the block before is where the axes stand.
//!
//! Law: without cutter compensation, rotation, scale and mirror image a block ends where its words say, and the axes stand there
//! once they have stopped; unless the move was a probe's, which stops where it touches. Side condition: what is in force
//! is known on every way, or no program of the library switches it on. Counter-example: `#1=#5001` after a block under G41.

use crate::canon::{Group, Op, Sys};
use crate::ir::{Expr, Module, Stmt};
use crate::legalize::each_step::each_step;
use crate::legalize::{Context, Modal, Setting};
use crate::text::Span;
use std::collections::BTreeSet;

/// What moves the axes away from where the words say.
const AWAY: [Group; 4] = [Group::RadiusComp, Group::Rotation, Group::Scaling, Group::Mirror];

/// The statements that read the end of the block before where that is so, by program.
pub(super) fn plain(module: &Module, context: &mut Context<'_>) -> BTreeSet<(usize, Span)> {
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    let mut found = BTreeSet::new();
    if !stmts().any(reads) {
        return found;
    }
    let facts = context.modal_facts(module);
    let never = AWAY.map(|group| !context.features.any_op(|op| op.group() == group && !is_off(op)));
    each_step(module, &facts, step, |index, stmt, (is_probed, off)| {
        let stands = off.into_iter().zip(never).all(|(off, never)| off || never);
        if stands && !is_probed && reads(stmt) {
            found.insert((index, stmt.site.span));
        }
    });
    found
}

/// Takes a statement; gives what is known to be off before it. `is_probed` is true where the last move was a probe's, on some way.
fn step(stmt: &Stmt, state: &mut Modal, is_probed: &mut bool) -> [bool; 4] {
    let off = AWAY.map(|group| matches!(state.of(group), Setting::Known(op, _) if is_off(op)));
    state.step(stmt);
    if let Some(nc) = stmt.kind.nc().filter(|nc| nc.moves() || nc.names_axis()) {
        let probes = nc.ops().any(|op| matches!(op, Op::Probe | Op::ProbeOther));
        // A block that may be skipped leaves what was.
        *is_probed = probes || *is_probed && stmt.site.skip.is_some();
    }
    off
}

fn is_off(op: Op) -> bool {
    matches!(op, Op::RadiusOff | Op::RotateOff | Op::ScaleOff | Op::MirrorOff)
}

fn reads(stmt: &Stmt) -> bool {
    let mut reads = false;
    stmt.kind.exprs(&mut |expr| {
        expr.walk(&mut |inner| reads |= matches!(inner, Expr::System(Sys::EndPosition, _)));
    });
    reads
}

//! Rapid moves at the two ends of such milling, for a target that takes none in it.
//!
//! Right after the start the length of C is 0, so a rapid move that leaves it there goes before the start, with X as a diameter. A rapid move of Z
//! alone right before the end goes after it.

use super::words::doubled;
use crate::canon::{Op, Role};
use crate::ir::{Expr, Module, Nc, NcItem, Stmt, StmtKind, Stmts};

/// Puts them outside, where no block skip stands between.
pub fn move_out(module: &mut Module) {
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        let mut at = 0;
        while at < block.stmts.len() {
            if alone(&block.stmts, at, Op::PolarPlane) {
                at = before_start(&mut block.stmts, at);
            } else if alone(&block.stmts, at, Op::PolarPlaneOff) {
                after_end(&mut block.stmts, at);
            }
            at += 1;
        }
    }
}

/// True for a block that has the code and nothing else.
fn alone(stmts: &[Stmt], at: usize, op: Op) -> bool {
    let stmt = stmts.get(at).filter(|stmt| stmt.site.skip.is_none());
    stmt.and_then(|stmt| stmt.kind.nc()).is_some_and(|nc| nc.items == [NcItem::Op(op)])
}

/// Moves the rapid moves after a start before it; where the start stands then.
fn before_start(stmts: &mut Stmts, start: usize) -> usize {
    let (mut start, mut at, mut rapid) = (start, start + 1, false);
    // X keeps to the side of the centre that it is on at the start.
    let outer = stands_outside(stmts, start);
    while let Some(stmt) = stmts.get(at) {
        let goes = match &stmt.kind {
            StmtKind::Comment => None,
            StmtKind::Nc(nc) if stmt.site.skip.is_none() => {
                rapid |= nc.has(Op::Rapid);
                match outside(nc, outer).filter(|_| rapid) {
                    Some(nc) => Some(nc),
                    None if is_plane(nc) => None,
                    None => break,
                }
            }
            _ => break,
        };
        if let Some(nc) = goes {
            let mut stmt = stmts.remove(at);
            stmt.kind = StmtKind::Nc(nc);
            stmts.insert(start, stmt);
            start += 1;
        }
        at += 1;
    }
    start
}

/// True where the last word of X before a start is a place above 0.
fn stands_outside(stmts: &Stmts, start: usize) -> bool {
    let before = stmts.iter().take(start).rev().filter_map(|stmt| stmt.kind.nc().map(|nc| (stmt, nc)));
    let mut names = before.filter(|(_, nc)| nc.word(Role::X).or(nc.word(Role::StepX)).is_some());
    let elsewhere =
        |nc: &Nc| nc.ops().any(|op| matches!(op, Op::MachineOnce | Op::ReferenceReturn | Op::Reference2));
    names
        .next()
        .is_some_and(|(stmt, nc)| stmt.site.skip.is_none() && !elsewhere(nc) && is_above(nc.word(Role::X)))
}

fn is_above(place: Option<&Expr>) -> bool {
    place.and_then(Expr::constant).is_some_and(|place| place > 0.0)
}

/// A rapid move at a length of 0 as one outside, of X only where that is the `outer` side; none for any other block.
fn outside(nc: &Nc, outer: bool) -> Option<Nc> {
    let mut items = Vec::with_capacity(nc.items.len());
    for item in &nc.items {
        match item {
            NcItem::Op(Op::Rapid) | NcItem::Word(Role::Z | Role::StepZ, _) => items.push(item.clone()),
            NcItem::Word(Role::X, value) if outer && is_above(Some(value)) => {
                items.push(NcItem::Word(Role::X, doubled(value)));
            }
            NcItem::Word(Role::Y, value) if value.constant() == Some(0.0) => {}
            _ => return None,
        }
    }
    items.iter().any(|item| matches!(item, NcItem::Word(..))).then_some(Nc { items })
}

/// Moves the rapid moves of Z before an end after it.
fn after_end(stmts: &mut [Stmt], end: usize) {
    let along_z = |nc: &Nc| {
        let along =
            |item: &NcItem| matches!(item, NcItem::Op(Op::Rapid) | NcItem::Word(Role::Z | Role::StepZ, _));
        nc.items.iter().all(along)
    };
    let mut first = None;
    for at in (0..end).rev() {
        let Some(stmt) = stmts.get(at).filter(|stmt| stmt.site.skip.is_none()) else { break };
        match &stmt.kind {
            StmtKind::Comment => {}
            StmtKind::Nc(nc) if along_z(nc) => {
                if nc.has(Op::Rapid) {
                    first = Some(at);
                }
            }
            _ => break,
        }
    }
    // The plane that is told after the end stays right after it.
    let planes = stmts.get(end + 1).filter(|stmt| stmt.site.skip.is_none());
    let last = end + usize::from(planes.and_then(|stmt| stmt.kind.nc()).is_some_and(is_plane));
    if let Some(moved) = first.and_then(|first| stmts.get_mut(first..=last)) {
        moved.rotate_right(last + 1 - end);
    }
}

/// True for a block that names a plane and nothing else.
fn is_plane(nc: &Nc) -> bool {
    matches!(nc.items.as_slice(), [NcItem::Op(Op::PlaneXy | Op::PlaneZx | Op::PlaneYz)])
}

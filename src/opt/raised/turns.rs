//! Whole turns that an angle loses.

use super::set;
use crate::canon::Func;
use crate::ir::analysis::{Liveness, Ways};
use crate::ir::{BinOp, Block, BlockId, Class, Expr, Place, Program, Stmt, Var};
use crate::opt::retarget::drop_statements;

const TURN: f64 = 360.0;

/// Leaves angles their turns where only sines and cosines read them.
pub(super) fn drop(program: &mut Program, ways: Ways) {
    let may = |block: &Block| block.stmts.iter().any(|stmt| less(stmt).is_some());
    if !program.blocks.iter().any(may) {
        return;
    }
    let live = Liveness::of(program, ways);
    let mut found: Vec<(BlockId, usize)> = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks).filter(|(_, block)| may(block)) {
        let mut after = Vec::new();
        live.backward(id, &mut |at, is_live| {
            if at + 1 == block.stmts.len() {
                let less = block.stmts.iter().filter_map(less).map(|(angle, _)| angle);
                after.extend(less.filter(|angle| is_live(angle)));
            }
        });
        let fits = |at: &usize| loses(block, *at, &after);
        found.extend((0..block.stmts.len()).filter(fits).map(|at| (id, at)));
    }
    drop_statements(program, &found);
}

/// `a = a - turns`: the angle, and what is taken off.
fn less(stmt: &Stmt) -> Option<(Var, Var)> {
    let (angle, value) = set(stmt)?;
    let Expr::Binary(BinOp::Sub, operands) = value else { return None };
    match **operands {
        [Expr::Var(from), Expr::Var(turns)]
            if from == angle && angle.class == Class::Temp && turns != angle =>
        {
            Some((angle, turns))
        }
        _ => None,
    }
}

/// True for a statement that takes whole turns off an angle which sines and cosines alone read; `after` are live after
/// the block.
fn loses(block: &Block, at: usize, after: &[Var]) -> bool {
    let Some((angle, turns)) = block.stmts.get(at).and_then(less) else { return false };
    let before = block.stmts.get(..at).unwrap_or_default();
    if !are_whole(before, turns) {
        return false;
    }
    let mut read = false;
    for stmt in block.stmts.get(at + 1..).unwrap_or_default() {
        let (mut all, mut own) = (0, 0);
        stmt.kind.exprs(&mut |e| {
            e.variables(&mut |var| all += usize::from(var == angle));
            e.walk(&mut |e| own += usize::from(is_of(e, angle)));
        });
        if all != own {
            return false;
        }
        read |= own > 0;
        match &stmt.kind.target() {
            Some(Place::Var(var)) if *var == angle => return read && stmt.site.skip.is_none(),
            _ => {}
        }
    }
    read && !after.contains(&angle)
}

/// True for the sine or cosine of a variable.
fn is_of(e: &Expr, angle: Var) -> bool {
    matches!(e, Expr::Call(Func::Sin | Func::Cos, of) if of.as_slice() == [Expr::Var(angle)])
}

/// True where a variable holds a whole number times a turn after these statements.
fn are_whole(stmts: &[Stmt], turns: Var) -> bool {
    let Some((at, value)) = last(stmts, turns) else { return false };
    let Expr::Binary(BinOp::Mul, operands) = value else { return false };
    match &**operands {
        [Expr::Call(Func::Fix, _), Expr::Number(by)] => *by == TURN,
        [Expr::Var(count), Expr::Number(by)] if *by == TURN => {
            let before = stmts.get(..at).unwrap_or_default();
            matches!(last(before, *count), Some((_, Expr::Call(Func::Fix, _))))
        }
        _ => false,
    }
}

/// The last statement that sets a variable, with only assignments of variables after it.
fn last(stmts: &[Stmt], var: Var) -> Option<(usize, &Expr)> {
    for (at, stmt) in stmts.iter().enumerate().rev() {
        let (written, value) = set(stmt)?;
        if written == var {
            return Some((at, value));
        }
    }
    None
}

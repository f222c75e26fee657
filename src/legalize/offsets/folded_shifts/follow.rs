//! By how much coordinates are shifted at a place.

use super::super::left_shifts::{AXES, is_none};
use crate::canon::Op;
use crate::ir::analysis::dataflow::{Lattice, OneOf};
use crate::ir::analysis::over_calls::Follow;
use crate::ir::{BinOp, Block, BlockId, Expr, Stmt};

/// The shift along each of X, Y, Z, A, B and C, by the bits of the number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shifted([OneOf<u64>; 6]);

impl Shifted {
    /// The one shift along an axis; none if it may be one of several.
    pub fn along(&self, axis: usize) -> Option<f64> {
        self.0[axis].only().map(|bits| f64::from_bits(*bits))
    }

    /// True where there is none along any axis.
    pub fn is_none(&self) -> bool {
        (0..AXES.len()).all(|axis| self.along(axis) == Some(0.0))
    }

    /// Takes the shift of a statement.
    pub fn step(&mut self, stmt: &Stmt) {
        let Some(nc) = stmt.kind.nc().filter(|nc| nc.has(Op::LocalShift)) else { return };
        for (role, held) in AXES.into_iter().zip(&mut self.0) {
            let Some(value) = nc.word(role) else { continue };
            let next = size(value).map_or_else(OneOf::any, one);
            if stmt.site.skip.is_some() {
                held.join(&next);
            } else {
                *held = next;
            }
        }
    }
}

impl Lattice for Shifted {
    fn join(&mut self, other: &Self) -> bool {
        self.0.iter_mut().zip(&other.0).fold(false, |changed, (mine, theirs)| mine.join(theirs) || changed)
    }
}

/// The size that a word sets: a number, or arithmetic of numbers.
pub(super) fn size(value: &Expr) -> Option<f64> {
    if is_none(value) {
        return Some(0.0);
    }
    // Sums of decimals are decimals.
    worked_out(value).map(|number| (number * 1e6).round() / 1e6)
}

/// What arithmetic of numbers comes to.
fn worked_out(e: &Expr) -> Option<f64> {
    let Expr::Binary(op, operands) = e else {
        return match e {
            Expr::Negate(inner) => worked_out(inner).map(|number| -number),
            e => e.constant(),
        };
    };
    let (a, b) = (worked_out(&operands[0])?, worked_out(&operands[1])?);
    let number = match op {
        BinOp::Add => a + b,
        BinOp::Sub => a - b,
        BinOp::Mul => a * b,
        BinOp::Div => a / b,
        _ => return None,
    };
    number.is_finite().then_some(number)
}

fn one(number: f64) -> OneOf<u64> {
    // There are two zeros.
    OneOf::one((number + 0.0).to_bits())
}

/// Follows it over calls.
pub(super) struct Shifts;

impl Follow for Shifts {
    type Known = Shifted;

    fn outside(&self, _: usize) -> Shifted {
        Shifted(std::array::from_fn(|_| one(0.0)))
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, shifted: &mut Shifted) {
        block.stmts.iter().for_each(|stmt| shifted.step(stmt));
    }

    fn lose(&self, _: &mut Shifted) {}
}

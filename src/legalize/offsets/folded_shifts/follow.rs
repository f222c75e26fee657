//! By how much coordinates are shifted at a place.

use super::super::left_shifts::{AXES, is_none};
use crate::canon::Op;
use crate::ir::analysis::dataflow::{Lattice, OneOf};
use crate::ir::analysis::entries;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::{BinOp, Block, BlockId, Expr, Module, Program, Stmt};

/// The shift along each of X, Y, Z, A, B and C.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shifted([Along; 6]);

/// The shift along an axis.
#[derive(Clone, Debug, PartialEq)]
struct Along {
    /// By the bits of the number.
    size: OneOf<u64>,
    /// What the register of the axis can hold it by.
    told: Told,
}

/// Where the register of an axis is told its shift, from the best.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Told {
    /// By a block on every way.
    Block,
    /// On some ways by the start of the program alone: there is none until a block sets one.
    Start,
    /// On some ways nowhere.
    Nowhere,
}

/// By how much a word is further along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum By {
    Number(f64),
    /// By what the register of the axis holds; true if starts of programs must set it too.
    Register(bool),
}

impl Shifted {
    /// The one shift along an axis; none if it may be one of several.
    fn along(&self, axis: usize) -> Option<f64> {
        self.0[axis].size.only().map(|bits| f64::from_bits(*bits))
    }

    /// What a word of an axis is further along by; none if nothing tells it.
    pub fn by(&self, axis: usize) -> Option<By> {
        let told = self.0[axis].told;
        let register = || (told != Told::Nowhere).then_some(By::Register(told == Told::Start));
        self.along(axis).map(By::Number).or_else(register)
    }

    /// True where there is none along any axis.
    pub fn is_none(&self) -> bool {
        (0..AXES.len()).all(|axis| self.along(axis) == Some(0.0))
    }

    /// Takes the shift of a statement.
    pub fn step(&mut self, stmt: &Stmt) {
        let Some(nc) = stmt.kind.nc().filter(|nc| nc.has(Op::LocalShift)) else { return };
        for (role, along) in AXES.into_iter().zip(&mut self.0) {
            let Some(value) = nc.word(role) else { continue };
            let next = size(value).map_or_else(OneOf::any, one);
            if stmt.site.skip.is_some() {
                along.size.join(&next);
            } else {
                *along = Along { size: next, told: Told::Block };
            }
        }
    }
}

impl Lattice for Shifted {
    fn join(&mut self, other: &Self) -> bool {
        let mut changed = false;
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            changed |= mine.size.join(&theirs.size) | (theirs.told > mine.told);
            mine.told = mine.told.max(theirs.told);
        }
        changed
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
pub(super) struct Shifts {
    /// True for the programs of which all runs pass their first statement once.
    pub starts: Vec<bool>,
}

impl Shifts {
    /// Of a library, by the programs of it that others call.
    pub fn of(module: &Module, called: &[bool]) -> Self {
        let comes_back = |program: &Program| {
            let mut ways = program.blocks.iter().flat_map(|block| block.term.kind.successors());
            ways.any(|to| to == BlockId(0)) || entries(program).any(|to| to == BlockId(0))
        };
        let starts = module.programs.iter().zip(called).map(|(p, called)| !called && !comes_back(p));
        Self { starts: starts.collect() }
    }
}

impl Follow for Shifts {
    type Known = Shifted;

    fn outside(&self, program: usize) -> Shifted {
        let starts = self.starts.get(program) == Some(&true);
        let told = if starts { Told::Start } else { Told::Nowhere };
        Shifted(std::array::from_fn(|_| Along { size: one(0.0), told }))
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, shifted: &mut Shifted) {
        block.stmts.iter().for_each(|stmt| shifted.step(stmt));
    }

    fn lose(&self, shifted: &mut Shifted) {
        shifted.0.iter_mut().for_each(|along| along.told = Told::Nowhere);
    }
}

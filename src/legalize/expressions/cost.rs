//! How many brackets an expression has inside one another, and about how many characters, where it is written with as
//! few brackets as keep its tree.
//!
//! Names of registers are not known yet: they count [`REGISTER`] characters. What is counted wrong is not written
//! wrong: the emitter counts what it has written.

use crate::dialect::Control;
use crate::ir::{BinOp, Cond, Expr};
use crate::legalize::features::is_long;
use smallvec::SmallVec;

/// Characters of a register's name.
pub(in crate::legalize) const REGISTER: usize = 5;

/// Characters that no name of a function has more of.
const NAME: usize = 8;

/// The size of something written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::legalize) struct Size {
    /// Brackets inside one another.
    pub depth: u32,
    /// Characters.
    pub length: usize,
}

impl Size {
    /// The same in brackets.
    pub fn bracketed(self) -> Size {
        Size { depth: self.depth + 1, length: self.length + 2 }
    }

    /// Beside another, with so many characters between them.
    pub fn beside(self, other: Size, between: usize) -> Size {
        Size { depth: self.depth.max(other.depth), length: self.length + other.length + between }
    }
}

/// Measures for a control.
#[derive(Clone, Copy)]
pub(in crate::legalize) struct Measure<'c> {
    control: &'c Control,
    /// By operator: higher binds tighter; 0 where nothing confirms what stands beside it.
    ranks: [u32; 8],
    comparisons: [u32; 6],
}

impl<'c> Measure<'c> {
    pub fn new(control: &'c Control) -> Self {
        let rank = |meaning: &str| {
            let row = control.operator(meaning).filter(|row| row.origin.is_settled());
            row.map_or(0, |row| row.rank.saturating_add(1))
        };
        Self { control, ranks: OPERATORS.map(rank), comparisons: COMPARISONS.map(rank) }
    }

    /// The size of an expression to which nothing else is joined.
    pub fn expr(&self, e: &Expr) -> Size {
        let mut operands = SmallVec::<[Size; 4]>::new();
        e.exprs(&mut |operand| operands.push(self.expr(operand)));
        self.joined(e, &operands)
    }

    /// The size of an expression whose operands have these sizes.
    pub fn joined(&self, e: &Expr, operands: &[Size]) -> Size {
        let all = |between: usize| {
            let first = operands.first().copied().unwrap_or_default();
            operands.iter().skip(1).fold(first, |sum, operand| sum.beside(*operand, between))
        };
        let leaf = |length: usize| Size { depth: 0, length };
        match e {
            Expr::Number(value) => leaf(digits(*value)),
            Expr::Increments(_) | Expr::Vacant | Expr::Var(_) => leaf(REGISTER),
            Expr::System(..) if operands.iter().all(|operand| operand.length <= 3) => leaf(REGISTER),
            // `#[5201+20*#1]`.
            Expr::System(..) => all(4).bracketed().beside(leaf(1), 8),
            Expr::Indirect(..) => all(0).bracketed().beside(leaf(1), 0),
            Expr::Negate(inner) => {
                let inner = if matches!(**inner, Expr::Binary(..)) { all(0).bracketed() } else { all(0) };
                inner.beside(leaf(1), 0)
            }
            Expr::Binary(op, sides) => {
                let rank = self.rank(*op);
                let spaces =
                    if matches!(op, BinOp::Add | BinOp::Sub | BinOp::Mul | BinOp::Div) { 1 } else { 5 };
                let [left, right] = [0, 1].map(|at| operands.get(at).copied().unwrap_or_default());
                let mixed = |side: &Expr| matches!(side, Expr::Binary(inner, _) if !op.reads_beside(*inner));
                let joins = |at: usize| mixed(&sides[at]) || self.binds_less(&sides[at], rank, at == 1);
                let left = if joins(0) { left.bracketed() } else { left };
                let right = if joins(1) { right.bracketed() } else { right };
                left.beside(right, spaces)
            }
            Expr::Call(function, arguments) => {
                let row = self.control.function(*function, arguments.len());
                let name = leaf(row.map_or(5, |row| row.spelling.len()));
                match (row.and_then(|row| row.form.as_deref()), operands) {
                    (Some("slash"), [a, b]) => a.bracketed().beside(b.bracketed(), 1).beside(name, 0),
                    _ => all(1).bracketed().beside(name, 0),
                }
            }
            Expr::Truth(cond) => self.cond(cond).bracketed(),
        }
    }

    /// No less than [`Measure::expr`] gives, in less time: most expressions are far smaller than may be.
    pub fn bound(&self, e: &Expr) -> Size {
        let leaf = |length: usize| Size { depth: 0, length };
        let all = |operands: &[Expr]| {
            operands.iter().fold(leaf(0), |sum, operand| sum.beside(self.bound(operand), 4)).bracketed()
        };
        match e {
            Expr::Number(value) if is_long(*value) => leaf(digits(*value)),
            Expr::Number(_) => leaf("-1234.5678".len()),
            Expr::Increments(_) | Expr::Vacant | Expr::Var(_) => leaf(REGISTER),
            Expr::System(_, subscripts) => all(subscripts).beside(leaf(9), 0),
            Expr::Indirect(_, inner) | Expr::Negate(inner) => {
                self.bound(inner).bracketed().beside(leaf(1), 0)
            }
            Expr::Binary(op, operands) => {
                let [left, right] = [0, 1].map(|at| {
                    let (operand, size) = (&operands[at], self.bound(&operands[at]));
                    let joins = matches!(operand, Expr::Call(..))
                        || matches!(operand, Expr::Binary(inner, _) if !op.reads_beside(*inner))
                        || self.binds_less(operand, self.rank(*op), at == 1);
                    if joins { size.bracketed() } else { size }
                });
                left.beside(right, 5)
            }
            Expr::Call(_, arguments) => all(arguments).beside(leaf(NAME), 0),
            Expr::Truth(_) => Size { depth: u32::MAX / 2, length: u32::MAX as usize },
        }
    }

    /// The size of a condition, without the brackets of its IF.
    pub fn cond(&self, cond: &Cond) -> Size {
        match cond {
            Cond::Compare(relation, a, b) => {
                let rank = self.comparisons[*relation as usize];
                let side = |e: &Expr| {
                    let size = self.expr(e);
                    // The writer brackets a sum whatever the ranks are.
                    let sum = matches!(e, Expr::Binary(BinOp::Add | BinOp::Sub, _));
                    if sum || self.binds_less(e, rank, true) { size.bracketed() } else { size }
                };
                side(a).beside(side(b), 4)
            }
            Cond::And(parts) | Cond::Or(parts) => {
                let mut parts = parts.iter().map(|part| self.cond(part).bracketed());
                let first = parts.next().unwrap_or_default();
                parts.fold(first, |sum, part| sum.beside(part, 5))
            }
            Cond::Not(inner) => self.cond(inner),
            Cond::Switch(_) => Size::default(),
        }
    }

    fn rank(&self, op: BinOp) -> u32 {
        self.ranks[op as usize]
    }

    /// True for an operand that needs brackets beside an operator of a rank.
    fn binds_less(&self, operand: &Expr, rank: u32, right: bool) -> bool {
        match operand {
            Expr::Binary(op, ..) => {
                let own = self.rank(*op);
                rank == 0 || own == 0 || own < rank || (right && own == rank)
            }
            Expr::Call(function, arguments) => {
                let slash = self.control.function(*function, 2);
                arguments.len() <= 2 && slash.is_some_and(|row| row.form.as_deref() == Some("slash"))
            }
            Expr::Negate(_) => right,
            Expr::Number(value) => right && value.is_sign_negative(),
            _ => false,
        }
    }
}

/// Characters of a constant.
fn digits(value: f64) -> usize {
    // Nearly all are small whole numbers.
    match value {
        0.0..10.0 if value.fract() == 0.0 && value.is_sign_positive() => 1,
        10.0..100.0 if value.fract() == 0.0 => 2,
        _ => value.to_string().len(),
    }
}

/// The names in the tables, in the order of [`BinOp`].
const OPERATORS: [&str; 8] =
    ["add", "subtract", "multiply", "divide", "modulo", "and.bits", "or.bits", "xor.bits"];

/// The names in the tables, in the order of [`Relation`](crate::ir::Relation).
const COMPARISONS: [&str; 6] = ["eq", "ne", "lt", "le", "gt", "ge"];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canon::{Func, Sys};
    use crate::dialect::registry;
    use crate::ir::{Bank, Class, Relation, Var};
    use proptest::prelude::*;

    fn expressions() -> impl Strategy<Value = Expr> {
        let var = |number| Expr::Var(Var { class: Class::Common, number });
        let number = prop_oneof![
            any::<i16>().prop_map(f64::from),
            any::<i32>().prop_map(|n| f64::from(n) / 1e4),
            any::<f64>().prop_filter("a number", |n| n.is_finite()),
        ];
        let leaf = prop_oneof![number.prop_map(Expr::Number), (100..999u32).prop_map(var)];
        leaf.prop_recursive(6, 40, 3, |inner| {
            let one = inner.clone();
            prop_oneof![
                one.clone().prop_map(|e| Expr::Negate(Box::new(e))),
                one.clone().prop_map(|e| Expr::Indirect(Bank::Numbered, Box::new(e))),
                one.clone().prop_map(|e| Expr::System(Sys::LengthGeometry, [e].into_iter().collect())),
                one.prop_map(|e| Expr::Call(Func::Sqrt, [e].into_iter().collect())),
                [inner.clone(), inner.clone()].prop_map(|[a, b]| Expr::binary(BinOp::Xor, a, b)),
                [inner.clone(), inner.clone()].prop_map(|[a, b]| Expr::binary(BinOp::Sub, a, b)),
                [inner.clone(), inner.clone()]
                    .prop_map(|all| Expr::Call(Func::Atan, all.into_iter().collect())),
                [inner.clone(), inner].prop_map(|[a, b]| Expr::Truth(Box::new(Cond::Compare(
                    Relation::Less,
                    a,
                    b
                )))),
            ]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: proptest::test_runner::RngSeed::Fixed(29), cases: 600, failure_persistence: None, ..ProptestConfig::default()
        })]
        #[test]
        fn nothing_is_larger_than_its_bound(e in expressions()) {
            for entry in registry::all() {
                let Some(control) = Control::plain(entry.name) else { continue };
                let measure = Measure::new(&control);
                let (size, most) = (measure.expr(&e), measure.bound(&e));
                prop_assert!(size.depth <= most.depth && size.length <= most.length, "{size:?} {most:?}");
            }
        }
    }

    #[test]
    fn names_of_functions_are_short() {
        for control in registry::all().iter().filter_map(|entry| Control::plain(entry.name)) {
            assert!(control.dialect().functions.iter().all(|row| row.spelling.len() <= NAME));
        }
    }
}

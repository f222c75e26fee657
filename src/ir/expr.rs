//! Expressions and conditions.

use super::{Bank, Place, Var};
use crate::canon::{Func, Sys};
use thin_vec::ThinVec;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Expr {
    /// A number.
    Number(f64),
    /// A count of least increments of the address that the value goes to: `X10` on a
    /// control that counts so. Stands only as the whole value of a word or an
    /// argument, or under one [`Expr::Negate`] there. One increment may also be multiplied by a computed count ([`Expr::count`]).
    Increments(f64),
    /// No value.
    Vacant,
    /// What a variable holds.
    Var(Var),
    /// What the variable with a computed number holds.
    Indirect(Bank, Box<Expr>),
    /// State of the machine, with its subscripts.
    System(Sys, ThinVec<Expr>),
    /// `-a`.
    Negate(Box<Expr>),
    /// `a op b`.
    Binary(BinOp, Box<[Expr; 2]>),
    /// A function.
    Call(Func, ThinVec<Expr>),
    /// 1 where the condition holds, else 0.
    Truth(Box<Cond>),
}

/// Arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BinOp {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// Quotient; a divisor of 0 stops the machine.
    Div,
    /// Remainder of the operands rounded to whole numbers, with the dividend's sign.
    Mod,
    /// Bitwise and of 32-bit whole numbers.
    And,
    /// Bitwise or of 32-bit whole numbers.
    Or,
    /// Bitwise exclusive or of 32-bit whole numbers.
    Xor,
}

/// A comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Relation {
    /// Equal; vacant equals only vacant.
    Equal,
    /// Not equal.
    NotEqual,
    /// Less, vacant counting as 0.
    Less,
    /// Less or equal, vacant counting as 0.
    LessEqual,
    /// Greater, vacant counting as 0.
    Greater,
    /// Greater or equal, vacant counting as 0.
    GreaterEqual,
}

/// A condition.
#[derive(Clone, Debug, PartialEq)]
pub enum Cond {
    /// A comparison.
    Compare(Relation, Expr, Expr),
    /// All hold. Every operand is evaluated.
    And(Vec<Cond>),
    /// One holds at least. Every operand is evaluated.
    Or(Vec<Cond>),
    /// Does not hold.
    Not(Box<Cond>),
    /// The operator's block-skip switch of this number (1 to 9) is on.
    Switch(u8),
}

impl BinOp {
    /// True where an operand of `inner` reads without brackets beside this operator, as far as their ranks allow it:
    /// sums and products have an order that everybody knows, and one operator alone has one. `FIX[#1] OR 1-3` has
    /// none, and which of `OR` and `-` comes first no maker's text says.
    pub const fn reads_beside(self, inner: BinOp) -> bool {
        const fn is_word(op: BinOp) -> bool {
            matches!(op, BinOp::Mod | BinOp::And | BinOp::Or | BinOp::Xor)
        }
        self as u8 == inner as u8 || !is_word(self) && !is_word(inner)
    }
}

impl Relation {
    /// The relation that holds exactly when this one does not.
    pub const fn negated(self) -> Self {
        match self {
            Relation::Equal => Relation::NotEqual,
            Relation::NotEqual => Relation::Equal,
            Relation::Less => Relation::GreaterEqual,
            Relation::LessEqual => Relation::Greater,
            Relation::Greater => Relation::LessEqual,
            Relation::GreaterEqual => Relation::Less,
        }
    }

    /// The relation with its operands exchanged.
    pub const fn swapped(self) -> Self {
        match self {
            Relation::Less => Relation::Greater,
            Relation::LessEqual => Relation::GreaterEqual,
            Relation::Greater => Relation::Less,
            Relation::GreaterEqual => Relation::LessEqual,
            same => same,
        }
    }
}

impl Cond {
    /// The condition that holds exactly when this one does not. Numbers are never
    /// NaN here, and vacancy behaves alike on both sides, so this is exact.
    #[must_use]
    pub fn negated(self) -> Self {
        match self {
            Cond::Compare(relation, a, b) => Cond::Compare(relation.negated(), a, b),
            Cond::And(all) => Cond::Or(all.into_iter().map(Cond::negated).collect()),
            Cond::Or(any) => Cond::And(any.into_iter().map(Cond::negated).collect()),
            Cond::Not(inner) => *inner,
            Cond::Switch(n) => Cond::Not(Box::new(Cond::Switch(n))),
        }
    }

    /// What comparisons for equal say on the way on which this holds, or does not: a variable, what it was compared with,
    /// and whether the two differ.
    pub fn likened<'e>(&'e self, holds: bool, each: &mut impl FnMut(Var, &'e Expr, bool)) {
        match (self, holds) {
            (Cond::Not(inner), _) => inner.likened(!holds, each),
            (Cond::And(all), true) | (Cond::Or(all), false) => {
                all.iter().for_each(|cond| cond.likened(holds, each));
            }
            (
                Cond::Compare(relation, Expr::Var(var), other)
                | Cond::Compare(relation, other, Expr::Var(var)),
                _,
            ) => match relation {
                Relation::Equal => each(*var, other, !holds),
                Relation::NotEqual => each(*var, other, holds),
                _ => {}
            },
            _ => {}
        }
    }
}

impl Expr {
    /// `a op b`.
    pub fn binary(op: BinOp, a: Expr, b: Expr) -> Self {
        Expr::Binary(op, Box::new([a, b]))
    }

    /// A computed count of least increments: so many times one.
    pub fn of_count(count: Expr) -> Self {
        Self::binary(BinOp::Mul, count, Expr::Increments(1.0))
    }

    /// The count, where the expression is a computed one of least increments.
    pub fn count(&self) -> Option<&Expr> {
        match self {
            Expr::Binary(BinOp::Mul, parts) if parts[1] == Expr::Increments(1.0) => Some(&parts[0]),
            _ => None,
        }
    }

    /// The constant's value, where the expression is one (a negated constant too).
    pub fn constant(&self) -> Option<f64> {
        match self {
            Expr::Number(value) => Some(*value),
            Expr::Negate(inner) => inner.constant().map(|v| -v),
            _ => None,
        }
    }

    /// True where the value can only be a whole number, or vacant.
    pub fn is_whole(&self) -> bool {
        match self {
            Expr::Number(value) => value.fract() == 0.0,
            Expr::Negate(inner) => inner.is_whole(),
            Expr::Truth(_) | Expr::Vacant => true,
            Expr::Binary(BinOp::And | BinOp::Or | BinOp::Xor | BinOp::Mod, _) => true,
            Expr::Binary(BinOp::Add | BinOp::Sub | BinOp::Mul, operands) => {
                operands.iter().all(Self::is_whole)
            }
            Expr::Call(Func::Fix | Func::Fup | Func::Round | Func::Bin | Func::Bcd, _) => true,
            Expr::System(state, _) => {
                matches!(state, Sys::Input | Sys::InputWord | Sys::Output | Sys::OutputWord)
            }
            _ => false,
        }
    }

    /// The place that the expression reads and nothing else, where it is a plain read.
    pub fn place(&self) -> Option<Place> {
        match self {
            Expr::Var(var) => Some(Place::Var(*var)),
            Expr::Indirect(bank, index) => Some(Place::Indirect(*bank, index.clone())),
            Expr::System(state, subscripts) => Some(Place::System(*state, subscripts.clone())),
            _ => None,
        }
    }

    /// True where evaluating it may yield vacant: copies of variables do, arithmetic does not.
    pub fn may_be_vacant(&self) -> bool {
        match self {
            Expr::Vacant | Expr::Indirect(Bank::Numbered, _) => true,
            Expr::Var(var) => var.class.nullable(),
            Expr::System(state, _) => {
                matches!(state, Sys::Empty | Sys::Address | Sys::AddressNow | Sys::Act)
            }
            _ => false,
        }
    }
}

/// True for a number with more than three places: an increment of lengths is a thousandth of a millimetre.
pub fn is_finer_than_words(number: f64) -> bool {
    let thousandths = number.abs() * 1000.0;
    (thousandths - thousandths.round()).abs() > 1e-6
}

//! Prints variables, expressions and conditions.

use crate::ir::{Bank, BinOp, BlockId, Class, Cond, Expr, Place, Relation, Var};
use std::fmt::{Display, Formatter, Result};

/// Name of each class, as it stands before a variable's number.
pub(super) const CLASSES: &[(Class, &str)] = &[
    (Class::Local, "local"),
    (Class::Common, "common"),
    (Class::Retained, "retained"),
    (Class::Global, "global"),
    (Class::Parametric, "param"),
    (Class::Register, "register"),
    (Class::Temp, "tmp"),
    (Class::Static, "static"),
];

/// Name of each operator, and how tight it binds.
pub(super) const OPERATORS: &[(BinOp, &str, u8)] = &[
    (BinOp::Add, "+", 1),
    (BinOp::Sub, "-", 1),
    (BinOp::Or, "or", 1),
    (BinOp::Xor, "xor", 1),
    (BinOp::Mul, "*", 2),
    (BinOp::Div, "/", 2),
    (BinOp::Mod, "mod", 2),
    (BinOp::And, "and", 2),
];

/// Name of each relation.
pub(super) const RELATIONS: &[(Relation, &str)] = &[
    (Relation::Equal, "eq"),
    (Relation::NotEqual, "ne"),
    (Relation::Less, "lt"),
    (Relation::LessEqual, "le"),
    (Relation::Greater, "gt"),
    (Relation::GreaterEqual, "ge"),
];

/// Binds tighter than every operator.
const TIGHT: u8 = 3;

impl Display for BlockId {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "block{}", self.0)
    }
}

impl Display for Var {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{}.{}", class_name(self.class), self.number)
    }
}

impl Display for Place {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Place::Var(var) => write!(f, "{var}"),
            Place::Indirect(bank, index) => indirect(f, *bank, index),
            Place::System(state, subscripts) => system(f, state.name(), subscripts),
        }
    }
}

impl Display for Expr {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        expr(f, self, 0)
    }
}

impl Display for Cond {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let list = |f: &mut Formatter<'_>, name, conds: &[Cond]| {
            write!(f, "{name}(")?;
            joined(f, conds)?;
            f.write_str(")")
        };
        match self {
            Cond::Compare(relation, a, b) => {
                let name = RELATIONS.iter().find(|(r, _)| r == relation).map_or("", |(_, name)| name);
                write!(f, "{a} {name} {b}")
            }
            Cond::And(conds) => list(f, "all", conds),
            Cond::Or(conds) => list(f, "any", conds),
            Cond::Not(inner) => write!(f, "not({inner})"),
            Cond::Switch(number) => write!(f, "switch {number}"),
        }
    }
}

/// The name of a class.
pub(super) fn class_name(class: Class) -> &'static str {
    CLASSES.iter().find(|(c, _)| *c == class).map_or("", |(_, name)| name)
}

/// A number, so that it reads back bit for bit.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-5..1e15).contains(&size) || !value.is_finite() {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

fn expr(f: &mut Formatter<'_>, e: &Expr, least: u8) -> Result {
    match e {
        Expr::Number(value) => f.write_str(&number(*value)),
        Expr::Increments(count) => write!(f, "increments({})", number(*count)),
        Expr::Vacant => f.write_str("vacant"),
        Expr::Var(var) => write!(f, "{var}"),
        Expr::Indirect(bank, index) => indirect(f, *bank, index),
        Expr::System(state, subscripts) => system(f, state.name(), subscripts),
        Expr::Negate(a) if matches!(**a, Expr::Number(_) | Expr::Negate(_)) => write!(f, "-({a})"),
        Expr::Negate(a) => {
            f.write_str("-")?;
            expr(f, a, TIGHT)
        }
        Expr::Binary(op, operands) => {
            let [a, b] = &**operands;
            let row = OPERATORS.iter().find(|(o, ..)| o == op);
            let (name, rank) = row.map_or(("", 0), |(_, name, rank)| (*name, *rank));
            let fence = rank < least;
            if fence {
                f.write_str("(")?;
            }
            expr(f, a, rank)?;
            write!(f, " {name} ")?;
            expr(f, b, rank + 1)?;
            if fence { f.write_str(")") } else { Ok(()) }
        }
        Expr::Call(function, arguments) => {
            write!(f, "{function}(")?;
            joined(f, arguments)?;
            f.write_str(")")
        }
        Expr::Truth(cond) => write!(f, "truth({cond})"),
    }
}

fn indirect(f: &mut Formatter<'_>, bank: Bank, index: &Expr) -> Result {
    let name = match bank {
        Bank::Numbered => "#",
        Bank::Global => "global",
        Bank::Parametric => "param",
    };
    write!(f, "{name}[{index}]")
}

fn system(f: &mut Formatter<'_>, name: &str, subscripts: &[Expr]) -> Result {
    write!(f, "sys {name}")?;
    if subscripts.is_empty() {
        return Ok(());
    }
    f.write_str("[")?;
    joined(f, subscripts)?;
    f.write_str("]")
}

fn joined<T: Display>(f: &mut Formatter<'_>, items: &[T]) -> Result {
    items.iter().enumerate().try_for_each(|(at, item)| {
        if at > 0 {
            f.write_str(", ")?;
        }
        write!(f, "{item}")
    })
}

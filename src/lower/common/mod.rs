//! What the lowerings of all dialects need: findings that name a fact once,
//! the site of a block, constants, what may be in force.

mod beside_codes;
mod findings;
mod in_force;
mod nowhere;
mod programs;
mod site;

pub use beside_codes::may_take;
pub use findings::{Findings, otherwise};
pub use in_force::InForce;
pub use nowhere::Nowhere;
pub use programs::{ProgramText, programs, says_something};
pub use site::{comment_text, site_of};

use crate::ir::Relation;
use crate::syntax::{BinaryOp, Expr, ExprKind, Item, ItemKind};
use smallvec::SmallVec;

/// What is told of a program that moves before it names a motion mode; the library may know its callers.
pub const CALLERS_MODE: &str =
    "this moves in the caller's motion mode; if that is an arc mode, the conversion moves straight";

/// The value of a constant: a number, signed or in brackets or not. One that is too
/// large for any control is none.
pub fn constant(expr: &Expr) -> Option<f64> {
    let mut sign = 1.0;
    let mut at = expr;
    loop {
        match &at.kind {
            ExprKind::Number(number) => return Some(sign * number.value).filter(|value| value.is_finite()),
            ExprKind::Negate(inner) => {
                sign = -sign;
                at = inner;
            }
            ExprKind::Plus(inner) | ExprKind::Group(inner) => at = inner,
            _ => return None,
        }
    }
}

/// The letters of a block's plain words with their constant values, as
/// [`crate::dialect::Control::code`] wants them. Comma words are left out.
pub fn letters(items: &[Item]) -> SmallVec<[(char, Option<f64>); 6]> {
    let words = items.iter().filter_map(|item| match &item.kind {
        ItemKind::Word(word) if !word.comma => Some(word),
        _ => None,
    });
    words.map(|word| (word.letter, word.value.as_ref().and_then(constant))).collect()
}

/// The relation of an operator that compares.
pub fn relation(op: BinaryOp) -> Option<Relation> {
    Some(match op {
        BinaryOp::Equal => Relation::Equal,
        BinaryOp::NotEqual => Relation::NotEqual,
        BinaryOp::Less => Relation::Less,
        BinaryOp::LessEqual => Relation::LessEqual,
        BinaryOp::Greater => Relation::Greater,
        BinaryOp::GreaterEqual => Relation::GreaterEqual,
        _ => return None,
    })
}

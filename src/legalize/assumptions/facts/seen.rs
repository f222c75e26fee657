//! Which blocks of constants were looked at: what another one rests on hangs on its operations and words alone.

use crate::canon::Role;
use crate::ir::{Expr, Nc, NcItem};
use smallvec::SmallVec;
use std::collections::BTreeSet;

/// Blocks of constants that were looked at.
#[derive(Default)]
pub(super) struct Seen {
    /// Their operations and words.
    shapes: BTreeSet<Shape>,
    /// The words of those of them that have no operation, a bit for each word.
    words: [u64; WORDS],
}

impl Seen {
    /// True where a block of these words rests on nothing that was not looked at; notes that it was.
    pub(super) fn is_known(&mut self, nc: &Nc) -> bool {
        let known = |item: &NcItem| {
            let word = part(item).filter(|(_, sign)| *sign != Sign::None).map(bit);
            word.is_some_and(|(at, bit)| self.words[at] & bit != 0)
        };
        if nc.items.iter().all(known) {
            return true;
        }
        let Some(shape) = nc.items.iter().map(part).collect::<Option<Shape>>() else { return false };
        if shape.iter().all(|(_, sign)| *sign != Sign::None) {
            shape.iter().map(|word| bit(*word)).for_each(|(at, bit)| self.words[at] |= bit);
        }
        !self.shapes.insert(shape)
    }
}

/// The operations and words of a block of constants.
type Shape = SmallVec<[Part; 8]>;

/// An operation, or a word by its role and the sign of its value.
type Part = (u16, Sign);

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Sign {
    /// Of an operation.
    None,
    Plus,
    Minus,
    /// That stands before the constant.
    Negated,
}

/// Of 64 bits: four signs of each role.
const WORDS: usize = Role::ALL.len() * 4 / 64 + 1;

/// What a block rests on hangs on no more than this of each item; none if it may.
fn part(item: &NcItem) -> Option<Part> {
    match item {
        NcItem::Op(op) => Some((*op as u16, Sign::None)),
        NcItem::Word(Role::WorkOffset | Role::Repeat, _) | NcItem::Code(..) => None,
        NcItem::Word(role, value) => {
            let sign = match value {
                Expr::Number(value) if *value < 0.0 => Sign::Minus,
                Expr::Number(_) => Sign::Plus,
                Expr::Negate(inner) if matches!(**inner, Expr::Number(_)) => Sign::Negated,
                _ => return None,
            };
            Some((*role as u16, sign))
        }
    }
}

/// The bit of a word.
fn bit((role, sign): Part) -> (usize, u64) {
    let at = usize::from(role) * 4 + sign as usize;
    (at / 64, 1 << (at % 64))
}

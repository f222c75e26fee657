//! What an NC block does to the flow of control, in the order it is written in.

use super::block_codes::{Codes, word};
use crate::canon::{Op, Role};
use crate::lower::common::constant;
use crate::syntax::{Expr, ExprKind, Index, Item};

/// One thing that a block does to the flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step<'b> {
    /// `L100`: a subroutine begins.
    Define(u32),
    /// `L101`, `L+R2`: a subroutine is called.
    Local(&'b Expr),
    /// `M98 P800`.
    Program,
    /// `G67`.
    ModalOff,
    /// `M17`.
    SubEnd,
    /// `M30`.
    AreaEnd,
    /// `M2`.
    End,
    /// `M99`, `M99 P10`.
    Return,
}

/// What an L word is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LWord {
    /// `L100`: the subroutine of this number.
    Define(u32),
    /// A call.
    Call,
    /// An operand: of a code, or how often a motion block is repeated.
    Operand,
}

/// The first subroutine number that the control keeps for itself.
pub const FIRST_FIXED: u32 = 91;

/// What the L word with this value is.
pub fn l_word(value: &Expr, codes: &Codes<'_, '_>) -> LWord {
    let operand = codes.known().any(|row| {
        row.words.contains_key("L")
            || row.beside().is_some_and(|beside| beside.iter().any(|word| word.letter == 'L'))
    });
    match constant(value) {
        _ if operand => LWord::Operand,
        Some(number) if (100.0..10_000.0).contains(&number) && number.fract() == 0.0 => {
            let number = number as u32;
            if number.is_multiple_of(100) { LWord::Define(number / 100) } else { LWord::Call }
        }
        Some(_) => LWord::Operand,
        None => LWord::Call,
    }
}

/// The steps of a block's words.
pub fn steps<'b>(items: &'b [Item], codes: &Codes<'b, '_>) -> Vec<Step<'b>> {
    let mut steps = Vec::new();
    for item in items {
        let Some(word) = word(item) else { continue };
        if word.letter == 'L'
            && let Some(value) = &word.value
        {
            match l_word(value, codes) {
                LWord::Define(sub) => steps.push(Step::Define(sub)),
                LWord::Call => steps.push(Step::Local(value)),
                LWord::Operand => {}
            }
        }
        let step = match codes.row(item).map(|row| row.op) {
            Some(Op::CallProgram) => Step::Program,
            Some(Op::CallModalOff) => Step::ModalOff,
            Some(Op::SubEnd) => Step::SubEnd,
            Some(Op::SubAreaEnd | Op::EndRewind) => Step::AreaEnd,
            Some(Op::End) => Step::End,
            Some(Op::Return) => Step::Return,
            _ => continue,
        };
        steps.push(step);
    }
    steps
}

/// The value of the word in an operand role of a flow code: P of `M98 P800`.
pub fn operand<'b>(items: &'b [Item], codes: &Codes<'b, '_>, role: Role) -> Option<&'b Expr> {
    items.iter().filter_map(word).find_map(|word| {
        let is = codes.role(word.letter, word.comma, None) == Ok(Some(role));
        word.value.as_ref().filter(|_| is)
    })
}

/// The number of the parametric variable that a value is, and whether its sign is minus.
pub fn parametric(value: &Expr) -> Option<(u32, bool)> {
    match &value.kind {
        ExprKind::Plus(inner) | ExprKind::Group(inner) => parametric(inner),
        ExprKind::Negate(inner) => parametric(inner).map(|(number, minus)| (number, !minus)),
        ExprKind::Variable(var) if var.name == "R" => match var.index {
            Index::Number(number) => Some((number, false)),
            _ => None,
        },
        _ => None,
    }
}

/// The number of a program that is named by a constant.
pub fn program_number(value: &Expr) -> Option<u32> {
    let number = constant(value)?;
    (number.fract() == 0.0 && (0.0..=9_999_999.0).contains(&number)).then_some(number as u32)
}

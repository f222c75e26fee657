//! Names of variables, as texts have them.

use crate::dialect::{Control, VariableClass};
use crate::syntax::{Index, VarRef};

/// The class of a variable by its whole name, `#100` or `VX`.
pub fn class_of<'c>(control: &'c Control, variable: &str) -> Option<&'c VariableClass> {
    let digits = variable.find(|sign: char| sign.is_ascii_digit());
    match digits {
        Some(at) => {
            let (name, number) = variable.split_at_checked(at)?;
            control.variable_class(name, number.parse().ok()?)
        }
        None => {
            let letter = variable.chars().last()?;
            control.letter_class(variable.strip_suffix(letter)?, letter)
        }
    }
}

/// The number of a variable as its whole name has it: 12 for `V12`, and none for `V012`, which is no name.
pub fn numbered(name: &str, letter: &str) -> Option<u32> {
    let digits = name.strip_prefix(letter)?;
    let is_plain =
        digits.bytes().all(|sign| sign.is_ascii_digit()) && (digits == "0" || !digits.starts_with('0'));
    digits.parse().ok().filter(|_| is_plain)
}

/// The whole name of a variable whose subscript is written: `#100`, `VX`. Of two numbers of one cell it has the cell's own.
pub fn name_of(variable: &VarRef, control: &Control) -> Option<String> {
    match &variable.index {
        Index::Number(number) => Some(format!("{}{}", variable.name, control.cell(&variable.name, *number))),
        Index::Letter(letter) => Some(format!("{}{letter}", variable.name)),
        _ => None,
    }
}

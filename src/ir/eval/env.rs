//! What an evaluation reads, and why it may stop.

use crate::canon::{Func, Sys};
use crate::ir::{Bank, Var};

/// A number, or vacant.
pub type Value = Option<f64>;

/// How deep expressions and conditions may nest.
pub const MAX_DEPTH: usize = 256;

/// Why an evaluation stops the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Alarm {
    /// A divisor of 0.
    #[error("division by zero")]
    DivideByZero,
    /// An argument outside the domain of its function.
    #[error("{0} outside its domain")]
    Domain(Func),
    /// A function with a number of arguments that it does not have.
    #[error("{0} with a wrong number of arguments")]
    Arity(Func),
    /// A result that no number can hold.
    #[error("overflow")]
    Overflow,
    /// An operand of a bit operation that 32 bits cannot hold.
    #[error("operand exceeds 32 bits")]
    Bits,
    /// State that the environment does not know.
    #[error("no such state: {0}")]
    State(Sys),
    /// A computed variable number without a variable.
    #[error("no such variable")]
    Variable,
    /// A value that depends on an address, where there is none.
    #[error("value depends on the address it stands in")]
    Address,
    /// Nesting past [`MAX_DEPTH`].
    #[error("nested too deep")]
    Depth,
}

/// The range of the arc tangent of two arguments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AtanRange {
    /// 0 up to 360.
    #[default]
    Full,
    /// Above -180 up to 180.
    Signed,
}

/// What an evaluation reads.
pub trait Env {
    /// What a variable holds. Must not be vacant for classes that never are.
    fn var(&self, var: Var) -> Value;

    /// What the variable with a computed number holds.
    fn indirect(&self, _bank: Bank, _number: u32) -> Result<Value, Alarm> {
        Err(Alarm::Variable)
    }

    /// State of the machine. A vacant subscript has been read as 0.
    fn system(&self, state: Sys, _subscripts: &[f64]) -> Result<Value, Alarm> {
        Err(Alarm::State(state))
    }

    /// True while the operator's block-skip switch of this number is on.
    fn switch(&self, _number: u8) -> bool {
        false
    }

    /// The least increment of the address that the value goes to.
    fn increment(&self) -> Result<f64, Alarm> {
        Err(Alarm::Address)
    }

    /// A parameter of the control: number, then bit or axis.
    fn parameter(&self, _arguments: &[f64]) -> Result<f64, Alarm> {
        Err(Alarm::Domain(Func::Parameter))
    }

    /// The range of the arc tangent of two arguments.
    fn atan_range(&self) -> AtanRange {
        AtanRange::default()
    }
}

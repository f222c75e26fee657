//! Syntax to IR: what a program of one control means, spelled out.
//!
//! Each dialect has one submodule; what a family of them shares is written once.
//! Lowering asks the [`crate::dialect::Control`] for every fact: what a code
//! does, what a letter means beside it, which machine state a system variable
//! is. What has no row there is not guessed at: it becomes a diagnostic of
//! severity error, and the program is refused.

pub mod cc100;
pub mod common;
pub mod fadal;
pub mod fanuc;
pub mod haas;
mod macro_b;

use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::{Program, Var};
use crate::syntax::ParsedFile;
use std::collections::BTreeMap;

/// Lowers all programs of a file. `file` is the file's index in its library and
/// `name` its name (some controls know programs by their file).
pub type Lower = fn(parsed: &ParsedFile<'_>, file: usize, name: &str, control: &Control) -> Lowered;

/// Where a file can be cut, at least `least` bytes apart: lowering the parts one by one is lowering the file, if a
/// program begins each of them. None where a program may need what stands in others.
pub type Cuts = fn(source: &[u8], least: usize) -> Vec<Cut>;

/// A line that a part of a file begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cut {
    /// Offset of its first byte.
    pub at: u32,
    /// How many lines stand before it.
    pub lines: usize,
}

/// The programs of one file.
#[derive(Clone, Debug, Default)]
pub struct Lowered {
    /// The programs, each with what was found while lowering it.
    pub programs: Vec<(Program, Vec<Diagnostic>)>,
    /// Names that people know variables by.
    pub names: BTreeMap<Var, String>,
    /// Framing of the file that is not part of any program: true where a `%` stands.
    pub tape: bool,
}

//! IR to target text.
//!
//! What arrives here is legal for the target: each operation has a code, each
//! function exists, each loop and call is one that the control knows. Emission
//! chooses spelling, brackets, labels and layout, nothing else. What has no row
//! in the target's table after all is refused with [`crate::diag::Code::Unmapped`]
//! and never printed as it came: nothing here takes text of the source but
//! comments and messages.
//!
//! Each dialect has one submodule; what a family of them shares is a module as well: [`macro_b`], and so is what all targets
//! share: `common`.

pub mod cc100;
mod common;
pub mod fadal;
pub mod fanuc;
pub mod haas;
pub mod macro_b;
mod naming;

pub use naming::{Index, Naming, Register, last_sequence};

use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::Valid;
use crate::text::Span;
use std::ops::Range;

/// Gathers what all programs of a library need to be written for a control.
pub type Emit = for<'a> fn(names: &'a Naming, control: &'a Control) -> Writer<'a>;

/// Writes a program. What it cannot write exactly comes back as diagnostics, all of them at once,
/// and then there is no text.
pub type Writer<'a> = Box<dyn Fn(Valid<'_>) -> Result<Emitted, Vec<Diagnostic>> + Sync + 'a>;

/// A program as the target reads it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Emitted {
    /// Its blocks, one a line, each with a line feed; without the framing of a file.
    pub text: String,
    /// Which bytes of the source each block of `text` comes from, in order; blocks that
    /// come from nowhere are not in it. Ranges leave the line feed out.
    pub blocks: Vec<(Span, Range<usize>)>,
    /// True where blocks have sequence numbers that the source does not give them.
    pub invents: bool,
    /// What a person must look at; none of it is an error.
    pub findings: Vec<Diagnostic>,
}

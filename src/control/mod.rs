//! Emulated controls: run a dialect's own program by that control's own rules and
//! record what the machine would do.
//!
//! A control is the oracle of the compiler. It reads `syntax` and asks `dialect`, and
//! shares nothing with `lower`, `ir`, `opt`, `legalize` and `emit`: a rule that one side
//! misread is then seen as a difference by `verify`.
//!
//! Each dialect has an interpreter that reads its statements and expressions. What a block
//! tells the machine they hand on in common terms (a [`machine::Command`]) to the one
//! [`machine::Machine`], which keeps the state of the machine and writes the [`trace`].
//! Whatever a control cannot say for certain is recorded as [`trace::EventKind::Unsure`]
//! where it mattered.
//!
//! Every run ends: it is bounded in steps, in events and in time.

mod by_need;
mod by_place;
pub mod cc100;
pub mod entry;
pub mod fadal;
pub mod fanuc;
mod fewer;
pub mod haas;
mod kept;
pub mod library;
pub mod machine;
mod macro_b;
mod outcome;
pub mod outside;
pub mod scenario;
mod session;
mod table;
#[cfg(test)]
#[allow(missing_docs)]
pub(crate) mod testing;
pub mod trace;
mod words;

pub use entry::Entry;
pub use fewer::FEWER_DIGITS;
pub use library::{Heard, Library, LoadedFile, ProgramRef};
pub use outcome::{Branch, Branches, End, Run, Stop};
pub use scenario::Scenario;
pub use table::Table;
pub use trace::Trace;

use crate::dialect::Control;

/// Runs a program of a library on its control.
///
/// `library` holds the files in which calls look for programs, in the order in which they
/// are looked through. The run ends by itself (the end of the program, an alarm, an error)
/// or at a bound of the scenario; nothing makes it panic.
pub type Execute =
    for<'f> fn(library: &Library<'f>, main: ProgramRef, control: &Control, scenario: &Scenario) -> Run;

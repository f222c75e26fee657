//! IR to IR that the target control can say.
//!
//! Nothing here knows a pair of controls. Each pass asks the target whether it
//! has something and, where it has not, puts an emulation in its place: one file
//! each, with its law, its side condition and where it ends. What cannot be
//! emulated becomes a diagnostic of severity error, at its place, and the
//! program is refused.
//!
//! Passes see a whole library, because variables, programs and modal state are shared by it; those that
//! need only one program are given each alone, all of them in a row while it is at hand. [`pipeline`] lists them;
//! each room holds those of one matter.

mod analyses;
mod assumptions;
mod by_program;
mod calls;
mod codes;
mod context;
mod cycles;
mod each_step;
mod expressions;
mod features;
mod lathe;
mod layout;
mod moves;
mod offsets;
mod operator;
pub mod pipeline;
mod registers;
mod rewrite;
mod variables;

pub use crate::ir::analysis::{Modal, ModalFacts, Setting, calls_of, reachable, replace_statements, span_of};
pub use context::{Context, Copied};
pub use expressions::split::ThenLines;
pub(crate) use lathe::other_kind::drop_others as drop_what_another_machine_asks;
pub use layout::program_numbers::ProgramNumbers;
pub use moves::start::{cancels_length, rests_on, rests_unwritten};
pub use registers::locked::{Elsewhere, Locked};
pub use registers::map::{Register, Registers};
pub use registers::names::name_of;
pub use rewrite::{Position, PreStatement, Rewriter, Wanted, rewrite_program};

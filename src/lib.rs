//! macroglot reads parametric CNC programs of one control and writes them for another.

extern crate alloc; // what pest derives names it, its `std` feature being off

pub mod assume;
pub mod canon;
pub mod check;
pub mod cli;
pub mod control;
pub mod diag;
pub mod dialect;
pub mod diff;
pub mod emit;
pub mod ir;
pub mod legalize;
pub mod library;
pub mod lint;
pub mod lower;
pub mod opt;
pub mod report;
pub mod survey;
pub mod syntax;
pub mod text;
pub mod verify;

/// True in a checked build, where the compiler checks itself: each pass is held to what it says of itself, and what it leaves to
/// the contract of the IR. Debug builds are checked, and so is that of `.ci/run`, which has no debug assertions.
pub(crate) const CHECKED: bool = cfg!(any(debug_assertions, checked));

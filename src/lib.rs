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

//! Typed, lossless blocks: parse and print.
//!
//! The law of this module: for any bytes, the tokens of the blocks of a line
//! tile that line, so that printing them gives the bytes back. A block that
//! the grammar cannot read is an [`ItemKind::Unparsed`] with its diagnostic,
//! and the rest of the file is read as if it were not there.
//!
//! Each dialect has one submodule here and one pest grammar in `grammar/`;
//! pest's `Rule` types never leave those submodules.

mod ast;
mod block;
pub mod cc100;
pub mod fadal;
pub mod fanuc;
mod file;
pub mod haas;
mod macro_b;
mod plain;
mod support;
#[cfg(test)]
#[allow(missing_docs)]
pub(crate) mod testing;
mod value;
mod walk;

pub use ast::*;
pub use block::print_blocks;
pub use file::{ParseTotals, ParsedFile, Parser, chunks, parse_faults, parse_file, parse_part, parse_totals};
pub use value::*;
pub use walk::{for_each_expr, for_each_item};

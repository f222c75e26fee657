//! Fadal to IR.
//!
//! A program is NC blocks and macro lines (`#`). Subroutines stand at its head
//! (`L100` .. `M17` .. `M30`) and become blocks of the same program; the first
//! block jumps over them. Angle unit, places of rounding and motion mode are
//! modal on this control: `flow` follows them over all ways through the program
//! first, so that each block is lowered knowing what holds there.
//!
//! Its rooms stand in one order, in which each uses only those before it: `codes`, `flow`, `build`, `macros`, `words`,
//! `program`. `tests/architecture.rs` fails otherwise.

mod build;
mod codes;
mod flow;
mod macros;
mod program;
#[cfg(test)]
mod tests;
mod words;

use super::Lowered;
use super::common::programs;
use crate::dialect::Control;
use crate::syntax::{ItemKind, ParsedFile};
use flow::Others;
use std::collections::BTreeMap;

/// Lowers all programs of a file; see [`super::Lower`].
pub fn lower(parsed: &ParsedFile<'_>, file: usize, _name: &str, control: &Control) -> Lowered {
    let tape = parsed.blocks.iter().flat_map(|block| &block.items).any(|item| item.kind == ItemKind::Tape);
    let texts = programs(&parsed.blocks);
    let others = Others::of(&texts, control);
    let lowered = |(at, text)| program::lower(text, (&others, at), parsed.source, file, control);
    let programs = texts.iter().enumerate().map(lowered).collect();
    Lowered { programs, names: BTreeMap::new(), tape }
}

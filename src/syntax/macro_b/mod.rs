//! What the Macro B family (Fanuc and Haas) has in common.
//!
//! [`blocks`] cuts a line at its end-of-block signs and has each block read in one of two ways.
//!
//! - [`reader`] reads ordinary blocks by hand, from bytes to items and tokens in one pass.
//! - What it declines the dialect's pest grammar reads (`grammar/macro_b.pest` and its own file). That gives a
//!   row of [`lexeme`]s which tiles the block, and [`tree`] builds the items from it.
//!
//! The grammar is the definition: on each block that the reader takes, it says the same. [`checks`] then finds
//! what a grammar lets pass but the control does not, [`shape`] tells brackets and comments before it is asked,
//! and [`faults`] says in a programmer's words why a block could not be read.

mod blocks;
mod checks;
mod expressions;
mod faults;
mod lexeme;
mod reader;
mod rules;
mod shape;
mod statements;
mod tree;

#[cfg(test)]
mod tests;

pub(super) use blocks::{Keep, read_line};
pub(super) use expressions::{bits_among_arithmetic, bits_behind_relations};
pub(super) use lexeme::{Lex, Lexemes, lexemes_of_rules};
pub(super) use rules::{Reading, Rules, read};

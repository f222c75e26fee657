//! What the Macro B family (Fanuc and Haas) has in common.
//!
//! A line goes through four steps. [`blocks`] cuts it at its end-of-block signs;
//! [`scanner`] reads blocks of plain words (built by [`plain`]), and the dialect's pest grammar
//! (`grammar/macro_b.pest` and its own file) all others, both into one row of
//! [`lexeme`]s that tiles the block; [`known`] is the memory of such rows, for the blocks that are
//! alike but for their digits ([`likeness`]); [`tree`] builds the items of the others from that row;
//! [`checks`] finds what the grammar lets pass but the control does not, and [`sound`] sees from
//! the row alone that it would find nothing.
//! [`faults`] says in a programmer's words why a block could not be read.

mod blocks;
mod cache_key;
mod checks;
mod expressions;
mod faults;
mod lexeme;
mod parse_cache;
mod plain;
mod precheck;
mod rules;
mod scanner;
mod shape;
mod statements;
mod tree;

#[cfg(test)]
mod tests;

pub(super) use blocks::{Keep, is_sound, read_line};
pub(super) use expressions::{bits_among_arithmetic, bits_behind_relations};
pub(super) use lexeme::{Lex, Lexemes, lexemes_of_rules};
pub(super) use parse_cache::ParseCache;
pub(super) use rules::{Reading, Rules, read};

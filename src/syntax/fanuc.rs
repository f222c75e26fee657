//! Fanuc Custom Macro B.

use super::Block;
use super::macro_b::{self, Keep, Lexemes, Reading, Rules, bits_among_arithmetic, lexemes_of_rules};
use crate::text::Span;

/// What pest makes of the grammar; it stays in here.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "grammar/macro_b.pest"]
    #[grammar = "grammar/fanuc.pest"]
    pub struct Grammar;
}
use grammar::{Grammar, Rule};

lexemes_of_rules!(Rule);

pub(super) const RULES: Rules = Rules {
    read,
    rank: bits_among_arithmetic,
    bits: false,
    bracket_depth: Some(5),
    constant_digits: Some(8),
    comments_do_not_nest: false,
    whole_letters: &['M', 'S', 'T'],
    point_is_fraction: true,
    atan_slash_needs_bracket: true,
    call_stands_first: true,
};

/// Reads the blocks of one line.
pub fn parse_line(source: &[u8], line: Span, out: &mut Vec<Block>) {
    macro_b::read_line(&RULES, source, line, Keep::Tokens, out);
}

/// As [`parse_line`], without the tokens.
pub fn parse_items(source: &[u8], line: Span, out: &mut Vec<Block>) {
    macro_b::read_line(&RULES, source, line, Keep::Items, out);
}

/// As [`parse_items`], without blocks of plain words in which nothing can be wrong.
pub fn parse_faults(source: &[u8], line: Span, out: &mut Vec<Block>) {
    macro_b::read_line(&RULES, source, line, Keep::Faults, out);
}

fn read(text: &str, start: u32, row: &mut Lexemes) -> Result<(), Reading> {
    macro_b::read::<Grammar, Rule>(Rule::block, text, start, row)
}

//! Haas macros, legacy and NGC controls.

use super::Block;
use super::macro_b::{self, Keep, Lexemes, Reading, Rules, bits_behind_relations, lexemes_of_rules};
use crate::text::Span;

/// What pest makes of the grammar; it stays in here.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "grammar/macro_b.pest"]
    #[grammar = "grammar/haas.pest"]
    pub struct Grammar;
}
use grammar::{Grammar, Rule};

lexemes_of_rules!(Rule);

pub(super) const RULES: Rules = Rules {
    read,
    rank: bits_behind_relations,
    bits: true,
    bracket_depth: None,
    constant_digits: None,
    comments_do_not_nest: true,
    whole_letters: &['M'],
    point_is_fraction: false,
    atan_slash_needs_bracket: false,
    call_stands_first: false,
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

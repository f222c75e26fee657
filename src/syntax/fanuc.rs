//! Fanuc Custom Macro B.

use super::macro_b::{self, Reading, Row, Rules, bits_among_arithmetic, lexemes_of_rules};
use super::{Block, Item};
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
    macro_b::parse_line(&RULES, source, line, out);
}

/// See [`super::ReadPlain`].
pub fn read_plain(source: &[u8], line: Span) -> Option<Vec<Item>> {
    macro_b::read_plain(source, line)
}

/// See [`super::IsPlain`].
pub fn is_plain(source: &[u8], line: Span) -> bool {
    macro_b::is_plain(source, line)
}

fn read(text: &str, start: u32, row: &mut Row) -> Result<(), Reading> {
    macro_b::read::<Grammar, Rule>(Rule::block, text, start, row)
}

//! What a dialect of the family fills in, and how its grammar is run.

use super::lexeme::{self, Lex, Lexemes};
use crate::syntax::BinaryOp;
use crate::syntax::support::stopped_at;
use pest::error::ErrorVariant;
use pest::{Parser, RuleType, Token};

/// The differences between the dialects that reading a block meets.
///
/// A grammar allows more than a control does, so that the fault can be named. The
/// limits are facts of the controls; see `dialects/` for their sources.
pub struct Rules {
    /// Runs the dialect's grammar over the text of one block.
    pub read: fn(text: &str, start: u32, row: &mut Lexemes) -> Result<(), Reading>,
    /// How close an operator binds; those of one rank go from left to right.
    pub rank: fn(BinaryOp) -> u8,
    /// True where a point after a variable's number selects a bit.
    pub bits: bool,
    /// How deep brackets may nest, function brackets included; none for freely.
    pub bracket_depth: Option<u32>,
    /// Digits that an assigned constant may have, leading zeros included.
    pub constant_digits: Option<u16>,
    /// True where a comment must not hold another `(`.
    pub comments_do_not_nest: bool,
    /// Letters of words whose plain numbers must have no fraction.
    pub whole_letters: &'static [char],
    /// True where a decimal point alone makes such a number wrong.
    pub point_is_fraction: bool,
    /// True where `ATAN[a]/b` without brackets round `b` is an alarm.
    pub atan_slash_needs_bracket: bool,
    /// True where a macro call allows no words before it.
    pub call_stands_first: bool,
}

/// Where a grammar gave up, and what would have let it go on.
pub struct Reading {
    /// Offset in the file.
    pub at: u32,
    /// What may stand there.
    pub expected: Vec<Lex>,
}

/// Runs a grammar over a block's text, which starts at `start` of its file.
pub fn read<P: Parser<R>, R: RuleType + Into<Lex>>(
    rule: R,
    text: &str,
    start: u32,
    row: &mut Lexemes,
) -> Result<(), Reading> {
    let pairs = P::parse(rule, text).map_err(|error| {
        let at = stopped_at(&error);
        let expected = match error.variant {
            ErrorVariant::ParsingError { positives, .. } => positives.into_iter().map(Into::into).collect(),
            ErrorVariant::CustomError { .. } => Vec::new(),
        };
        Reading { at: start + at as u32, expected }
    })?;
    let mut from = 0;
    for token in pairs.tokens() {
        match token {
            Token::Start { pos, .. } => from = pos.pos(),
            Token::End { rule, pos } => {
                let leaf = text.as_bytes().get(from..pos.pos()).unwrap_or_default();
                lexeme::push(row, rule.into(), start + from as u32, leaf);
            }
        }
    }
    Ok(())
}

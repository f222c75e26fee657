//! Bosch CC100: plain blocks and parametric blocks. One line is one block.

mod build;
mod check;
mod diagnose;
mod grammar;
mod lexemes;

use super::Block;
use super::plain::plain_block;
use super::support::{readable, tile, too_long, unparsed};
use crate::text::Span;
use grammar::{Grammar, Rule};
use pest::Parser as _;

/// What stands at the head of a part that a conversion wrote into a file of its own.
pub const PART: &str = "A PART: PUT IT AFTER M30 OF THE PROGRAM THAT CALLS IT";

/// Reads the one block of a line. Nothing nests in this language, so no line is
/// too deep.
pub fn parse_line(source: &[u8], line: Span, out: &mut Vec<Block>) {
    read_line(source, line, true, out);
}

/// As [`parse_line`], without the tokens.
pub fn parse_items(source: &[u8], line: Span, out: &mut Vec<Block>) {
    let first = out.len();
    read_line(source, line, false, out);
    out[first..].iter_mut().for_each(|block| block.tokens = Vec::new());
}

fn read_line(source: &[u8], line: Span, tokens: bool, out: &mut Vec<Block>) {
    if line.is_empty() {
        return;
    }
    match too_long(line).or_else(|| plain_block(source, line, tokens)) {
        Some(block) => out.push(block),
        None => by_grammar(source, line, out),
    }
}

/// Reads a line by the grammar, which defines what [`plain_block`] may take over.
fn by_grammar(source: &[u8], line: Span, out: &mut Vec<Block>) {
    let text = readable(line.of(source));
    match Grammar::parse(Rule::block, &text) {
        Ok(pairs) => {
            let lexemes = pairs.clone().flatten().filter_map(|pair| {
                let span = pair.as_span();
                let at = |offset: usize| line.start + offset as u32;
                Some((lexemes::kind(pair.as_rule())?, Span::new(at(span.start()), at(span.end()))))
            });
            let tokens = tile(source, line, lexemes);
            let (items, mut errors) = build::items(line, pairs);
            errors.extend(check::mixture(&items));
            out.push(Block { span: line, tokens, items, errors: errors.into() });
        }
        Err(error) => out.push(unparsed(line, diagnose::diagnose(&text, line, &error))),
    }
}

#[cfg(test)]
mod tests;

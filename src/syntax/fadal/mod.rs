//! Fadal: NC lines, and macro lines after `#`. One line is one block.

mod build;
mod builder;
mod check;
mod diagnose;
mod expr;
mod grammar;
mod lexemes;
mod mark;
mod reader;

use super::plain::plain_block;
use super::support::{depth, fault, readable, tile, too_long, unparsed};
use super::{Block, SyntaxError};
use crate::diag::Code;
use crate::text::Span;
use grammar::{Grammar, Rule};
use mark::mark_of;
use pest::Parser as _;

/// Longest macro line that is read, and deepest brackets: far above the 63
/// characters the control takes, so that only damage is refused, and low enough
/// that no tree is too deep to walk.
const MOST_BYTES: usize = 1024;
const MOST_BRACKETS: usize = 32;

/// Reads the one block of a line.
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
    let by_hand = || plain_block(source, line, tokens).or_else(|| reader::read(source, line, tokens));
    match too_long(line).or_else(by_hand) {
        Some(block) => out.push(block),
        None => by_grammar(source, line, out),
    }
}

/// Reads a line by the grammar, which defines what [`plain_block`] and [`reader::read`] may take over.
fn by_grammar(source: &[u8], line: Span, out: &mut Vec<Block>) {
    let text = readable(line.of(source));
    if let Some(error) = too_complex(&text, line) {
        out.push(unparsed(line, error));
        return;
    }
    match Grammar::parse(Rule::block, &text) {
        Ok(pairs) => {
            let lexemes = pairs.clone().flatten().filter_map(|pair| {
                let span = pair.as_span();
                let at = |offset: usize| line.start + offset as u32;
                Some((lexemes::kind(pair.as_rule())?, Span::new(at(span.start()), at(span.end()))))
            });
            let tokens = tile(source, line, lexemes);
            let (items, errors) = build::items(source, line, pairs);
            out.push(Block { span: line, tokens, items, errors: errors.into() });
        }
        Err(error) => out.push(unparsed(line, diagnose::diagnose(&text, line, &error))),
    }
}

fn too_complex(text: &str, line: Span) -> Option<SyntaxError> {
    let mark = mark_of(text)?;
    let statement = text.get(mark..).unwrap_or("");
    let message = if statement.len() > MOST_BYTES {
        format!("macro line of {} characters: it is not read beyond {MOST_BYTES}", statement.len())
    } else if depth(statement, b'(', b')') > MOST_BRACKETS {
        format!("brackets nest deeper than {MOST_BRACKETS}")
    } else {
        return None;
    };
    Some(fault(Code::TooComplex, Span::new(line.start + mark as u32, line.end), message))
}

#[cfg(test)]
mod tests;

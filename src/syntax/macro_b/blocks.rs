//! Cuts a line into blocks and reads each, by hand or by the grammar.

use super::faults::{self, outside_text};
use super::lexeme::{Lexemes, is_tiled, tokens};
use super::rules::Rules;
use super::shape::{self, Shape};
use super::tree;
use super::{checks, reader};
use crate::syntax::support::{readable, too_long};
use crate::syntax::{Block, Comment, Fence, Item, ItemKind, SyntaxError, Token, TokenKind};
use crate::text::Span;
use thin_vec::{ThinVec, thin_vec};

/// What is kept of a block beside what it says.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Its tokens.
    Tokens,
    /// Nothing.
    Items,
    /// Nothing, and no block of a line in which nothing can be wrong.
    Faults,
}

/// Reads the blocks of one line.
pub fn read_line(rules: &Rules, source: &[u8], line: Span, keep: Keep, out: &mut Vec<Block>) {
    let first = out.len();
    if let Some(block) = whole_line(source, line) {
        out.push(block);
    } else {
        let mut at = line.start;
        while at < line.end {
            let rest = Span::new(at, line.end);
            let end = by_hand(rules, source, rest, keep, out);
            at = end.unwrap_or_else(|| by_grammar(rules, source, line, at, out));
        }
        if out[first..].iter().any(|block| !block.errors.is_empty()) && outside_text(source, line) {
            out.truncate(first);
            out.push(outside_block(line));
        }
    }
    if keep != Keep::Tokens {
        out[first..].iter_mut().for_each(|block| block.tokens = Vec::new());
    }
}

/// The block of a line that is not cut into several whatever stands in it.
fn whole_line(source: &[u8], line: Span) -> Option<Block> {
    too_long(line).or_else(|| is_dump_header(line.of(source)).then(|| outside_block(line)))
}

/// Reads the block at the start of `rest` by hand, unless that declines it; says where it ends.
pub(super) fn by_hand(
    rules: &Rules,
    source: &[u8],
    rest: Span,
    keep: Keep,
    out: &mut Vec<Block>,
) -> Option<u32> {
    match keep {
        Keep::Tokens => reader::read::<true>(rules, source, rest, out),
        Keep::Items => reader::read::<false>(rules, source, rest, out),
        Keep::Faults => {
            reader::pass(rules, source, rest).or_else(|| reader::read::<false>(rules, source, rest, out))
        }
    }
}

/// Reads the block of a line that starts at `at` by the grammar; says where it ends.
#[cold]
#[inline(never)]
pub(super) fn by_grammar(rules: &Rules, source: &[u8], line: Span, at: u32, out: &mut Vec<Block>) -> u32 {
    let (span, shape) = outline(line.of(source), line.start, at);
    out.push(grammar_block(rules, source, span, line.start, &shape));
    // A block has at least one byte, so the line is finished after finitely many.
    span.end.max(at + 1)
}

/// The block of a line that starts at `at`, and its outline, which counts from the start of the line.
fn outline(line: &[u8], line_start: u32, at: u32) -> (Span, Shape) {
    let start = (at - line_start) as usize;
    let mut shape = shape::outline(line, start);
    shape.end = with_trailing_blanks(line, start, shape.end);
    (Span::new(at, line_start + shape.end as u32), shape)
}

/// A block read by the grammar.
fn grammar_block(rules: &Rules, source: &[u8], span: Span, line_start: u32, shape: &Shape) -> Block {
    let bytes = span.of(source);
    if shape.depth > shape::DEEPEST {
        return unread(span, end_of_block(bytes, span), faults::too_deep(span, shape.depth));
    }
    let mut row = Lexemes::new();
    let tree = match (rules.read)(&readable(bytes), span.start, &mut row) {
        Ok(()) if !is_tiled(&row, span) => {
            // Cannot happen while grammars tile; if one does not, nothing may be lost.
            return unread(span, None, faults::not_tiled(span));
        }
        Ok(()) => tree::build(source, &row, rules.rank),
        Err(stop)
            if is_after_sign(source, line_start, span)
                && matches!(bytes.trim_ascii(), [b'A'..=b'Z' | b'a'..=b'z', ..]) =>
        {
            Err(faults::remark(span, faults::explain(source, span, line_start, shape, &stop)))
        }
        Err(stop) => Err(faults::explain(source, span, line_start, shape, &stop)),
    };
    match tree {
        Ok(tree) => {
            let mut block =
                Block { span, tokens: tokens(&row), items: tree.items, errors: tree.errors.into() };
            checks::check_items(rules, source, &block.items, &mut block.errors);
            checks::check_shape(rules, source, &mut block, line_start, shape);
            block
        }
        Err(fault) => unread(span, end_of_block(bytes, span), fault),
    }
}

/// True where a `;` ends a block before this one in its line.
fn is_after_sign(source: &[u8], line_start: u32, span: Span) -> bool {
    source[line_start as usize..span.start as usize].trim_ascii_end().ends_with(b";")
}

/// A block whose text is kept and not understood.
fn unread(span: Span, end: Option<Span>, fault: SyntaxError) -> Block {
    let text = Span::new(span.start, end.map_or(span.end, |end| end.start));
    let mut tokens = vec![Token { kind: TokenKind::Other, span: text }];
    let mut items = vec![Item { kind: ItemKind::Unparsed, span: text }];
    if let Some(end) = end {
        let sign = Span::new(end.start, end.start + 1);
        items.push(Item { kind: ItemKind::EndOfBlock, span: sign });
        tokens.push(Token { kind: TokenKind::EndOfBlock, span: sign });
        if sign.end < end.end {
            tokens.push(Token { kind: TokenKind::Space, span: Span::new(sign.end, end.end) });
        }
    }
    Block { span, tokens, items, errors: thin_vec![fault] }
}

/// The `;` that ends a block and the blanks after it.
fn end_of_block(bytes: &[u8], span: Span) -> Option<Span> {
    let text = bytes.len() - bytes.iter().rev().take_while(|byte| is_blank(**byte)).count();
    (bytes.get(text.checked_sub(1)?) == Some(&b';') && !inside_open_comment(bytes))
        .then(|| Span::new(span.start + text as u32 - 1, span.end))
}

fn inside_open_comment(bytes: &[u8]) -> bool {
    shape::outline(bytes, 0).open_comment.is_some()
}

/// Blanks between a `;` and the end of the line belong to the block that it ends.
fn with_trailing_blanks(line: &[u8], start: usize, end: usize) -> usize {
    let closed = end > start && line.get(end - 1) == Some(&b';');
    if closed && line[end..].iter().all(|&byte| is_blank(byte)) { line.len() } else { end }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0 | 0x7f)
}

/// `&F=//CNC_MEM/USER/`: where a memory dump says which folder a program was in.
fn is_dump_header(line: &[u8]) -> bool {
    matches!(line, [b'&', b'F' | b'f', b'=', ..])
}

fn outside_block(line: Span) -> Block {
    Block {
        span: line,
        tokens: vec![Token { kind: TokenKind::Comment, span: line }],
        items: vec![Item {
            kind: ItemKind::Comment(Comment { text: line, fence: Fence::Outside }),
            span: line,
        }],
        errors: ThinVec::new(),
    }
}

//! Cuts a line into blocks and reads each, by the scanner or by the grammar.

use super::faults::{self, outside_text};
use super::lexeme::{Lexemes, tokens};
use super::parse_cache::{self, is_tiled};
use super::plain::{NeedsCheck, Plain};
use super::shape::{self, Shape};
use super::tree;
use super::{Rules, checks, precheck, scanner};
use crate::syntax::support::{LONGEST_LINE, readable, too_long};
use crate::syntax::{Block, Comment, Fence, Item, ItemKind, SyntaxError, Token, TokenKind};
use crate::text::Span;

/// What is kept of a block beside what it says.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Its tokens.
    Tokens,
    /// Nothing.
    Items,
}

/// Reads the blocks of one line.
pub fn read_line(rules: &Rules, source: &[u8], line: Span, keep: Keep, out: &mut Vec<Block>) {
    if let Some(block) = too_long(line) {
        out.push(block);
        return;
    }
    let bytes = line.of(source);
    let first = out.len();
    let mut at = if is_dump_header(bytes) { line.end } else { line.start };
    while at < line.end {
        let block = plain_block(rules, source, Span::new(at, line.end), keep).unwrap_or_else(|| {
            let (span, shape) = outline(bytes, line.start, at);
            grammar_block(rules, source, span, line.start, &shape, keep)
        });
        // A block has at least one byte, so the line is finished after finitely many.
        at = block.span.end.max(at + 1);
        out.push(block);
    }
    let faulty = out[first..].iter().any(|block| !block.errors.is_empty());
    if is_dump_header(bytes) || (faulty && outside_text(source, line)) {
        out.truncate(first);
        out.push(outside_block(line));
    }
    if keep == Keep::Items {
        out[first..].iter_mut().for_each(|block| block.tokens = Vec::new());
    }
}

/// True for a line of blocks in which nothing can be wrong, as far as their leaves tell; see [`sound`].
pub fn is_sound(rules: &Rules, source: &[u8], line: Span) -> bool {
    // What is plain is seen faster than remembered.
    let found = || {
        is_plain(source, line)
            || parse_cache::is_sound(rules, line.of(source), || is_found_sound(rules, source, line))
    };
    line.len() <= LONGEST_LINE && found()
}

/// As [`is_sound`], by the grammar.
pub(super) fn is_found_sound(rules: &Rules, source: &[u8], line: Span) -> bool {
    let bytes = line.of(source);
    let mut row = Lexemes::new();
    let mut at = line.start;
    while at < line.end {
        let (span, shape) = outline(bytes, line.start, at);
        let shaped = shape.depth <= rules.bracket_depth.map_or(shape::DEEPEST, |most| most as usize)
            && shape.open_comment.is_none()
            && shape.nested_comment.is_none();
        row.clear();
        if !shaped
            || (rules.read)(&readable(span.of(source)), span.start, &mut row).is_err()
            || !is_tiled(&row, span)
            || !precheck::is_sound(rules, source, &row)
        {
            return false;
        }
        at = span.end.max(at + 1);
    }
    !is_dump_header(bytes)
}

/// True for a line that is one block of plain words in which nothing can be wrong, or empty.
pub fn is_plain(source: &[u8], line: Span) -> bool {
    let mut check = NeedsCheck::default();
    scanner::scan(source, line, &mut check) == Some(line.end) && !check.0
}

/// The block of a line that starts at `at`, and its outline, which counts from the start of the line.
fn outline(line: &[u8], line_start: u32, at: u32) -> (Span, Shape) {
    let start = (at - line_start) as usize;
    let mut shape = shape::outline(line, start);
    shape.end = with_trailing_blanks(line, start, shape.end);
    (Span::new(at, line_start + shape.end as u32), shape)
}

/// The block at the start of `rest`, up to the end of its line, if the scanner reads it.
fn plain_block(rules: &Rules, source: &[u8], rest: Span, keep: Keep) -> Option<Block> {
    let text = rest.of(source);
    if !scanner::begins_plain(text) {
        return None;
    }
    let mut plain = Plain::within(text);
    let (end, tokens, plain) = match keep {
        Keep::Tokens => {
            let mut both = (Lexemes::new(), plain);
            let end = scanner::scan(source, rest, &mut both)?;
            (end, tokens(&both.0), both.1)
        }
        Keep::Items => (scanner::scan(source, rest, &mut plain)?, Vec::new(), plain),
    };
    let needs_check = plain.needs_check;
    let span = Span::new(rest.start, end);
    let mut block = Block { span, tokens, items: plain.into_items(), errors: Vec::new() };
    debug_assert!(keep == Keep::Items || block.is_tiled());
    if needs_check {
        checks::check_items(rules, source, &block.items, &mut block.errors);
    }
    Some(block)
}

/// A block read by the grammar.
pub(super) fn grammar_block(
    rules: &Rules,
    source: &[u8],
    span: Span,
    line_start: u32,
    shape: &Shape,
    keep: Keep,
) -> Block {
    let bytes = span.of(source);
    if shape.depth > shape::DEEPEST {
        return unread(span, end_of_block(bytes, span), faults::too_deep(span, shape.depth));
    }
    let mut row = Lexemes::new();
    let tree = match parse_cache::read(rules, source, span, &mut row) {
        Ok(()) if !is_tiled(&row, span) => {
            // Cannot happen while grammars tile; if one does not, nothing may be lost.
            return unread(span, None, faults::not_tiled(span));
        }
        Ok(()) => tree::build(source, &row, rules.rank),
        Err(stop) => Err(faults::explain(source, span, line_start, shape, &stop)),
    };
    match tree {
        Ok(tree) => {
            let tokens = if keep == Keep::Tokens { tokens(&row) } else { Vec::new() };
            let mut block = Block { span, tokens, items: tree.items, errors: tree.errors };
            checks::check_items(rules, source, &block.items, &mut block.errors);
            checks::check_shape(rules, source, &mut block, line_start, shape);
            block
        }
        Err(fault) => unread(span, end_of_block(bytes, span), fault),
    }
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
    Block { span, tokens, items, errors: vec![fault] }
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
    line.get(..3).is_some_and(|head| head.eq_ignore_ascii_case(b"&F="))
}

fn outside_block(line: Span) -> Block {
    Block {
        span: line,
        tokens: vec![Token { kind: TokenKind::Comment, span: line }],
        items: vec![Item {
            kind: ItemKind::Comment(Comment { text: line, fence: Fence::Outside }),
            span: line,
        }],
        errors: Vec::new(),
    }
}

//! Cuts a line into blocks and reads each, by the scanner or by the grammar.

use super::faults::{self, outside_text};
use super::lexeme::{Lexeme, Row, tokens};
use super::plain::{NeedsCheck, Plain};
use super::shape::{self, Shape};
use super::tree::{self, Tree};
use super::{Rules, checks, scanner};
use crate::syntax::support::readable;
use crate::syntax::{Block, Comment, Fence, Item, ItemKind, SyntaxError, Token, TokenKind};
use crate::text::Span;

/// Reads the blocks of one line.
pub fn parse_line(rules: &Rules, source: &[u8], line: Span, out: &mut Vec<Block>) {
    let bytes = line.of(source);
    if is_dump_header(bytes) {
        out.push(outside_block(line));
        return;
    }
    let first = out.len();
    let mut at = line.start;
    while at < line.end {
        let mut scanned =
            (Row::new(), Plain::within(bytes.get((at - line.start) as usize..).unwrap_or_default()));
        let end = scanner::scan(source, Span::new(at, line.end), &mut scanned);
        let (mut row, plain) = scanned;
        let block = match end {
            Some(end) => plain_block(rules, source, Span::new(at, end), &row, plain),
            None => {
                let start = (at - line.start) as usize;
                let mut shape = shape::outline(bytes, start);
                shape.end = with_trailing_blanks(bytes, start, shape.end);
                let span = Span::new(at, line.start + shape.end as u32);
                row.clear();
                grammar_block(rules, source, span, line.start, &shape, &mut row)
            }
        };
        // A block has at least one byte, so the line is finished after finitely many.
        at = block.span.end.max(at + 1);
        out.push(block);
    }
    if out[first..].iter().any(|block| !block.errors.is_empty()) && outside_text(source, line) {
        out.truncate(first);
        out.push(outside_block(line));
    }
}

/// What a line says that is one block of plain words in which nothing can be wrong; none for any other.
pub fn read_plain(source: &[u8], line: Span) -> Option<Vec<Item>> {
    let mut plain = Plain::within(line.of(source));
    let whole = !line.is_empty() && scanner::scan(source, line, &mut plain) == Some(line.end);
    (whole && !plain.needs_check).then(|| plain.into_items())
}

/// True for a line that is one block of plain words in which nothing can be wrong, or empty.
pub fn is_plain(source: &[u8], line: Span) -> bool {
    let mut check = NeedsCheck::default();
    scanner::scan(source, line, &mut check) == Some(line.end) && !check.0
}

/// A block read by the scanner.
fn plain_block(rules: &Rules, source: &[u8], span: Span, row: &Row, plain: Plain) -> Block {
    let needs_check = plain.needs_check;
    let mut block = Block { span, tokens: tokens(row), items: plain.into_items(), errors: Vec::new() };
    debug_assert!(block.is_tiled());
    if needs_check {
        checks::check_items(rules, source, &block.items, &mut block.errors);
    }
    block
}

/// A block read by the grammar.
pub(super) fn grammar_block(
    rules: &Rules,
    source: &[u8],
    span: Span,
    line_start: u32,
    shape: &Shape,
    row: &mut Row,
) -> Block {
    let bytes = span.of(source);
    if shape.depth > shape::DEEPEST {
        return unread(span, end_of_block(bytes, span), faults::too_deep(span, shape.depth));
    }
    let read = (rules.read)(&readable(bytes), span.start, row);
    let tree = match read {
        Ok(()) => tree::build(source, row, rules.rank),
        Err(stop) => Err(faults::explain(source, span, line_start, shape, &stop)),
    };
    match tree {
        Ok(tree) => {
            let mut block = finish(rules, source, span, row, tree);
            checks::check_shape(rules, source, &mut block, line_start, shape);
            block
        }
        Err(fault) => unread(span, end_of_block(bytes, span), fault),
    }
}

fn finish(rules: &Rules, source: &[u8], span: Span, row: &[Lexeme], tree: Tree) -> Block {
    let mut block = Block { span, tokens: tokens(row), items: tree.items, errors: tree.errors };
    if !block.is_tiled() {
        // Cannot happen while grammars tile; if one does not, nothing may be lost.
        return unread(span, None, faults::not_tiled(span));
    }
    checks::check_items(rules, source, &block.items, &mut block.errors);
    block
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

/// The `;` that ends a block and the blanks behind it.
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

//! Builds the items of a block of plain words, straight from the scanner's row.
//!
//! The same as [`super::tree`] would build, which tests hold it to; it need not ask
//! what may come next, since the scanner yields letters, signs, numbers, comments and
//! sequence numbers only.

use super::lexeme::{Lex, Lexeme};
use super::tree::read_number;
use crate::syntax::{Comment, Expr, ExprKind, Fence, Item, ItemKind, Number, Word};
use crate::text::Span;

/// What a block of plain words says.
pub struct Plain {
    pub items: Vec<Item>,
    /// True where a word stands that can be wrong: a code or speed with a point, a macro call.
    pub needs_check: bool,
}

/// Builds the items of a scanned row.
pub fn build(source: &[u8], row: &[Lexeme]) -> Plain {
    let count = row.iter().filter(|leaf| starts_item(leaf.kind)).count();
    let mut plain = Plain { items: Vec::with_capacity(count), needs_check: false };
    let mut rest = row.iter();
    while let Some(leaf) = rest.next() {
        let (kind, end) = match leaf.kind {
            Lex::Letter => {
                let Some(next) = rest.next() else { break };
                let sign = (next.kind == Lex::Sign).then_some(next.span);
                let Some(number) = (if sign.is_some() { rest.next() } else { Some(next) }) else { break };
                plain.word(source, leaf.span, sign, number.span)
            }
            Lex::SequenceLetter => {
                let Some(digits) = rest.next() else { break };
                let number = digits.span.of(source).iter().fold(0u32, |value, digit| {
                    value.wrapping_mul(10).wrapping_add(u32::from(digit.wrapping_sub(b'0')))
                });
                (ItemKind::Sequence { number, inserted: false }, digits.span.end)
            }
            Lex::Comment => {
                let text = Span::new(leaf.span.start + 1, leaf.span.end - 1);
                (ItemKind::Comment(Comment { text, fence: Fence::Closed }), leaf.span.end)
            }
            Lex::EndOfBlock => (ItemKind::EndOfBlock, leaf.span.end),
            _ => continue,
        };
        plain.items.push(Item { kind, span: Span::new(leaf.span.start, end) });
    }
    plain
}

impl Plain {
    fn word(&mut self, source: &[u8], letter: Span, sign: Option<Span>, digits: Span) -> (ItemKind, u32) {
        let letter = letter.of(source).first().map_or(' ', |byte| char::from(byte.to_ascii_uppercase()));
        let number = read_number(digits.of(source));
        self.needs_check |= can_be_wrong(letter, &number);
        let constant = Expr { kind: ExprKind::Number(number), span: digits };
        let value = match sign {
            None => constant,
            Some(sign) => {
                let inner = Box::new(constant);
                let minus = sign.of(source) == b"-";
                let kind = if minus { ExprKind::Negate(inner) } else { ExprKind::Plus(inner) };
                Expr { kind, span: sign.to(digits) }
            }
        };
        (ItemKind::Word(Word { letter, comma: false, value: Some(value), equals: false }), digits.end)
    }
}

/// True where a word of a scanned row can be wrong.
pub fn needs_check(source: &[u8], row: &[Lexeme]) -> bool {
    row.iter().enumerate().filter(|(_, leaf)| leaf.kind == Lex::Letter).any(|(at, leaf)| {
        let letter = leaf.span.of(source).first().map_or(' ', |byte| char::from(byte.to_ascii_uppercase()));
        let number = || row.iter().skip(at).find(|leaf| leaf.kind == Lex::Number);
        matches!(letter, 'G' | 'M' | 'S' | 'T')
            && number().is_some_and(|leaf| can_be_wrong(letter, &read_number(leaf.span.of(source))))
    })
}

/// A code that calls a macro, or a code, speed or tool with a point.
fn can_be_wrong(letter: char, number: &Number) -> bool {
    match letter {
        'G' => (65.0..67.0).contains(&number.value),
        _ => number.point && matches!(letter, 'M' | 'S' | 'T'),
    }
}

fn starts_item(kind: Lex) -> bool {
    matches!(kind, Lex::Letter | Lex::SequenceLetter | Lex::Comment | Lex::EndOfBlock)
}

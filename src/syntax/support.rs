//! What the parsers of all dialects need around their pest grammars: text that
//! pest can read, tokens that tile, numbers, and errors in a programmer's words.

use super::{Block, Item, ItemKind, Number, SyntaxError, Token, TokenKind};
use crate::diag::Code;
use crate::text::Span;
use pest::error::{Error, ErrorVariant, InputLocation};
use std::borrow::Cow;

/// Stands in pest's text for a byte that no grammar names.
pub(super) const PLACEHOLDER: u8 = 0x01;

/// The mark that editors put before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// True for what no control sees: the NUL and DEL of a tape leader, and the Ctrl-Z that ends files of old computers.
const fn is_passed_over(byte: u8) -> bool {
    matches!(byte, 0x00 | 0x7f | 0x1a)
}

/// The line as text of the same length, so that offsets stay one to one:
/// bytes beyond ASCII and control bytes become [`PLACEHOLDER`], the NUL and DEL
/// of a tape leader, a byte order mark at its start and Ctrl-Z become blanks.
pub(super) fn readable(line: &[u8]) -> Cow<'_, str> {
    let plain = |byte: &u8| (0x20..0x7f).contains(byte) || *byte == b'\t';
    if line.iter().all(plain)
        && let Ok(text) = std::str::from_utf8(line)
    {
        return Cow::Borrowed(text);
    }
    let mark = if line.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
    let replaced = line.iter().enumerate().map(|(at, byte)| match byte {
        _ if at < mark => ' ',
        byte if is_passed_over(*byte) => ' ',
        byte if plain(byte) => char::from(*byte),
        _ => char::from(PLACEHOLDER),
    });
    Cow::Owned(replaced.collect())
}

/// Tokens for `line` out of its lexemes, which come in order: what lies between
/// them becomes tokens too, so that they tile whatever the lexemes are.
pub(super) fn tile(
    source: &[u8],
    line: Span,
    lexemes: impl Iterator<Item = (TokenKind, Span)>,
) -> Vec<Token> {
    let mut tokens = Vec::with_capacity(12);
    let mut at = line.start;
    let gap = |tokens: &mut Vec<Token>, from: u32, to: u32| {
        if from < to {
            let span = Span::new(from, to);
            let text = span.of(source);
            let head = if from == line.start { BYTE_ORDER_MARK } else { &[] };
            let text = text.strip_prefix(head).unwrap_or(text);
            let blank = text.iter().all(|byte| matches!(byte, b' ' | b'\t') || is_passed_over(*byte));
            let kind = if blank { TokenKind::Space } else { TokenKind::Other };
            tokens.push(Token { kind, span });
        }
    };
    for (kind, span) in lexemes {
        if span.is_empty() || span.start < at || span.end > line.end {
            continue;
        }
        gap(&mut tokens, at, span.start);
        tokens.push(Token { kind, span });
        at = span.end;
    }
    gap(&mut tokens, at, line.end);
    tokens
}

/// A block that could not be read, with the reason.
pub(super) fn unparsed(line: Span, error: SyntaxError) -> Block {
    Block {
        span: line,
        tokens: vec![Token { kind: TokenKind::Other, span: line }],
        items: vec![Item { kind: ItemKind::Unparsed, span: line }],
        errors: thin_vec::thin_vec![error],
    }
}

/// The longest line that is read, in bytes: far above what any control takes, and low enough that the parts of one line
/// never fill the memory.
pub const LONGEST_LINE: usize = 256 * 1024;

/// A line that is too long to be read, as a block that keeps its text.
pub(super) fn too_long(line: Span) -> Option<Block> {
    let message =
        || format!("the line has {} characters, more than any control takes: it is not read", line.len());
    (line.len() > LONGEST_LINE).then(|| unparsed(line, fault(Code::TooComplex, line, message())))
}

/// An error, from its parts.
pub(super) fn fault(code: Code, span: Span, message: impl Into<String>) -> SyntaxError {
    SyntaxError { code, span, message: message.into() }
}

/// A constant from its digits and point.
pub(super) fn number(text: &str) -> Number {
    let mut digits = 0usize;
    let mut whole = 0u64;
    let mut places = None;
    for byte in text.bytes() {
        match byte {
            b'0'..=b'9' => {
                digits += 1;
                whole = whole.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                places = places.map(|places: usize| places + 1);
            }
            _ => places = Some(0),
        }
    }
    // Up to 15 digits and their power of ten are exact, and one division rounds right.
    let value = match TENS.get(places.unwrap_or(0)) {
        Some(ten) if digits <= 15 => whole as f64 / ten,
        _ => text.parse().unwrap_or(0.0),
    };
    Number { value, point: places.is_some(), digits: u16::try_from(digits).unwrap_or(u16::MAX) }
}

const TENS: [f64; 16] =
    [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// How deep brackets nest in `text`.
pub(super) fn depth(text: &str, open: u8, close: u8) -> usize {
    let mut at = 0usize;
    let mut deepest = 0;
    for byte in text.bytes() {
        if byte == open {
            at += 1;
            deepest = deepest.max(at);
        } else if byte == close {
            at = at.saturating_sub(1);
        }
    }
    deepest
}

/// Where pest stopped reading, as an offset into its text.
pub(super) fn stopped_at<R>(error: &Error<R>) -> usize {
    match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    }
}

/// What pest would have read where it stopped, in the words of `name`; rules
/// without a name are left out: `a number or a variable`.
pub(super) fn expected<R: Copy>(error: &Error<R>, name: impl Fn(R) -> Option<&'static str>) -> String {
    let ErrorVariant::ParsingError { positives, .. } = &error.variant else { return String::new() };
    let mut names: Vec<&str> = Vec::new();
    for rule in positives {
        if let Some(name) = name(*rule)
            && !names.contains(&name)
        {
            names.push(name);
        }
    }
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}

/// The lexeme of `text` at `at`, to point at and to name: a word of letters, a
/// run of digits, or one character.
pub(super) fn lexeme_at(text: &str, at: usize) -> &str {
    let rest = text.get(at..).unwrap_or("");
    let same: fn(&u8) -> bool = match rest.bytes().next() {
        None => return "",
        Some(byte) if byte.is_ascii_alphabetic() => u8::is_ascii_alphabetic,
        Some(byte) if byte.is_ascii_digit() => u8::is_ascii_digit,
        Some(_) => return rest.get(..1).unwrap_or(rest),
    };
    let length = rest.bytes().take_while(same).count();
    rest.get(..length).unwrap_or(rest)
}

/// `found` in words: the lexeme in quotes, or the end of the line.
pub(super) fn found(lexeme: &str) -> String {
    match lexeme.as_bytes() {
        [] => "the end of the line".to_owned(),
        [PLACEHOLDER] => "a byte that is not ASCII text".to_owned(),
        _ => format!("`{lexeme}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_bytes_keep_their_places() {
        assert_eq!(readable(b"G0 X1\t"), "G0 X1\t");
        assert_eq!(readable(b"\0\xc3\xa9G\x07"), " \u{1}\u{1}G\u{1}");
    }

    #[test]
    fn tokens_tile_what_lies_between() {
        let source = b"  G\xff1 ";
        let line = Span::new(0, 6);
        let lexemes = [(TokenKind::Letter, Span::new(2, 3)), (TokenKind::Number, Span::new(4, 5))];
        let tokens = tile(source, line, lexemes.into_iter());
        let kinds: Vec<_> = tokens.iter().map(|token| token.kind).collect();
        use TokenKind::*;
        assert_eq!(kinds, [Space, Letter, Other, Number, Space]);
    }

    #[test]
    fn numbers_say_how_they_are_written() {
        assert_eq!(number("007."), Number { value: 7.0, point: true, digits: 3 });
        assert_eq!(number(".25"), Number { value: 0.25, point: true, digits: 2 });
        assert_eq!(number("12"), Number { value: 12.0, point: false, digits: 2 });
    }

    #[test]
    fn numbers_are_rounded_as_the_standard_library_does() {
        let texts = proptest::string::string_regex(r"[0-9]{1,18}\.?[0-9]{0,18}|\.[0-9]{1,18}").unwrap();
        super::super::testing::runner(2_000)
            .run(&texts, |text| {
                let expected: f64 = text.parse().unwrap();
                assert_eq!(number(&text).value.to_bits(), expected.to_bits(), "{text}");
                Ok(())
            })
            .unwrap();
    }

    #[test]
    fn lexemes_are_named_whole() {
        assert_eq!(lexeme_at("V1=TAN V2", 3), "TAN");
        assert_eq!(lexeme_at("V1=^5", 3), "^");
        assert_eq!(lexeme_at("V1", 2), "");
    }
}

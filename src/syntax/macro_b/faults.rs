//! Why a block could not be read, in a programmer's words.

use super::lexeme::Lex;
use super::rules::Reading;
use super::shape::Shape;
use crate::diag::Code;
use crate::syntax::SyntaxError;
use crate::syntax::support::fault;
use crate::text::Span;

/// Finds the reason why the grammar stopped; `shape` counts from the start of the line.
pub fn explain(source: &[u8], block: Span, line_start: u32, shape: &Shape, stop: &Reading) -> SyntaxError {
    let place = |at: usize| Span::new(line_start + at as u32, line_start + at as u32 + 1);
    if let Some(at) = shape.nested_comment.map(place).filter(|at| at.start < stop.at) {
        return fault(Code::NestedComment, at, "a comment cannot contain another: it ends at the first `)`");
    }
    let text = block.of(source);
    if let Some(at) = function_with_parenthesis(text) {
        let at = block.start + at as u32;
        let message = "round brackets hold a comment: write arguments in `[` and `]`";
        return fault(Code::RoundBrackets, Span::new(at, at + 1), message);
    }
    if let Some(at) = shape.extra_close.map(place) {
        return fault(Code::UnbalancedBracket, at, "this `]` closes no bracket");
    }
    if let Some(at) = shape.unclosed.map(place) {
        return fault(Code::UnbalancedBracket, at, "this `[` is never closed");
    }
    let before = text.get(..(stop.at - block.start) as usize).unwrap_or_default();
    let next = source.get(stop.at as usize..block.end as usize).unwrap_or_default();
    at_stop(block, before.trim_ascii_end(), next, stop)
}

/// True where a code with its number stands there: `M98`, `G65`.
fn after_code(before: &[u8]) -> bool {
    let digits = before.iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
    let letter = before.iter().rev().nth(digits);
    digits > 0 && letter.is_some_and(|letter| b"GMgm".contains(letter))
}

/// The reason, judged by what stands on both sides of the place.
fn at_stop(block: Span, before: &[u8], next: &[u8], stop: &Reading) -> SyntaxError {
    let one = Span::new(stop.at, stop.at + u32::from(!next.is_empty()));
    let last = before.last().map_or(0, u8::to_ascii_uppercase);
    let expects = |kind| stop.expected.contains(&kind);
    match next.first() {
        Some(b'#') if matches!(last, b'O' | b'N') && expects(Lex::Integer) => {
            let letter = char::from(last);
            let message = format!("{letter} takes a written number, not a variable");
            fault(Code::VariableProgramNumber, one, message)
        }
        Some(b'#') if last == b'#' => fault(
            Code::BareIndirection,
            one,
            "a variable that gives a variable's number needs brackets: \
                                               `#[#1]`",
        ),
        Some(b'<' | b'>' | b'=') if expects(Lex::Operator) => {
            fault(Code::RelationalSign, one, "write comparisons as EQ, NE, GT, GE, LT or LE")
        }
        // A control that keeps programs in files calls them by their names too.
        Some(b'<') if next.contains(&b'>') && after_code(before) => {
            let end = next.iter().position(|byte| *byte == b'>').unwrap_or_default() as u32;
            let message = "a program is called by the name of its file, and only numbers are read here: give the file a number, \
                           and call it by P";
            fault(Code::Unreadable, Span::new(stop.at, stop.at + end + 1), message)
        }
        Some(b'0') if last == b'D' && expects(Lex::Do) => loop_word(one),
        Some(b'D' | b'd') if expects(Lex::Do) && next.get(1) == Some(&b'0') => loop_word(one),
        Some(b'(') if matches!(last, b'+' | b'-' | b'*' | b'/' | b'=' | b'[' | b',') => {
            fault(Code::RoundBrackets, one, "round brackets hold a comment: write expressions in `[` and `]`")
        }
        Some(b'.') if in_number(before) => {
            fault(Code::Unreadable, one, "this number has a decimal point before: take one of the two out")
        }
        None if last == b':' => {
            let at = block.start + before.len() as u32;
            let message = "a colon does not end a block: write `;`, or nothing";
            fault(Code::Unreadable, Span::new(at - 1, at), message)
        }
        Some(b'O' | b'o')
            if last.is_ascii_alphabetic()
                && lone_letter(before)
                && expects(Lex::Number)
                && next.get(1).is_none_or(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b' ')) =>
        {
            let message = format!(
                "the letter O stands after {}, where a number begins: write a zero",
                char::from(last)
            );
            fault(Code::WordWithoutValue, one, message)
        }
        _ if last.is_ascii_alphabetic() && lone_letter(before) && expects(Lex::Number) => {
            let end = block.start + before.len() as u32;
            let letter = Span::new(end - 1, end);
            let name = char::from(last);
            let message = format!("{name} has no number after it: write the number, or take {name} out");
            fault(Code::WordWithoutValue, letter, message)
        }
        _ => fault(Code::Unreadable, one, expectation(next, &stop.expected)),
    }
}

/// True where a number with a decimal point stands right before.
fn in_number(before: &[u8]) -> bool {
    let digits = |bytes: &[u8]| bytes.iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
    let whole = before.len() - digits(before);
    let point = whole.checked_sub(1).filter(|at| before[*at] == b'.');
    point.is_some_and(|at| digits(&before[..at]) > 0 || whole < before.len())
}

/// The fault of a block after a `;`: text there is a remark more often than a block.
pub fn remark(block: Span, fault: SyntaxError) -> SyntaxError {
    match fault.code {
        Code::WordWithoutValue | Code::Unreadable => SyntaxError {
            span: block,
            message:
                "`;` ends the block, and what stands after it is no block: write a remark in `(` and `)`"
                    .into(),
            ..fault
        },
        _ => fault,
    }
}

fn loop_word(span: Span) -> SyntaxError {
    fault(Code::LoopWordSlip, span, "this is a zero: write DO with the letter O")
}

/// True where the last letter is not part of a longer word.
fn lone_letter(before: &[u8]) -> bool {
    before.len() < 2 || !before[before.len() - 2].is_ascii_alphabetic()
}

/// What stands there and what would have been right.
fn expectation(next: &[u8], expected: &[Lex]) -> String {
    let found = match next.first() {
        None => "the block ends here".to_owned(),
        Some(&byte @ b' '..=b'~') => format!("`{}` cannot stand here", char::from(byte)),
        Some(byte) => format!("the byte {byte:#04x} cannot stand here"),
    };
    let mut names: Vec<&str> = expected.iter().filter_map(|kind| kind.in_words()).collect();
    names.sort_unstable();
    names.dedup();
    match names.as_slice() {
        [] => found,
        [only] => format!("{found}; expected {only}"),
        // Between items anything may follow: a list of everything helps nobody.
        many if many.len() > 6 => format!("{found}; no word or statement begins like this"),
        [most @ .., last] => format!("{found}; expected {} or {last}", most.join(", ")),
    }
}

/// The parenthesis after a function's name.
fn function_with_parenthesis(text: &[u8]) -> Option<usize> {
    const NAMES: [&[u8]; 10] =
        [b"SIN", b"COS", b"TAN", b"SQRT", b"ABS", b"ROUND", b"FIX", b"FUP", b"ATAN", b"SQR"];
    let mut at = 0;
    while let Some(open) = memchr::memchr(b'(', text.get(at..)?).map(|i| at + i) {
        let before = text[..open].trim_ascii_end();
        let ends = |name: &[u8]| {
            before.len() >= name.len() && before[before.len() - name.len()..].eq_ignore_ascii_case(name)
        };
        if NAMES.iter().any(|name| ends(name)) {
            return Some(open);
        }
        // What is inside a comment is no code.
        at = open + 1 + memchr::memchr(b')', &text[open + 1..])?;
    }
    None
}

/// A block with more brackets than are read.
pub fn too_deep(block: Span, depth: usize) -> SyntaxError {
    let message = format!("brackets nest {depth} deep, and no control takes that: split the expression");
    fault(Code::TooComplex, block, message)
}

/// A block whose tokens would lose text.
pub fn not_tiled(block: Span) -> SyntaxError {
    fault(Code::Unreadable, block, "parts of this block cannot be read; it is kept as text")
}

/// How many bytes may stand before the first `%` of a file.
const LONGEST_LEADER: usize = 4096;

/// True for text before the first `%`, which a control passes over.
///
/// Only a leader that holds no readable block counts as one, and only if something
/// follows the `%`: else the line belongs to a program without a `%` at its head.
pub fn outside_text(source: &[u8], line: Span) -> bool {
    let head = &source[..source.len().min(LONGEST_LEADER)];
    let Some(tape) = memchr::memchr(b'%', head).filter(|at| *at >= line.end as usize) else { return false };
    let at_line_start = matches!(head[..tape].last(), Some(b'\n' | b'\r'));
    let rest = source.get(tape + 1..).unwrap_or_default();
    let holds_code = head[..tape].split(|byte| matches!(byte, b'\n' | b'\r')).any(looks_like_code);
    at_line_start && !holds_code && rest.iter().any(|byte| byte.is_ascii_alphanumeric())
}

/// A line that begins as code does: a letter or `#` with a digit after it.
fn looks_like_code(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    let line = line.strip_prefix(b"/").unwrap_or(line);
    matches!(line, [first, digit, ..]
        if (first.is_ascii_alphabetic() || matches!(first, b'#' | b':')) && matches!(digit, b'0'..=b'9' | b'#' | b'['))
}

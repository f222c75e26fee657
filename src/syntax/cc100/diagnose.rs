//! Why a block cannot be read: the commonest slips by name, the rest by what was
//! expected where reading stopped.

use super::grammar::Rule;
use super::lexemes::name;
use crate::diag::Code;
use crate::syntax::SyntaxError;
use crate::syntax::support::{expected, fault, found, lexeme_at, stopped_at};
use crate::text::Span;
use pest::error::{Error, ErrorVariant};

const FUNCTIONS: [&str; 4] = ["SQR", "SIN", "COS", "ATN"];

/// The error of a block that the grammar stopped at.
pub(super) fn diagnose(text: &str, line: Span, error: &Error<Rule>) -> SyntaxError {
    let at = name_start(text, stopped_at(error).min(text.len()));
    let lexeme = lexeme_at(text, at);
    let expects = |rule: Rule| match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => positives.contains(&rule),
        ErrorVariant::CustomError { .. } => false,
    };
    let before = text.get(..at).unwrap_or("").trim_end_matches([' ', '\t']);
    let first = lexeme.as_bytes().first().copied().unwrap_or(0);
    let value_due = [Rule::number, Rule::constant, Rule::operation, Rule::variable].into_iter().any(expects);
    let operand_due = value_due && before.ends_with(['=', '+', '-', '*', '/']);
    let is_function = FUNCTIONS.iter().any(|function| function.eq_ignore_ascii_case(lexeme));
    let is_name = lexeme.len() > 1 && first.is_ascii_alphabetic();
    let goes_on = is_operator(first) && (expects(Rule::EOI) || expects(Rule::variable));
    let (code, message) = if first == b'(' && (operand_due || expects(Rule::add)) {
        (
            Code::NoBrackets,
            "this control has no brackets in expressions: divide the statement into steps".to_owned(),
        )
    } else if operand_due && is_name && before.ends_with('=') {
        (
            Code::UnknownFunction,
            format!("there is no function {lexeme}: the control has SQR, SIN, COS and ATN"),
        )
    } else if operand_due && is_name || (goes_on || is_function) && has_assignment(before) {
        let words = found(lexeme);
        (Code::OneOperation, format!("an assignment takes one operation: put {words} into a step of its own"))
    } else if first == b'(' {
        (Code::UnclosedComment, "the comment has no closing bracket".to_owned())
    } else if before.contains('$') && first != b'$' && !before.ends_with('$') {
        (Code::LabelNotAlone, "a label needs a block of its own".to_owned())
    } else if (value_due || expects(Rule::equals)) && before.ends_with(|c: char| c.is_ascii_alphabetic()) {
        let letter = before.chars().last().unwrap_or(' ');
        let message = format!("{letter} needs a number directly after it, or `=` and a variable");
        let start = line.start + before.len() as u32 - 1;
        return fault(Code::WordWithoutValue, Span::new(start, start + 1), message);
    } else {
        let message = match expected(error, name).as_str() {
            "" => format!("{} is not expected here", found(lexeme)),
            expected => format!("{expected} is expected here, not {}", found(lexeme)),
        };
        (Code::Unreadable, message)
    };
    let start = line.start + at as u32;
    fault(code, Span::new(start, (start + lexeme.len() as u32).min(line.end)), message)
}

/// Reading stops after the `SQR` of `SQRT`: the whole name is meant.
fn name_start(text: &str, at: usize) -> usize {
    let before = text.get(..at).unwrap_or("");
    let start = before.trim_end_matches(|letter: char| letter.is_ascii_alphabetic()).len();
    let function = before.get(start..).unwrap_or("");
    let known = FUNCTIONS.iter().any(|name| name.eq_ignore_ascii_case(function));
    let goes_on = text.as_bytes().get(at).is_some_and(u8::is_ascii_alphabetic);
    if known && goes_on { start } else { at }
}

fn is_operator(byte: u8) -> bool {
    matches!(byte, b'+' | b'-' | b'*' | b'/')
}

/// True where the last `=` before the place belongs to an assignment.
fn has_assignment(before: &str) -> bool {
    let Some((target, _)) = before.rsplit_once('=') else { return false };
    let target = target.trim_end_matches([' ', '\t']);
    target.rfind(['V', 'v']).is_some_and(|at| target.len() - at <= 4)
}

//! Why a line cannot be read: the commonest slips by name, the rest by what was
//! expected where reading stopped.

use super::grammar::Rule;
use super::lexemes::name;
use super::mark::mark_of;
use crate::diag::Code;
use crate::syntax::SyntaxError;
use crate::syntax::support::{expected, fault, found, lexeme_at, stopped_at};
use crate::text::Span;
use pest::error::{Error, ErrorVariant};

/// Statements that stand after `#` only.
const STATEMENTS: [&str; 10] =
    ["IF", "GOTO", "PRINT", "SPRINT", "INPUT", "SINPUT", "CLEAR", "WAIT", "START", "INDEX"];

/// The error of a line that the grammar stopped at.
pub(super) fn diagnose(text: &str, line: Span, error: &Error<Rule>) -> SyntaxError {
    let at = stopped_at(error).min(text.len());
    let stop = Stop { text, at, lexeme: lexeme_at(text, at), error };
    let (code, at, length, message) = match mark_of(text) {
        Some(mark) => stop.on_macro_line(mark),
        None => stop.on_nc_line(),
    }
    .unwrap_or_else(|| (Code::Unreadable, at, stop.lexeme.len(), stop.unexpected()));
    let start = line.start + at as u32;
    fault(code, Span::new(start, (start + length as u32).min(line.end)), message)
}

/// A code, where, how long, and the message.
type Finding = Option<(Code, usize, usize, String)>;

struct Stop<'t> {
    text: &'t str,
    at: usize,
    lexeme: &'t str,
    error: &'t Error<Rule>,
}

impl Stop<'_> {
    fn expects(&self, rule: Rule) -> bool {
        match &self.error.variant {
            ErrorVariant::ParsingError { positives, .. } => positives.contains(&rule),
            ErrorVariant::CustomError { .. } => false,
        }
    }

    fn unexpected(&self) -> String {
        match expected(self.error, name).as_str() {
            "" => format!("{} is not expected here", found(self.lexeme)),
            expected => format!("{expected} is expected here, not {}", found(self.lexeme)),
        }
    }

    /// The bytes from where reading stopped.
    fn rest(&self) -> &[u8] {
        self.text.as_bytes().get(self.at..).unwrap_or(&[])
    }

    fn before(&self) -> Option<&u8> {
        self.at.checked_sub(1).and_then(|at| self.text.as_bytes().get(at))
    }

    fn here(&self, code: Code, message: &str) -> Finding {
        Some((code, self.at, self.lexeme.len(), message.to_owned()))
    }

    fn on_macro_line(&self, mark: usize) -> Finding {
        let statement = self.text.get(mark + 1..).unwrap_or("").trim_start_matches([' ', '\t']);
        let label = self.text.len() - statement.len();
        if statement.starts_with(':') && self.at > label {
            let message = "a label needs a line to itself, without a comment or a statement";
            return Some((Code::LabelNotAlone, self.at, self.text.len() - self.at, message.to_owned()));
        }
        let operator_due = self.expects(Rule::add);
        match self.rest() {
            [b';', ..] => self.here(Code::SemicolonInMacro, "a macro line has no semicolons: divide the parts by commas"),
            [b'"', rest @ ..] if !rest.contains(&b'"') => {
                let message = "the closing quotation mark is missing".to_owned();
                Some((Code::UnterminatedText, self.at, self.text.len() - self.at, message))
            }
            [b'^', ..] => self.here(Code::ExponentForm, "there is no exponent form; write the number out"),
            [b'E' | b'e', next, ..]
                if self.before().is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.')
                    && (next.is_ascii_digit() || matches!(next, b'+' | b'-')) =>
            {
                self.here(Code::ExponentForm, "there is no exponent form; write the number out")
            }
            [b'(', ..] if operator_due => {
                self.here(Code::MacroComment, "a comment on a macro line begins with an apostrophe; or an operator is missing before the bracket")
            }
            [letter, rest @ ..] if letter.is_ascii_alphabetic() && is_value(rest) && self.expects(Rule::EOI) => {
                self.here(Code::MixedLine, "NC words cannot follow a macro statement: put them on a line \
                                            of their own")
            }
            _ => None,
        }
    }

    fn on_nc_line(&self) -> Finding {
        let first = self.text.trim_start_matches([' ', '\t']);
        let start = self.text.len() - first.len();
        let word = lexeme_at(first, 0);
        if self.at <= start + word.len() && STATEMENTS.iter().any(|name| name.eq_ignore_ascii_case(word)) {
            let message = format!("{word} is a macro statement: begin its line with `#`");
            return Some((Code::Unreadable, start, word.len(), message));
        }
        let value_due = self.expects(Rule::number) || self.expects(Rule::sign);
        match self.rest() {
            [b'#', ..] => self.here(
                Code::MixedLine,
                "a macro statement cannot follow NC words: put it on a line of its own",
            ),
            [b'=', ..] => {
                self.here(Code::EqualsOnNcLine, "an R variable is set by its sign here, without `=`")
            }
            [b'R' | b'r', digit, ..] if value_due && digit.is_ascii_digit() => {
                self.here(Code::SignMissing, "a sign is needed between the letter and the variable: `X+R2`")
            }
            [b'V' | b'v', digit, ..] if value_due && digit.is_ascii_digit() => self.here(
                Code::VariableOnNcLine,
                "a V variable cannot stand among NC words: copy it to an R variable on a macro line first",
            ),
            _ if value_due => {
                let bytes = self.text.as_bytes().get(..self.at).unwrap_or(&[]);
                let at = bytes.iter().rposition(|byte| !matches!(byte, b' ' | b'\t'))?;
                let letter = char::from(*bytes.get(at)?);
                if !letter.is_ascii_alphabetic() {
                    return None;
                }
                let message =
                    format!("{letter} needs a number or a variable after it, not {}", found(self.lexeme));
                Some((Code::WordWithoutValue, at, 1, message))
            }
            _ => None,
        }
    }
}

/// True where the value of a word begins: `1`, ` -2`, `+R1`.
fn is_value(rest: &[u8]) -> bool {
    rest.iter()
        .find(|byte| !matches!(byte, b' ' | b'+' | b'-'))
        .is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.')
}

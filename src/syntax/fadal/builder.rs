//! What building a block needs: places, faults and whole numbers.

use super::grammar::Rule;
use crate::diag::Code;
use crate::syntax::SyntaxError;
use crate::syntax::support::fault;
use crate::text::Span;
use pest::iterators::Pair;

/// What building a block needs.
pub(super) struct Build<'s> {
    pub source: &'s [u8],
    /// Where the line starts.
    pub start: u32,
    /// Where its `#` stands.
    pub mark: Option<Span>,
    pub errors: Vec<SyntaxError>,
}

impl<'s> Build<'s> {
    pub(super) fn new(source: &'s [u8], line: Span) -> Self {
        Self { source, start: line.start, mark: None, errors: Vec::new() }
    }

    /// The place of a pair in the file, blanks after it left out.
    pub(super) fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        let length = span.as_str().trim_ascii_end().len();
        Span::new(self.start + span.start() as u32, self.start + (span.start() + length) as u32)
    }

    pub(super) fn fault(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.errors.push(fault(code, span, message));
    }

    /// A whole number; where it has too many digits, a fault and the largest one.
    pub(super) fn whole(&mut self, pair: &Pair<'_, Rule>) -> u32 {
        pair.as_str().parse().unwrap_or_else(|_| {
            self.fault(Code::NumberTooLarge, self.span(pair), "the number has too many digits");
            u32::MAX
        })
    }
}

//! Arguments of macro calls: which local each letter sets.
//!
//! Specification I gives each letter a local of its own. Specification II has A, B
//! and C once and then up to ten sets of I, J, K for the locals from 4 on; an I, J or
//! K that does not come behind its forerunner in the alphabet begins the next set.

use super::Lowering;
use super::block::Words;
use super::expr::At;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{BareLength, Row};
use crate::ir::{Argument, Expr};
use crate::lower::common::constant;
use crate::syntax::{self, ExprKind};
use crate::text::Span;

/// The first local of the sets of I, J, K, and the last local there is.
const FIRST_OF_SETS: u32 = 4;
const LAST_LOCAL: u32 = 33;

/// Counts the sets of I, J, K.
#[derive(Default)]
struct Sets {
    set: u32,
    last: Option<u32>,
}

impl Sets {
    /// The local of the next I, J or K.
    fn next(&mut self, letter: char) -> u32 {
        let place = u32::from(letter) - u32::from('I');
        if self.last.is_some_and(|last| place <= last) {
            self.set += 1;
        }
        self.last = Some(place);
        FIRST_OF_SETS + 3 * self.set + place
    }
}

impl<'a> Lowering<'a> {
    /// The arguments that the words of a call set, in the order written.
    pub(super) fn arguments(&mut self, words: &Words<'a>) -> Vec<Argument> {
        let mut arguments: Vec<Argument> = Vec::with_capacity(words.len());
        let mut sets = Sets::default();
        let mut first_kind: Option<Span> = None;
        for &(word, span) in words {
            let letter = word.letter;
            let local = match letter {
                _ if word.comma => None,
                'I'..='K' if self.by_place(span) => Some(sets.next(letter)),
                _ => self.control.argument_local(letter),
            };
            let Some(local) = local.filter(|local| *local <= LAST_LOCAL) else {
                let message = match letter {
                    'I'..='K' => "more than ten sets of I, J and K".into(),
                    _ => format!("{letter} cannot be an argument of a macro call"),
                };
                self.findings.add(Diagnostic::new(Code::MacroCallNotAlone, span, message));
                continue;
            };
            if !matches!(letter, 'A'..='C' | 'I'..='K') {
                first_kind.get_or_insert(span);
            }
            let Some(value) = &word.value else {
                self.findings.not_understood(span, format!("{letter} has no value"));
                continue;
            };
            let value = self.argument(letter, value);
            let before = arguments.len();
            arguments.retain(|earlier| earlier.local != local);
            if before != arguments.len() && value.may_be_vacant() {
                // Whether a vacant argument takes back the one before it is in no text.
                self.unknown_behaviour("vacant.word.dropped", span);
            }
            arguments.push(Argument { local, value });
        }
        if let Some(span) = first_kind.filter(|_| sets.set > 0) {
            match self.findings.behaviour("arguments.mixed.later.wins", span) {
                Some("true") => {}
                Some(_) => {
                    let message = "letters of the first specification stand beside repeated or unordered I, J, K: the control takes one kind or the other";
                    self.findings.add(Diagnostic::new(Code::ArgumentsMixed, span, message));
                }
                None => self.unknown_behaviour("arguments.mixed.later.wins", span),
            }
        }
        arguments
    }

    fn by_place(&mut self, span: Span) -> bool {
        match self.control.behaviour("arguments.order.ijk").map(|row| row.value.as_str()) {
            Some("true") => true,
            Some("false") => false,
            _ => {
                self.unknown_behaviour("arguments.order.ijk", span);
                true
            }
        }
    }

    /// The value of an argument: a number without a point counts what its letter counts.
    fn argument(&mut self, letter: char, value: &'a syntax::Expr) -> Expr {
        let Some((number, point)) = literal(value) else { return self.expr(value, At::Argument) };
        if point || number == 0.0 {
            return Expr::Number(number);
        }
        let row = self.control.dialect().arguments.iter().find(|row| row.letter == letter);
        match row.filter(|row| row.bare.is_some()) {
            Some(row) => self.findings.rest_on(row, value.span),
            None => self.rest_on_numbers(value.span),
        }
        match self.control.bare_argument(letter) {
            BareLength::Increments => Expr::Increments(number),
            BareLength::Units => Expr::Number(number),
            BareLength::Unknown => {
                let fact = row.map_or_else(|| self.control.numbers().fact(), Row::fact);
                let note = format!("what {letter} counts without a decimal point; it is taken as written");
                self.findings.unconfirmed(fact, Some(&note), value.span);
                Expr::Number(number)
            }
        }
    }
}

/// The value of a literal that stands alone, and whether it has a decimal point. In
/// brackets it is an expression, whose numbers count whole units.
pub(super) fn literal(value: &syntax::Expr) -> Option<(f64, bool)> {
    let mut at = value;
    loop {
        match &at.kind {
            ExprKind::Number(number) => {
                return Some((constant(value).filter(|value| value.is_finite())?, number.point));
            }
            ExprKind::Negate(inner) | ExprKind::Plus(inner) => at = inner,
            _ => return None,
        }
    }
}

//! Arguments of macro calls: which local each letter sets.
//!
//! Specification I gives each letter a local of its own. Specification II has A, B
//! and C once and then up to ten sets of I, J, K for the locals from 4 on. Some
//! controls take it where I, J, K are out of order or repeated, others only where one is repeated.

use crate::diag::{Code, Diagnostic};
use crate::dialect::{BareLength, Question, Row};
use crate::ir::{Argument, Expr};
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::expressions::At;
use crate::lower::macro_b::parts::{Words, literal};
use crate::syntax;
use crate::text::Span;

/// The first local of the sets of I, J, K, and the last local there is.
const FIRST_OF_SETS: u32 = 4;
const LAST_LOCAL: u32 = 33;

/// Gives I, J and K the locals of the sets.
#[derive(Default)]
struct Sets {
    set: u32,
    last: Option<u32>,
    counts: [u32; 3],
}

impl Sets {
    /// The local of the next I, J or K: by its place after the letter before it, and by how often
    /// the letter stood before.
    fn next(&mut self, letter: char) -> (u32, u32) {
        let column = column(letter);
        if self.last.is_some_and(|last| column <= last) {
            self.set += 1;
        }
        self.last = Some(column);
        let count =
            self.counts.get_mut(column as usize).map_or(0, |count| std::mem::replace(count, *count + 1));
        (FIRST_OF_SETS + 3 * self.set + column, FIRST_OF_SETS + 3 * count + column)
    }
}

fn column(letter: char) -> u32 {
    u32::from(letter) - u32::from('I')
}

impl<'a> Lowering<'a> {
    /// The arguments that the words of a call set, in the order written.
    pub fn arguments(&mut self, words: &Words<'a>) -> Vec<Argument> {
        let mut arguments: Vec<Argument> = Vec::with_capacity(words.len());
        let mut sets = Sets::default();
        let by_place = self.by_place(words);
        let mut first_kind: Option<Span> = None;
        for (at, &(word, span)) in words.iter().enumerate() {
            let letter = word.letter;
            let local = match letter {
                _ if word.comma => None,
                'I'..='K' if by_place => Some(self.local_of_set(sets.next(letter), span)),
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
            self.signed |= matches!(value, Expr::Negate(_));
            let set = by_place && matches!(letter, 'I'..='K');
            if !set && words.iter().take(at).any(|(other, _)| !other.comma && other.letter == letter) {
                let message = format!("{letter} is in this call twice: the later one is taken");
                self.findings.add(Diagnostic::new(Code::WordTwice, span, message));
            }
            let before = arguments.len();
            arguments.retain(|earlier| earlier.local != local);
            if before != arguments.len() && value.may_be_vacant() {
                // Whether a vacant argument takes back the one before it is in no text.
                self.unknown_behaviour(Question::VacantWordDropped, span);
            }
            arguments.push(Argument { local, value });
        }
        if let Some(span) = first_kind.filter(|_| by_place) {
            match self.findings.behaviour(Question::ArgumentsMixedLaterWins, span) {
                Some("true") => {}
                Some(_) => {
                    let message = "this call mixes letters of argument list I with repeated or unordered \
                                   I, J, K: the control takes one kind or the other";
                    self.findings.add(Diagnostic::new(Code::ArgumentsMixed, span, message));
                }
                None => self.unknown_behaviour(Question::ArgumentsMixedLaterWins, span),
            }
        }
        arguments
    }

    /// True where I, J and K of this call are of the second specification: their places, not the
    /// letters, say which locals they set.
    fn by_place(&mut self, words: &Words<'a>) -> bool {
        let sets: Words<'a> = words
            .iter()
            .filter(|(word, _)| !word.comma && matches!(word.letter, 'I'..='K'))
            .copied()
            .collect();
        let falls = sets.windows(2).find(|pair| matches!(pair, [(a, _), (b, _)] if b.letter <= a.letter));
        let Some(&[_, (_, span)]) = falls else { return false };
        let twice = sets
            .iter()
            .enumerate()
            .any(|(at, (word, _))| sets.iter().take(at).any(|(other, _)| other.letter == word.letter));
        match self.findings.behaviour(Question::ArgumentsOrderIjk, span) {
            Some("true") => true,
            Some("repeated") => twice,
            Some(_) => false,
            None => {
                self.unknown_behaviour(Question::ArgumentsOrderIjk, span);
                true
            }
        }
    }

    /// The local of an I, J or K, given by place and by count.
    fn local_of_set(&mut self, (place, count): (u32, u32), span: Span) -> u32 {
        if place == count {
            return place;
        }
        match self.findings.behaviour(Question::ArgumentsRepeatedOrder, span) {
            Some("place") => place,
            Some(_) => count,
            None => {
                self.unknown_behaviour(Question::ArgumentsRepeatedOrder, span);
                place
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
                let note = format!(
                    "no manual says which unit {letter} has without a decimal point; it is \
                                    taken as written"
                );
                self.findings.unconfirmed(fact, Some(&note), value.span);
                Expr::Number(number)
            }
        }
    }
}

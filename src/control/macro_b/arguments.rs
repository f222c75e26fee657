//! Arguments of macro calls: which local variable each word sets.

use super::code::{Coded, Form, Word, Words};
use super::memory::Locals;
use super::rules::Lists;
use super::run::Runner;
use crate::canon::Role;
use crate::control::outcome::Stop;
use crate::control::session::Halt;
use crate::dialect::{BareLength, Question};

/// What a call's words say.
pub struct Arguments {
    pub locals: Locals,
    pub program: Option<f64>,
    pub count: Option<f64>,
}

/// The letters of an argument list whose I, J and K may count by place.
const SETS: &str = "IJK";

/// One I, J or K of a list: how many stood before it with the same letter, and how many
/// sets were begun by a letter that does not follow the one before.
#[derive(Clone, Copy)]
struct Triple {
    letter: usize,
    same_before: usize,
    sets_before: usize,
}

/// The I, J and K of a list, each with its index among the words.
fn triples(words: &[(usize, usize)]) -> Vec<(usize, Triple)> {
    let mut sets_before = 0;
    let step = |(at, &(index, letter)): (usize, &(usize, usize))| {
        let earlier = words.get(..at).unwrap_or_default();
        sets_before += usize::from(earlier.last().is_some_and(|(_, last)| *last >= letter));
        let same_before = earlier.iter().filter(|(_, other)| *other == letter).count();
        (index, Triple { letter, same_before, sets_before })
    };
    words.iter().enumerate().map(step).collect()
}

impl<'c> Runner<'c> {
    /// The arguments that stand after the call's code, or round an alias.
    pub fn arguments(&mut self, words: &Words, call: Coded) -> Result<Arguments, Halt> {
        let mut read = Arguments { locals: Locals::default(), program: None, count: None };
        let places = self.places(words, call);
        let (mut others, row) = (false, self.row(call.row));
        for (at, word) in words.words.iter().enumerate() {
            let before = at < call.word && call.alias.is_none();
            if at == call.word || before {
                continue;
            }
            let role = row.and_then(|row| self.session.control.role(word.letter, word.comma, Some(row)));
            match (role, word.letter) {
                (Some(Role::Program), _) => read.program = self.eval(&word.value)?,
                (Some(Role::CallCount), _) | (None, 'L') => read.count = self.eval(&word.value)?,
                _ => {
                    let value = self.argument(word)?;
                    let local = match places.iter().find(|(index, _)| *index == at) {
                        Some((_, triple)) => self.local_by_place(*triple),
                        None => {
                            others |= !"ABC".contains(word.letter);
                            self.local_of(word)?
                        }
                    };
                    if !read.locals.set(local, value, self.off) {
                        return Err(self.refused(word));
                    }
                }
            }
        }
        if others && !places.is_empty() && !self.rules.mixed_later_wins.ask(&mut self.session.trace) {
            // Which of the two kinds such a control takes is not known.
            self.session.trace.doubt(Question::ArgumentsMixedLaterWins.fact());
        }
        Ok(read)
    }

    /// The I, J and K of the list, where their places say which locals they set.
    fn places(&mut self, words: &Words, call: Coded) -> Vec<(usize, Triple)> {
        let letters = words.words.iter().enumerate().filter(|(at, word)| *at != call.word && !word.comma);
        let letters = letters.filter_map(|(at, word)| Some((at, SETS.find(word.letter)?)));
        let all = triples(&letters.collect::<Vec<_>>());
        if !all.iter().any(|(_, triple)| triple.sets_before > 0) {
            return Vec::new();
        }
        let twice = all.iter().any(|(_, triple)| triple.same_before > 0);
        match self.rules.lists.ask(&mut self.session.trace) {
            Lists::FallingOrTwice => all,
            Lists::Twice if twice => all,
            _ => Vec::new(),
        }
    }

    fn local_by_place(&mut self, triple: Triple) -> usize {
        let same = triple.sets_before == triple.same_before;
        let by_count = !same && self.rules.set_by_count.ask(&mut self.session.trace);
        let set = if by_count { triple.same_before } else { triple.sets_before };
        4 + 3 * set + triple.letter
    }

    fn local_of(&self, word: &Word) -> Result<usize, Halt> {
        match self.session.control.argument_local(word.letter).filter(|_| !word.comma) {
            Some(local) => Ok(local as usize),
            None => Err(self.refused(word)),
        }
    }

    fn refused(&self, word: &Word) -> Halt {
        let text = format!("{} is no argument of a macro call", word.letter);
        Halt::Alarm(Stop::alarm(self.style.alarms.call_not_alone, text))
    }

    /// The value of an argument; without a point it counts least increments of its address,
    /// on some controls and for some letters.
    fn argument(&mut self, word: &Word) -> Result<Option<f64>, Halt> {
        let value = self.eval(&word.value)?;
        if word.form == Form::Wrapped && value.is_some() && self.is_vacant(word)? {
            self.session.trace.doubt("machine:argument.signed");
        }
        let Some(number) = value.filter(|value| word.form == Form::Bare && *value != 0.0) else {
            return Ok(value);
        };
        let rows = &self.session.control.dialect().arguments;
        if let Some(row) = rows.iter().find(|row| row.letter == word.letter && row.bare.is_some()) {
            self.session.trace.rest_on(row);
        }
        let role = self.session.control.word(word.letter, word.comma).map(|row| row.role);
        let increment = match role {
            Some(role) if role.is_integer() => return Ok(value),
            Some(role) if role.is_axis() && !role.is_length() && !self.rules.angle_arguments => {
                self.length_increment()
            }
            Some(role) => self.increment_of(role).unwrap_or_else(|| self.length_increment()),
            None => self.length_increment(),
        };
        let bare = self.session.control.bare_argument(word.letter);
        if bare == BareLength::Unknown {
            self.session.trace.doubt(&format!("argument:{}", word.letter));
        } else if self.rules.numbers_unsure {
            self.session.trace.doubt("numbers");
        }
        Ok(Some(match bare {
            BareLength::Increments => crate::control::words::to_increment(number * increment, increment),
            _ => number,
        }))
    }
}

//! Arguments of macro calls: which local variable each word sets.

use super::code::{Coded, Form, Word, Words};
use super::memory::Locals;
use super::run::Runner;
use crate::canon::Role;
use crate::control::outcome::Stop;
use crate::control::session::Halt;
use crate::dialect::BareLength;

/// What a call's words say.
pub struct Arguments {
    pub locals: Locals,
    pub program: Option<f64>,
    pub count: Option<f64>,
}

/// Goes through I, J and K by place: `K J I` are the third of the first, the second of the
/// second and the first of the third three.
#[derive(Default)]
struct Places {
    group: usize,
    last: Option<usize>,
}

impl Places {
    fn next(&mut self, letter: usize) -> usize {
        if self.last.is_some_and(|last| letter <= last) {
            self.group += 1;
        }
        self.last = Some(letter);
        4 + 3 * self.group + letter
    }
}

impl<'c> Runner<'c> {
    /// The arguments that stand behind the call's code, or round an alias.
    pub fn arguments(&mut self, words: &Words<'c>, call: Coded<'c>) -> Result<Arguments, Halt> {
        let mut read = Arguments { locals: Locals::default(), program: None, count: None };
        let (mut places, mut others) = (Places::default(), false);
        for (at, word) in words.words.iter().enumerate() {
            let before = at < call.word && call.alias.is_none();
            if at == call.word || before {
                continue;
            }
            let role = call.row.and_then(|row| self.session.control.role(word.letter, word.comma, Some(row)));
            match (role, word.letter) {
                (Some(Role::Program), _) => read.program = self.eval(&word.value)?,
                (Some(Role::CallCount), _) | (None, 'L') => read.count = self.eval(&word.value)?,
                _ => {
                    let value = self.argument(word)?;
                    let local = match "IJK".find(word.letter) {
                        Some(letter) if self.rules.order_ijk.peek() => places.next(letter),
                        _ => {
                            others |= !"ABCIJK".contains(word.letter);
                            self.local_of(word)?
                        }
                    };
                    if !read.locals.set(local, value, self.off) {
                        return Err(self.refused(word));
                    }
                }
            }
        }
        if places.group > 0 {
            self.rules.order_ijk.ask(&mut self.session.trace);
            if others {
                self.rules.mixed_later_wins.ask(&mut self.session.trace);
            }
        }
        Ok(read)
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

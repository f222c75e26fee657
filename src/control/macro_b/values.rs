//! The value of a word: decimal points, least increments, whole numbers, vacancy.

use super::code::{Form, Meaning, Word};
use super::meaning::reads;
use super::rules::{Dwell, VacantBracket};
use super::run::Runner;
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use crate::control::session::Halt;
use crate::control::words::to_increment;
use crate::dialect::{BareLength, CodeMeaning};

/// A word's role, and the code that gives it where one does.
pub type RoleOf<'c> = Option<(Role, Option<&'c CodeMeaning>)>;

impl<'c> Runner<'c> {
    /// The role of a word: beside a code of the block, beside the drilling cycle in force, or by itself.
    pub fn role_of(&self, meaning: &Meaning, at: usize, word: &Word) -> RoleOf<'c> {
        if let Some(Some((role, row))) = meaning.beside.get(at) {
            return Some((*role, self.row(Some(*row))));
        }
        let alone = || Some((meaning.alone.get(at).copied().flatten()?, None));
        let Some(cycle) = self.cycle else { return alone() };
        let ends = meaning.codes.iter().filter_map(|code| self.row(code.row)).any(|row| {
            row.op == Op::CycleOff
                || (row.op.group() == crate::canon::Group::Motion)
                || moves_by_itself(row.op)
        });
        if ends {
            return alone();
        }
        if cycle.op == Op::Linear && !reads(cycle, word) {
            return alone();
        }
        self.session
            .control
            .role(word.letter, word.comma, Some(cycle))
            .map(|role| (role, Some(cycle)))
            .or_else(alone)
    }

    /// The value of a word in the units of the program; none if the word is dropped.
    pub fn word_value(&mut self, word: &Word, known: RoleOf<'_>) -> Result<Option<f64>, Halt> {
        let role = known.map(|(role, _)| role);
        if known.and_then(|(_, row)| row).is_some_and(|row| row.counts.contains(&word.letter)) {
            return self.counted(word);
        }
        if word.form.is_literal() {
            let value = self.eval(&word.value)?.unwrap_or(0.0);
            return self.literal(word, value, role).map(Some);
        }
        let increment = role.and_then(|role| self.increment_of(role));
        let rounds = increment.filter(|_| self.rules.round_in_address);
        let Some(value) = self.eval_in(&word.value, rounds)? else {
            return Ok(None);
        };
        // A sign before a vacant variable leaves nothing to drop but a zero: the variable decides.
        if word.form == Form::Wrapped && self.is_vacant(word)? {
            return Ok(match self.rules.vacant_bracket.ask(&mut self.session.trace) {
                VacantBracket::Dropped => None,
                VacantBracket::Zero => Some(0.0),
            });
        }
        Ok(Some(self.computed(value, role, increment)))
    }

    /// The value of a word that counts least increments and has no point.
    fn counted(&mut self, word: &Word) -> Result<Option<f64>, Halt> {
        if word.form == Form::Point {
            let stop =
                Stop::alarm(self.style.alarms.point, "a decimal point in a number of least increments");
            return Err(Halt::Alarm(stop));
        }
        let Some(count) = self.eval(&word.value)? else { return Ok(None) };
        self.rounds_to_whole(count);
        let increment = self.length_increment();
        Ok(Some(to_increment(count.round() * increment, increment)))
    }

    /// True where the one variable of a word is vacant.
    pub(super) fn is_vacant(&mut self, word: &Word) -> Result<bool, Halt> {
        use super::code::Ex;
        let mut inner = &word.value;
        while let Ex::Group(next) | Ex::Negate(next) | Ex::Plus(next) = inner {
            inner = next;
        }
        match inner {
            Ex::Read(_) => Ok(self.eval(inner)?.is_none()),
            _ => Ok(false),
        }
    }

    /// The least increment that the values of a role have, in the units in force.
    pub fn increment_of(&self, role: Role) -> Option<f64> {
        if role.is_length() || self.session.machine.takes_length(role) {
            Some(self.length_increment())
        } else if role.is_axis() || role.is_angle() {
            Some(self.rules.increment_degrees)
        } else {
            None
        }
    }

    fn literal(&mut self, word: &Word, value: f64, role: Option<Role>) -> Result<f64, Halt> {
        let Some(role) = role else { return Ok(value) };
        if matches!(role, Role::DwellMs | Role::CycleDwell | Role::DwellS) {
            let answer = match word.form {
                // Seconds are written with a point; without one they count thousandths.
                Form::Point if role == Role::DwellS => return Ok(value),
                // A calculator's number is as if it had one.
                _ if role == Role::DwellS && self.bare_of(word.letter) == BareLength::Units => {
                    return Ok(value);
                }
                Form::Point => self.rules.dwell_point.ask(&mut self.session.trace),
                _ => self.rules.dwell_bare.ask(&mut self.session.trace),
            };
            return self.dwell(value, role, answer);
        }
        if value == 0.0 || word.form == Form::Point {
            return Ok(value);
        }
        let (bare, increment) = match role {
            Role::Feed => (self.rules.bare_feed, Some(self.length_increment())),
            _ => (self.bare_of(word.letter), self.increment_of(role)),
        };
        if role.is_scale() {
            return Ok(value / self.rules.scale_parts.ask(&mut self.session.trace));
        }
        let Some(increment) = increment else { return Ok(value) };
        let left = role == Role::Feed && bare == BareLength::Unknown;
        if left && self.rules.whole_feeds && self.session.machine.feeds_millimetres() {
            // As written.
        } else if left || role == Role::Feed && self.rules.feed_unsure {
            self.session.trace.doubt("numbers:bare_feed");
        } else if self.rules.numbers_unsure || bare == BareLength::Unknown {
            self.session.trace.doubt("numbers");
        }
        Ok(match bare {
            BareLength::Increments => to_increment(value * increment, increment),
            BareLength::Units if role == Role::Feed => value / self.rules.feed_parts,
            _ => value,
        })
    }

    /// What a number without a point counts after a letter of a length: a calculator's only where it is reached.
    fn bare_of(&self, letter: char) -> BareLength {
        let pointed = &self.rules.pointed;
        let reached = pointed.is_empty() || pointed.chars().any(|one| one == letter);
        if reached || self.rules.bare_length != BareLength::Units {
            self.rules.bare_length
        } else {
            BareLength::Increments
        }
    }

    fn dwell(&mut self, value: f64, role: Role, answer: Dwell) -> Result<f64, Halt> {
        let milliseconds = match answer {
            Dwell::Milliseconds => value,
            Dwell::Seconds => value * 1000.0,
            Dwell::Refused => {
                let stop = Stop::alarm(self.style.alarms.point, "a decimal point in the time of a dwell");
                return Err(Halt::Alarm(stop));
            }
        };
        Ok(if role == Role::DwellS { milliseconds / 1000.0 } else { milliseconds })
    }

    fn computed(&mut self, value: f64, role: Option<Role>, increment: Option<f64>) -> f64 {
        if role == Some(Role::Speed) {
            self.session.trace.odd_speed(value);
        }
        match role {
            Some(Role::DwellMs | Role::CycleDwell) => {
                match self.rules.dwell_expression.ask(&mut self.session.trace) {
                    Dwell::Seconds => value * 1000.0,
                    _ => value,
                }
            }
            Some(role) if role.is_integer() && value.fract() != 0.0 => {
                self.rounds_to_whole(value);
                if self.rules.integer_word_rounds.ask(&mut self.session.trace) {
                    value.round()
                } else {
                    value
                }
            }
            _ => match increment {
                Some(increment) if self.rules.word_rounds => {
                    if let Some(short) = self.numeric.short {
                        short.place(self.off, increment, &mut self.session.trace);
                    }
                    let word = to_increment(value, increment);
                    if let Some(role) = role.filter(|_| word != value) {
                        self.command.rounded.push((role, (word - value).abs()));
                    }
                    word
                }
                _ => value,
            },
        }
    }
}

/// Codes whose words are their own though a cycle is in force.
fn moves_by_itself(op: Op) -> bool {
    use Op::*;
    matches!(op, Dwell | ReferenceReturn | Reference2 | ReferenceFrom | WriteWork | LocalShift | SetPosition)
        || matches!(op, WriteLength | WriteLengthWear | WriteRadius | WriteRadiusWear | WriteOffset | Probe)
}

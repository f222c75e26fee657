//! What codes and words mean, and how they are written.

use super::control::numbered;
use super::site::fingerprint;
use super::{CodeHead, CodeMeaning, Control, Dialect, Profile, Question, SiteCode, WordMeaning};
use crate::canon::{Act, Op, Role};
use std::collections::BTreeMap;

/// The place of a code's row in its table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodePlace(usize);

/// A code that calls a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alias {
    /// The program that is called.
    pub program: u32,
    /// True where the other words of the block are its arguments.
    pub arguments: bool,
    /// True where it is called after each move until the call is ended.
    pub modal: bool,
}

impl Control {
    /// What a code means, where `block` holds the letters and constant values of
    /// all words of its block. Of several rows the one with most words beside it
    /// counts: `G10 L2` before `G10`.
    pub fn code(&self, letter: char, number: f64, block: &[(char, Option<f64>)]) -> Option<&CodeMeaning> {
        self.code_at(self.code_place(letter, number, block)?)
    }

    /// The same as a place, for what is to outlive its reader.
    pub fn code_place(&self, letter: char, number: f64, block: &[(char, Option<f64>)]) -> Option<CodePlace> {
        let rows = self.codes.get(&CodeHead::new(letter, number)?)?;
        let fitting = rows.iter().filter_map(|(at, beside)| {
            let row = self.dialect.codes.get(*at)?;
            let fits = beside.iter().all(|wanted| self.stands(*wanted, (letter, number), block));
            fits.then_some(((beside.len(), row.when.is_some()), *at))
        });
        fitting.max_by_key(|(rank, _)| *rank).map(|(_, at)| CodePlace(at))
    }

    /// The row of a code at its place.
    pub fn code_at(&self, place: CodePlace) -> Option<&CodeMeaning> {
        self.dialect.codes.get(place.0)
    }

    /// The place of a row of this control.
    pub fn place_of_code(&self, row: &CodeMeaning) -> Option<CodePlace> {
        let rows = self.codes.get(&row.head()?)?;
        let own = |at: &usize| self.dialect.codes.get(*at).is_some_and(|other| std::ptr::eq(other, row));
        rows.iter().map(|(at, _)| *at).find(own).map(CodePlace)
    }

    /// All rows of a code, whatever words they want beside it.
    pub fn rows_of(&self, head: CodeHead) -> impl Iterator<Item = &CodeMeaning> {
        self.codes.get(&head).into_iter().flatten().filter_map(|(at, _)| self.dialect.codes.get(*at))
    }

    /// True where words beside a code may change what it means.
    pub fn depends_on_words(&self, head: CodeHead) -> bool {
        self.codes.get(&head).into_iter().flatten().any(|(_, beside)| !beside.is_empty())
    }

    /// The setting, `name=value`, under which the control has a code that it has not as it is set.
    pub fn code_under(&self, letter: char, number: f64) -> Option<&str> {
        let head = CodeHead::new(letter, number)?;
        let mut rows = self.dialect.other_codes.iter();
        rows.find(|row| row.head() == Some(head))?.when.as_deref()
    }

    /// The setting, and its value, under which a code takes a word of this letter, where it does not as the control is set.
    pub fn word_under(&self, code: &str, letter: char) -> Option<(&str, &str)> {
        let machine = self.machine().name();
        let takes = |row: &&CodeMeaning| {
            row.code == code
                && row.machine.as_deref().is_none_or(|of| of == machine)
                && row.words.keys().any(|word| address(word) == Some((letter, false)))
        };
        self.dialect.other_codes.iter().filter(takes).find_map(|row| self.one_open(row.when.as_deref()?))
    }

    /// The first condition of several that does not hold, and its first value.
    pub(super) fn first_open<'a>(&self, when: &'a str) -> Option<(&'a str, &'a str)> {
        let mut conditions = when.split(" and ").filter_map(|one| one.split_once('='));
        let holds =
            |name: &str, values: &str| values.split('|').any(|value| self.setting(name) == Some(value));
        let (name, values) = conditions.find(|(name, values)| !holds(name, values))?;
        Some((name, values.split('|').next().unwrap_or_default()))
    }

    /// The one condition of several that does not hold, and its first value.
    fn one_open<'a>(&self, when: &'a str) -> Option<(&'a str, &'a str)> {
        let holds =
            |name: &str, values: &str| values.split('|').any(|value| self.setting(name) == Some(value));
        let conditions = when.split(" and ").filter_map(|one| one.split_once('='));
        let mut open = conditions.filter(|(name, values)| !holds(name, values));
        let (name, values) = open.next()?;
        open.next().is_none().then(|| (name, values.split('|').next().unwrap_or_default()))
    }

    /// True where the word that a row wants stands in the block. A word with any
    /// value does not count where another code of the block reads its letter:
    /// the P of `G54 M98 P8099` is the program.
    fn stands(&self, wanted: super::Beside, code: (char, f64), block: &[(char, Option<f64>)]) -> bool {
        let values = block.iter().filter(|(letter, _)| *letter == wanted.letter).map(|(_, value)| *value);
        match wanted.thousandths {
            Some(thousandths) => values
                .flatten()
                .filter_map(|value| CodeHead::new(wanted.letter, value))
                .any(|head| head.thousandths == thousandths),
            None => values.count() > 0 && !self.reads_elsewhere(wanted.letter, code, block),
        }
    }

    fn reads_elsewhere(&self, letter: char, code: (char, f64), block: &[(char, Option<f64>)]) -> bool {
        let own = CodeHead::new(code.0, code.1);
        let others = block.iter().filter(|(letter, _)| matches!(letter, 'G' | 'M'));
        let heads = others.filter_map(|(letter, value)| CodeHead::new(*letter, (*value)?));
        heads
            .filter(|head| Some(*head) != own)
            .flat_map(|head| self.rows_of(head))
            .any(|row| row.words.keys().any(|word| address(word) == Some((letter, false))))
    }

    /// The code that is written for an operation whose operands have these values.
    /// A row that fixes an operand to another value is not taken; one that fixes
    /// more of them is preferred (`G55` before `G54.1 P`).
    pub fn code_for(&self, op: Op, operands: &BTreeMap<Role, f64>) -> Option<&CodeMeaning> {
        // Reversed, because the last of equals is the greatest: the first row counts.
        let rows = self.targets.get(&op)?.iter().rev().filter_map(|&at| self.dialect.codes.get(at));
        let fitting = rows.filter(|row| {
            row.preferred
                && row.fixed.iter().all(|(role, value)| operands.get(role) == Some(value))
                && operands.iter().all(|(role, value)| {
                    row.fixed.contains_key(role) || self.written(Some(row), *role, *value).is_some()
                })
        });
        fitting.max_by_key(|row| (row.op == op, row.fixed.len(), row.when.is_some()))
    }

    /// The role of a letter beside a code; none if the control gives it none.
    pub fn role(&self, letter: char, comma: bool, code: Option<&CodeMeaning>) -> Option<Role> {
        let beside = code.and_then(|row| {
            row.words
                .iter()
                .find(|(written, _)| address(written) == Some((letter, comma)))
                .map(|(_, role)| *role)
        });
        beside.or_else(|| self.word(letter, comma).map(|row| row.role))
    }

    /// The letter of a role beside a code, and whether it is a comma word.
    pub fn letter(&self, role: Role, code: Option<&CodeMeaning>) -> Option<(char, bool)> {
        let told = (role == Role::Repeat).then(|| self.behaviour(Question::CycleRepeatLetter)).flatten();
        if let Some(letter) = told.and_then(|row| row.value.chars().next()) {
            return Some((letter, false));
        }
        // Of two letters that the code reads, the one that usually has the role is written.
        let beside = code.and_then(|row| {
            let read = row.words.iter().filter(|(_, found)| **found == role);
            let letters = read.filter_map(|(written, _)| address(written));
            letters.max_by_key(|(letter, comma)| {
                (self.word(*letter, *comma).is_some_and(|word| word.role == role), std::cmp::Reverse(*letter))
            })
        });
        beside.or_else(|| {
            let row = self.dialect.words.iter().find(|row| row.role == role)?;
            let letter = address(&row.letter)?;
            let taken =
                code.is_some_and(|code| code.words.keys().any(|written| address(written) == Some(letter)));
            (!taken).then_some(letter)
        })
    }

    /// The parametric variable whose value the code takes for a role: R0 for the
    /// retract plane of a drilling cycle.
    pub fn parametric(&self, role: Role, code: Option<&CodeMeaning>) -> Option<(char, u32)> {
        code?.words.iter().filter(|(_, found)| **found == role).find_map(|(written, _)| parametric(written))
    }

    /// The role that a parametric variable has beside a code.
    pub fn parametric_role(&self, letter: char, number: u32, code: Option<&CodeMeaning>) -> Option<Role> {
        let mut words = code?.words.iter();
        words.find(|(written, _)| parametric(written) == Some((letter, number))).map(|(_, role)| *role)
    }

    /// What a letter means by itself.
    pub fn word(&self, letter: char, comma: bool) -> Option<&WordMeaning> {
        self.words.get(&(letter, comma)).and_then(|&at| self.dialect.words.get(at))
    }

    /// The word that does an operation by itself, without a code: `E2`, `T01`.
    pub fn word_for(&self, op: Op) -> Option<&WordMeaning> {
        self.dialect.words.iter().find(|row| row.op == Some(op))
    }

    /// The common value of a written number: `P1` of `G54.1` is work offset 101.
    pub fn canonical(&self, code: Option<&CodeMeaning>, role: Role, written: f64) -> f64 {
        let shift =
            self.shifts(code, role).find(|s| (f64::from(s.first)..=f64::from(s.last)).contains(&written));
        shift.map_or(written, |shift| written + shift.add as f64)
    }

    /// The number to write for a common value; none if the control cannot write it.
    pub fn written(&self, code: Option<&CodeMeaning>, role: Role, value: f64) -> Option<f64> {
        if self.letter(role, code).is_none() && self.parametric(role, code).is_none() {
            return None;
        }
        let mut ranged = false;
        for shift in self.shifts(code, role) {
            ranged = true;
            let written = value - shift.add as f64;
            if (f64::from(shift.first)..=f64::from(shift.last)).contains(&written) {
                return Some(written);
            }
        }
        (!ranged).then_some(value)
    }

    /// The common numbers that the word has beside a code, as `0 to 6 and 101 to 142`. No text, if it has all of
    /// them.
    pub fn numbers_of(&self, code: Option<&CodeMeaning>, role: Role) -> Option<String> {
        let range = |shift: &super::Shift| {
            let [first, last] = [shift.first, shift.last].map(|number| i64::from(number) + shift.add);
            if first == last { first.to_string() } else { format!("{first} to {last}") }
        };
        let ranges: Vec<String> = self.shifts(code, role).map(range).collect();
        (!ranges.is_empty()).then(|| ranges.join(" and "))
    }

    fn shifts<'c>(
        &'c self,
        code: Option<&'c CodeMeaning>,
        role: Role,
    ) -> impl Iterator<Item = &'c super::Shift> + 'c {
        let beside = code.and_then(|row| row.shift.get(&role));
        let usual =
            || self.dialect.words.iter().find(|row| row.role == role).and_then(|row| row.shift.get(&role));
        beside.or_else(usual).into_iter().flatten()
    }

    /// The program that the profile makes a code call.
    pub fn alias(&self, letter: char, number: f64) -> Option<Alias> {
        let mut aliases = self.aliases.iter();
        aliases.find(|(own, called, _)| *own == letter && *called == number).map(|(_, _, alias)| *alias)
    }

    /// The codes that call programs: letter, number, and what is called.
    pub fn aliased(&self) -> impl Iterator<Item = (char, f64, Alias)> + '_ {
        self.aliases.iter().copied()
    }

    /// What the profile says of a builder's code.
    pub fn site_code(&self, letter: char, number: f64) -> Option<&SiteCode> {
        let wanted = CodeHead::new(letter, number)?;
        self.profile.site.iter().find(|site| site.head() == Some(wanted))
    }

    /// The programs of the machine's builder that are not converted, as the code of another machine does what they do: each with the
    /// code that calls it.
    pub fn builders_programs(&self) -> impl Iterator<Item = (u32, &str)> {
        self.profile.site.iter().filter_map(|site| Some((site.builders_program()?, site.code.as_str())))
    }

    /// What the profile says of a builder's code by the name that it has.
    pub fn site_of(&self, act: Act) -> Option<&SiteCode> {
        self.profile.site.iter().find(|site| site.head().is_some() && self.act_of(site) == Some(act))
    }

    /// The code that does what a name stands for, as it is written.
    pub fn code_of(&self, act: Act) -> Option<&CodeMeaning> {
        self.code_for(Op::Act, &BTreeMap::from([(Role::Act, act.number())]))
    }

    /// The name of a builder's code; none if it has none and does not need one.
    pub fn act_of(&self, site: &SiteCode) -> Option<Act> {
        site.act(|| *self.owner.get_or_init(|| fingerprint(&self.profile)))
    }
}

/// The codes that the settings make call programs; of two for one code the first counts.
pub(super) fn aliases(
    dialect: &Dialect,
    settings: &BTreeMap<String, String>,
    profile: &Profile,
) -> Vec<(char, f64, Alias)> {
    let calls = |site: &SiteCode| {
        let (head, program) = (site.head()?, site.calls.filter(|_| site.target.is_none())?);
        Some((head.letter, head.number(), Alias { program, arguments: site.arguments, modal: false }))
    };
    let mut aliases: Vec<_> = profile.site.iter().filter_map(calls).collect();
    for row in &dialect.settings {
        let (Some(rule), Some((stem, first))) = (row.alias, numbered(&row.name)) else { continue };
        for (setting, program) in (first..=row.through.unwrap_or(first)).zip(rule.program..) {
            let value = settings.get(&format!("{stem}{setting}")).and_then(|value| value.parse::<f64>().ok());
            let Some(value) = value.filter(|value| *value != 0.0) else { continue };
            // A program of the builder that the code of another machine stands for.
            let is_builders = |site: &SiteCode| {
                let is_it = |head: CodeHead| head.letter == rule.letter && head.number() == value.abs();
                site.builders_program() == Some(program) && site.head().is_some_and(is_it)
            };
            if profile.site.iter().any(is_builders) {
                continue;
            }
            let alias = Alias { program, arguments: rule.arguments, modal: value < 0.0 };
            aliases.push((rule.letter, value.abs(), alias));
        }
    }
    aliases
}

/// The letter of a word as tables write it, and whether a comma stands before it.
pub(super) fn address(written: &str) -> Option<(char, bool)> {
    let (letter, comma) = match written.strip_prefix(',') {
        Some(letter) => (letter, true),
        None => (written, false),
    };
    let mut chars = letter.chars();
    Some((chars.next().filter(|_| chars.as_str().is_empty())?, comma))
}

/// `R0` as the variable 0 of R.
fn parametric(written: &str) -> Option<(char, u32)> {
    let letter = written.chars().next()?;
    let digits = written.get(letter.len_utf8()..).filter(|digits| !digits.is_empty())?;
    Some((letter, digits.parse().ok()?))
}

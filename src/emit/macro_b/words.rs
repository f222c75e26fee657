//! Blocks of words.

use super::Emitter;
use super::expressions::Place;
use crate::canon::{Op, Role};
use crate::dialect::{BareLength, CodeHead, Question, beside_letter};
use crate::emit::common::spellings::{Code, Operand};
use crate::ir::{BinOp, Expr, Nc, NcItem};
use smallvec::SmallVec;

/// The letters that a block has used, comma words apart.
#[derive(Default)]
struct Used(u64);

impl Used {
    /// Notes a letter; true where the block has it already.
    fn twice(&mut self, (letter, comma): (char, bool)) -> bool {
        let bit = 1u64 << (u32::from(letter) % 32 + if comma { 32 } else { 0 });
        let seen = self.0 & bit != 0;
        self.0 |= bit;
        seen
    }
}

impl<'p> Emitter<'p> {
    /// Writes the words of a block, in the order they were written in.
    pub(super) fn words(&mut self, nc: &Nc) {
        let word = |item: &'_ NcItem| matches!(item, NcItem::Word(..));
        if nc.items.iter().all(word) {
            // Most blocks have no code.
            let mut used = Used::default();
            for item in &nc.items {
                if let NcItem::Word(role, value) = item {
                    self.role_word(*role, value, &[], &mut used);
                }
            }
            return;
        }
        let codes = self.codes(nc);
        let known: SmallVec<[&Code; 8]> = codes.iter().flatten().copied().collect();
        self.count_m_codes(nc, &known);
        let mut used = Used::default();
        let mut codes = codes.iter();
        for item in &nc.items {
            match item {
                NcItem::Op(_) => {
                    if let Some(Some(code)) = codes.next() {
                        self.out.word(&code.text);
                    }
                }
                NcItem::Word(role, value) => self.role_word(*role, value, &known, &mut used),
                NcItem::Code(letter, value) => self.computed_code(*letter, value),
            }
        }
        if known.iter().any(|code| code.shared) {
            self.check_reading(nc, &known);
        }
    }

    /// A code that means another thing beside some words must not be beside them.
    fn check_reading(&mut self, nc: &Nc, codes: &[&Code]) {
        let mut written: SmallVec<[(char, Option<f64>); 12]> = SmallVec::new();
        for code in codes {
            written.extend(code.row.head().map(|head| (head.letter, Some(head.number()))));
            written.extend(code.text.split(' ').skip(1).filter_map(|word| {
                let comma = word.starts_with(',');
                let word = word.strip_prefix(',').unwrap_or(word);
                let letter = word.chars().next()?;
                Some((beside_letter(letter, comma), word.get(letter.len_utf8()..)?.parse().ok()))
            }));
        }
        for item in &nc.items {
            let NcItem::Word(role, value) = item else { continue };
            if let Some(((letter, comma), _)) = self.spellings.letter(*role, codes) {
                written.push((beside_letter(letter, comma), value.constant()));
            }
        }
        for code in codes.iter().filter(|code| code.shared) {
            let Some(head) = code.row.head() else { continue };
            let read = self.control.code(head.letter, head.number(), &written);
            if read.is_none_or(|read| read.op != code.row.op) {
                self.out
                    .unmapped(format_args!("{} beside these words: they make another code of it", code.text));
            }
        }
    }

    /// Writes a code by its number, which the control must have where it is constant.
    fn computed_code(&mut self, letter: char, value: &Expr) {
        self.out.space();
        self.out.push(letter);
        match value.constant() {
            Some(number) => {
                let head = CodeHead::new(letter, number);
                let known =
                    self.control.dialect().codes.iter().any(|row| head.is_some() && row.head() == head);
                if !known && self.control.site_code(letter, number).is_none() {
                    self.out.unmapped(format_args!("the code {letter}{number}"));
                }
                self.out.number(number, false);
            }
            None => self.word_value(Role::Tool, value),
        }
    }

    /// The code of each operation; none for one that a word beside it does by itself.
    fn codes(&mut self, nc: &Nc) -> SmallVec<[Option<&'p Code<'p>>; 8]> {
        let (spellings, control) = (self.spellings, self.control);
        let mut codes = SmallVec::new();
        for op in nc.ops() {
            let code = spellings.code(op, |role| match nc.word(role) {
                None => Operand::None,
                Some(value) => match value.constant() {
                    Some(number) => Operand::Constant(number),
                    None => Operand::Computed(split_sum(value).1),
                },
            });
            let by_word = || control.word_for(op).is_some_and(|row| nc.word(row.role).is_some());
            if op.is_flow() || (code.is_none() && !by_word()) {
                // Additional work offsets are as many as its profile says.
                let hint = match op {
                    Op::SelectWork => " (`work_offsets` of its machine profile says how many it has)",
                    _ => "",
                };
                let meaning = op.meaning().trim().trim_end_matches('.');
                self.out.unmapped(format_args!("the operation '{op}' ({meaning}) with these words{hint}"));
            }
            codes.push(code.filter(|_| !by_word()));
        }
        codes
    }

    fn count_m_codes(&mut self, nc: &Nc, codes: &[&Code]) {
        let most = self.spellings.m_codes;
        let computed = nc.items.iter().filter(|item| matches!(item, NcItem::Code('M', _))).count();
        if codes.iter().filter(|code| code.is_m()).count() + computed > most {
            self.out.unmapped(format_args!("more than {most} M codes in one block"));
        }
    }

    /// Writes a word, unless the code beside it says the same.
    #[inline]
    fn role_word(&mut self, role: Role, value: &Expr, codes: &[&Code], used: &mut Used) {
        if codes.iter().any(|code| !code.row.fixed.is_empty() && code.row.fixed.contains_key(&role)) {
            return;
        }
        let spellings = self.spellings;
        let Some((letter, code)) = spellings.letter(role, codes) else {
            return self.out.unmapped(format_args!(
                "the word '{role}' ({}) here: no letter has this meaning",
                meaning(role)
            ));
        };
        let misread = codes.iter().any(|c| c.words.iter().any(|(l, r)| *l == letter && *r != role));
        if misread || used.twice(letter) {
            return self.out.unmapped(format_args!(
                "the word '{role}' ({}) here: {} means something else",
                meaning(role),
                letter.0
            ));
        }
        self.out.space();
        if letter.1 {
            self.out.push(',');
        }
        self.out.push(letter.0);
        if spellings.is_literal_only(role)
            && value.constant().is_none()
            && !matches!(value, Expr::Increments(_))
        {
            return self.out.unmapped(format_args!("a computed value after {}", letter.0));
        }
        if spellings.is_shifted(role, code) {
            return self.shifted(role, value, code);
        }
        let alone = code.is_none() && spellings.is_counted(role);
        if alone || code.is_some_and(|code| code.row.counts.contains(&letter.0)) {
            return self.counted(role, value);
        }
        match value.constant() {
            Some(number) if role.is_act_word() => self.out.number(number, crate::dialect::measures(letter.0)),
            _ => self.word_value(role, value),
        }
    }

    /// Writes the number that the control has for a common one: 101 is `P1` of G54.1. Of a computed
    /// value the difference must be its last summand.
    fn shifted(&mut self, role: Role, value: &Expr, code: Option<&Code>) {
        let row = code.map(|code| code.row);
        let (base, add) = split_sum(value);
        match value.constant() {
            Some(number) => match self.control.written(row, role, number) {
                Some(written) => self.literal(role, written),
                None => self.out.lacks_number(number, role, row),
            },
            None if code.is_some_and(|code| code.adds(role, add)) => self.word_value(role, base),
            None => self.out.unmapped(format_args!("a computed value of the word '{role}'")),
        }
    }

    /// Writes the value of a word: `10.`, `#1`, `-#1`, `[#1+#2]`, `-[#1+#2]`.
    pub(super) fn word_value(&mut self, role: Role, value: &Expr) {
        self.place = if role.is_integer() { Place::Whole } else { Place::Word };
        match value {
            Expr::Number(number) => self.literal(role, *number),
            Expr::Increments(count) => self.increments(role, *count),
            Expr::Negate(inner) => match &**inner {
                Expr::Number(number) => self.literal(role, -number),
                Expr::Increments(count) => self.increments(role, -count),
                inner => {
                    self.out.push('-');
                    self.behind_letter(inner);
                }
            },
            value => self.behind_letter(value),
        }
        self.place = Place::Statement;
    }

    /// Writes a value that is no constant: a variable as it is, anything else in brackets.
    pub(super) fn behind_letter(&mut self, value: &Expr) {
        match value {
            Expr::Var(_) | Expr::Indirect(..) | Expr::System(..) | Expr::Vacant => self.value(value),
            _ => self.bracketed(value),
        }
    }

    fn literal(&mut self, role: Role, value: f64) {
        match role {
            Role::Turret => match self.control.turret_word().written(value) {
                Some(digits) => self.out.push_str(&digits),
                None => {
                    let (station, offset) = crate::dialect::turret_parts(value);
                    let why = match station {
                        0.0 => "alone in a T word, which would turn the turret",
                        _ => "in a T word, whose digits do not hold it",
                    };
                    self.out.unmapped(format_args!("the offset {offset} {why}"));
                }
            },
            // Two digits for each of what stands in one number, as people write it.
            Role::ThreadForm if value.fract() == 0.0 && value >= 100.0 => {
                self.out.push_str(&format!("{value:06}"));
            }
            _ if role.is_scale() => self.scale(value),
            _ if has_point(role) => self.out.number(value, true),
            Role::SpeedLimit | Role::Builder => self.out.number(value, false),
            _ if value.fract() == 0.0 => self.out.number(value, false),
            // A constant with a point would be an alarm, one in brackets is rounded.
            _ if role.is_integer() && self.control.is(Question::IntegerWordRounds) => {
                self.bracketed(&Expr::Number(value));
            }
            Role::DwellMs | Role::CycleDwell
                if self.control.behaviour(Question::DwellPoint).is_some_and(|b| b.value == "ms") =>
            {
                self.out.number(value, true);
            }
            _ => self.out.unmapped(format_args!("a fraction in the word '{role}'")),
        }
    }

    /// Writes a scale factor: with a point where the control is known to take one, or nothing else is known.
    fn scale(&mut self, value: f64) {
        match self.control.scale_parts().filter(|_| !self.control.is(Question::ScalePoint)) {
            Some(parts) if (value * parts - (value * parts).round()).abs() < 1e-6 => {
                self.out.number((value * parts).round(), false);
            }
            Some(parts) => {
                self.out
                    .unmapped(format_args!("the scale factor {value}, which counts parts of {parts} here"));
            }
            None => self.out.number(value, true),
        }
    }

    /// Writes a number that counts least increments, whatever others count here.
    fn counted(&mut self, role: Role, value: &Expr) {
        if let Some(count) = value.count() {
            self.place = Place::Word;
            self.behind_letter(count);
            self.place = Place::Statement;
            return;
        }
        match value {
            Expr::Increments(count) if count.fract() == 0.0 => self.out.number(*count, false),
            Expr::Number(0.0) => self.out.number(0.0, false),
            _ => self.out.unmapped(format_args!(
                "the word '{role}' ({}) here: it must be a whole count of least increments",
                meaning(role)
            )),
        }
    }

    fn increments(&mut self, role: Role, count: f64) {
        let bare = if role == Role::Feed { self.control.bare_feed() } else { self.control.bare_length() };
        if bare == BareLength::Increments && count.fract() == 0.0 && has_point(role) {
            self.out.number(count, false);
        } else {
            self.out.unmapped(format_args!("a count of increments in the word '{role}'"));
        }
    }
}

/// A value without the constant that is added to it last, and that constant.
fn split_sum(value: &Expr) -> (&Expr, f64) {
    match value {
        Expr::Binary(BinOp::Add, sum) => match &**sum {
            [base, Expr::Number(add)] => (base, *add),
            _ => (value, 0.0),
        },
        _ => (value, 0.0),
    }
}

/// True where a constant in this role has a decimal point.
fn has_point(role: Role) -> bool {
    !role.is_integer()
        && !role.is_act_word()
        && !matches!(role, Role::DwellMs | Role::CycleDwell | Role::SpeedLimit | Role::Builder)
}

/// What a role is, as a part of a sentence.
fn meaning(role: Role) -> &'static str {
    role.meaning().trim().trim_end_matches('.')
}

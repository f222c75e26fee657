//! Blocks of words.
//!
//! A block has plain words or words by variables, never both, and no code stands beside the latter (seed 004:245, 754).
//! So codes and settings go to a block of their own before a move by variables: `G1 F1500`, then `X=V33`.

use super::Emitter;
use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::emit::common::spellings::{Code, Operand};
use crate::ir::{Expr, Nc, NcItem, SourceInfo};
use smallvec::SmallVec;

impl<'p> Emitter<'p> {
    /// Writes a block of words, on two lines where variables stand in it.
    pub(super) fn block_of_words(&mut self, site: &'p SourceInfo, nc: &Nc) {
        let unit = |item: &NcItem| matches!(item, NcItem::Op(Op::CheckInch | Op::CheckMetric));
        if nc.items.iter().any(unit) {
            self.check_unit(site, nc.has(Op::CheckInch));
            let rest: Vec<NcItem> = nc.items.iter().filter(|item| !unit(item)).cloned().collect();
            if !rest.is_empty() {
                self.block_of_words(site, &Nc { items: rest });
            }
            return;
        }
        let spelled = by_number(nc);
        let by_variable = |item: &NcItem| match item {
            NcItem::Word(_, value) | NcItem::Code(_, value) => value.constant().is_none(),
            NcItem::Op(op) => spelled == Some(*op),
        };
        if nc.items.iter().any(by_variable) {
            let (first, rest): (Vec<NcItem>, Vec<NcItem>) =
                nc.items.iter().cloned().partition(|item| !by_variable(item) && !self.is_by_word(nc, item));
            // Apart from its G code a time would be a feed.
            let waits =
                |role: Role| spelled == Some(Op::Dwell) && matches!(role, Role::DwellS | Role::DwellMs);
            let moves = |item: &NcItem| matches!(item, NcItem::Word(role, _) if acts_with_move(*role) || waits(*role));
            let once = |item: &NcItem| matches!(item, NcItem::Op(op) if op.takes_axes());
            if first.iter().any(|item| moves(item) || once(item)) {
                self.begin(site);
                return self.out.unmapped("variables and numbers in one block");
            }
            // What stops the program comes after the move, and so does what ends spindle or coolant there.
            let after = self.control.behaviour(Question::MStopActs).is_some_and(|row| row.value == "end");
            let stops = |item: &NcItem| match item {
                NcItem::Op(Op::OptionalStop | Op::Stop) => true,
                NcItem::Op(Op::SpindleStop | Op::CoolantOff) => after,
                _ => false,
            };
            let (stop, first): (Vec<NcItem>, Vec<NcItem>) = first.into_iter().partition(stops);
            // The spindle must not start at the speed of before.
            let starts = first.iter().any(|item| matches!(item, NcItem::Op(Op::SpindleCw | Op::SpindleCcw)));
            let speed = |item: &NcItem| starts && matches!(item, NcItem::Word(Role::Speed, _));
            let (speed, rest): (Vec<NcItem>, Vec<NcItem>) = rest.into_iter().partition(speed);
            self.begin(site);
            for items in [speed, first, rest, stop].into_iter().filter(|items| !items.is_empty()) {
                self.words(&Nc { items });
                self.finish();
                self.open();
            }
            return self.finish();
        }
        self.begin(site);
        self.words(nc);
        self.finish();
    }

    /// True for an operation that a word by a variable does by itself: the tool change of `T=V30` (seed 004:1632).
    fn is_by_word(&self, nc: &Nc, item: &NcItem) -> bool {
        let NcItem::Op(op) = item else { return false };
        let role = self.control.word_for(*op).map(|row| row.role);
        role.and_then(|role| nc.word(role)).is_some_and(|value| value.constant().is_none())
    }

    /// `TST QM`, and a stop if the operator has set the other unit (seed 004:1664).
    fn check_unit(&mut self, site: &'p SourceInfo, inch: bool) {
        if !self.out.has_statement("test.unit") {
            return;
        }
        self.begin(site);
        self.out.push_str("TST QM");
        self.finish();
        let (branch, text) = match inch {
            true => ("BEQ", "SET THE CONTROL TO INCH"),
            false => ("BNE", "SET THE CONTROL TO METRIC"),
        };
        let Some(label) = self.stop_of(text.into()) else { return };
        self.open();
        self.out.push_str(branch);
        self.word("P");
        self.out.integer(label);
        self.finish();
    }

    /// Writes the words of a block, in the order they were written in.
    pub(super) fn words(&mut self, nc: &Nc) {
        let codes = self.codes(nc);
        let known: SmallVec<[&Code; 8]> = codes.iter().flatten().copied().collect();
        let most = self.spellings.m_codes;
        if known.iter().filter(|code| code.is_m()).count() > most {
            self.out.unmapped(format_args!("more than {most} M codes in one block"));
        }
        let mut used: SmallVec<[char; 12]> = SmallVec::new();
        let mut codes = codes.iter();
        let spelled = by_number(nc);
        for item in &nc.items {
            match item {
                NcItem::Op(op) => {
                    let code = codes.next().copied().flatten().filter(|_| spelled != Some(*op));
                    // Tool 0 takes the length away (seed 004:105).
                    let text = if *op == Op::LengthOff { Some("T00") } else { code.map(|code| &*code.text) };
                    text.into_iter().for_each(|text| self.word(text));
                }
                NcItem::Word(role, value) => self.role_word(*role, value, &known, &mut used),
                // `G=V19`: its numbers are the same on both controls (seed 004:1632).
                NcItem::Code(letter, Expr::Var(var)) => {
                    self.space();
                    self.out.push(*letter);
                    self.out.push('=');
                    self.variable(*var);
                }
                NcItem::Code(letter, _) => self.out.unmapped(format_args!("a computed {letter} code")),
            }
        }
    }

    /// The code of each operation; none for one that a word beside it does by itself.
    fn codes(&mut self, nc: &Nc) -> SmallVec<[Option<&'p Code<'p>>; 8]> {
        let (spellings, control) = (self.spellings, self.control);
        let mut codes = SmallVec::new();
        for op in nc.ops() {
            let code = spellings.code(op, |role| match nc.word(role).map(Expr::constant) {
                None => Operand::None,
                Some(Some(number)) => Operand::Constant(number),
                Some(None) => Operand::Computed(0.0),
            });
            let by_word = || {
                let is_tool = op == Op::LengthOff && control.is(Question::ToolWordSelectsLength);
                is_tool || control.word_for(op).is_some_and(|row| nc.word(row.role).is_some())
            };
            if op.is_flow() || (code.is_none() && !by_word()) {
                self.out.unmapped(format_args!("the operation '{op}' with these words"));
            }
            codes.push(code.filter(|_| !by_word()));
        }
        codes
    }

    /// Writes a word, unless the code beside it says the same.
    fn role_word(&mut self, role: Role, value: &Expr, codes: &[&Code], used: &mut SmallVec<[char; 12]>) {
        if codes.iter().any(|code| code.row.fixed.contains_key(&role)) {
            return;
        }
        let Some(((letter, false), _)) = self.spellings.letter(role, codes) else {
            let meaning = role.meaning().trim().trim_end_matches('.');
            return self
                .out
                .unmapped(format_args!("the word '{role}' ({meaning}) here: no letter has this meaning"));
        };
        let misread = codes
            .iter()
            .any(|code| code.words.iter().any(|((other, _), meaning)| *other == letter && *meaning != role));
        if misread || used.contains(&letter) {
            return self.out.unmapped(format_args!("the word '{role}' here: {letter} means something else"));
        }
        let beside = codes.iter().any(|code| code.words.iter().any(|(_, meaning)| *meaning == role));
        if letter == 'T' && role != Role::Tool && !beside {
            // By itself it would change the tool.
            return self.out.unmapped(format_args!("the word '{role}' in a block without G41 or G42"));
        }
        if matches!(role, Role::ArcI | Role::ArcJ | Role::ArcK) {
            return self.out.unmapped("the centre of an arc: no source says from where it counts here");
        }
        if role == Role::ArcRadius && value.constant().is_none() && !matches!(value, Expr::Negate(_)) {
            return self.out.unmapped("an arc's radius from a variable: its sign means another arc here");
        }
        used.push(letter);
        self.space();
        self.out.push(letter);
        match (value.constant(), value) {
            (Some(number), _) => self.literal(role, letter, number),
            // The shorter arc has a minus here: its radius stands in the program with the other sign.
            (None, Expr::Negate(inner)) if role == Role::ArcRadius => match **inner {
                Expr::Var(var) => {
                    self.out.push('=');
                    self.variable(var);
                }
                _ => self.out.unmapped("a computed radius of an arc"),
            },
            (None, Expr::Var(var)) => {
                self.out.push('=');
                self.variable(*var);
            }
            _ => self.out.unmapped(format_args!("a computed value of the word '{role}'")),
        }
    }

    fn literal(&mut self, role: Role, letter: char, value: f64) {
        let value = if role == Role::ArcRadius { self.radius(value) } else { value };
        if letter == 'T' && value == value.trunc() && (0.0..10.0).contains(&value) {
            self.out.push('0');
        }
        if role.is_integer() && value.fract() != 0.0 {
            return self.out.unmapped(format_args!("a fraction in the word '{role}'"));
        }
        self.out.number(value, false);
    }

    /// The shorter arc has a negative radius here, and which one a positive means no source says (seed 004:375).
    fn radius(&mut self, value: f64) -> f64 {
        let negative = self.control.behaviour(Question::ArcRadiusNegative).map(|row| row.value.as_str());
        if value < 0.0 || negative != Some("short") {
            self.out.unmapped("an arc of more than 180 degrees by its radius");
        }
        -value
    }
}

/// True for a word that only means something beside the move.
fn acts_with_move(role: Role) -> bool {
    role.is_axis() || matches!(role, Role::ArcRadius | Role::ArcI | Role::ArcJ | Role::ArcK)
}

/// True if a word or a code of a block is given by a variable.
pub(super) fn by_variables(nc: &Nc) -> bool {
    let by_variable = |item: &NcItem| matches!(item, NcItem::Word(_, value) | NcItem::Code(_, value) if value.constant().is_none());
    nc.items.iter().any(by_variable)
}

/// The operation of a block that the code by a variable in it stands for (`G=V31 F=V30`).
fn by_number(nc: &Nc) -> Option<Op> {
    let code = nc.items.iter().any(|item| matches!(item, NcItem::Code(_, Expr::Var(_))));
    nc.ops().find(|op| code && op.acts_with_words())
}

//! Blocks of words.
//!
//! A word takes a number or one R variable with a sign; a number that is no whole word has a point. R itself is written
//! `R0` and a sign, as the control wants it (seed 000:19 to 31; facts/fadal-target.md 2).

use super::Emitter;
use super::lines::Kind;
use crate::canon::{Group, Op, Role};
use crate::dialect::Question;
use crate::emit::common::spellings::{Code, Operand};
use crate::ir::{Expr, Nc, NcItem, SourceInfo};
use smallvec::SmallVec;

/// Modes that move nothing and take no word, so that they may be said a block before.
const MODES: [Group; 5] = [Group::Plane, Group::Distance, Group::Units, Group::FeedMode, Group::ReturnPlane];

impl<'p> Emitter<'p> {
    /// Writes a block of words, or several, where the control takes less in one.
    pub(super) fn block_of_words(&mut self, site: &'p SourceInfo, nc: &Nc) {
        if let Some(parts) = self.as_two(nc) {
            return parts.iter().for_each(|items| self.block_of_words(site, &Nc { items: items.clone() }));
        }
        let ordered = self.mode_first(nc);
        self.begin(site, Kind::Words);
        self.words(ordered.as_ref().unwrap_or(nc));
        self.finish();
    }

    /// A block whose code for places or increments stands after its words, with the code before them, where it counts for
    /// no word before it.
    fn mode_first(&self, nc: &Nc) -> Option<Nc> {
        let is_mode = |item: &NcItem| matches!(item, NcItem::Op(op) if op.group() == Group::Distance);
        let hangs =
            |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis() || *role == Role::CycleR);
        let word = nc.items.iter().position(hangs)?;
        let mode = nc.items.iter().position(is_mode).filter(|mode| *mode > word)?;
        self.control.behaviour(Question::DistanceCode).filter(|row| row.value != "block")?;
        let mut items = nc.items.clone();
        let mode = items.remove(mode);
        items.insert(word, mode);
        Some(Nc { items })
    }

    /// The two blocks that a block becomes, if it has to. A fixture is not chosen in the block of an arc; G53 and G92 stand with
    /// no other G code, so those beside them go before them; and so do modes of a block with more G codes than the maker
    /// shows in one (facts/fadal-target.md 1, 5).
    fn as_two(&self, nc: &Nc) -> Option<[Vec<NcItem>; 2]> {
        let is_fixture =
            |item: &NcItem| matches!(item, NcItem::Op(Op::SelectWork) | NcItem::Word(Role::WorkOffset, _));
        if nc.has(Op::SelectWork) && is_arc(nc) {
            return Some(split(nc, is_fixture));
        }
        let is_g = |op| self.spellings.bare_code(op).is_some_and(|code| !code.is_m());
        if let Some(alone) = [Op::MachineOnce, Op::SetPosition].into_iter().find(|op| nc.has(*op)) {
            let beside = |item: &NcItem| matches!(item, NcItem::Op(op) if *op != alone && is_g(*op));
            return nc.items.iter().any(beside).then(|| split(nc, beside));
        }
        let mode = |item: &NcItem| matches!(item, NcItem::Op(op) if MODES.contains(&op.group()) && is_g(*op));
        let most = self.control.limit("g.codes").map_or(usize::MAX, |most| most as usize);
        let many = nc.ops().filter(|op| is_g(*op)).count() > most;
        let some = nc.items.iter().any(mode) && !nc.items.iter().all(mode);
        (many && some).then(|| split(nc, mode))
    }

    /// Writes the words of a block, in the order they were written in.
    fn words(&mut self, nc: &Nc) {
        let codes = self.codes(nc);
        let known: SmallVec<[&Code; 8]> = codes.iter().flatten().copied().collect();
        self.check_m_codes(&known);
        self.check_plane(nc, &known);
        self.check_position(nc);
        let mut used: SmallVec<[char; 12]> = SmallVec::new();
        let mut codes = codes.iter();
        for item in &nc.items {
            match item {
                NcItem::Op(_) => {
                    if let Some(Some(code)) = codes.next() {
                        self.word(&code.text);
                    }
                }
                NcItem::Word(role, value) => self.role_word(*role, value, &known, &mut used),
                NcItem::Code(letter, _) => self.out.unmapped(format_args!("a computed {letter} code")),
            }
        }
    }

    /// The code of each operation; none for one that a word beside it does by itself.
    fn codes(&mut self, nc: &Nc) -> SmallVec<[Option<&'p Code<'p>>; 8]> {
        let mut codes = SmallVec::new();
        for op in nc.ops() {
            let (code, by_word) = self.code_of(op, nc);
            if op.is_flow() || (code.is_none() && !by_word) {
                self.out.unmapped(format_args!("the operation '{op}' with these words"));
            }
            codes.push(code);
        }
        codes
    }

    /// The code of an operation in a block, and true if a word does it, by itself or with the code.
    fn code_of(&self, op: Op, nc: &Nc) -> (Option<&'p Code<'p>>, bool) {
        let code = self.spellings.code(op, |role| match nc.word(role).map(Expr::constant) {
            None => Operand::None,
            Some(Some(number)) => Operand::Constant(number),
            Some(None) => Operand::Computed(0.0),
        });
        let word = self.control.word_for(op).filter(|row| nc.word(row.role).is_some());
        (code.filter(|_| word.is_none_or(|row| row.with_code)), word.is_some())
    }

    /// True for a block with a word that sets the variable R0, whatever the word means there.
    pub(super) fn sets_r0(&self, nc: &Nc) -> bool {
        let codes: SmallVec<[&Code; 8]> = nc.ops().filter_map(|op| self.code_of(op, nc).0).collect();
        let fixed = |role: &Role| codes.iter().any(|code| code.row.fixed.contains_key(role));
        nc.items.iter().any(|item| match item {
            NcItem::Word(role, _) if !fixed(role) => {
                self.spellings.letter(*role, &codes).is_some_and(|((letter, _), _)| letter == 'R')
            }
            _ => false,
        })
    }

    /// A cycle or a table that is not told its R0 takes what R0 holds, which is something else here.
    fn check_plane(&mut self, nc: &Nc, codes: &[&Code]) {
        for role in codes.iter().filter_map(|code| code.row.words.get("R0")) {
            if *role != Role::ArcRadius && nc.word(*role).is_none() {
                let meaning = role.meaning().trim().trim_end_matches('.');
                self.out.unmapped(format_args!(
                    "this block without '{role}' ({meaning}): it would take what R0 holds"
                ));
            }
        }
    }

    /// Nobody says whether a cycle without a position drills where the tool stands.
    fn check_position(&mut self, nc: &Nc) {
        let runs = self.control.behaviour(Question::CycleRunsWithoutAxes);
        let known = runs.is_some_and(|row| row.value == "true");
        let placed = nc.word(Role::X).is_some() || nc.word(Role::Y).is_some();
        if nc.ops().any(Op::is_cycle) && !placed && nc.word(Role::Repeat).is_none() && !known {
            self.out.unmapped("a cycle without X and Y: nobody says whether it drills where the tool stands");
        }
    }

    /// No more M codes than the control takes, and none of more than two digits (facts/fadal-target.md 5).
    fn check_m_codes(&mut self, codes: &[&Code]) {
        let most = self.spellings.m_codes;
        if codes.iter().filter(|code| code.is_m()).count() > most {
            self.out.unmapped(format_args!("more than {most} M codes in one block"));
        }
    }

    /// Writes a word, unless the code beside it says the same.
    fn role_word(&mut self, role: Role, value: &Expr, codes: &[&Code], used: &mut SmallVec<[char; 12]>) {
        if codes.iter().any(|code| code.row.fixed.contains_key(&role)) {
            return;
        }
        let spellings = self.spellings;
        let Some(((letter, false), code)) = spellings.letter(role, codes) else {
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
        used.push(letter);
        self.space();
        self.out.push(letter);
        if letter == 'R' {
            self.out.push('0');
        }
        let value = match value.constant() {
            Some(number) if spellings.is_shifted(role, code) => {
                match self.control.written(code.map(|code| code.row), role, number) {
                    Some(written) => &Expr::Number(written),
                    None => return self.out.lacks_number(number, role, code.map(|code| code.row)),
                }
            }
            None if spellings.is_shifted(role, code) => {
                return self.out.unmapped(format_args!("a computed value of the word '{role}'"));
            }
            _ => value,
        };
        match value.constant() {
            Some(number) if role.is_act_word() => self.out.number(number, crate::dialect::measures(letter)),
            // The speed of a tap stands in F, whose numbers have a point as those of every word that measures.
            Some(number) if letter == 'F' => self.out.number(number, true),
            _ => self.word_value(role, value, letter == 'R'),
        }
    }

    /// Writes the value of a word: `10.`, `+R9`, `-R9`; `signed` where a sign must stand.
    pub(super) fn word_value(&mut self, role: Role, value: &Expr, signed: bool) {
        let negated = match value {
            Expr::Negate(inner) => Some(&**inner),
            _ => None,
        };
        match (value.constant(), value, negated) {
            (Some(number), ..) => {
                if signed && !number.is_sign_negative() {
                    self.out.push('+');
                }
                self.literal(role, number);
            }
            (_, Expr::Var(var), _) => {
                self.out.push('+');
                self.parametric(*var);
            }
            (.., Some(Expr::Var(var))) => {
                self.out.push('-');
                self.parametric(*var);
            }
            _ => self.out.unmapped(format_args!("a computed value of the word '{role}'")),
        }
    }

    /// A word takes R alone.
    fn parametric(&mut self, var: crate::ir::Var) {
        let register = self.names.variable(var);
        if register.is_some_and(|register| &*register.name == "R") {
            self.variable(var);
        } else {
            self.out.unmapped("a variable in a word that is no R");
        }
    }

    fn literal(&mut self, role: Role, value: f64) {
        let whole = role.is_integer() || matches!(role, Role::DwellMs | Role::CycleDwell);
        match whole {
            false => self.out.number(value, true),
            true if value.fract() == 0.0 => self.out.number(value, false),
            true => self.out.unmapped(format_args!("a fraction in the word '{role}'")),
        }
    }
}

/// The items of a block for which this holds, and the others.
fn split(nc: &Nc, first: impl Fn(&NcItem) -> bool) -> [Vec<NcItem>; 2] {
    nc.items.iter().cloned().partition::<Vec<_>, _>(first).into()
}

/// True for a block with an arc, or with the words of one.
fn is_arc(nc: &Nc) -> bool {
    let words = [Role::ArcI, Role::ArcJ, Role::ArcK, Role::ArcRadius];
    nc.has(Op::ArcCw) || nc.has(Op::ArcCcw) || words.iter().any(|role| nc.word(*role).is_some())
}

//! Blocks of NC words.

use super::roles::BlockCodes;
use super::unknown::{Unknown, is_of_mode};
use crate::canon::{Auxiliary, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CodeMeaning, Question, beside_letter};
use crate::ir::{Expr, Nc, NcItem, SourceInfo, StmtKind};
use crate::lower::common::constant;
use crate::lower::macro_b::build::{Lowering, Motion};
use crate::lower::macro_b::codes::CodeId;
use crate::lower::macro_b::expressions::At;
use crate::lower::macro_b::parts::Words;
use crate::syntax::{ExprKind, Word};
use crate::text::Span;

impl<'a> Lowering<'a> {
    /// The code of a G or M word with a constant for its number.
    pub fn constant_code(&mut self, word: &Word) -> Option<CodeId> {
        if !matches!(word.letter, 'G' | 'M') || word.comma {
            return None;
        }
        match &word.value.as_ref()?.kind {
            ExprKind::Number(number) => self.codes.find(word.letter, number.value),
            _ => None,
        }
    }

    /// What a code means among the words of its block.
    pub fn row_beside(&mut self, id: CodeId, words: &Words<'a>) -> Option<&'a CodeMeaning> {
        let code = self.codes.get(id)?;
        if !code.depends {
            return code.row;
        }
        let letter = |word: &Word| beside_letter(word.letter, word.comma);
        let letters: Vec<(char, Option<f64>)> =
            words.iter().map(|(word, _)| (letter(word), word.value.as_ref().and_then(constant))).collect();
        self.control.code(code.head.letter, code.head.number(), &letters)
    }

    /// The construct rests on a code's row; said once a program.
    pub fn rest_on_code(&mut self, id: CodeId, row: &'a CodeMeaning, span: Span) {
        if !row.origin.is_confirmed()
            && (self.codes.tell(id) || self.codes.get(id).is_some_and(|c| c.depends))
        {
            self.findings.rest_on(row, span);
        }
    }

    /// A block of NC words.
    pub fn nc(&mut self, words: &Words<'a>, site: &SourceInfo) {
        if let Some(nc) = self.bare_words(words) {
            self.check_turning(&nc, site.span);
            return self.builder.push(StmtKind::Nc(nc), site.clone());
        }
        let (codes, unknown) = self.block_codes(words);
        let kept: Words<'a> = match unknown {
            Unknown::None => Words::new(),
            Unknown::Builders => words.iter().filter(|(word, _)| is_of_mode(word)).copied().collect(),
            Unknown::Other => return self.builder.push(StmtKind::Comment, site.clone()),
        };
        if unknown == Unknown::Builders && codes.is_empty() {
            return self.builder.push(StmtKind::Comment, site.clone());
        }
        let words = if unknown == Unknown::Builders { &kept } else { words };
        self.check_machine(words, &codes);
        self.check_codes_of_cycle(words, &codes, site.span);
        self.check_told_once(words, &codes);
        self.note_axes(words, &codes);
        if let Some((_, row)) = codes.iter().rev().find(|(_, row)| row.op.group() == Group::FeedMode) {
            self.inverse = row.op == Op::FeedInverse;
            // A block that may be skipped leaves either in force.
            let same = site.skip.is_none() || self.motion.feed == Some(row.op);
            self.motion.feed = Some(row.op).filter(|_| same);
        }
        let mut nc = Nc { items: Vec::with_capacity(words.len() + 1) };
        let (mut seen, mut seconds) = (Seen::default(), Vec::new());
        let stops = self.stops_with_alarm(&codes);
        let mut next = codes.iter();
        for &(word, span) in words {
            if matches!(word.letter, 'G' | 'M') && !word.comma {
                match self.constant_code(word) {
                    Some(id) => {
                        if let Some(&(_, row)) = next.as_slice().first().filter(|(found, _)| *found == id) {
                            next.next();
                            let noted = (&mut seen, &mut seconds);
                            self.operation(id, row, word, span, &mut nc, noted);
                        }
                    }
                    None => self.computed_code(word, span, &mut nc, &mut seen),
                }
            } else if !stops && !belongs_to_code(word, &codes) {
                self.word(word, span, &codes, &mut nc, &mut seen);
            }
        }
        self.tell_seconds(&nc, seconds);
        self.check_lead(&nc, &codes, site.span);
        self.radius_by_length_word(&mut nc, site.span);
        self.check_m_codes(&seen, site.span);
        self.check_turning(&nc, site.span);
        self.drops_allowances(&mut nc, site.span);
        if nc.ops().filter(|op| *op == Op::Act).count() > 1 {
            return self.builders_codes(nc, site);
        }
        self.settle_change(&mut nc, site.span);
        if self.drops_change(&mut nc) {
            if !site.comments.is_empty() || site.sequence.get().is_some() {
                self.builder.push(StmtKind::Comment, site.clone());
            }
            return;
        }
        let place = self.apart_of_limit(&mut nc, site);
        self.push_nc(nc, site);
        if let Some(place) = place {
            self.push_nc(place, &SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() });
        }
    }

    /// H beside G41 or G42, where nothing else names a length or a radius: a parameter says which of the two it is.
    fn radius_by_length_word(&mut self, nc: &mut Nc, span: Span) {
        let begins = nc.has(Op::RadiusLeft) || nc.has(Op::RadiusRight);
        let alone = nc.word(Role::LengthOffset).is_some() && nc.word(Role::RadiusOffset).is_none();
        if !begins || !alone || nc.ops().any(|op| op.group() == Group::LengthComp) {
            return;
        }
        let question = Question::RadiusByLengthWord;
        let answer = self.control.behaviour(question).map(|row| row.value.as_str());
        if matches!(answer, Some("true" | "unknown")) {
            for item in &mut nc.items {
                if let NcItem::Word(role @ Role::LengthOffset, _) = item {
                    *role = Role::RadiusOffset;
                }
            }
        }
        if answer == Some("unknown") {
            let what = "H beside G41 or G42 without D: whether it names the cutter radius or the tool length, the machine's \
                            profile does not say";
            let help = "give parameters.5001.2 in the profile: 1 if H names the radius, 0 if it is the length; or write D";
            let finding = Diagnostic::new(Code::NotUnderstood, span, what).with_help(help);
            self.findings.add(finding.lacking("parameter.5001.2"));
        }
    }

    /// More than one named code of the builder in a block: each gets a block of its own, before or after what moves.
    fn builders_codes(&mut self, mut nc: Nc, site: &SourceInfo) {
        if nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_act_word())) {
            let message = "two codes of the builder and a word: the block does not say whose it is";
            self.findings.add(
                Diagnostic::new(Code::NotUnderstood, site.span, message)
                    .with_help("give each code a block of its own"),
            );
        }
        let names = |item: &NcItem| matches!(item, NcItem::Op(Op::Act) | NcItem::Word(Role::Act, _));
        let (acts, rest): (Vec<_>, Vec<_>) = std::mem::take(&mut nc.items).into_iter().partition(names);
        let acts = acts.into_iter().filter(|item| matches!(item, NcItem::Word(..)));
        let mut blocks: Vec<Nc> = acts.map(|name| Nc { items: vec![NcItem::Op(Op::Act), name] }).collect();
        if !rest.is_empty() {
            let at = if self.control.acts(Auxiliary::Other).late { 0 } else { blocks.len() };
            blocks.insert(at, Nc { items: rest });
        }
        let mut site = site.clone();
        for nc in blocks {
            let rest = SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
            self.push_nc(nc, &std::mem::replace(&mut site, rest));
        }
    }

    /// A lookahead limit is a statement of its own, whatever stands beside it. A block that only stops the reading ahead is a wait.
    fn push_nc(&mut self, mut nc: Nc, site: &SourceInfo) {
        if nc.has(Op::LimitLookahead) {
            let limit = nc.word(Role::Lookahead).cloned().unwrap_or(Expr::Number(0.0));
            self.lookahead_limited = limit.constant() != Some(0.0);
            self.builder.push(StmtKind::LimitLookahead(limit), site.clone());
            nc.items.retain(|item| {
                !matches!(item, NcItem::Op(Op::LimitLookahead) | NcItem::Word(Role::Lookahead, _))
            });
            if nc.items.is_empty() {
                return;
            }
        }
        if nc.items == [NcItem::Op(Op::MachineOnce)] && self.control.statement("lookahead.stop").is_some() {
            return self.builder.push(StmtKind::Sync, site.clone());
        }
        self.builder.push(StmtKind::Nc(nc), site.clone());
    }

    fn operation(
        &mut self,
        id: CodeId,
        row: &'a CodeMeaning,
        word: &Word,
        span: Span,
        nc: &mut Nc,
        (seen, seconds): (&mut Seen, &mut Vec<Second<'a>>),
    ) {
        // What it ends is read nowhere here.
        if row.op == Op::DataInputEnd {
            return;
        }
        let group = row.op.group();
        seen.m_codes += u32::from(word.letter == 'M');
        if group != Group::OneShot && seen.group(group) && drop_clashing(nc, row.op) {
            seconds.push(Second { row, span });
        }
        if matches!(group, Group::Motion | Group::Cycle) {
            let depends = self.codes.get(id).is_some_and(|code| code.depends);
            let beside = if depends { self.control.place_of_code(row) } else { None };
            self.motion = Motion { code: Some(id), beside, joined: false, ..self.motion };
        }
        // Many codes share these operations: which one it is, only its number says.
        if matches!(
            row.op,
            Op::Builder | Op::MachineSpecific | Op::CycleOther | Op::ProbeOther | Op::PlaneOther
        ) {
            if let Some(code) = self.codes.get(id) {
                nc.items.push(NcItem::Code(code.head.letter, Expr::Number(code.head.number())));
            }
        } else {
            nc.items.push(NcItem::Op(row.op));
            nc.items.extend(row.with.iter().map(|op| NcItem::Op(*op)));
        }
        for (role, value) in &row.fixed {
            if seen.role(*role) && *role != Role::Act {
                nc.items.retain(|item| !matches!(item, NcItem::Word(other, _) if other == role));
            }
            nc.items.push(NcItem::Word(*role, Expr::Number(*value)));
        }
    }

    fn computed_code(&mut self, word: &'a Word, span: Span, nc: &mut Nc, seen: &mut Seen) {
        let Some(value) = &word.value else {
            return self.findings.not_understood(span, format!("{} has no number", word.letter));
        };
        if constant(value).is_some_and(|number| crate::dialect::CodeHead::new(word.letter, number).is_none())
        {
            return self
                .findings
                .not_understood(span, format!("this is not the number of a {} code", word.letter));
        }
        seen.m_codes += u32::from(word.letter == 'M');
        // It may be one of how the feed counts.
        self.motion.feed = None;
        let message = format!("the number of this {} code is computed", word.letter);
        self.findings.add(Diagnostic::new(Code::ComputedCode, span, message));
        let value = self.expr(value, At::Word(Role::Tool));
        nc.items.push(NcItem::Code(word.letter, value));
    }

    fn word(&mut self, word: &'a Word, span: Span, codes: &BlockCodes<'a>, nc: &mut Nc, seen: &mut Seen) {
        let said = self.findings.count();
        let Some((role, code)) = self.role(word, span, codes) else { return };
        if codes.is_empty() && code.is_none() && self.findings.count() == said {
            self.note_role(word, role);
        }
        let Some(value) = word.value.as_ref().filter(|_| !word.equals) else {
            return self.findings.not_understood(span, format!("{} has no value", word.letter));
        };
        let written = value;
        let Some((role, value)) = self.word_value(role, word.letter, value, code) else { return };
        let value = if role == Role::Turret { self.turret_word(written, value) } else { value };
        let Some(value) = self.as_diameter(role, value, span) else { return };
        if seen.role(role) && role != Role::Builder {
            nc.items.retain(|item| !matches!(item, NcItem::Word(other, _) if *other == role));
            let message = format!("{} is in this block twice: the later one is taken", word.letter);
            self.findings.add(Diagnostic::new(Code::WordTwice, span, message));
        }
        let other = match role {
            Role::DwellMs => Some(Role::DwellS),
            Role::DwellS => Some(Role::DwellMs),
            _ => None,
        };
        if nc.items.iter().any(|item| matches!(item, NcItem::Word(own, _) if Some(*own) == other)) {
            return self
                .findings
                .not_understood(span, "a dwell with two times: no source says which one counts");
        }
        if code.is_none()
            && let Some(op) = self.codes.letter(word.letter, word.comma).and_then(|row| row.op)
        {
            nc.items.push(NcItem::Op(op));
        }
        self.signed |= matches!(value, Expr::Negate(_));
        for question in questions(role, &value) {
            if self.findings.behaviour(*question, span).is_none() {
                self.unknown_behaviour(*question, span);
            }
        }
        nc.items.push(NcItem::Word(role, value));
    }

    fn check_m_codes(&mut self, seen: &Seen, span: Span) {
        if seen.m_codes < 2 {
            return;
        }
        match self.findings.behaviour(Question::MCodesPerBlock, span) {
            Some("any") => {}
            Some(most) if most.parse().is_ok_and(|most: u32| seen.m_codes <= most) => {}
            Some(most) => {
                let message = format!("the block has {} M codes, and the control takes {most}", seen.m_codes);
                self.findings.add(Diagnostic::new(Code::MCodes, span, message));
            }
            None => self.unknown_behaviour(Question::MCodesPerBlock, span),
        }
    }
}

/// Questions of behaviour that a word rests on.
fn questions(role: Role, value: &Expr) -> &'static [Question] {
    match (role, value.constant()) {
        (Role::ArcI | Role::ArcJ | Role::ArcK, _) => &[Question::ArcCentre],
        (Role::ArcRadius, Some(radius)) if radius < 0.0 => &[Question::ArcRadiusNegative],
        (Role::ArcRadius, Some(_)) => &[Question::ArcRadiusPositive],
        (Role::ArcRadius, None) => &[Question::ArcRadiusPositive, Question::ArcRadiusNegative],
        (Role::Repeat, Some(count)) if count >= 1.0 => &[],
        (Role::Repeat, _) => &[Question::CycleL0Stores],
        _ => &[],
    }
}

/// True for a word that is part of a code of the block: the L2 of `G10 L2`.
fn belongs_to_code(word: &Word, codes: &BlockCodes<'_>) -> bool {
    codes.iter().any(|(_, row)| {
        row.code.contains(' ')
            && row.beside().is_some_and(|beside| {
                let letter = beside_letter(word.letter, word.comma);
                beside.iter().any(|b| b.letter == letter && b.thousandths.is_some())
            })
    })
}

/// Drops the operations that exclude `op`; true where there was one. Ending a cycle
/// goes with any motion, and the two ways of cooling with one another.
fn drop_clashing(nc: &mut Nc, op: Op) -> bool {
    let before = nc.items.len();
    nc.items.retain(|item| {
        let NcItem::Op(other) = item else { return true };
        let cancel = *other != op && (*other == Op::CycleOff || op == Op::CycleOff);
        let cooling = matches!((*other, op), (Op::Mist, Op::Flood) | (Op::Flood, Op::Mist));
        other.group() != op.group() || cancel || cooling
    });
    before != nc.items.len()
}

/// A code of a group of which the block has another one before it.
pub(super) struct Second<'a> {
    pub row: &'a CodeMeaning,
    pub span: Span,
}

/// What a block has said already.
#[derive(Default)]
pub struct Seen {
    groups: u32,
    roles: [u128; 2],
    m_codes: u32,
}

impl Seen {
    /// Notes a group; true where it was there.
    fn group(&mut self, group: Group) -> bool {
        let bit = 1u32.checked_shl(group as u32).unwrap_or(0);
        let there = self.groups & bit != 0;
        self.groups |= bit;
        there
    }

    /// Notes a role; true where it was there.
    pub fn role(&mut self, role: Role) -> bool {
        let (at, bit) = (role as usize / 128, 1u128 << (role as u32 % 128));
        let Some(roles) = self.roles.get_mut(at) else { return false };
        let there = *roles & bit != 0;
        *roles |= bit;
        there
    }
}

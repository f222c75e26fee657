//! The words of a block: codes by the control's table, the rest by the codes beside them.

use super::Lowering;
use super::flow::{Flow, whole_label};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CodeMeaning, Question};
use crate::ir::{BinOp, Expr, Nc, NcItem};
use crate::lower::common::may_take;
use crate::syntax::{ExprKind, Item, Word};
use crate::text::Span;

/// How a profile says that M6 triggers the change to the tool of its block.
const CHANGE: &str = "if it triggers the change to the tool of its block, write M6 = { op = \"tool.change\" } under [codes] of the machine \
                      profile, and change_by = \"m6\" under [settings] if T alone changes no tool";

/// What a block's words come to.
#[derive(Default)]
pub(super) struct Planned {
    /// The tool change ahead of the rest.
    pub change: Option<Change>,
    /// The operations.
    pub block: Option<Nc>,
    /// Where they send the control.
    pub flow: Option<Flow>,
}

/// A tool change that hangs on the number of the tool.
pub(super) struct Change {
    /// The change itself.
    pub nc: Nc,
    /// The number of the tool.
    pub tool: Expr,
    /// What the number must not be.
    pub unless: Vec<Expr>,
}

/// A word with the row of its code, or its role.
enum Meaning<'c> {
    Code(&'c CodeMeaning, f64),
    Role(Role),
}

impl<'a> Lowering<'a> {
    /// Lowers the words of a block.
    pub(super) fn words(&mut self, words: &[(&Word, Span)], items: &[Item]) -> Planned {
        let Some(meanings) = self.meanings(words) else { return Planned::default() };
        let mut plan = Planned::default();
        let mut nc = Nc::default();
        let calls = meanings.iter().filter_map(Meaning::code).any(|row| row.op.is_flow());
        let coded = meanings.iter().filter_map(Meaning::code).any(|row| row.op == Op::ToolChange);
        for ((word, span), meaning) in words.iter().zip(&meanings) {
            match meaning {
                Meaning::Code(row, number) if row.op.is_flow() => {
                    let flow = self.flow_of(row, (word.letter, *number), words, &meanings, *span);
                    if plan.flow.is_some() {
                        self.findings.not_understood(
                            *span,
                            "this block jumps, calls or ends twice: only one can happen",
                        );
                    }
                    plan.flow = plan.flow.or(flow);
                }
                Meaning::Code(row, _) => {
                    for op in std::iter::once(row.op).chain(row.with.iter().copied()) {
                        self.add(&mut nc, NcItem::Op(op), *span);
                    }
                    for (role, value) in &row.fixed {
                        self.add(&mut nc, NcItem::Word(*role, Expr::Number(*value)), *span);
                    }
                }
                Meaning::Role(Role::Sequence | Role::CallAgain | Role::CallCount) if calls => {}
                Meaning::Role(Role::Tool) => self.tool(word, *span, coded, &mut plan, &mut nc),
                Meaning::Role(role) => {
                    if let Some(value) = self.word_value(*role, word, *span) {
                        self.add(&mut nc, NcItem::Word(*role, value), *span);
                    }
                }
            }
        }
        if let Some(at) = words.iter().map(|(_, span)| *span).reduce(Span::to) {
            self.complete(&mut nc, items, at);
            if coded {
                self.coded_change(at, &plan, &mut nc);
            }
            if nc.has(Op::Dwell) && nc.word(Role::DwellS).or(nc.word(Role::DwellMs)).is_none() {
                self.findings.not_understood(at, "no source says how long a dwell without a time waits");
            }
            let ends = matches!(plan.flow, None | Some(Flow::End { .. }));
            if !ends && nc.moves() {
                let message = "no source says whether the move comes before the jump or the call";
                self.findings.not_understood(at, message);
            }
        }
        if !nc.items.is_empty() {
            plan.block = Some(nc);
        }
        plan
    }

    /// Adds to a block what it does not have yet; which of two counts no source says.
    pub(super) fn add(&mut self, nc: &mut Nc, item: NcItem, span: Span) {
        let clash = match &item {
            NcItem::Op(op) => nc
                .ops()
                .any(|other| other == *op || op.group() != Group::OneShot && other.group() == op.group()),
            NcItem::Word(role, _) => nc.word(*role).is_some(),
            NcItem::Code(..) => false,
        };
        if clash {
            self.findings.not_understood(span, "no source says which of two such words in a block counts");
        } else {
            nc.items.push(item);
        }
    }

    /// What each word is; none if one of them is not known.
    fn meanings(&mut self, words: &[(&Word, Span)]) -> Option<Vec<Meaning<'a>>> {
        let numbers: Vec<Option<f64>> = words.iter().map(|(word, _)| self.whole(word)).collect();
        let letters: Vec<(char, Option<f64>)> =
            words.iter().zip(&numbers).map(|((word, _), number)| (word.letter, *number)).collect();
        let mut codes = Vec::new();
        for ((word, span), number) in words.iter().zip(&numbers) {
            codes.push(None);
            if word.comma || !matches!(word.letter, 'G' | 'M') {
                continue;
            }
            let Some(number) = *number else {
                let message =
                    format!("the number of this {} code is computed: write the number", word.letter);
                self.findings.not_understood(*span, message);
                return None;
            };
            let Some(row) = self.control.code(word.letter, number, &letters) else {
                let message = format!("no source names {}{number} for this control", word.letter);
                let finding =
                    Diagnostic::new(Code::NotUnderstood, *span, message).asking(word.letter, number);
                self.findings.add(finding.with_help(self.answered_by(word.letter, number)));
                return None;
            };
            self.findings.rest_on(row, *span);
            if matches!(row.op, Op::Builder | Op::MachineSpecific | Op::CycleOther) {
                let message = format!("what {}{number} does is not known", word.letter);
                let help = self.answered_by(word.letter, number);
                let finding =
                    Diagnostic::new(Code::NotUnderstood, *span, message).asking(word.letter, number);
                self.findings.add(finding.with_help(help));
                return None;
            }
            self.told_by_variable(word, &format!("code is taken to be {}{number}", word.letter), *span);
            if let Some(code) = codes.last_mut() {
                *code = Some(Meaning::Code(row, number));
            }
        }
        let rows: Vec<&CodeMeaning> = codes.iter().flatten().filter_map(Meaning::code).collect();
        let is_axis =
            |word: &Word| self.control.role(word.letter, word.comma, None).is_some_and(Role::is_axis);
        let moves = words.iter().any(|(word, _)| is_axis(word));
        let mut all = Vec::new();
        for ((word, span), code) in words.iter().zip(codes) {
            let meaning = code.or_else(|| self.role(word, &rows, *span).map(Meaning::Role));
            let named = rows.iter().any(|row| row.words.contains_key(&*word.letter.to_string()));
            if let Some(Meaning::Role(role)) = &meaning
                && !named
                && let Some(row) = may_take(rows.iter().copied(), *role, moves)
            {
                self.findings.beside_code(word.letter, *role, &row.code, *span);
            }
            if meaning.is_none() {
                let message = format!("no source says what {} means here", word.letter);
                self.findings.not_understood(*span, message);
            }
            all.push(meaning);
        }
        all.into_iter().collect()
    }

    /// Where a profile says what a code does that the builder made.
    fn answered_by(&self, letter: char, number: f64) -> String {
        if (letter, number) == ('M', 6.0) {
            return CHANGE.into();
        }
        format!(
            "if the machine's builder made it, say in the machine profile what it does: [[site]] with code = \
             \"{letter}{number}\", a text, and name, target or do"
        )
    }

    /// The role of a letter: from the code of the block that uses it, else its usual one.
    fn role(&mut self, word: &Word, rows: &[&CodeMeaning], span: Span) -> Option<Role> {
        let letter = word.letter.to_string();
        let mut beside = rows.iter().filter(|row| !word.comma && row.words.contains_key(&letter));
        if let Some(row) = beside.next() {
            let role = self.control.role(word.letter, word.comma, Some(row))?;
            return beside.all(|other| other.words.get(&letter) == Some(&role)).then_some(role);
        }
        let row = self.control.word(word.letter, word.comma)?;
        self.findings.rest_on(row, span);
        Some(row.role)
    }

    /// Says what a word by a variable is taken for, unless the variable is given that just before.
    fn told_by_variable(&mut self, word: &Word, what: &str, span: Span) {
        let Some(value) = &word.value else { return };
        let why = if self.constants.sure(value).is_none() {
            "the only value that the program gives its variable"
        } else if self.constants.is_given_above(value) {
            "the value that its variable gets above: if you change that value, convert again"
        } else {
            return;
        };
        self.findings.add(Diagnostic::new(Code::CodeByVariable, span, format!("the {what}, {why}")));
    }

    /// The constant that a word holds, its own or that of its variable.
    pub(super) fn whole(&self, word: &Word) -> Option<f64> {
        let value = word.value.as_ref()?;
        self.constants.sure(value).or_else(|| match &value.kind {
            ExprKind::Variable(variable) => self.constants.value(variable),
            _ => None,
        })
    }

    /// What a code of flow does.
    fn flow_of(
        &mut self,
        row: &CodeMeaning,
        (letter, number): (char, f64),
        words: &[(&Word, Span)],
        meanings: &[Meaning<'_>],
        span: Span,
    ) -> Option<Flow> {
        let word = |wanted: Role| {
            let mut found = words.iter().zip(meanings);
            found.find_map(|((word, span), meaning)| match meaning {
                Meaning::Role(role) if *role == wanted => Some((*word, *span)),
                _ => None,
            })
        };
        let label = word(Role::Sequence);
        let flow = match row.op {
            Op::CallLocal => {
                let (label, span) = self.label_of(label, span)?;
                let count = match (word(Role::CallAgain), word(Role::CallCount)) {
                    (Some((again, span)), _) => Some(self.count(again, 1.0, span)?),
                    (None, Some((count, span))) => Some(self.count(count, 0.0, span)?),
                    (None, None) => None,
                };
                Flow::CallBlock { label, count, span }
            }
            Op::Jump => {
                let (label, span) = self.label_of(label, span)?;
                Flow::Jump(label, span)
            }
            Op::CallCycle => {
                let fixed = row.fixed.get(&Role::Program).copied();
                let cycle = fixed.unwrap_or(number - 800.0);
                if !(0.0..=99.0).contains(&cycle) {
                    self.findings.not_understood(span, "no cycle has this number");
                    return None;
                }
                Flow::CallCycle(cycle as u32)
            }
            Op::Return if letter == 'M' => Flow::End { rewind: false },
            Op::Return => Flow::Return,
            Op::End => Flow::End { rewind: false },
            Op::EndRewind => Flow::End { rewind: true },
            _ => {
                self.findings.not_understood(span, "no source says how this control calls or jumps by it");
                return None;
            }
        };
        Some(flow)
    }

    /// The label that the P word names.
    fn label_of(&mut self, word: Option<(&Word, Span)>, span: Span) -> Option<(u32, Span)> {
        let label = word.and_then(|(word, _)| self.whole(word)).and_then(whole_label);
        let Some(label) = label else {
            self.findings.not_understood(span, "the label that this goes to is computed: write its number");
            return None;
        };
        let at = word.map_or(span, |(_, span)| span);
        if let Some((word, _)) = word {
            self.told_by_variable(word, &format!("label is taken to be ${label}"), at);
        }
        Some((label, at))
    }

    /// How often a call runs in all, where `first` runs come on top of the number written.
    fn count(&mut self, word: &Word, first: f64, span: Span) -> Option<Expr> {
        if let Some(row) = self.control.behaviour(Question::RepeatCounts) {
            self.findings.rest_on(row, span);
        }
        Some(match self.operand(word.value.as_ref()?)? {
            Expr::Number(again) => Expr::Number(again + first),
            again if first == 0.0 => again,
            again => Expr::binary(BinOp::Add, again, Expr::Number(first)),
        })
    }
}

impl<'c> Meaning<'c> {
    fn code(&self) -> Option<&'c CodeMeaning> {
        match self {
            Meaning::Code(row, _) => Some(row),
            Meaning::Role(_) => None,
        }
    }
}

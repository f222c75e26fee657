//! What is found while one program is lowered.

use crate::canon::Group;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, DecimalPoint, Question, Row, Side, matters};
use crate::syntax::{ExprKind, Item, ItemKind};
use crate::text::Span;
use foldhash::{HashMap, HashMapExt};
use std::sync::Arc;

/// The findings of one program after another. A fact that no maker's text confirms is reported
/// where a program first rests on it, and only there.
#[derive(Debug)]
pub struct Findings<'c> {
    control: &'c Control,
    list: Vec<Diagnostic>,
    facts: HashMap<String, Told>,
    /// By the place of a row of the control, which stays where it is: the last program that rests on it.
    rows: HashMap<usize, u32>,
    /// Counts the programs.
    program: u32,
}

/// What was last said of an unconfirmed fact.
#[derive(Debug)]
struct Told {
    finding: Diagnostic,
    note: Option<String>,
    /// The program that it was said in.
    last: u32,
}

/// What is said of a construct that is not converted for a control which answers a question so.
pub fn otherwise(question: Question, answer: &str) -> String {
    format!("'{question}' is '{answer}' on this control ({}): that is not converted", question.meaning())
}

impl<'c> Findings<'c> {
    /// No findings yet.
    pub fn new(control: &'c Control) -> Self {
        Self { control, list: Vec::new(), facts: HashMap::new(), rows: HashMap::new(), program: 1 }
    }

    /// The control whose facts are relied on.
    pub fn control(&self) -> &'c Control {
        self.control
    }

    /// Adds a finding.
    pub fn add(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.list.len()
    }

    /// The construct at `span` has no known meaning: the program is refused.
    pub fn not_understood(&mut self, span: Span, message: impl Into<Arc<str>>) {
        self.add(Diagnostic::new(Code::NotUnderstood, span, message));
    }

    /// A word of a builder's code is carried as it is: a length without a point may count increments.
    pub fn bare_act_word(&mut self, letter: char, number: f64, point: bool, span: Span) {
        let by_units = self.control.profile().decimal_point == Some(DecimalPoint::Calculator);
        if !point && number != 0.0 && crate::dialect::measures(letter) && !by_units {
            let message = format!("{letter}{number} beside a code of the builder has no decimal point");
            let finding = Diagnostic::new(Code::NotUnderstood, span, message);
            self.add(finding.with_help(
                "write the point: without one it may count increments. Or say decimal_point = \"calculator\" in the machine's \
                 profile, where a number without one counts whole units",
            ));
        }
    }

    /// The construct at `span` rests on a row of the table.
    pub fn rest_on<R: Row>(&mut self, row: &'c R, span: Span) {
        let place = std::ptr::from_ref(row) as usize;
        if !row.origin().is_confirmed() && self.rows.insert(place, self.program) != Some(self.program) {
            self.unconfirmed(row.fact(), row.origin().note.as_deref(), span);
        }
    }

    /// The answer to a question of behaviour on which the construct at `span` rests.
    /// An unknown or missing answer is none, and is left for the caller to report.
    pub fn behaviour(&mut self, question: Question, span: Span) -> Option<&'c str> {
        let row = self.control.behaviour(question).filter(|row| row.value != "unknown")?;
        self.rest_on(row, span);
        Some(&row.value)
    }

    /// True where the answer to a question of behaviour, on which the construct at `span` rests, is `true`.
    pub fn is(&mut self, question: Question, span: Span) -> bool {
        self.behaviour(question, span) == Some("true")
    }

    /// As [`Findings::behaviour`], where the common form knows one answer alone: another is not understood.
    pub fn only(&mut self, question: Question, answer: &str, span: Span) -> Option<()> {
        let known = self.behaviour(question, span)?;
        if known != answer {
            self.not_understood(span, otherwise(question, known));
        }
        Some(())
    }

    /// The construct at `span` rests on a fact that nothing confirms, named as
    /// a machine profile confirms it: `behaviour:load.sets.condition`.
    pub fn unconfirmed(&mut self, fact: String, note: Option<&str>, span: Span) {
        if let Some(told) = self.facts.get_mut(&fact) {
            if std::mem::replace(&mut told.last, self.program) == self.program {
                return;
            }
            if told.note.as_deref() == note {
                return self.list.push(Diagnostic { span, ..told.finding.clone() });
            }
        }
        if self.control.has_tried(&fact) {
            return;
        }
        let finding = self.control.unconfirmed(Side::Source, &fact, note, span);
        self.list.push(finding.clone());
        self.facts.insert(fact, Told { finding, note: note.map(str::to_owned), last: self.program });
    }

    /// Reports a code for absolute or incremental words that stands after words of its block.
    pub fn distance_order(&mut self, items: &[Item]) {
        let mut axes = false;
        for item in items {
            let ItemKind::Word(word) = &item.kind else { continue };
            let number = word.value.as_ref().and_then(|value| match &value.kind {
                ExprKind::Number(number) => Some(number.value),
                _ => None,
            });
            let code = number.and_then(|number| self.control.code(word.letter, number, &[]));
            if word.letter == 'G' && axes && code.is_some_and(|row| row.op.group() == Group::Distance) {
                let name = "machine:distance.code.behind.words";
                self.unconfirmed(name.into(), matters::meaning(name), item.span);
            }
            axes |= matches!(word.letter, 'X' | 'Y' | 'Z');
        }
    }

    /// The findings, in the order of their places. Those of another program follow.
    pub fn take_list(&mut self) -> Vec<Diagnostic> {
        self.program += 1;
        let mut list = std::mem::take(&mut self.list);
        list.sort_by_key(|finding| finding.span);
        list
    }
}

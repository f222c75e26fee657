//! A program while it is lowered: what is built, what was found, what holds before the present block.

use super::planes::Planes;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Builder, Class, Comment, Place, SourceInfo, StmtKind, TermKind, Var};
use crate::lower::common::{Findings, Nowhere, otherwise};
use crate::lower::fadal::flow::{Goal, Shape, State};
use crate::syntax;
use crate::text::Span;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The lowering of one program.
pub struct Lowering<'b> {
    /// The file's bytes.
    pub source: &'b [u8],
    /// The control.
    pub control: &'b Control,
    /// The parts of the program.
    pub shape: &'b Shape,
    /// The program that is built.
    pub builder: Builder,
    /// What was found.
    pub findings: Findings<'b>,
    /// The modal state before the present block.
    pub state: State,
    /// The present block's place.
    pub at: usize,
    /// The site of the present block; its comments go with the first statement.
    pub site: SourceInfo,
    /// True once a statement of the present block was added.
    pub placed: bool,
    /// Comments that stand where no statement can: they go with the next one.
    pub carried: Vec<Comment>,
    entries: HashMap<usize, BlockId>,
    told: HashSet<String>,
    /// Where jumps go to labels that no block has.
    pub nowhere: Nowhere,
    temps: u32,
    /// Where a straight move was spelled out under an arc mode, and where the mode is read.
    pub spelled_out: bool,
    /// Where the program reads the motion mode.
    pub reads_motion: Option<Span>,
    /// What is known of the retract planes of its cycles.
    pub planes: Planes,
}

impl<'b> Lowering<'b> {
    /// Nothing of a program yet.
    pub fn new(source: &'b [u8], control: &'b Control, shape: &'b Shape) -> Self {
        Self {
            source,
            control,
            shape,
            builder: Builder::new(),
            findings: Findings::new(control),
            state: State::entry(),
            at: 0,
            site: SourceInfo::default(),
            placed: false,
            carried: Vec::new(),
            entries: HashMap::new(),
            told: HashSet::new(),
            nowhere: Nowhere::default(),
            temps: 0,
            spelled_out: false,
            reads_motion: None,
            planes: Planes::default(),
        }
    }

    /// The id of the IR block that begins at a source block.
    pub fn entry(&mut self, at: usize) -> BlockId {
        *self.entries.entry(at).or_insert_with(|| self.builder.fresh())
    }

    /// True where a drilling cycle may be active before the block.
    pub fn in_cycle(&self) -> bool {
        self.state.cycle.list().iter().any(|code| *code != 0)
    }

    /// The block of a jump goal; one with an alarm if no block has it.
    pub fn block_of(&mut self, goal: &Goal, span: Span) -> BlockId {
        let Some((at, times)) = self.shape.goals.get(goal).copied() else {
            let name = match goal {
                Goal::Sequence(number) => format!("N{number}"),
                Goal::Label(syntax::Label::Name(name)) => format!(":{name}"),
                Goal::Label(syntax::Label::Number(number)) => format!(":{number}"),
            };
            return self.nowhere.block(name, span, &mut self.builder, &mut self.findings);
        };
        if times > 1 {
            match goal {
                Goal::Sequence(_) if self.control.is(Question::GotoForwardFirst) => {
                    self.findings.not_understood(span, otherwise(Question::GotoForwardFirst, "true"));
                }
                Goal::Sequence(number) => {
                    let message =
                        format!("N{number} is in the program {times} times: the first one is taken");
                    self.once(Code::TargetTwice, &message, span, message.clone());
                }
                Goal::Label(_) => {
                    self.suppose(Question::GotoFirstLabel, "true", span);
                }
            }
        }
        if self.shape.region(at) != self.shape.region(self.at) {
            let message = "the jump goes out of a subroutine or into one";
            self.once(Code::SubroutineLeft, &at.to_string(), span, message.into());
        }
        self.entry(at)
    }

    /// The next free temporary.
    pub fn temp(&mut self) -> Var {
        self.temps += 1;
        Var { class: Class::Temp, number: self.temps }
    }

    /// The site for the next statement of the block: its comments go with the first.
    pub fn take_site(&mut self) -> SourceInfo {
        self.placed = true;
        let mut site = self.site.clone();
        self.site.comments.clear();
        if self.builder.is_open() && !self.carried.is_empty() {
            site.comments.splice(0..0, self.carried.drain(..));
        }
        site
    }

    /// Adds a statement of the present block.
    pub fn push(&mut self, kind: StmtKind) {
        let site = self.take_site();
        self.builder.push(kind, site);
    }

    /// Adds an assignment of the present block.
    pub fn assign(&mut self, target: Place, value: crate::ir::Expr) {
        self.push(StmtKind::Assign { target, value });
    }

    /// Ends the IR block with a terminator of the present source block.
    pub fn end(&mut self, kind: TermKind) {
        let mut site = self.take_site();
        site.skip = None;
        self.builder.end(kind, site);
    }

    /// Stands where the source has something that is not understood; its finding says what.
    pub fn hole(&mut self) {
        let text = "NOT CONVERTED".to_owned();
        self.push(StmtKind::Alarm { number: crate::ir::Expr::Number(1.0).into(), text: text.into() });
    }

    /// Reports something once for each `key`.
    pub fn once(&mut self, code: Code, key: &str, span: Span, message: String) {
        if self.told.insert(format!("{code:?} {key}")) {
            self.findings.add(Diagnostic::new(code, span, message));
        }
    }

    /// Reports, once for each program, what is the same for all of them.
    pub fn once_for_all(&mut self, code: Code, span: Span, message: &'static str) {
        if self.told.insert(message.to_owned()) {
            self.findings.add(Diagnostic::new(code, span, message).asked_once());
        }
    }

    /// Reports, once for each variable, that it is read while moves may be to come.
    pub fn early(&mut self, name: &str, span: Span, message: String) {
        if self.told.insert(format!("early {name}")) {
            let finding = Diagnostic::new(Code::EarlyRead, span, message);
            self.findings.add(finding.with_fact(Question::LookaheadRunsEarly.fact()));
        }
    }

    /// The answer to a question of behaviour on which the construct at `span` rests;
    /// an unknown answer is none and is reported as an unconfirmed fact.
    pub fn rely(&mut self, question: Question, span: Span) -> Option<&'b str> {
        let known = self.findings.behaviour(question, span);
        if known.is_none() {
            let note = self.control.behaviour(question).and_then(|row| row.origin.note.as_deref());
            self.findings.unconfirmed(question.fact().into(), note.or(Some("no source says")), span);
        }
        known
    }

    /// The construct at `span` is converted as for a control that answers so: where it answers otherwise, the
    /// construct is not understood; if nobody knows, that is an unconfirmed fact.
    pub fn suppose(&mut self, question: Question, answer: &str, span: Span) {
        if let Some(other) = self.rely(question, span).filter(|known| *known != answer) {
            self.findings.not_understood(span, otherwise(question, other));
        }
    }

    /// The block is not understood: the finding is added, and nothing else.
    pub fn refuse<T>(&mut self, span: Span, message: impl Into<Arc<str>>) -> Option<T> {
        self.findings.not_understood(span, message);
        None
    }
}

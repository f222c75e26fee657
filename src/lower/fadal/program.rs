//! One program: its blocks in source order, its subroutines, its jumps.

use super::exit_modes::Others;
use super::flow::Flow;
use super::shape::Shape;
use super::state::State;
use super::steps::steps;
use super::words::Codes;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Builder, Class, Cond, Place, Program, Remark, SourceInfo, StmtKind, TermKind, Var};
use crate::lower::common::{Findings, ProgramText, otherwise, site_of};
use crate::syntax::{Block, ItemKind, Label};
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
    site: SourceInfo,
    placed: bool,
    /// Comments that stand where no statement can: they go with the next one.
    carried: Vec<Remark>,
    entries: HashMap<usize, BlockId>,
    told: HashSet<String>,
    temps: u32,
    /// Where a straight move was spelled out under an arc mode, and where the mode is read.
    pub spelled_out: bool,
    /// Where the program reads the motion mode.
    pub reads_motion: Option<Span>,
    /// True once a word R, and not R0, gave a drilling cycle its retract plane.
    pub plane_by_word: bool,
}

/// Lowers a program's text; `others` is what is known of the programs of its file, and which of them this is.
pub fn lower(
    text: &ProgramText<'_>,
    others: (&Others, usize),
    source: &[u8],
    file: usize,
    control: &Control,
) -> (Program, Vec<Diagnostic>) {
    let shape = Shape::new(text.blocks, control);
    let mut flow = Flow::new(text.blocks, control, &shape, others);
    let mut lowering = Lowering {
        source,
        control,
        shape: &shape,
        builder: Builder::new(),
        findings: Findings::new(control),
        state: State::entry(),
        at: 0,
        site: SourceInfo::default(),
        placed: false,
        carried: Vec::new(),
        entries: HashMap::new(),
        told: HashSet::new(),
        temps: 0,
        spelled_out: false,
        reads_motion: None,
        plane_by_word: false,
    };
    let mut head = SourceInfo::default();
    for (at, block) in text.blocks.iter().enumerate() {
        if let Some(state) = flow.at(at) {
            lowering.state = state;
        }
        lowering.block(at, block, &mut head);
        let state = std::mem::take(&mut lowering.state);
        lowering.state = flow.behind(block, state);
    }
    lowering.finish();
    let program = lowering.builder.finish(text.name.cloned(), file, head);
    (program, lowering.findings.take_list())
}

impl<'b> Lowering<'b> {
    fn block(&mut self, at: usize, block: &'b Block, head: &mut SourceInfo) {
        self.at = at;
        self.site = site_of(block, self.source);
        self.placed = false;
        for error in &block.errors {
            self.findings.add(Diagnostic::new(error.code, error.span, &*error.message));
        }
        self.enter(at);
        if let Some(item) = block.items.iter().find(|item| matches!(item.kind, ItemKind::Program(_))) {
            // The comments beside the name are the program's.
            *head = SourceInfo { span: block.span, ..std::mem::take(&mut self.site) };
            self.site = SourceInfo { span: block.span, ..SourceInfo::default() };
            self.placed = block
                .items
                .iter()
                .all(|other| std::ptr::eq(item, other) || !crate::lower::common::says_something(other));
        }
        let frame = block.items.iter().all(|item| matches!(item.kind, ItemKind::Tape | ItemKind::EndOfBlock));
        let codes = Codes::new(&block.items, self.control);
        let unparsed = block.items.iter().any(|item| item.kind == ItemKind::Unparsed);
        let skip = self.site.skip;
        if skip == Some(1) {
            let _ = self.rely(Question::SkipLevels, block.span);
        } else if skip.is_some() {
            self.suppose(Question::SkipLevels, "true", block.span);
        }
        let level_fits = skip.is_none_or(|level| (1..=9).contains(&level));
        if !level_fits {
            self.findings.not_understood(block.span, "block skip has the levels 1 to 9");
            self.site.skip = None;
        }
        let skip = skip.filter(|_| level_fits);
        // What changes the flow is jumped over; the rest carries its switch.
        let over = skip.filter(|_| self.flows(block, &codes)).map(|level| {
            let (body, next) = (self.builder.fresh(), self.builder.fresh());
            self.end(TermKind::Branch { cond: Cond::Switch(level), then: next, otherwise: body });
            self.builder.start(body);
            self.site.skip = None;
            next
        });
        if unparsed || !level_fits {
            self.hole();
        } else {
            self.items(&block.items, &codes);
        }
        if !self.placed && !frame {
            self.empty(block);
        }
        if let Some(next) = over {
            self.builder.start(next);
        }
    }

    /// A block that became no statement: its comments are kept.
    fn empty(&mut self, block: &Block) {
        let mut site = self.take_site();
        let silent =
            block.items.iter().any(|item| matches!(item.kind, ItemKind::Label(_) | ItemKind::Set(_)))
                || self.shape.area_end == Some(self.at)
                || self.shape.begins(self.at).is_some();
        if !self.builder.is_open() {
            // A statement here would be a block of its own that nothing reaches.
            self.carried.extend(site.remarks.drain(..));
        } else if !silent || !site.remarks.is_empty() {
            self.builder.push(StmtKind::Remark, site);
        }
    }

    fn flows(&self, block: &Block, codes: &Codes<'_, '_>) -> bool {
        let mut jumps = false;
        crate::syntax::for_each_item(&block.items, &mut |item| {
            jumps |= matches!(item.kind, ItemKind::Goto(_) | ItemKind::Start(_) | ItemKind::If { .. });
        });
        jumps || !steps(&block.items, codes).is_empty()
    }

    /// Begins what begins at a block: a subroutine, the main part, a jump target.
    fn enter(&mut self, at: usize) {
        let shape = self.shape;
        if let Some(sub) = shape.ends(at)
            && self.builder.is_open()
        {
            if sub.followed {
                self.suppose(Question::SubEndsAtNext, "true", self.site.span);
            } else {
                let message = format!(
                    "the subroutine L{}00 runs into the end of its area: end it with M17",
                    sub.number
                );
                self.once(Code::SubroutineLeft, "area", self.site.span, message);
            }
            self.builder.end(TermKind::Return { to: None }, SourceInfo::default());
        }
        if shape.subs.first().is_some_and(|sub| sub.blocks.start == at) && self.builder.is_open() {
            if !self.builder.is_at_start() {
                self.suppose(Question::SubAreaEntered, "true", self.site.span);
            }
            let main = self.entry(shape.main);
            self.builder.end(TermKind::Jump(main), SourceInfo::default());
        }
        let labels = shape.labels.get(&at);
        let main = at == shape.main && !shape.subs.is_empty();
        if main || labels.is_some() || shape.begins(at).is_some() {
            let id = self.entry(at);
            self.builder.start(id);
            if let Some(sub) = shape.begins(at).and_then(|place| shape.subs.get(place)) {
                self.builder.label(Label::Name(format!("L{}00", sub.number)));
            }
            labels.into_iter().flatten().for_each(|label| self.builder.label(label.clone()));
        }
    }

    /// The id of the IR block that begins at a source block.
    pub fn entry(&mut self, at: usize) -> BlockId {
        *self.entries.entry(at).or_insert_with(|| self.builder.fresh())
    }

    fn finish(&mut self) {
        if !self.carried.is_empty() {
            let remarks = self.carried.drain(..).collect();
            self.builder.push(StmtKind::Remark, SourceInfo { remarks, ..SourceInfo::default() });
        }
        let shape = self.shape;
        let Some(last) = shape.subs.last() else { return self.note_modes() };
        if shape.area_end.is_none() {
            let message = format!("no M30 closes the subroutines up to L{:02}00", last.number);
            self.findings.add(Diagnostic::new(Code::SubroutineArea, self.site.span, message));
        }
        self.note_modes();
    }

    fn note_modes(&mut self) {
        if let (true, Some(span)) = (self.spelled_out, self.reads_motion) {
            let message = "this reads the motion mode, and the conversion writes G1 for a straight move \
                           in an arc mode: write G1 there yourself";
            self.findings.not_understood(span, message);
        }
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
        self.site.remarks.clear();
        if self.builder.is_open() && !self.carried.is_empty() {
            site.remarks.splice(0..0, self.carried.drain(..));
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
        self.push(StmtKind::Alarm { number: crate::ir::Expr::Number(1.0), text });
    }

    /// Reports something once for each `key`.
    pub fn once(&mut self, code: Code, key: &str, span: Span, message: String) {
        if self.told.insert(format!("{code:?} {key}")) {
            self.findings.add(Diagnostic::new(code, span, message));
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

//! A program from its name to its end.

use super::Emitter;
use crate::CHECKED;
use crate::diag::Code;
use crate::dialect::Question;
use crate::emit::common::flow::{Abilities, Form, Plan};
use crate::emit::common::labels::{self, Labels, Standing};
use crate::emit::common::lines::Kind;
use crate::emit::common::reach::Reach;
use crate::ir::analysis::{Arrivals, callees};
use crate::ir::{Block, BlockId, Cond, SourceInfo, TermKind};
use crate::syntax::Label;
use std::sync::LazyLock;

/// The site of a line that stands for nothing of the source.
static ELSEWHERE: LazyLock<SourceInfo> = LazyLock::new(SourceInfo::default);

/// Bytes that most lines do not reach.
const USUAL_LINE: usize = 24;

impl<'p> Emitter<'p> {
    /// Writes the program.
    pub(super) fn program(&mut self) {
        let program = self.program;
        self.out.span = program.site.span;
        if !self.is_closed() {
            return self.out.unmapped("a jump to a block that does not exist");
        }
        let names = self.names;
        let kept = |number| names.is_returned_to(number);
        let arrivals = Arrivals::of_program(program, kept);
        let most = self.control.text().sequence_max;
        let lay_out = |guarded: bool| {
            let abilities = Abilities { guarded, ..self.abilities() };
            let plan = Plan::new(program, &arrivals, abilities, |block| self.is_joined(block));
            let reach = Reach::of(program, names, most);
            let (labels, faults) = Labels::new(program, &plan.labelled, kept, reach, most);
            (plan, labels, faults)
        };
        let mut made = lay_out(false);
        // A jump that is stopped before it looks takes two lines, for which there may be other labels.
        if names.guard().or(made.1.guard()).is_some() {
            made = lay_out(true);
        }
        let (plan, labels, faults) = made;
        self.out.emitted.invents = labels.invents();
        self.out.labels = labels;
        let count = program.blocks.iter().map(|block| block.stmts.len() + 1).sum();
        self.out.text.reserve(count * USUAL_LINE);
        self.out.emitted.blocks.reserve(count);
        for fault in faults {
            self.out.refuse(Code::NoSequenceNumber, fault);
        }
        self.header();
        self.taken_registers();
        for (at, (block, form)) in program.blocks.iter().zip(&plan.forms).enumerate() {
            self.out.line.under = plan.under.get(at).copied().flatten();
            self.block(at, block, *form);
        }
        self.out.line.under = None;
        self.out.flush_label();
        if let Some(end) = self.out.labels.number(program.blocks.len()) {
            self.out.label_line(end, None);
        }
    }

    fn is_closed(&self) -> bool {
        let count = self.program.blocks.len();
        self.program.blocks.iter().all(|block| {
            let mut all = block.term.kind.successors().into_iter().chain(callees(block));
            all.all(|to| to.index() < count)
        })
    }

    fn abilities(&self) -> Abilities<'p> {
        let control = self.control;
        let depth = ["do.depth", "do.numbers"].into_iter().filter_map(|name| control.limit(name)).min();
        Abilities {
            control,
            guarded: false,
            skips: true,
            then: control.statement("if.then").is_some(),
            then_messages: control.statement("if.then").is_some(),
            then_words: control.statement("if.then.words").is_some() || control.is(Question::ThenWords),
            loops: control.statement("while").and(depth).unwrap_or(0),
        }
    }

    /// Writes the block that names the program.
    fn header(&mut self) {
        let site = &self.program.site;
        let Some(name) = &self.program.name else {
            site.comments.iter().for_each(|comment| self.out.comment_lines(&comment.text));
            return;
        };
        let most = self.control.text().program_max;
        let Some(number) = self.names.program(name).filter(|number| (1..=most).contains(number)) else {
            return self.out.unmapped(format_args!("the name of the program, {name}"));
        };
        self.out.program_line(site, number);
    }

    fn block(&mut self, at: usize, block: &'p Block, form: Form) {
        self.label(at, block, form);
        self.out.line.block = at;
        let joined = self.is_joined(block);
        let (alone, last) = match block.stmts.split_last() {
            Some((last, rest)) if joined => (rest, Some(last)),
            _ => (block.stmts.as_slice(), None),
        };
        for stmt in alone {
            self.statement(stmt);
        }
        if let Some(stmt) = last {
            self.begin(&stmt.site, Kind::Words, None);
            self.out.carry(&block.term.site);
            self.words_of(stmt);
        }
        self.end(block, form, joined);
    }

    /// Sets the label of the block's first line and writes those that have no room on it.
    /// The label of an empty block before stays for this line too, but not before a loop: a jump from
    /// inside the loop to its WHILE would enter it once more.
    fn label(&mut self, at: usize, block: &'p Block, form: Form) {
        let chosen = self.out.labels.number(at);
        let mut own = chosen;
        let mut others = Vec::new();
        for number in labels::numbers(block).filter(|number| Some(*number) != chosen) {
            let stands = || block.stmts.iter().map(|s| &s.site).chain([&block.term.site]);
            let written = match self.out.labels.standing(number, at) {
                Standing::Label => true,
                Standing::Free => stands().all(|site| site.sequence.get() != Some(number)),
                Standing::Barred => false,
            };
            match own {
                _ if !written => {}
                Some(_) => others.push(number),
                None => own = Some(number),
            }
        }
        let jumped_to = self.out.line.label.is_some_and(|label| self.out.labels.is_claimed(label));
        let loops = matches!(form, Form::While { .. }) && jumped_to;
        if own.is_some_and(|own| Some(own) != self.out.line.label) || loops {
            self.out.flush_label();
        }
        for number in others {
            self.out.flush_label();
            self.out.label_line(number, None);
        }
        if own.is_some() {
            self.out.line.label = own;
            self.out.line.name = block.labels.iter().find_map(|label| match label {
                Label::Name(name) if chosen.is_some() => Some(name.as_str()),
                _ => None,
            });
        }
    }

    fn end(&mut self, block: &'p Block, form: Form, joined: bool) {
        let site = &block.term.site;
        let condition = match &block.term.kind {
            TermKind::Branch { cond, .. } => Some(&**cond),
            _ => None,
        };
        match form {
            Form::Fall => self.bare(site),
            Form::Goto(to) => self.goto(site, to),
            Form::If { negated, to, otherwise } => {
                self.begin(site, Kind::Macro, None);
                self.test("IF", "if.goto", condition, negated);
                self.jump(to);
                self.out.finish();
                otherwise.into_iter().for_each(|to| self.goto(site, to));
            }
            Form::Then => {
                self.out.carry(site);
                self.out.line.condition = condition;
            }
            Form::Skip(level) => {
                self.out.carry(site);
                self.out.line.skip = Some(level);
            }
            Form::SkipGoto { level, to, otherwise } => {
                self.out.line.skip = Some(level);
                self.goto(site, to);
                otherwise.into_iter().for_each(|to| self.goto(&ELSEWHERE, to));
            }
            Form::While { negated, number } => {
                self.begin(site, Kind::Macro, None);
                self.test("WHILE", "while", condition, negated);
                self.numbered("DO", number);
                self.out.finish();
            }
            Form::EndDo(number) => {
                self.begin(site, Kind::Macro, None);
                self.numbered("END", number);
                self.out.finish();
            }
            Form::Own(then) => {
                self.leave(block, joined);
                then.into_iter().for_each(|to| self.goto(site, to));
            }
        }
    }

    /// Writes what stood beside an end that is not written itself.
    fn bare(&mut self, site: &'p SourceInfo) {
        self.out.carry(site);
        if self.out.has_carried() {
            self.begin(site, Kind::Words, None);
            self.out.finish();
        }
    }

    fn test(&mut self, word: &str, statement: &str, condition: Option<&Cond>, negated: bool) {
        if self.out.has_statement(statement)
            && let Some(condition) = condition
        {
            self.out.word(word);
            self.out.push(' ');
            self.bracketed_condition(condition, negated);
        }
    }

    fn numbered(&mut self, word: &str, number: u32) {
        self.out.word(word);
        self.out.integer(number);
    }

    /// Writes a jump on a line of its own.
    fn goto(&mut self, site: &'p SourceInfo, to: BlockId) {
        self.begin(site, Kind::Macro, None);
        self.jump(to);
        self.out.finish();
    }

    fn jump(&mut self, to: BlockId) {
        if self.out.has_statement("goto") {
            self.out.word("GOTO ");
            self.sequence_of(to);
        }
    }

    /// Writes the number that a block is found by.
    pub(super) fn sequence_of(&mut self, block: BlockId) {
        match self.out.labels.number(block.index()) {
            Some(number) => self.out.integer(number),
            // Told when the numbers were given out.
            None => assert!(!CHECKED || !self.out.faults.is_empty(), "a jump target without a number"),
        }
    }
}

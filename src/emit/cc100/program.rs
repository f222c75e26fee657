//! A program from its name to its end.

use super::Emitter;
use super::labels::Labels;
use super::lines::{SKIP, plain};
use super::statements::loaded_together;
use crate::canon::{Op, Sys};
use crate::diag::Code;
use crate::dialect::Compares;
use crate::dialect::OperandPlace;
use crate::emit::common::flow::{Abilities, Form, Plan};
use crate::emit::common::taken::Taken;
use crate::ir::analysis::{Arrivals, callees};
use crate::ir::analysis::{Cfg, reachable};
use crate::ir::{Block, BlockId, Cond, Expr, Relation, SourceInfo, StmtKind, TermKind};
use crate::syntax::cc100::PART;
use crate::text::Span;

/// Registers for values in between that a comment names, so that it fits into a line.
const SCRATCH_IN_A_LINE: usize = 6;

/// V30 to V80 are for programs (seed 004:52).
const CROWDED: &str = "the library has more variables than V30 to V80: this program uses others too, which belong to cycles of \
                       the maker and the builder. Make sure that no cycle of your control uses the ones at its head";

/// Calls reach no other file.
const PASTED: &str = "the program returns to one that calls it, and calls on the target reach no other file: put its blocks \
                      after the M30 of the caller, under labels that are free there";

impl<'p> Emitter<'p> {
    /// Writes the program.
    pub(super) fn program(&mut self) {
        let program = self.program;
        self.out.span = program.site.span;
        let count = program.blocks.len();
        let closed = program.blocks.iter().all(|block| {
            block.term.kind.successors().into_iter().chain(callees(block)).all(|to| to.index() < count)
        });
        if !closed {
            return self.out.unmapped("a jump to a block that does not exist");
        }
        let arrivals = Arrivals::of_program(program, |_| false);
        let abilities = Abilities {
            control: self.control,
            guarded: false,
            skips: false,
            then: false,
            then_messages: false,
            then_words: false,
            loops: 0,
        };
        let mut plan = Plan::new(program, &arrivals, abilities, |_| false);
        // What returns is a part of another program, which calls it by its label.
        let is_part = reachable(program, BlockId(0)).into_iter().filter_map(|id| program.block(id));
        let is_part = is_part.into_iter().any(|block| matches!(block.term.kind, TermKind::Return { .. }));
        plan.labelled.iter_mut().take(usize::from(is_part)).for_each(|needed| *needed = true);
        self.labels = Labels::new(program, &plan.labelled);
        self.header();
        self.taken_registers();
        if is_part {
            self.comment(PART);
            self.out.review(Code::Conditional, PASTED.into());
        }
        for (at, (block, form)) in program.blocks.iter().zip(&plan.forms).enumerate() {
            self.label(at);
            block.stmts.chunk_by(loaded_together).for_each(|stmts| self.statements(stmts));
            self.end(block, *form);
        }
        self.tail(count);
        if self.page.crowded {
            self.out.span = program.site.span;
            self.out.review_once(Code::Conditional, CROWDED.into());
        }
        if self.labels.short {
            self.out.span = program.site.span;
            self.out.unmapped("more than 99 labels and subprograms");
        }
    }

    /// Writes what the program is called, which is no word here.
    fn header(&mut self) {
        let site = &self.program.site;
        let name = self.program.name.as_ref().map(|name| name.to_string()).unwrap_or_default();
        // What was written here before, and converted since, has the name that people know it by.
        let name = if self.is_named_in_text() { String::new() } else { name };
        self.carry(site);
        let comments = self.take_carried().into_iter().map(|comment| plain(&comment.text));
        let words: Vec<String> =
            std::iter::once(name).chain(comments).filter(|text| !text.is_empty()).collect();
        self.comment(&words.join(" "));
    }

    /// True where the program's first comment is the number of a program.
    fn is_named_in_text(&self) -> bool {
        let first = self.program.blocks.first().and_then(|block| block.stmts.first());
        let comment = first.filter(|stmt| stmt.kind == StmtKind::Comment);
        let text = comment.and_then(|stmt| stmt.site.comments.first()).map(|comment| comment.text.as_str());
        text.and_then(|text| text.strip_prefix('O')).is_some_and(|number| {
            (4..=5).contains(&number.len()) && number.bytes().all(|digit| digit.is_ascii_digit())
        })
    }

    /// Writes which registers the program takes, so that whoever reads it at the machine knows what they hold.
    fn taken_registers(&mut self) {
        self.out.span = Span::default();
        if let Some(mark) = self.names.mark(self.program) {
            self.comment(mark);
        }
        let taken = Taken::of(self.program, self.names);
        for ((name, number), label) in taken.named {
            self.comment(&format!("{name}{number} = {label}"));
        }
        let scratch: Vec<String> =
            taken.scratch.into_iter().map(|(name, number)| format!("{name}{number}")).collect();
        for some in scratch.chunks(SCRATCH_IN_A_LINE) {
            self.comment(&format!("SCRATCH {}", some.join(" ")));
        }
    }

    fn label(&mut self, at: usize) {
        if let Some(label) = self.labels.of(at) {
            self.flush_comments();
            self.label_line(label);
        }
    }

    /// The end of the text. What runs on there goes round the stops for alarms.
    fn tail(&mut self, count: usize) {
        let runs_out =
            self.program.blocks.last().is_some_and(|block| matches!(block.term.kind, TermKind::Stray));
        let last = BlockId(count.saturating_sub(1) as u32);
        let comes_to = count < 2 || !Cfg::whole(self.program, false).preds(last).is_empty();
        let own = self.labels.of(count);
        self.out.span = Span::default();
        self.flush_comments();
        if self.alarms.is_empty() {
            own.into_iter().for_each(|end| self.label_line(end));
            return self.flush_comments();
        }
        let end = own.or_else(|| self.labels.of_stop().filter(|_| runs_out));
        // Nothing runs on after a part.
        end.into_iter().filter(|_| runs_out && comes_to).for_each(|end| self.go_to(end));
        self.stops();
        end.into_iter().for_each(|end| self.label_line(end));
        self.flush_comments();
    }

    /// Writes the stops that stand for alarms: the machine stands, and stands again at each start (seed 004:1568).
    fn stops(&mut self) {
        for (label, text) in std::mem::take(&mut self.alarms) {
            self.label_line(label);
            self.open();
            self.code(Op::Stop);
            self.finish_stop(&text);
            self.go_to(label);
        }
    }

    /// `G24 P5` on a line of its own.
    pub(super) fn go_to(&mut self, label: u32) {
        self.open();
        self.code(Op::Jump);
        self.word("P");
        self.out.integer(label);
        self.finish();
    }

    fn end(&mut self, block: &'p Block, form: Form) {
        let site = &block.term.site;
        match form {
            Form::Fall => self.carry(site),
            Form::Goto(to) => self.goto(site, to),
            Form::If { negated, to, otherwise } => {
                if let TermKind::Branch { cond, .. } = &block.term.kind {
                    self.branch(site, cond, negated, to);
                }
                otherwise.into_iter().for_each(|to| self.goto(site, to));
            }
            Form::Skip(_) | Form::SkipGoto { .. } => {
                self.out.span = site.span;
                self.out.unmapped(SKIP);
            }
            Form::Then | Form::While { .. } | Form::EndDo(_) => self.out.unmapped("a statement round others"),
            Form::Own(then) => {
                self.leave(block);
                then.into_iter().for_each(|to| self.goto(site, to));
            }
        }
    }

    fn goto(&mut self, site: &'p SourceInfo, to: BlockId) {
        self.begin(site);
        if let Some(label) = self.labels.of(to.index()) {
            self.go_to(label);
        }
    }

    /// `TST V30` and then `BEQ P5`: the test stands right before its branch, because what else sets the register no
    /// source says for sure (facts/cc100-target.md 2).
    fn branch(&mut self, site: &'p SourceInfo, condition: &Cond, negated: bool, to: BlockId) {
        let zero =
            self.control.form(OperandPlace::Condition).is_some_and(|form| form.compares == Compares::Zero);
        let (condition, negated) = match condition {
            Cond::Not(inner) => (&**inner, !negated),
            other => (other, negated),
        };
        self.begin(site);
        let (Cond::Compare(relation, tested, Expr::Number(0.0)), true) = (condition, zero) else {
            return self.out.unmapped("a condition of that kind");
        };
        let relation = if negated { relation.negated() } else { *relation };
        match tested {
            Expr::Var(var) => {
                self.out.push_str("TST ");
                self.variable(*var);
            }
            // Of the test of a code only zero or not zero is known.
            Expr::System(state @ Sys::CodeTest, code)
                if matches!(relation, Relation::Equal | Relation::NotEqual) =>
            {
                match self.place(*state, code, 'r') {
                    Some(test) => self.out.push_str(&test),
                    None => return,
                }
            }
            _ => return self.out.unmapped("a condition of that kind"),
        }
        self.finish();
        self.open();
        self.out.push_str(match relation {
            Relation::Equal => "BEQ",
            Relation::NotEqual => "BNE",
            Relation::Less => "BLT",
            Relation::LessEqual => "BLE",
            Relation::Greater => "BGT",
            Relation::GreaterEqual => "BGE",
        });
        if let Some(label) = self.labels.of(to.index()) {
            self.word("P");
            self.out.integer(label);
        }
        self.finish();
    }
}

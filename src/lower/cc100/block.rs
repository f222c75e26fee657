//! One block: its statements in order, its words together.

use super::Lowering;
use super::register::{self, Source};
use super::words::{Change, Planned};
use crate::canon::Func;
use crate::diag::Diagnostic;
use crate::ir::{BinOp, Cond, Expr, Place, Relation, SourceInfo, StmtKind, TermKind, Var};
use crate::syntax::{
    Block, ExprKind, Index, Item, ItemKind, Label, TestSubject, VarRef, Word, for_each_expr,
};
use crate::text::Span;

/// Words of a block, more than any control takes: each letter twice.
const MOST_WORDS: usize = 52;

impl Lowering<'_> {
    /// Lowers a block. Statements act from left to right; the words act together,
    /// after the statements or before the first jump.
    pub(super) fn block(&mut self, block: &Block, mut site: SourceInfo) {
        for error in &block.errors {
            self.findings.add(Diagnostic::new(error.code, error.span, error.message.clone()));
        }
        match site.skip.take() {
            Some(level) => self.pass_over(level, block, &site),
            None => self.end_skips(),
        }
        let mut words: Vec<(&Word, Span)> = block.items.iter().filter_map(as_word).collect();
        if words.len() > MOST_WORDS {
            self.findings.not_understood(block.span, "no block of this control has so many words");
            words.clear();
        }
        if block.items.iter().any(|item| matches!(item.kind, ItemKind::Label(_))) {
            self.constants.forget();
        }
        self.check_mixture(block, &words);
        self.findings.distance_order(&block.items);
        let mut planned = (!words.is_empty()).then(|| self.words(&words, &block.items));
        let mut said = planned.is_some();
        let mut jumped = false;
        for item in &block.items {
            match &item.kind {
                ItemKind::Branch { relation, target } => {
                    if let Some(planned) = planned.take() {
                        self.act(planned, &site);
                    }
                    self.branch(*relation, target, &site, item.span);
                    jumped = true;
                    said = true;
                }
                ItemKind::Word(_) if jumped => {
                    let message = "no source says what words after a jump do";
                    self.findings.not_understood(item.span, message);
                }
                _ => said |= self.statement(item, &site),
            }
            self.constants.follow(&item.kind);
        }
        if let Some(planned) = planned.take() {
            self.act(planned, &site);
        }
        if !said && !site.comments.is_empty() {
            self.push(StmtKind::Comment, &site);
        }
    }

    /// Goes on after blocks with a block skip.
    pub(super) fn end_skips(&mut self) {
        if let Some(next) = self.skipped.take() {
            self.constants.forget();
            self.build.start(next);
        }
    }

    /// Passes over a block while its switch is on. Blocks that follow each other are passed over together, since nobody turns
    /// the switch between them.
    fn pass_over(&mut self, level: u8, block: &Block, site: &SourceInfo) {
        match self.control.statement("block.skip") {
            Some(row) => self.findings.rest_on(row, block.span),
            None => self.findings.not_understood(block.span, "no source says that this control skips blocks"),
        }
        if block.items.iter().any(|item| matches!(item.kind, ItemKind::Label(_))) {
            let message = "no source says whether jumps find a label whose block is skipped: take the / away";
            self.findings.not_understood(block.span, message);
        }
        if self.skipped.is_some() {
            return;
        }
        let (body, next) = (self.build.fresh(), self.build.fresh());
        let site = SourceInfo { span: site.span, ..SourceInfo::default() };
        let cond = Box::new(Cond::Switch(level));
        self.build.end(TermKind::Branch { cond, then: next, otherwise: body }, site);
        self.build.start(body);
        self.skipped = Some(next);
    }

    fn act(&mut self, planned: Planned, site: &SourceInfo) {
        if let Some(change) = planned.change {
            self.change_tool(change, site);
        }
        if let Some(nc) = planned.block {
            self.push(StmtKind::Nc(nc), site);
        }
        if let Some(flow) = planned.flow {
            self.constants.forget();
            self.flow(flow, site);
        }
    }

    /// Changes the tool, unless its number turns out to be one that changes nothing.
    fn change_tool(&mut self, change: Change, site: &SourceInfo) {
        let Change { nc, tool, unless } = change;
        if unless.is_empty() {
            return self.push(StmtKind::Nc(nc), site);
        }
        let otherwise = self.build.fresh();
        for number in unless {
            let then = self.build.fresh();
            // The word is a whole number, and so is the tool in the spindle.
            let tool = match number {
                Expr::System(..) if tool.constant().is_none() => {
                    Expr::Call(Func::Round, [tool.clone()].into())
                }
                _ => tool.clone(),
            };
            // A reader looks for what may change on the left.
            let pair = if tool.constant().is_some() { (number, tool) } else { (tool, number) };
            let cond = Cond::Compare(Relation::NotEqual, pair.0, pair.1);
            self.build.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, site.clone());
            self.build.start(then);
        }
        self.push(StmtKind::Nc(nc), site);
        self.build.start(otherwise);
    }

    /// Lowers a statement; false where it says nothing.
    fn statement(&mut self, item: &Item, site: &SourceInfo) -> bool {
        match &item.kind {
            ItemKind::Sequence { .. } | ItemKind::Comment(_) | ItemKind::EndOfBlock => return false,
            ItemKind::Tape | ItemKind::Skip(_) | ItemKind::Word(_) => return false,
            ItemKind::Label(Label::Number(number)) => {
                self.place_label(*number);
                return false;
            }
            ItemKind::Assign { target, value, .. } => {
                if let (Some(target), Some((value, source))) = (self.variable(target), self.value(value)) {
                    self.assign(target, value, site);
                    self.set_register(source, Expr::Var(target), site);
                }
            }
            ItemKind::Step { target, down } => {
                if let Some(target) = self.variable(target) {
                    let whole = Expr::Call(Func::Fix, [Expr::Var(target)].into());
                    let op = if *down { BinOp::Sub } else { BinOp::Add };
                    let value = Expr::binary(op, whole, Expr::Number(1.0));
                    self.assign(target, value, site);
                    self.set_register(Source::Arithmetic, Expr::Var(target), site);
                }
            }
            ItemKind::Test(subject) => self.test(subject, site, item.span),
            ItemKind::Timer(target) => self.timer(target, site),
            ItemKind::Transfer { table, cells } => self.transfer(table, cells, site, item.span),
            ItemKind::Unparsed => {}
            _ => self.findings.not_understood(item.span, "this control has no such statement"),
        }
        true
    }

    /// Assigns a variable.
    pub(super) fn assign(&mut self, target: Var, value: Expr, site: &SourceInfo) {
        self.push(StmtKind::Assign { target: Place::Var(target), value }, site);
    }

    /// Notes what the condition register holds from here on; [`register`] drops what nobody reads.
    pub(super) fn set_register(&mut self, source: Source, value: Expr, site: &SourceInfo) {
        self.assign(register::marker(source), value, site);
    }

    fn test(&mut self, subject: &TestSubject, site: &SourceInfo, span: Span) {
        match subject {
            TestSubject::Variable(variable) => {
                if let Some(variable) = self.variable(variable) {
                    self.set_register(Source::Test, Expr::Var(variable), site);
                }
            }
            TestSubject::Code(number) => {
                if let Some(value) = self.code_is_active(*number, span) {
                    self.set_register(Source::Flag, value, site);
                }
            }
            TestSubject::Flag(flag) => {
                if let Some(value) = self.flag(*flag, span) {
                    self.set_register(Source::Flag, value, site);
                }
            }
        }
    }

    /// Refuses a block if nobody knows whether a word sees a variable before or
    /// after the assignment beside it.
    fn check_mixture(&mut self, block: &Block, words: &[(&Word, Span)]) {
        let mut read: Vec<&VarRef> = Vec::new();
        for (word, _) in words {
            if let Some(ExprKind::Variable(variable)) = word.value.as_ref().map(|value| &value.kind) {
                read.push(variable);
            }
        }
        for item in &block.items {
            let same = |v: &VarRef| read.iter().any(|r| r.name == v.name && r.index == v.index);
            let clash = match &item.kind {
                ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } => same(target),
                ItemKind::Timer(target) => same(target),
                ItemKind::Transfer { cells, .. } => cells.iter().any(|c| !c.store && same(&c.variable)),
                _ => false,
            };
            if clash {
                let message = "no source says whether a word of this block uses the value from before or \
                               after the assignment";
                self.findings.not_understood(item.span, message);
            }
            if !words.is_empty() && reads_machine(item) {
                let message =
                    "no source says whether this reads the machine before or after the block's words act";
                self.findings.not_understood(item.span, message);
            }
        }
    }
}

fn as_word(item: &Item) -> Option<(&Word, Span)> {
    match &item.kind {
        ItemKind::Word(word) => Some((word, item.span)),
        _ => None,
    }
}

/// True for an assignment that reads an active value, `V1=X`.
fn reads_machine(item: &Item) -> bool {
    let mut reads = false;
    if let ItemKind::Assign { .. } = item.kind {
        for_each_expr(std::slice::from_ref(item), &mut |expr| {
            reads |= matches!(&expr.kind, ExprKind::Variable(v) if v.index == Index::None);
        });
    }
    reads
}

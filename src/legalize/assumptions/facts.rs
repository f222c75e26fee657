//! What the conversion takes for granted of the controls, where no maker's text says so.
//!
//! What concerns the target is looked for last: what stands in a program then is what the target will be told. Each fact is said once a program,
//! at the first place that rests on it. Facts about vacancy matter only where a variable may be vacant; that is looked
//! for by data flow.

mod seen;
mod states;
mod vacant;

use crate::canon::{Func, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CodeMeaning, Control, Question, Row, Side};
use crate::ir::analysis::Vacancy;
use crate::ir::{BinOp, Block, Cond, Expr, Module, Nc, NcItem, Program, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::by_program::look_with;
use crate::legalize::expressions::functions::of_magnitudes_only;
use crate::legalize::features::Feature;
use crate::text::Span;
use foldhash::{HashMap, HashMapExt};
use seen::Seen;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use vacant::VACANCY;

/// Reports the unconfirmed facts of the target that programs rest on.
pub fn of_target(module: &Module, context: &mut Context<'_>) {
    // All values are constants if nothing of these stood there: what was put in since was put in for one of them.
    let source = [
        Feature::Computed,
        Feature::Variable,
        Feature::Temp,
        Feature::Clear,
        Feature::Call,
        Feature::LocalCall,
    ];
    let asked = [Feature::Input, Feature::Print, Feature::Message];
    let computes = source.into_iter().chain(asked).any(|thing| context.features.has(thing));
    look(module, computes, context, context.target, Side::Target);
}

/// Reports the unconfirmed facts of the source about vacant variables that programs rest on: these
/// hang on where a variable may be vacant, which lowering does not know.
pub fn of_source(module: &Module, context: &mut Context<'_>) {
    if context.source.is(Question::Vacancy) {
        look(module, true, context, context.source, Side::Source);
    }
}

fn look(module: &Module, computes: bool, context: &mut Context<'_>, control: &Control, side: Side) {
    // Where nothing is computed, nothing vacant is.
    let asked = VACANCY
        .iter()
        .any(|question| control.behaviour(*question).is_some_and(|row| !row.origin.is_confirmed()));
    let own = computes && asked && context.source.is(Question::Vacancy);
    let summaries = if own { context.summaries(module) } else { Arc::default() };
    let given = if own { context.called(module).given(module) } else { BTreeMap::new() };
    let (none, summaries) = (BTreeSet::new(), &*summaries);
    let all = look_with(
        module,
        || Found::new(control, side),
        |found, index, program| {
            let given = given.get(&index).unwrap_or(&none);
            found.program(program, own.then(|| Vacancy::of(program, summaries, given)))
        },
    );
    for (index, findings) in all.into_iter().enumerate() {
        for finding in findings {
            let fact = finding.fact().unwrap_or_default();
            context.add_once(index, &format!("{side} {fact}"), finding);
        }
    }
}

/// The place of the first statement from here on that has one.
fn first_place(block: &Block, at: usize) -> Option<Span> {
    let stmts = block.stmts.iter().skip(at).map(|stmt| stmt.site.span);
    stmts.chain([block.term.site.span]).find(|span| !span.is_empty())
}

/// The first place in the last blocks of a program, by how many they are.
fn places(program: &Program) -> Vec<Option<Span>> {
    let mut places = vec![None];
    for block in program.blocks.iter().rev() {
        places.push(first_place(block, 0).or(places.last().copied().flatten()));
    }
    places
}

struct Found<'c> {
    control: &'c Control,
    side: Side,
    /// By the place of a row of the control: what is said of it, and the last program that rests on it.
    rows: HashMap<usize, (Diagnostic, u32)>,
    /// Counts the programs.
    program: u32,
    /// What is to be said of the present program.
    all: Vec<Diagnostic>,
    /// Where a finding goes whose statement has no place of its own: that of the next one, by how many blocks are left.
    places: Vec<Option<Span>>,
    /// Where a finding goes if no such statement comes.
    home: Span,
    /// The blocks of constants of the present program that were looked at.
    seen: Seen,
}

impl<'c> Found<'c> {
    fn new(control: &'c Control, side: Side) -> Self {
        Self {
            control,
            side,
            rows: HashMap::new(),
            program: 0,
            all: Vec::new(),
            places: Vec::new(),
            home: Span::default(),
            seen: Seen::default(),
        }
    }

    /// What is to be said of a program.
    fn program(&mut self, program: &Program, vacancy: Option<Vacancy<'_>>) -> Vec<Diagnostic> {
        (self.home, self.program) = (program.site.span, self.program + 1);
        self.places = places(program);
        self.seen = Seen::default();
        for (at, id) in program.ids().enumerate() {
            let blocks = program.blocks.get(at..).unwrap_or_default();
            if self.side == Side::Target {
                self.block(blocks);
            }
            if let Some(vacancy) = &vacancy {
                self.vacant(id, blocks, vacancy);
            }
        }
        std::mem::take(&mut self.all)
    }

    fn row<T: Row>(&mut self, row: &'c T, span: Span) {
        if row.origin().is_confirmed() {
            return;
        }
        let place = std::ptr::from_ref(row) as usize;
        let (control, side) = (self.control, self.side);
        let told = || control.unconfirmed(side, &row.fact(), row.origin().note.as_deref(), span);
        let (finding, last) = self.rows.entry(place).or_insert_with(|| (told(), 0));
        if std::mem::replace(last, self.program) != self.program {
            self.all.push(Diagnostic { span, ..finding.clone() });
        }
    }

    /// The behaviour must be confirmed, whatever its answer.
    fn behaviour(&mut self, question: Question, span: Span) {
        if let Some(row) = self.control.behaviour(question) {
            self.row(row, span);
        }
    }

    /// As [`Found::behaviour`], where the common form has one answer: a control that is known to give another has not
    /// what is written.
    fn expects(&mut self, question: Question, answer: &str, span: Span) {
        self.behaviour(question, span);
        let row =
            self.control.behaviour(question).filter(|row| row.value != "unknown" && row.value != answer);
        if let Some(row) = row {
            let what = format!(
                "the target answers '{}' to '{question}' ({}); the conversion has no form \
                                for that",
                row.value,
                question.meaning()
            );
            self.all.push(Diagnostic::new(Code::NoEquivalent, span, what));
        }
    }

    /// The place of a statement of the first of `blocks`, or of the next one that has any: what an emulation puts
    /// before a statement has none, and may end a block.
    fn span(&self, blocks: &[Block], at: usize) -> Span {
        // Most statements have one.
        let stmt = blocks.first().and_then(|block| block.stmts.get(at));
        if let Some(stmt) = stmt.filter(|stmt| !stmt.site.span.is_empty()) {
            return stmt.site.span;
        }
        let here = blocks.first().and_then(|block| first_place(block, at));
        here.or_else(|| self.places.get(blocks.len().wrapping_sub(1)).copied().flatten()).unwrap_or(self.home)
    }

    fn block(&mut self, blocks: &[Block]) {
        let Some(block) = blocks.first() else { return };
        for (at, stmt) in block.stmts.iter().enumerate() {
            if let StmtKind::Nc(nc) = &stmt.kind
                && stmt.site.skip.is_none()
                && self.seen.is_known(nc)
            {
                continue;
            }
            let span = self.span(blocks, at);
            stmt.kind.exprs(&mut |e| e.walk(&mut |e| self.value(e, span)));
            if stmt.site.skip.is_some_and(|level| level > 1) {
                self.behaviour(Question::SkipLevels, span);
            }
            match &stmt.kind {
                StmtKind::Nc(nc) => {
                    let number = nc.word(Role::WorkOffset).and_then(Expr::constant);
                    let operands = number.map(|number| (Role::WorkOffset, number)).into_iter().collect();
                    nc.ops().for_each(|op| self.code(op, &operands, span));
                    self.tool_word(nc, span);
                    self.words(nc, span);
                }
                StmtKind::Output(_) => self.statement("output.formatted", span),
                StmtKind::OpenPort => self.statement("output.open", span),
                StmtKind::ClosePort => self.statement("output.close", span),
                StmtKind::ModalCall(_) => self.statement("call.modal", span),
                _ => {}
            }
        }
        let span = self.span(blocks, block.stmts.len());
        block.term.kind.exprs(&mut |e| e.walk(&mut |e| self.value(e, span)));
        match &block.term.kind {
            TermKind::Branch { cond, .. } => match &**cond {
                Cond::Switch(2..) => self.behaviour(Question::SkipLevels, span),
                Cond::And(_) | Cond::Or(_) => self.behaviour(Question::ConditionAndOr, span),
                _ => {}
            },
            TermKind::End { rewind } => {
                let op = if *rewind { Op::EndRewind } else { Op::End };
                self.code(op, &Default::default(), span);
            }
            TermKind::Computed { .. } => self.statement("goto.computed", span),
            TermKind::Return { to: Some(_) } => self.statement("return.to.sequence", span),
            TermKind::Call { call, .. } if call.count.as_ref().and_then(Expr::constant) == Some(0.0) => {
                self.expects(Question::RepeatZero, "none", span);
            }
            TermKind::Call { call, .. } if call.count.is_some() && !call.arguments.is_empty() => {
                self.behaviour(Question::CallRepeatReloadsArguments, span);
            }
            _ => {}
        }
    }

    /// What a tool word does, where one is written for a change or a length.
    fn tool_word(&mut self, nc: &Nc, span: Span) {
        if nc.has(Op::LengthOff) && self.control.is(Question::ToolWordSelectsLength) {
            self.behaviour(Question::ToolWordSelectsLength, span);
        }
        if nc.has(Op::ToolChange) && self.control.word_for(Op::ToolChange).is_some() {
            self.behaviour(Question::ToolChangeWord, span);
        }
    }

    /// The letters of words that no code beside them explains, and what the words rest on.
    fn words(&mut self, nc: &Nc, span: Span) {
        let rows: Vec<&CodeMeaning> =
            nc.ops().filter_map(|op| self.control.code_for(op, &Default::default())).collect();
        for item in &nc.items {
            let NcItem::Word(role, value) = item else { continue };
            if let Some((letter, comma)) = self.control.letter(*role, None)
                && let Some(row) = self.control.word(letter, comma).filter(|row| row.role == *role)
                && !rows.iter().any(|code| code.words.values().any(|own| own == role))
            {
                self.row(row, span);
            }
            if (role.is_length() || role.is_axis()) && value.constant().is_none() {
                self.behaviour(Question::WordBareExpression, span);
            }
            match (role, value.constant()) {
                (Role::ArcI | Role::ArcJ | Role::ArcK, _) => self.behaviour(Question::ArcCentre, span),
                (Role::ArcRadius, radius) => {
                    // As the control has it written.
                    let row = self.control.behaviour(Question::ArcRadiusNegative);
                    let turned = row.is_some_and(|row| row.value == "short");
                    let radius = radius.map(|radius| if turned { -radius } else { radius });
                    if radius.is_none_or(|radius| radius >= 0.0) {
                        self.behaviour(Question::ArcRadiusPositive, span);
                    }
                    if radius.is_none_or(|radius| radius < 0.0) {
                        self.behaviour(Question::ArcRadiusNegative, span);
                    }
                }
                (Role::DwellMs | Role::CycleDwell, Some(_)) => self.behaviour(Question::DwellBare, span),
                (Role::Repeat, count) if count.is_none_or(|count| count < 1.0) => {
                    self.behaviour(Question::CycleL0Stores, span);
                }
                _ => {}
            }
        }
    }

    fn statement(&mut self, name: &str, span: Span) {
        if let Some(row) = self.control.statement(name) {
            self.row(row, span);
        }
    }

    fn code(&mut self, op: Op, operands: &std::collections::BTreeMap<crate::canon::Role, f64>, span: Span) {
        // Operands pick between spellings of one operation only where it has several.
        let some = if op == Op::SelectWork { operands.clone() } else { Default::default() };
        if let Some(row) = self.control.code_for(op, &some) {
            self.row(row, span);
        }
    }

    fn value(&mut self, e: &Expr, span: Span) {
        match e {
            Expr::Call(function, arguments) => {
                if let Some(row) = self.control.function(*function, arguments.len()) {
                    self.row(row, span);
                }
                match function {
                    Func::Round => self.expects(Question::RoundHalfAway, "true", span),
                    Func::RoundIncrement => self.behaviour(Question::RoundInAddress, span),
                    Func::Fix if of_magnitudes_only(self.control) => {}
                    Func::Fix => self.expects(Question::FixTowardZero, "true", span),
                    Func::Asin => self.behaviour(Question::AsinRange, span),
                    Func::Acos => self.behaviour(Question::AcosRange, span),
                    Func::Atan if arguments.len() == 2 => self.behaviour(Question::Atan2Range, span),
                    Func::Atan => self.behaviour(Question::AtanRange, span),
                    _ => {}
                }
            }
            Expr::System(state, subscripts) if self.side == Side::Target => {
                self.state(*state, subscripts, span)
            }
            Expr::Binary(BinOp::Mod, ..) => {
                self.behaviour(Question::ModRoundsOperands, span);
                self.behaviour(Question::ModSign, span);
            }
            Expr::Binary(op @ (BinOp::And | BinOp::Or | BinOp::Xor), operands) => {
                let [a, b] = &**operands;
                if !(is_narrow(a) && is_narrow(b) || *op == BinOp::And && (is_narrow(a) || is_narrow(b))) {
                    self.behaviour(Question::BitsWidth, span);
                }
                self.bits(a, b, span);
            }
            _ => {}
        }
    }

    fn bits(&mut self, a: &Expr, b: &Expr, span: Span) {
        if !a.is_whole() || !b.is_whole() {
            self.behaviour(Question::BitsOfFraction, span);
        }
    }
}

/// True for a constant of few bits.
fn is_narrow(e: &Expr) -> bool {
    e.constant().is_some_and(|value| (0.0..65_536.0).contains(&value))
}

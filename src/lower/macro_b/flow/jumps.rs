//! Jumps and conditions, and the codes that leave a program or jump in it.

use super::call::{Flow, Parts};
use crate::canon::{Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BinOp, Class, Cond, Expr, Place, Relation, SourceInfo, StmtKind, TermKind, Var};
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::expressions::At;
use crate::lower::macro_b::parts::{Words, acts};
use crate::syntax::{self, Item, ItemKind, Target};
use crate::text::Span;

/// The number that the block of all computed jumps goes to.
const HUB: Var = Var { class: Class::Temp, number: 1 };

impl<'a> Lowering<'a> {
    /// `GOTO`.
    pub fn goto(&mut self, target: &'a Target, span: Span, site: &SourceInfo) {
        match target {
            Target::Sequence(number) => {
                let to = self.target(*number, span);
                self.builder.end(TermKind::Jump(to), site.clone());
            }
            Target::Computed(value) => {
                match self.control.statement("goto.computed") {
                    Some(row) => self.findings.rest_on(row, span),
                    None if self.findings.is(Question::GotoComputed, span) => {}
                    None => self.unknown_behaviour(Question::GotoComputed, span),
                }
                let value = self.expr(value, At::Value);
                self.jump_to(value, span, site);
            }
            Target::Label(_) => self.findings.not_understood(span, "this control has no named labels"),
        }
    }

    /// A jump to a sequence number that is a value.
    ///
    /// Where a program has very many of both, a jump leaves its number in a temporary and goes on at one
    /// block that jumps for all of them.
    fn jump_to(&mut self, value: Expr, span: Span, site: &SourceInfo) {
        if value.constant().is_none() && (self.hub.is_some() || self.is_crowded()) {
            let hub = *self.hub.get_or_insert_with(|| (self.builder.fresh(), span));
            // A temporary is never vacant; what is vacant finds no block, as 0 does not.
            let value = match value.may_be_vacant() {
                true => Expr::binary(BinOp::Add, value, Expr::Number(0.0)),
                false => value,
            };
            self.builder.push(StmtKind::Assign { target: Place::Var(HUB), value }, site.clone());
            return self.builder.end(TermKind::Jump(hub.0), SourceInfo { span, ..SourceInfo::default() });
        }
        let kind = match value.constant().and_then(crate::ir::eval::whole) {
            Some(number) => TermKind::Jump(self.target(number, span)),
            None => TermKind::Computed { value: Box::new(value), targets: self.all_targets(span).into() },
        };
        self.builder.end(kind, site.clone());
    }

    /// The block that jumps for all computed jumps, after the program's text.
    pub fn close_hub(&mut self) {
        let Some((hub, span)) = self.hub.take() else { return };
        if self.builder.is_open() {
            self.builder.end(TermKind::Stray, SourceInfo::default());
        }
        self.builder.start(hub);
        let targets = self.all_targets(span);
        let site = SourceInfo { span, ..SourceInfo::default() };
        self.builder
            .end(TermKind::Computed { value: Box::new(Expr::Var(HUB)), targets: targets.into() }, site);
    }

    /// `IF [..]` and what is done when it holds.
    pub fn if_statement(
        &mut self,
        condition: &'a syntax::Expr,
        then: bool,
        bare: bool,
        body: &'a [Item],
        span: Span,
        site: &SourceInfo,
    ) {
        self.check_form(then, bare, body, span);
        let cond = self.cond(condition);
        let mut doing = body.iter().filter(|item| acts(item));
        if let (Some(Item { kind: ItemKind::Goto(Target::Sequence(number)), span }), None) =
            (doing.next(), doing.next())
        {
            let then = self.target(*number, *span);
            self.builder.end_then(site.clone(), |otherwise| TermKind::Branch {
                cond: Box::new(cond),
                then,
                otherwise,
            });
            return;
        }
        let (then, otherwise) = (self.builder.fresh(), self.builder.fresh());
        self.builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, site.clone());
        self.builder.start(then);
        let motion = self.motion;
        self.items(body, site);
        // After it the mode is either: the words that need it must say which.
        self.motion.meet(motion);
        self.builder.start(otherwise);
    }

    /// Which forms a control takes: without IF, without THEN, with words after it.
    fn check_form(&mut self, then: bool, bare: bool, body: &[Item], span: Span) {
        let jump = body.iter().filter(|item| acts(item)).all(|item| matches!(item.kind, ItemKind::Goto(_)));
        let words = body.iter().any(|item| matches!(item.kind, ItemKind::Word(_)));
        if !body.iter().any(acts) {
            self.findings.not_understood(span, "nothing follows the condition");
        }
        if body.iter().any(|i| matches!(i.kind, ItemKind::Do { .. } | ItemKind::End { .. })) {
            let message = "a loop cannot begin or end after a condition";
            self.findings.add(Diagnostic::new(Code::LoopNotPaired, span, message));
        }
        if bare {
            match self.control.statement("if.bare") {
                Some(row) => self.findings.rest_on(row, span),
                None => self.findings.not_understood(span, "a condition needs IF before it"),
            }
        }
        // One macro statement after THEN is what every control of the family takes.
        if jump || (then && !words) {
            return;
        }
        match (self.findings.behaviour(Question::ThenWords, span), words) {
            (Some("true"), _) => {}
            (Some(_), true) => {
                let takes =
                    if then { "THEN takes one macro statement" } else { "a condition takes GOTO or THEN" };
                let what = format!("{takes}, and no G or M words: jump past a block of its own for them");
                self.findings.not_understood(span, what);
            }
            (None, true) => self.unknown_behaviour(Question::ThenWords, span),
            // A jump is what the condition takes, and no THEN is missing before it.
            (_, false) if !then && body.iter().any(|item| matches!(item.kind, ItemKind::Goto(_))) => {
                let message = "a statement stands beside the jump of a condition: no source says whether it is done, and when";
                let told = Diagnostic::new(Code::Conditional, span, message);
                self.findings.add(told.with_help("give it a block of its own"));
            }
            (_, false) if !then => {
                let message = "THEN is missing before the statement";
                self.findings.add(Diagnostic::new(Code::ThenMissing, span, message));
            }
            _ => {}
        }
    }

    /// `M99`, with `P` or without.
    pub fn returning(&mut self, flow: Flow<'a>, words: &Words<'a>, site: &SourceInfo) {
        let parts = self.parts(flow, words, &[Role::Sequence]);
        if !parts.rest.is_empty() {
            match self.findings.behaviour(Question::M99BlockMovesFirst, site.span) {
                Some("true") => {}
                _ => self.unknown_behaviour(Question::M99BlockMovesFirst, site.span),
            }
            self.nc(&parts.rest, site);
        }
        let to = self.part(&parts, Role::Sequence);
        let Some(to) = to else {
            return self.builder.end(TermKind::Return { to: None }, site.clone());
        };
        match self.findings.behaviour(Question::M99PJumpsHere, site.span) {
            Some("true") => return self.jump_to(to, site.span, site),
            Some(_) => {}
            None => self.unknown_behaviour(Question::M99PJumpsHere, site.span),
        }
        self.builder.end(TermKind::Return { to: Some(to) }, site.clone());
    }

    /// `M96 P Q`: jumps when an input is off, that is reads 0.
    pub fn jump_on_input(&mut self, flow: Flow<'a>, words: &Words<'a>, site: &SourceInfo) {
        let parts = self.parts(flow, words, &[Role::Sequence, Role::Input]);
        self.run_first(&parts, site);
        let number = self.part(&parts, Role::Sequence);
        let input = self.part(&parts, Role::Input);
        let input = input.and_then(|input| self.input(input.constant()?));
        let number = number.and_then(|number| crate::ir::eval::whole(number.constant()?));
        let (Some(number), Some(input)) = (number, input) else {
            return self
                .findings
                .not_understood(site.span, "this jump needs constants for its block and its input");
        };
        let then = self.target(number, site.span);
        let cond = Cond::Compare(Relation::Equal, input, Expr::Number(0.0));
        // The code looks when the moves before it are done; a comparison may be worked out before.
        let early = SourceInfo { comments: Default::default(), ..site.clone() };
        self.builder.push(StmtKind::Sync, early);
        self.builder.end_then(site.clone(), |otherwise| TermKind::Branch {
            cond: Box::new(cond),
            then,
            otherwise,
        });
    }

    /// The state of the input with this number, counted from 0.
    fn input(&self, number: f64) -> Option<Expr> {
        let run = self.control.system_run(Sys::Input)?;
        let variable = run.first?.checked_add(crate::ir::eval::whole(number)?)?;
        let subscripts = run.subscripts_of(variable)?;
        Some(Expr::System(Sys::Input, subscripts.into_iter().map(|n| Expr::Number(f64::from(n))).collect()))
    }

    /// `M30`, `M02`: the other words of the block act first.
    pub fn ending(&mut self, flow: Flow<'a>, words: &Words<'a>, site: &SourceInfo) {
        let parts = self.parts(flow, words, &[]);
        self.run_first(&parts, site);
        self.builder.end(TermKind::End { rewind: flow.row.op == Op::EndRewind }, site.clone());
    }

    /// The words beside a call or a jump act before it.
    pub fn run_first(&mut self, parts: &Parts<'a>, site: &SourceInfo) {
        if !parts.rest.is_empty() {
            self.nc(&parts.rest, site);
        }
    }
}

//! The macro statements that are not flow.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Expr, OutputPart, Place, SourceInfo, StmtKind};
use crate::lower::common::comment_text;
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::expressions::At;
use crate::syntax::{ExprKind, Fence, Item, ItemKind, OutputPart as Part};
use crate::text::Span;

impl<'a> Lowering<'a> {
    /// One statement; `rest` is what stands after it in its block.
    pub fn statement(&mut self, item: &'a Item, rest: &'a [Item], site: &SourceInfo) {
        match &item.kind {
            ItemKind::Assign { target, value, by_sign: false } => {
                let text = comment(rest).map(|span| comment_text(span, self.source));
                // What is wrong with the value is told too.
                let target = self.target_place(target);
                let bracket = matches!(value.kind, ExprKind::Group(_) | ExprKind::Plus(_));
                let value = self.expr(value, At::Value);
                if bracket
                    && value.may_be_vacant()
                    && !self.findings.is(Question::BracketCopiesVacancy, item.span)
                {
                    self.unknown_behaviour(Question::BracketCopiesVacancy, item.span);
                }
                if let Some(target) = target {
                    self.assign(target, value, text, site);
                }
            }
            ItemKind::If { condition, then, bare, body } => {
                self.if_statement(condition, *then, *bare, body, item.span, site);
            }
            ItemKind::Do { condition, number } => self.do_loop(condition.as_ref(), *number, item.span, site),
            ItemKind::End { number } => self.end_loop(*number, item.span, site),
            ItemKind::Goto(target) => self.goto(target, item.span, site),
            ItemKind::SetNames { first, names } => self.set_names(*first, names, item.span, site),
            ItemKind::Output { binary: false, parts } => self.output(parts, item.span, site),
            ItemKind::Output { binary: true, .. } => {
                self.findings.not_understood(item.span, "BPRNT puts out binary words: no other control can");
            }
            ItemKind::OpenPort => {
                self.rest_on_statement("output.open", item.span);
                self.builder.push(StmtKind::OpenPort, site.clone());
            }
            ItemKind::ClosePort => {
                self.rest_on_statement("output.close", item.span);
                self.builder.push(StmtKind::ClosePort, site.clone());
            }
            // The parser's error says why.
            ItemKind::Unparsed => self.builder.push(StmtKind::Comment, site.clone()),
            _ => {
                let text = String::from_utf8_lossy(item.span.of(self.source));
                self.findings.not_understood(item.span, format!("this control has no statement '{text}'"));
            }
        }
    }

    /// An assignment; one to the alarm or the stop variable is that statement, and the
    /// comment after it is its message.
    fn assign(&mut self, target: Place, value: Expr, text: Option<String>, site: &SourceInfo) {
        let Place::System(state @ (Sys::Alarm | Sys::StopMessage), _) = target else {
            return self.builder.push(StmtKind::Assign { target, value }, site.clone());
        };
        let mut site = site.clone();
        let text = match text {
            Some(text) => {
                if let Some(at) =
                    site.comments.iter().position(|comment| !comment.leading && comment.text == text)
                {
                    site.comments.remove(at);
                }
                text
            }
            None => String::new(),
        };
        let kind = match state {
            Sys::Alarm => StmtKind::Alarm { number: value.into(), text: text.into() },
            _ => StmtKind::StopMessage { number: value.into(), text: text.into() },
        };
        self.builder.push(kind, site);
    }

    /// The construct is one of the control's statements.
    pub fn rest_on_statement(&mut self, name: &str, span: Span) {
        match self.control.statement(name) {
            Some(row) => self.findings.rest_on(row, span),
            None => self.findings.not_understood(span, "the control has no such statement"),
        }
    }

    fn set_names(&mut self, first: u32, names: &[String], span: Span, site: &SourceInfo) {
        match self.numbered(first, span) {
            Some(Expr::Var(first)) => {
                self.builder
                    .push(StmtKind::SetNames { first, names: names.iter().cloned().collect() }, site.clone());
            }
            _ => self.findings.not_understood(span, format!("#{first} cannot be given a name")),
        }
    }

    fn output(&mut self, parts: &'a [Part], span: Span, site: &SourceInfo) {
        self.rest_on_statement("output.formatted", span);
        let mut out = Vec::with_capacity(parts.len());
        for part in parts {
            match part {
                Part::Text(text) => {
                    let text = comment_text(*text, self.source);
                    if text.contains(' ') {
                        let message = "a blank in the text of DPRNT: only '*' is certain to print a blank";
                        self.findings.add(Diagnostic::new(Code::OutputBlank, span, message));
                    }
                    out.push(OutputPart::Text(text.replace('*', " ")));
                }
                Part::Value { value, whole, fraction } => {
                    let value = self.expr(value, At::Value);
                    out.push(OutputPart::Value { value, whole: *whole, fraction: *fraction });
                }
            }
        }
        self.builder.push(StmtKind::Output(out), site.clone());
    }
}

/// The first comment of the items.
fn comment(items: &[Item]) -> Option<Span> {
    items.iter().find_map(|item| match &item.kind {
        ItemKind::Comment(comment) if comment.fence != Fence::Within => Some(comment.text),
        _ => None,
    })
}

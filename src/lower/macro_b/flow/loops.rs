//! WHILE, DO and END.

use crate::diag::{Code, Diagnostic};
use crate::ir::{SourceInfo, TermKind};
use crate::lower::macro_b::build::{Loop, Lowering};
use crate::syntax::Expr;
use crate::text::Span;

impl<'a> Lowering<'a> {
    /// `WHILE [..] DO n`: the condition is tested before each pass, that is at its head.
    pub fn do_loop(&mut self, condition: Option<&'a Expr>, number: u32, span: Span, site: &SourceInfo) {
        let row = self.control.statement(if condition.is_some() { "while" } else { "do.endless" });
        row.iter().for_each(|row| self.findings.rest_on(*row, span));
        if self.loops.iter().any(|open| open.number == number) {
            self.loop_error(Code::LoopsCross, span, format!("DO{number} stands inside another DO{number}"));
        }
        let (head, exit) = (self.builder.fresh(), self.builder.fresh());
        match condition {
            Some(condition) => {
                self.builder.start(head);
                let cond = self.cond(condition);
                let body = self.builder.fresh();
                self.builder.end(
                    TermKind::Branch { cond: Box::new(cond), then: body, otherwise: exit },
                    site.clone(),
                );
                self.builder.start(body);
            }
            None => {
                self.builder.end(TermKind::Jump(head), site.clone());
                self.builder.start(head);
            }
        }
        self.motion.join();
        self.loops.push(Loop { number, start: self.at, head, exit, site: site.clone() });
    }

    /// `END n` closes the nearest open loop of its number, which must be the innermost one.
    pub fn end_loop(&mut self, number: u32, span: Span, site: &SourceInfo) {
        let Some(found) = self.loops.iter().rposition(|open| open.number == number) else {
            return self.loop_error(
                Code::LoopNotPaired,
                span,
                format!("END{number} has no DO{number} before it"),
            );
        };
        if found + 1 != self.loops.len() {
            self.loop_error(Code::LoopsCross, span, format!("the loop DO{number} crosses another loop"));
        }
        // Loops that it crosses are closed as well: the program is refused, and one error is enough.
        let Some(closed) = self.loops.drain(found..).next() else { return };
        self.builder.end(TermKind::Jump(closed.head), site.clone());
        self.builder.start(closed.exit);
    }

    /// Loops that are open at the end of the program.
    pub fn close_loops(&mut self) {
        for open in std::mem::take(&mut self.loops).into_iter().rev() {
            self.loop_error(
                Code::LoopNotPaired,
                open.site.span,
                format!("DO{} has no END{} in this program", open.number, open.number),
            );
        }
    }

    fn loop_error(&mut self, code: Code, span: Span, message: String) {
        self.findings.add(Diagnostic::new(code, span, message));
    }
}

//! Statements of macro lines.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BlockId, Class, Expr, Place, PrintPart, StmtKind, TermKind, Var};
use crate::lower::common::{comment_text, says_something};
use crate::lower::fadal::build::Lowering;
use crate::lower::fadal::codes::program_number;
use crate::lower::fadal::flow::goal;
use crate::syntax::{self, Index, Item, ItemKind, ProgramName, Target, VarRef};
use crate::text::Span;

impl<'b> Lowering<'b> {
    /// One macro statement; none if it is not understood, which is then reported.
    pub fn statement(&mut self, item: &'b Item, depth: u32) -> Option<()> {
        match &item.kind {
            // The block begins there already.
            ItemKind::Label(_) => {}
            ItemKind::Program(_) => {}
            ItemKind::Assign { target, value, .. } => {
                let value = self.expr(value)?;
                let place = self.target(target)?;
                self.scratches_plane(&place, item.span);
                self.assign(place, value);
            }
            ItemKind::If { condition, body, .. } => self.branch(condition, body, item.span, depth)?,
            ItemKind::Goto(target) => {
                let to = self.jump_to(target, item.span)?;
                self.end(TermKind::Jump(to));
            }
            ItemKind::Print { serial, parts, stay } => {
                let mut out = Vec::with_capacity(parts.len());
                for part in parts {
                    out.push(match part {
                        syntax::PrintPart::Text(text) => PrintPart::Text(comment_text(*text, self.source)),
                        syntax::PrintPart::Value(value) => {
                            let _ = self.rely(Question::PrintFormat, value.span);
                            PrintPart::Value(self.expr(value)?)
                        }
                    });
                }
                self.push(StmtKind::Print { serial: *serial, parts: out.into(), stay: *stay });
            }
            ItemKind::Input { serial, targets } => {
                for target in targets {
                    let target = self.target(target)?;
                    self.push(StmtKind::Input { serial: *serial, target });
                }
            }
            ItemKind::Clear(ranges) => self.clear(ranges, item.span)?,
            // Modal, and told from the state; DEBUG and RUN change nothing of what the machine does.
            ItemKind::Set(_) => {}
            ItemKind::Wait => self.push(StmtKind::Sync),
            ItemKind::Start(program) => {
                let Some(number) = program_number(program) else {
                    return self.refuse(item.span, "START needs a program number");
                };
                self.end(TermKind::Chain(ProgramName::Number(number)));
            }
            ItemKind::Index(_) => {
                let message = "INDEX sends its text to the maker's indexer";
                self.findings.add(Diagnostic::new(Code::Indexer, item.span, message));
                return None;
            }
            _ => return self.refuse(item.span, "this control has no such statement"),
        }
        Some(())
    }

    fn branch(
        &mut self,
        condition: &'b syntax::Expr,
        body: &'b [Item],
        span: Span,
        depth: u32,
    ) -> Option<()> {
        if depth > 16 {
            return self.refuse(span, "IF nests too deeply");
        }
        let cond = self.condition(condition)?;
        let said: Vec<&Item> = body.iter().filter(|item| says_something(item)).collect();
        if said.iter().any(|item| matches!(item.kind, ItemKind::Word(_))) {
            let _ = self.rely(Question::ThenWords, span);
            return self.refuse(span, "NC words cannot follow THEN");
        }
        if let [Item { kind: ItemKind::Goto(target), .. }] = said.as_slice() {
            let then = self.jump_to(target, span)?;
            let otherwise = self.builder.fresh();
            self.end(TermKind::Branch { cond: Box::new(cond), then, otherwise });
            self.builder.start(otherwise);
            return Some(());
        }
        let (then, otherwise) = (self.builder.fresh(), self.builder.fresh());
        self.end(TermKind::Branch { cond: Box::new(cond), then, otherwise });
        self.builder.start(then);
        let mut whole = Some(());
        for item in said {
            whole = whole.and(self.statement(item, depth + 1));
        }
        self.builder.start(otherwise);
        whole
    }

    /// The block that a jump goes to.
    fn jump_to(&mut self, target: &Target, span: Span) -> Option<BlockId> {
        let Some(goal) = goal(target) else {
            return self.refuse(span, "this control has no jump to a computed number");
        };
        Some(self.block_of(&goal, span))
    }

    /// What can be assigned: state that is only read cannot.
    fn target(&mut self, var: &VarRef) -> Option<Place> {
        let place = self.place(var)?;
        let rows = self.control.dialect().system.iter().filter(|row| row.name == var.name);
        let read_only =
            matches!(place, Place::System(..)) && rows.into_iter().all(|row| !row.access.contains('w'));
        if read_only {
            return self.refuse(var.span, format!("{} cannot be written", var.name));
        }
        Some(place)
    }

    fn clear(&mut self, ranges: &[(VarRef, Option<VarRef>)], span: Span) -> Option<()> {
        if ranges.is_empty() {
            self.suppose(Question::ClearAll, "true", span);
            self.push(StmtKind::ClearAll(Class::Global));
            return Some(());
        }
        for (from, to) in ranges {
            let last = to.as_ref().unwrap_or(from);
            let (Index::Number(first), Index::Number(end)) = (&from.index, &last.index) else {
                if to.is_none() && from.name == "V" {
                    let place = self.target(from)?;
                    self.assign(place, Expr::Number(0.0));
                    continue;
                }
                return self.refuse(from.span, "CLEAR takes variables, ranges of variables, or nothing");
            };
            let known = self.control.variable_class("V", *first).is_some()
                && self.control.variable_class("V", *end).is_some();
            if from.name != "V" || last.name != "V" || first > end || !known {
                return self.refuse(
                    from.span.to(last.span),
                    "CLEAR takes V variables, from the lower to the higher",
                );
            }
            for number in *first..=*end {
                let target = Place::Var(Var { class: Class::Global, number });
                self.assign(target, Expr::Number(0.0));
            }
        }
        Some(())
    }
}

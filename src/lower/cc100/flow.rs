//! Labels, jumps, calls and ends.

use super::register::REGISTER;
use super::{Lowering, cycle_name};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BlockId, Call, Callee, Cond, Expr, SourceInfo, TermKind};
use crate::lower::common::relation;
use crate::syntax::{BinaryOp, Label, Target};
use crate::text::Span;

/// Where a block's words send the control.
pub(super) enum Flow {
    /// Calls a part of this program.
    CallBlock {
        /// Its label.
        label: u32,
        /// How often it runs, in all.
        count: Option<Expr>,
        /// The place that names it.
        span: Span,
    },
    /// Calls a cycle of the maker.
    CallCycle(u32),
    /// Jumps to a label.
    Jump(u32, Span),
    /// Ends a called part.
    Return,
    /// Ends the program; a cycle goes back to its caller.
    End {
        /// True for the end that rewinds.
        rewind: bool,
    },
}

impl Lowering<'_> {
    /// The block that a label names.
    fn target(&mut self, label: u32, span: Span) -> BlockId {
        let Some(found) = self.labels.get(&label).copied() else {
            return self.nowhere.block(format!("${label}"), span, &mut self.build, &mut self.findings);
        };
        if self.repeated.contains(&label)
            && self.findings.only(Question::GotoFirstLabel, "true", span).is_none()
        {
            let message = format!("${label} is in the program more than once: the first one is taken");
            self.findings.add(Diagnostic::new(Code::TargetTwice, span, message));
        }
        found
    }

    /// Goes on under a label.
    pub(super) fn place_label(&mut self, number: u32) {
        // A label that stands a second time is a place that no jump reaches by its number.
        let first = self.labels.get(&number).copied().filter(|_| self.placed.insert(number));
        let id = first.unwrap_or_else(|| self.build.fresh());
        self.build.start(id);
        if first.is_some() {
            // `$2` is no sequence number: N2 is another block.
            let name = format!("${number}");
            self.build.label(if self.computed { Label::Number(number) } else { Label::Name(name) });
        }
    }

    /// Lowers a jump on the condition register.
    pub(super) fn branch(&mut self, operator: BinaryOp, target: &Target, site: &SourceInfo, span: Span) {
        let Some(relation) = relation(operator) else {
            return self.findings.not_understood(span, "this control has no such jump");
        };
        let cond = Cond::Compare(relation, Expr::Var(REGISTER), Expr::Number(0.0));
        let known = match target {
            // One that an operator may edit is looked for when the program runs.
            Target::Computed(label) if !self.constants.is_given_above(label) => {
                self.constants.sure(label).and_then(whole_label)
            }
            _ => None,
        };
        let known = known.map(|label| Target::Label(Label::Number(label)));
        match known.as_ref().unwrap_or(target) {
            Target::Label(Label::Number(label)) => {
                let then = self.target(*label, span);
                self.build.end_then(site.clone(), |otherwise| TermKind::Branch {
                    cond: Box::new(cond),
                    then,
                    otherwise,
                });
            }
            Target::Computed(label) => {
                let Some(value) = self.operand(label) else { return };
                let shared = self.dispatches.iter().find(|(known, _)| *known == value).map(|(_, id)| *id);
                let otherwise = self.build.fresh();
                let then = shared.unwrap_or_else(|| self.build.fresh());
                self.build.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, site.clone());
                if shared.is_none() {
                    self.dispatch(value, then, site);
                }
                self.build.start(otherwise);
            }
            _ => self.findings.not_understood(span, "this control jumps to labels only"),
        }
    }

    /// Builds the block that goes to the label that a value names; one serves all
    /// jumps by the same variable, since it names every label of the program.
    fn dispatch(&mut self, value: Expr, id: BlockId, site: &SourceInfo) {
        self.build.start(id);
        let targets = self.labels.iter().map(|(number, id)| (*number, *id)).collect();
        self.build.end(TermKind::Computed { value: Box::new(value.clone()), targets }, site.clone());
        self.dispatches.push((value, id));
    }

    /// Leaves the present block.
    pub(super) fn flow(&mut self, flow: Flow, site: &SourceInfo) {
        let site = site.clone();
        match flow {
            Flow::CallBlock { label, count, span } => {
                let entry = self.target(label, span);
                self.call(Callee::Block(entry), count, site);
            }
            Flow::CallCycle(number) => self.call(Callee::Program(cycle_name(number)), None, site),
            Flow::Jump(label, span) => {
                let to = self.target(label, span);
                self.build.end(TermKind::Jump(to), site);
            }
            Flow::Return => self.build.end(TermKind::Return { to: None }, site),
            Flow::End { rewind: false } if self.is_cycle => {
                self.ends.insert(site.span);
                self.build.end(TermKind::Return { to: None }, site);
            }
            Flow::End { rewind } => {
                if !rewind && !self.findings.is(Question::CycleEndEndsProgram, site.span) {
                    self.findings
                        .not_understood(site.span, "no source says what the end of a cycle does here");
                }
                self.build.end(TermKind::End { rewind }, site);
            }
        }
    }

    fn call(&mut self, callee: Callee, count: Option<Expr>, site: SourceInfo) {
        let call = Call { callee, level: false, arguments: Vec::new(), count };
        self.build.end_then(site, |next| TermKind::Call { call: Box::new(call), next });
    }
}

/// The label that a number names.
pub(super) fn whole_label(number: f64) -> Option<u32> {
    let in_range = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number);
    in_range.then_some(number as u32)
}

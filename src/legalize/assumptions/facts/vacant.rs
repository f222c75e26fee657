//! The facts about vacancy: which programs rest on them, by data flow.

use super::Found;
use crate::dialect::Question;
use crate::ir::analysis::Vacancy;
use crate::ir::{Block, BlockId, Cond, Expr, Relation, TermKind};
use crate::text::Span;

/// What matters only where a variable may be vacant.
pub(super) const VACANCY: [Question; 3] =
    [Question::VacantEqZero, Question::VacantComparesAsZero, Question::VacantArithmeticZero];

impl Found<'_> {
    /// Facts that matter only where a variable may be vacant.
    pub(super) fn vacant(&mut self, id: BlockId, blocks: &[Block], vacancy: &Vacancy<'_>) {
        let Some(block) = blocks.first() else { return };
        let [equality, order, arithmetic] = VACANCY.map(|question| !self.is_told(question));
        let compares = || match &block.term.kind {
            TermKind::Branch { cond, .. } => match &**cond {
                Cond::Compare(Relation::Equal | Relation::NotEqual, ..) => equality,
                Cond::Compare(..) => order,
                _ => equality || order,
            },
            _ => false,
        };
        if !arithmetic && !compares() {
            return;
        }
        let mut told = !arithmetic;
        vacancy.forward(id, &mut |at, may| match block.stmts.get(at) {
            Some(_) if told => {}
            Some(stmt) => {
                stmt.kind.exprs(&mut |e| e.walk(&mut |e| told |= computes_with(e, may)));
                if told {
                    let span = self.span(blocks, at);
                    self.behaviour(Question::VacantArithmeticZero, span);
                }
            }
            None => {
                if let TermKind::Branch { cond, .. } = &block.term.kind {
                    let span = self.span(blocks, at);
                    self.condition(cond, span, may);
                }
            }
        });
    }

    fn condition(&mut self, cond: &Cond, span: Span, may: &dyn Fn(&Expr) -> bool) {
        match cond {
            Cond::Compare(_, _, Expr::Vacant) | Cond::Compare(_, Expr::Vacant, _) => {}
            Cond::Compare(relation, a, b) => {
                let equality = matches!(relation, Relation::Equal | Relation::NotEqual);
                // What is vacant does not equal 5, whether or not it equals 0.
                let other = |e: &Expr| equality && e.constant().is_some_and(|value| value != 0.0);
                if (may(a) && !other(b)) || (may(b) && !other(a)) {
                    self.behaviour(
                        if equality { Question::VacantEqZero } else { Question::VacantComparesAsZero },
                        span,
                    );
                }
                let mut arithmetic = false;
                for e in [a, b] {
                    e.walk(&mut |e| arithmetic |= computes_with(e, may));
                }
                if arithmetic {
                    self.behaviour(Question::VacantArithmeticZero, span);
                }
            }
            Cond::And(parts) | Cond::Or(parts) => {
                parts.iter().for_each(|part| self.condition(part, span, may))
            }
            Cond::Not(inner) => self.condition(inner, span, may),
            Cond::Switch(_) => {}
        }
    }

    /// True where there is no more to say about a behaviour in this program.
    fn is_told(&self, question: Question) -> bool {
        let last = |row| self.rows.get(&(std::ptr::from_ref(row) as usize)).map(|(_, last)| *last);
        let row = self.control.behaviour(question).filter(|row| !row.origin.is_confirmed());
        row.is_none_or(|row| last(row) == Some(self.program))
    }
}

/// True where arithmetic takes an operand that may be vacant.
fn computes_with(e: &Expr, may: &dyn Fn(&Expr) -> bool) -> bool {
    match e {
        Expr::Binary(_, operands) => operands.iter().any(may),
        Expr::Call(_, arguments) => arguments.iter().any(may),
        _ => false,
    }
}

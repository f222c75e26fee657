//! What conditions say of variables, and what is known of them.

use super::known::{Known, Range, opposite};
use super::{Reader, bare};
use crate::canon::Sys;
use crate::dialect::Question;
use crate::syntax::{BinaryOp, Expr, ExprKind, Index, VarRef};

impl Reader<'_> {
    /// Takes in that a condition did not hold.
    pub(super) fn went_on(&mut self, condition: &Expr) {
        if let ExprKind::Binary(op, _) = &bare(condition).kind
            && let Some(holds) = opposite(*op)
        {
            self.learn(condition, holds);
        }
    }

    /// Takes in that a condition held.
    pub(super) fn held(&mut self, condition: &Expr) {
        if let ExprKind::Binary(op, _) = &bare(condition).kind
            && opposite(*op).is_some()
        {
            self.learn(condition, *op);
        }
    }

    /// Takes in that this comparison of the two sides of a condition is true.
    fn learn(&mut self, condition: &Expr, holds: BinaryOp) {
        let ExprKind::Binary(_, operands) = &bare(condition).kind else { return };
        let [a, b] = &**operands;
        let ExprKind::Variable(variable) = &bare(a).kind else { return };
        let Some(name) = self.name(variable) else { return };
        match self.value(b) {
            // It is not vacant.
            Some(Known::Vacant) if holds == BinaryOp::NotEqual => {
                self.known.entry(name).or_insert(Known::Number(Range::ANY));
            }
            Some(Known::Number(Range { low, high, .. })) if low == high => {
                let old = match self.known.get(&name) {
                    Some(Known::Number(range)) => range.clone(),
                    Some(Known::Vacant) => return,
                    None if !self.is_nullable(&name) => Range::ANY,
                    // A vacant one, taken for 0, would have gone the other way.
                    None if self.says(Question::VacantComparesAsZero, "true") => {
                        let stays = Range::one(0.0).compare(holds, &Range::one(low)) != Some(false);
                        if stays || matches!(holds, BinaryOp::Equal | BinaryOp::NotEqual) {
                            return;
                        }
                        Range::ANY
                    }
                    None => return,
                };
                self.known.insert(name, Known::Number(old.where_holds(holds, low)));
            }
            _ => {}
        }
    }

    /// Whether a condition holds, where that is known.
    pub(super) fn holds(&self, e: &Expr) -> Option<bool> {
        use BinaryOp::*;
        let (op, [left, right]) = match &e.kind {
            ExprKind::Group(inner) => return self.holds(inner),
            // Parsers limit how deep expressions nest.
            ExprKind::Binary(op @ (And | Or), operands) => {
                let decides = *op == Or;
                let ways = [&operands[0], &operands[1]].map(|part| self.holds(part));
                return match ways {
                    [Some(way), _] | [_, Some(way)] if way == decides => Some(decides),
                    [Some(_), Some(_)] => Some(!decides),
                    _ => None,
                };
            }
            ExprKind::Binary(op, operands) => (*op, &**operands),
            _ => return None,
        };
        let (a, b) = (self.value(left)?, self.value(right)?);
        let as_zero = |known: &Known| match known {
            Known::Number(range) => Some(range.clone()),
            Known::Vacant => self.says(Question::VacantComparesAsZero, "true").then_some(Range::one(0.0)),
        };
        match (op, &a, &b) {
            (Equal | NotEqual, Known::Vacant, Known::Vacant) => Some(op == Equal),
            (Equal | NotEqual, Known::Vacant, Known::Number(other))
            | (Equal | NotEqual, Known::Number(other), Known::Vacant) => {
                let never_zero = other.low > 0.0 || other.high < 0.0;
                (never_zero || self.says(Question::VacantEqZero, "false")).then_some(op == NotEqual)
            }
            _ => {
                let (a, b) = (as_zero(&a)?, as_zero(&b)?);
                let by_whole = || self.against_its_whole(op, (left, &a), (right, &b));
                a.compare(op, &b).or_else(by_whole)
            }
        }
    }

    /// Whether a comparison of a variable with its whole part holds, where its sign says so.
    fn against_its_whole(&self, op: BinaryOp, left: (&Expr, &Range), right: (&Expr, &Range)) -> Option<bool> {
        use BinaryOp::*;
        let is = |whole: &Range, of: &Expr| {
            let ExprKind::Variable(variable) = &bare(of).kind else { return false };
            whole.whole_of.is_some() && whole.whole_of == self.name(variable)
        };
        // How it is written: the variable first.
        let (op, of) = if is(right.1, left.0) {
            (op, left.1)
        } else if is(left.1, right.0) {
            let turned = match op {
                Less => Greater,
                LessEqual => GreaterEqual,
                Greater => Less,
                GreaterEqual => LessEqual,
                op => op,
            };
            (turned, right.1)
        } else {
            return None;
        };
        match op {
            Less if of.low >= 0.0 => Some(false),
            GreaterEqual if of.low >= 0.0 => Some(true),
            Greater if of.high <= 0.0 => Some(false),
            LessEqual if of.high <= 0.0 => Some(true),
            _ => None,
        }
    }

    pub(super) fn is_system(&self, variable: &VarRef) -> bool {
        self.state(variable).is_some()
    }

    pub(super) fn is_alarm(&self, variable: &VarRef) -> bool {
        self.state(variable) == Some(Sys::Alarm)
    }

    pub(super) fn state(&self, variable: &VarRef) -> Option<Sys> {
        let Index::Number(number) = variable.index else { return None };
        self.control.read_system(&variable.name, Some(number)).map(|(state, ..)| state)
    }
}

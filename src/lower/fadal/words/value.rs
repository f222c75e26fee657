//! The values of NC words.

use crate::canon::Role;
use crate::diag::Code;
use crate::dialect::{BareLength, CodeMeaning, Question, Row};
use crate::ir::Expr;
use crate::lower::common::constant;
use crate::lower::fadal::build::Lowering;
use crate::lower::fadal::macros::{negate, piecewise};
use crate::syntax::{self, ExprKind, Number};
use crate::text::Span;

impl<'b> Lowering<'b> {
    /// The value of a word in a role, in common numbers: fixture E7 is work offset 101.
    pub fn word_value(&mut self, e: &syntax::Expr, role: Role, code: Option<&CodeMeaning>) -> Option<Expr> {
        let value = self.nc_value(e, Some(role))?;
        if role == Role::Speed {
            return self.speed(value, e.span);
        }
        if let Expr::Number(number) = value {
            return Some(Expr::Number(self.control.canonical(code, role, number)));
        }
        Some(self.shifted(value, role, code))
    }

    /// The value of an NC word or of `R3+7.5`: a number or a parametric variable, with its sign.
    pub fn nc_value(&mut self, e: &syntax::Expr, role: Option<Role>) -> Option<Expr> {
        match &e.kind {
            ExprKind::Number(number) if !number.value.is_finite() => {
                self.refuse(e.span, "the number is too large")
            }
            ExprKind::Number(number) => Some(self.bare(*number, role, e.span)),
            ExprKind::Plus(inner) => self.nc_value(inner, role),
            ExprKind::Negate(inner) => {
                // One sign stands before a value; a parser nests no more than it reads.
                if matches!(inner.kind, ExprKind::Negate(_)) {
                    return self.refuse(e.span, "a word has one sign");
                }
                let value = self.nc_value(inner, role)?;
                let angle = matches!(role, Some(Role::A | Role::B | Role::C));
                // The sign of an angle may be the way of its axis, that of 0 too.
                Some(if angle && value == Expr::Number(0.0) { Expr::Number(-0.0) } else { negate(value) })
            }
            ExprKind::Variable(var) if var.name == "R" => {
                if role.is_some_and(Role::is_integer) {
                    self.suppose(Question::IntegerWordRounds, "true", var.span);
                }
                self.read(var)
            }
            ExprKind::Variable(var) => {
                self.refuse(var.span, format!("{} cannot stand in an NC word, only R0 to R9 can", var.name))
            }
            _ => self.refuse(e.span, "a word takes a number or an R variable, not an expression"),
        }
    }

    /// A written number: what it counts without a decimal point depends on the control.
    fn bare(&mut self, number: Number, role: Option<Role>, span: Span) -> Expr {
        let angle = matches!(role, Some(Role::A | Role::B | Role::C | Role::Angle));
        let length = role.is_none_or(Role::is_length) || angle;
        let numbers = self.control.numbers();
        let counts = match role {
            _ if number.point || number.value == 0.0 => return Expr::Number(number.value),
            Some(Role::Feed) => self.control.bare_feed(),
            _ if length => self.control.bare_length(),
            _ => return Expr::Number(number.value),
        };
        match counts {
            BareLength::Increments if role.is_some() => return Expr::Increments(number.value),
            BareLength::Units => self.findings.rest_on(numbers, span),
            _ => self.findings.unconfirmed(
                numbers.fact(),
                Some("no source says which unit a number without a point has"),
                span,
            ),
        }
        Expr::Number(number.value)
    }

    /// A digit after the point of a speed picks the belt range and is no speed.
    fn speed(&mut self, value: Expr, span: Span) -> Option<Expr> {
        match value.constant() {
            Some(speed) if speed.fract() != 0.0 && self.findings.is(Question::SpindleRangeSuffix, span) => {
                let message = "the digit after the point of S picks the belt range here; the target picks its range by the \
                               speed";
                self.once_for_all(Code::SpeedRange, span, message);
                Some(Expr::Number(speed.trunc()))
            }
            _ => Some(value),
        }
    }

    /// A computed number of a table whose rows are numbered otherwise in common.
    fn shifted(&mut self, value: Expr, role: Role, code: Option<&CodeMeaning>) -> Expr {
        let beside = code.and_then(|row| row.shift.get(&role));
        let usual = || self.control.dialect().words.iter().find(|row| row.role == role)?.shift.get(&role);
        let Some(shifts) = beside.or_else(usual) else { return value };
        let mut pieces: Vec<(f64, f64)> =
            shifts.iter().map(|shift| (f64::from(shift.first), shift.add as f64)).collect();
        pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
        piecewise(value, pieces.into_iter())
    }
}

/// True for a value that is written as the number 0.
pub fn is_zero(e: &syntax::Expr) -> bool {
    constant(e) == Some(0.0)
}

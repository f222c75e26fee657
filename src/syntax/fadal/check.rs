//! What the grammar alone cannot see: comparisons out of place, labels.

use crate::diag::Code;
use crate::syntax::support::fault;
use crate::syntax::{BinaryOp, Expr, ExprKind, Index, SyntaxError, VarRef};

/// Faults of an expression that must be true or false.
pub(super) fn condition(expr: &Expr, errors: &mut Vec<SyntaxError>) {
    match &expr.kind {
        ExprKind::Group(inner) | ExprKind::Not(inner) => condition(inner, errors),
        ExprKind::Binary(BinaryOp::And | BinaryOp::Or, operands) => {
            operands.iter().for_each(|operand| condition(operand, errors));
        }
        ExprKind::Binary(op, operands) if is_relation(*op) => {
            operands.iter().for_each(|operand| value(operand, errors));
        }
        _ => {
            let message = "this is a value; a comparison such as `V1<>0` is expected";
            errors.push(fault(Code::ConditionExpected, expr.span, message));
            value(expr, errors);
        }
    }
}

/// Faults of an expression that must be a number.
pub(super) fn value(expr: &Expr, errors: &mut Vec<SyntaxError>) {
    match &expr.kind {
        ExprKind::Number(_) => {}
        ExprKind::Variable(variable) => subscript(variable, errors),
        ExprKind::Negate(inner) | ExprKind::Plus(inner) | ExprKind::Group(inner) => value(inner, errors),
        ExprKind::Call { arguments, .. } => arguments.iter().for_each(|argument| value(argument, errors)),
        ExprKind::Binary(op, operands)
            if !is_relation(*op) && !matches!(op, BinaryOp::And | BinaryOp::Or) =>
        {
            operands.iter().for_each(|operand| value(operand, errors));
        }
        ExprKind::Not(_) | ExprKind::Binary(..) => {
            let message = "this is true or false; a value is expected";
            errors.push(fault(Code::ComparisonAsValue, expr.span, message));
        }
    }
}

/// Faults of a variable's subscript.
pub(super) fn subscript(variable: &VarRef, errors: &mut Vec<SyntaxError>) {
    if let Index::Computed(inner) = &variable.index {
        value(inner, errors);
    }
}

fn is_relation(op: BinaryOp) -> bool {
    use BinaryOp::*;
    matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
}

//! INC and DEC of variables that are known to be whole.
//!
//! Lowering writes DEC V1 as `FIX[V1]-1`: the fraction goes first. Law: FIX of a
//! whole number is that number. Side condition: on every way here the variable
//! was last given a whole constant, a sum, difference or product of whole
//! values, or was stepped, and no other program ran since. Counter-example:
//! `V6=V5+1` behind `V5=V4/50`.

use super::graph::Graph;
use crate::canon::Func;
use crate::ir::{BinOp, Block, Callee, Class, Expr, Place, Program, Stmt, StmtKind, TermKind, Var};
use crate::lower::common::Findings;

/// One bit a variable of the control: whether it is whole. 99 numbers and 26 letters fit.
type Wholes = u128;

fn bit(var: Var) -> Wholes {
    if var.class == Class::Global { 1u128.checked_shl(var.number).unwrap_or(0) } else { 0 }
}

fn is_whole(value: &Expr, known: Wholes) -> bool {
    match value {
        Expr::Number(number) => number.fract() == 0.0,
        Expr::Var(var) => known & bit(*var) != 0,
        Expr::Negate(inner) => is_whole(inner, known),
        Expr::Call(Func::Fix, _) => true,
        Expr::Binary(BinOp::Add | BinOp::Sub | BinOp::Mul, operands) => {
            operands.iter().all(|operand| is_whole(operand, known))
        }
        _ => false,
    }
}

fn step(stmt: &Stmt, known: Wholes) -> Wholes {
    match &stmt.kind {
        StmtKind::Assign { target: Place::Var(var), value } if is_whole(value, known) => known | bit(*var),
        StmtKind::Assign { target: Place::Var(var), .. } => known & !bit(*var),
        _ => known,
    }
}

fn through(block: &Block, known: Wholes) -> Wholes {
    let after = block.stmts.iter().fold(known, |known, stmt| step(stmt, known));
    match &block.term.kind {
        TermKind::Call { call, .. } if !matches!(call.callee, Callee::Block(_)) => 0,
        _ => after,
    }
}

/// Takes FIX out of the steps of whole variables, and reports the other steps.
pub fn resolve(program: &mut Program, findings: &mut Findings<'_>) {
    let starts = Graph::of(program).forward(program, &0, |a, b| a & b, through);
    for (block, mut known) in program.blocks.iter_mut().zip(starts) {
        for stmt in &mut block.stmts {
            let span = stmt.site.span;
            if let StmtKind::Assign { target: Place::Var(var), value: Expr::Binary(_, operands) } =
                &mut stmt.kind
                && let [counted, _] = &mut **operands
                && *counted == Expr::Call(Func::Fix, [Expr::Var(*var)].into())
            {
                if known & bit(*var) != 0 {
                    *counted = Expr::Var(*var);
                } else if findings.behaviour("step.drops.fraction", span) != Some("true") {
                    findings.not_understood(span, "no source says what a step does with a fraction");
                } else {
                    let why = "the fraction is taken off before the step, toward zero";
                    findings.unconfirmed("behaviour:step.drops.fraction".into(), Some(why), span);
                }
            }
            known = step(stmt, known);
        }
    }
}

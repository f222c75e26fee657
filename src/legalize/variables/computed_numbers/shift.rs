//! Rewrites computed numbers that the target has elsewhere.

use super::{Finding, Numbers};
use crate::ir::{Bank, BinOp, Expr, Place, Program, StmtKind, shifted};
use crate::legalize::rewrite_program;

/// True if a number walks in steps of `gap` or more, as `5201+#19*20` does: from one axis's numbers to the next's.
pub(super) fn walks(number: &Expr, gap: f64) -> bool {
    match number {
        Expr::Binary(BinOp::Add | BinOp::Sub, operands) => operands.iter().any(|part| walks(part, gap)),
        Expr::Binary(BinOp::Mul, operands) => {
            operands.iter().filter_map(Expr::constant).any(|step| step.abs() >= gap)
        }
        _ => false,
    }
}

/// Adds the distance to computed numbers that the target has elsewhere, and names what it counts otherwise; true if
/// there are any.
pub(super) fn shift(program: &mut Program, numbers: &mut Numbers<'_>) -> bool {
    let mut any = false;
    let mut moved = |number: Expr| match *numbers.of(&number) {
        Finding::Shifted(.., by) => {
            any = true;
            Place::Indirect(Bank::Numbered, Box::new(shifted(number, by as f64)))
        }
        Finding::Counted(state, first, _, from) => {
            any = true;
            let count = match shifted(number, f64::from(from) - f64::from(first)) {
                // What is left of the number is the count itself.
                Expr::Binary(BinOp::Add, sum) if sum[0] == Expr::Number(0.0) => {
                    let [_, count] = *sum;
                    count
                }
                count => count,
            };
            Place::System(state, [count].into())
        }
        _ => Place::Indirect(Bank::Numbered, Box::new(number)),
    };
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        if let StmtKind::Assign { target, .. } | StmtKind::Input { target, .. } = &mut stmt.kind
            && let Place::Indirect(Bank::Numbered, number) = target
        {
            *target = moved(std::mem::replace(number.as_mut(), Expr::Vacant));
        }
    }
    rewrite_program(program, |e| matches!(e, Expr::Indirect(Bank::Numbered, _)), &mut |e, _, _| match e {
        Expr::Indirect(Bank::Numbered, number) => moved(*number).read(),
        other => other,
    });
    any
}

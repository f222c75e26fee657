//! Makes functions again of what stands for them in temporaries.
//!
//! **Law.** `t = -t` where t is below 0, and nothing where it is not, is ABS. FIX of a size that gets the sign of its number
//! back is FIX of the number. A step up and one down again of a whole part leave it. An angle has the sine and cosine
//! of what is whole turns away from it.
//!
//! **Side condition.** All of it is kept in temporaries, in blocks that nothing else enters, and no comment or skip stands
//! there. Between the parts only variables are assigned, none of which a part still reads. An angle that loses its turns is read by sines and
//! cosines alone. Numbers beyond the digits of a control, and angles of that size, are off by their last digit, as they were.
//!
//! **Counter-examples.** A second jump into the middle. `t = -t` where another variable is below 0. A turn of 361. An
//! angle that a word reads too: `X t` is another place a turn away.

mod diamonds;
mod turns;

use super::pass::{Level, Library, Pass};
use crate::canon::Func;
use crate::ir::{BinOp, Block, Class, Expr, Place, Program, Stmt, StmtKind, Var};

/// The pass.
pub struct Raised;

impl Pass for Raised {
    fn name(&self) -> &'static str {
        "raised"
    }

    fn keeps_legal(&self) -> bool {
        false
    }

    fn run(&self, program: &mut Program, library: &Library, _: Level) {
        if program.temporaries().next().is_none() {
            return;
        }
        program.blocks.iter_mut().for_each(join);
        while let Some(at) = diamonds::raise(program) {
            join(&mut program.blocks[at]);
        }
        turns::drop(program, library.ways);
    }
}

/// The variable that a statement sets, and its value, where it is nothing but that.
fn set(stmt: &Stmt) -> Option<(Var, &Expr)> {
    let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind else { return None };
    (stmt.site.comments.is_empty() && stmt.site.skip.is_none()).then_some((*var, value))
}

/// Puts values into the parts of functions that come directly after them: `t = q`, `t = ABS[t]`.
fn join(block: &mut Block) {
    let mut at = 1;
    while at < block.stmts.len() {
        let joined = block.stmts.get(at - 1..=at).and_then(|two| match two {
            [first, second] => joined(first, second),
            _ => None,
        });
        match joined {
            Some(value) => {
                let first = block.stmts.remove(at - 1);
                if let Some(stmt) = block.stmts.get_mut(at - 1) {
                    stmt.site.sequence = first.site.sequence.or(stmt.site.sequence);
                    if let StmtKind::Assign { value: old, .. } = &mut stmt.kind {
                        *old = value;
                    }
                }
                at = at.saturating_sub(1).max(1);
            }
            None => at += 1,
        }
    }
}

/// The value of the second statement with that of the first in it.
fn joined(first: &Stmt, second: &Stmt) -> Option<Expr> {
    let ((temp, inner), (target, outer)) = (set(first)?, set(second)?);
    if temp != target || temp.class != Class::Temp || inner.may_be_vacant() {
        return None;
    }
    match outer {
        Expr::Call(function @ (Func::Abs | Func::Fix), arguments)
            if arguments.as_slice() == [Expr::Var(temp)] =>
        {
            Some(Expr::Call(*function, [inner.clone()].into()))
        }
        Expr::Binary(op @ (BinOp::Add | BinOp::Sub), operands) => match &**operands {
            // A step of a whole part.
            [Expr::Call(Func::Fix, arguments), by @ Expr::Number(1.0)]
                if arguments.as_slice() == [Expr::Var(temp)] =>
            {
                let whole = Expr::Call(Func::Fix, [inner.clone()].into());
                Some(Expr::binary(*op, whole, by.clone()))
            }
            [Expr::Var(var), Expr::Number(1.0)] if *var == temp => undone(inner, *op),
            _ => None,
        },
        _ => None,
    }
}

/// The whole part that was stepped the other way before.
fn undone(stepped: &Expr, op: BinOp) -> Option<Expr> {
    let Expr::Binary(before, operands) = stepped else { return None };
    let opposite = matches!((*before, op), (BinOp::Add, BinOp::Sub) | (BinOp::Sub, BinOp::Add));
    match &**operands {
        [whole @ Expr::Call(Func::Fix, _), Expr::Number(1.0)] if opposite => Some(whole.clone()),
        _ => None,
    }
}

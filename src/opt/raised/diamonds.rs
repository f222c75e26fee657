//! Signs that are turned where a variable is below 0.

use super::set;
use crate::canon::Func;
use crate::ir::{
    BinOp, BlockId, Callee, Class, Cond, Expr, Place, Program, Relation, SourceInfo, Stmt, StmtKind,
    TermKind, Terminator, Var,
};
use crate::syntax::Label;

/// A sign that is turned.
struct Turned {
    /// The block that asks, the one that turns, and the one after both.
    asks: BlockId,
    turns: BlockId,
    past: BlockId,
    put: Put,
}

/// What stands for it.
enum Put {
    /// The temporary gets its size.
    Size(Var),
    /// The statement at this place is the whole part of the variable.
    Whole(usize, Var),
}

/// Raises one, and tells in which block.
pub(super) fn raise(program: &mut Program) -> Option<usize> {
    let found = program.ids().find_map(|id| turned(program, id))?;
    let after = program.blocks.get_mut(found.past.index())?;
    after.labels.clear();
    let stmts = std::mem::take(&mut after.stmts);
    let term = std::mem::replace(&mut after.term, round(found.past));
    let turns = program.blocks.get_mut(found.turns.index())?;
    turns.stmts.clear();
    turns.term = round(found.turns);
    let asks = program.blocks.get_mut(found.asks.index())?;
    match found.put {
        Put::Size(temp) => {
            let value = Expr::Call(Func::Abs, [Expr::Var(temp)].into());
            let kind = StmtKind::Assign { target: Place::Var(temp), value };
            asks.stmts
                .push(Stmt { kind, site: SourceInfo { span: asks.term.site.span, ..SourceInfo::default() } });
        }
        Put::Whole(at, number) => {
            if let Some(StmtKind::Assign { value, .. }) = asks.stmts.get_mut(at).map(|stmt| &mut stmt.kind) {
                *value = Expr::Call(Func::Fix, [Expr::Var(number)].into());
            }
        }
    }
    asks.stmts.extend(stmts);
    asks.term = term;
    Some(found.asks.index())
}

/// The end of a block that nothing reaches any more and that reaches nothing else.
fn round(id: BlockId) -> Terminator {
    Terminator { kind: TermKind::Jump(id), site: SourceInfo::default() }
}

fn turned(program: &Program, asks: BlockId) -> Option<Turned> {
    let block = program.block(asks)?;
    let TermKind::Branch {
        cond: Cond::Compare(relation, Expr::Var(asked), Expr::Number(0.0)),
        then,
        otherwise,
    } = &block.term.kind
    else {
        return None;
    };
    let (past, turns) = match relation {
        Relation::GreaterEqual => (*then, *otherwise),
        Relation::Less => (*otherwise, *then),
        _ => return None,
    };
    let [stmt] = program.block(turns)?.stmts.as_slice() else { return None };
    let (temp, value) = set(stmt)?;
    let fits = temp.class == Class::Temp
        && minus(value) == Some(temp)
        && program.block(turns)?.term.kind == TermKind::Jump(past)
        && asks != turns
        && asks != past
        && is_own(program, turns, 1)
        && program.block(turns)?.labels.is_empty()
        && is_own(program, past, 2);
    let put = if *asked == temp { Put::Size(temp) } else { whole(&block.stmts, temp, *asked)? };
    fits.then_some(Turned { asks, turns, past, put })
}

/// The variable whose sign a value turns.
fn minus(value: &Expr) -> Option<Var> {
    match value {
        Expr::Negate(inner) => match **inner {
            Expr::Var(var) => Some(var),
            _ => None,
        },
        Expr::Binary(BinOp::Mul, operands) => match **operands {
            [Expr::Var(var), Expr::Number(-1.0)] => Some(var),
            _ => None,
        },
        _ => None,
    }
}

/// The place where a temporary was given the whole part of a number's size, which both still hold.
fn whole(stmts: &[Stmt], temp: Var, number: Var) -> Option<Put> {
    for (at, stmt) in stmts.iter().enumerate().rev() {
        let (written, value) = set(stmt)?;
        if written == temp {
            let Expr::Call(Func::Fix, arguments) = value else { return None };
            let [Expr::Call(Func::Abs, of)] = arguments.as_slice() else { return None };
            return (of.as_slice() == [Expr::Var(number)]).then_some(Put::Whole(at, number));
        }
        if written == number {
            return None;
        }
    }
    None
}

/// True for a block that so many ways lead to and nothing else: no number, no call, no comment at its head's jump.
fn is_own(program: &Program, id: BlockId, ways: usize) -> bool {
    let Some(block) = program.block(id) else { return false };
    let named = block.labels.iter().all(|label| matches!(label, Label::Name(_)));
    let mut count = 0;
    for from in &program.blocks {
        count += from.term.kind.successors().iter().filter(|to| **to == id).count();
        let called = match &from.term.kind {
            TermKind::Call { call, .. } => Some(&call.callee),
            _ => None,
        };
        let modal = from.stmts.iter().filter_map(|stmt| match &stmt.kind {
            StmtKind::ModalCall(call) => Some(&call.callee),
            _ => None,
        });
        if modal.chain(called).any(|callee| *callee == Callee::Block(id)) {
            return false;
        }
    }
    let quiet = |site: &SourceInfo| site.comments.is_empty();
    let asked = program.blocks.iter().filter(|from| from.term.kind.successors().contains(&id));
    id != BlockId(0) && named && count == ways && asked.into_iter().all(|from| quiet(&from.term.site))
}

//! Makes one function of the steps by which an earlier conversion took a whole part.
//!
//! **Law.** `v = x`, `v = -v` where x is below 0, `v = FIX[v]+1`, `v = v-1`, and `v = -v` where x is below 0, is `v = FIX[x]`:
//! FIX is toward zero, so it is that of the magnitude with the sign of x. The step up and down, which may also be left out,
//! changes no whole number below 2^53. The value is the same; a zero that a sign was turned of may keep that sign.
//!
//! **Side condition.** `v` is a temporary, and only these blocks lead to one another. None of their statements has a comment or
//! may be skipped.
//!
//! **Counter-example.** A loop that jumps to the step: there `v` is not what `x` gave it.

use super::pass::{Level, Library, Pass};
use crate::canon::Func;
use crate::ir::analysis::{Cfg, modal_bodies};
use crate::ir::{BinOp, Block, BlockId, Class, Cond, Expr, Place, Program, Relation, SourceInfo, Stmt};
use crate::ir::{StmtKind, TermKind, Terminator, Var};
use std::collections::BTreeSet;
use thin_vec::ThinVec;

/// The pass.
pub struct WholeParts;

impl Pass for WholeParts {
    fn name(&self) -> &'static str {
        "whole-parts"
    }

    fn keeps_legal(&self) -> bool {
        false
    }

    fn run(&self, program: &mut Program, library: &Library, _: Level) {
        if library.ways.come_back || program.temporaries().next().is_none() {
            return;
        }
        let cfg = Cfg::whole(program, false);
        let modal: BTreeSet<BlockId> = modal_bodies(program).collect();
        // A block that one whole part ends in may be where the next one begins: from the last to the first.
        for first in program.ids().collect::<Vec<_>>().into_iter().rev() {
            let Some(found) = Steps::at(program, first) else { continue };
            let Steps { below, step, back, end, .. } = found;
            let only = |id: BlockId, from: &[BlockId]| {
                id != BlockId(0)
                    && !modal.contains(&id)
                    && cfg.preds(id).iter().all(|pred| from.contains(pred))
            };
            if only(below, &[first]) && only(step, &[first, below]) && only(back, &[step]) {
                let joined = only(end, &[step, back]);
                found.replace(program, first, joined);
            }
        }
    }
}

/// The blocks of a whole part, but for the first.
struct Steps {
    below: BlockId,
    step: BlockId,
    back: BlockId,
    end: BlockId,
    v: Var,
    x: Var,
}

impl Steps {
    /// The whole part that ends this block.
    fn at(program: &Program, first: BlockId) -> Option<Self> {
        let block = program.block(first)?;
        let (v, Expr::Var(x)) = set(block.stmts.last()?)? else { return None };
        let (asked, step, below) = sign(block)?;
        let given = v.class == Class::Temp && v != *x && (asked == v || asked == *x);
        let turned = turns(program.block(below)?, v) == Some(step);
        let block = program.block(step)?;
        let (again, end, back) = sign(block)?;
        let ends = again == *x && turns(program.block(back)?, v) == Some(end);
        let blocks = [first, below, step, back, end];
        let apart = blocks.iter().collect::<BTreeSet<_>>().len() == blocks.len();
        let whole = given && turned && ends && apart && is_whole(block, v);
        whole.then_some(Self { below, step, back, end, v, x: *x })
    }

    /// Puts the function in their place. With `joined` nothing else leads to what comes after it.
    fn replace(self, program: &mut Program, first: BlockId, joined: bool) {
        let nothing = || Block {
            labels: ThinVec::new(),
            stmts: ThinVec::new(),
            term: Terminator { kind: TermKind::Jump(first), site: SourceInfo::default() },
        };
        for id in [self.below, self.step, self.back] {
            program.blocks[id.index()] = nothing();
        }
        let after = match joined {
            true => std::mem::replace(&mut program.blocks[self.end.index()], nothing()),
            false => Block {
                term: Terminator { kind: TermKind::Jump(self.end), site: SourceInfo::default() },
                ..nothing()
            },
        };
        let block = &mut program.blocks[first.index()];
        if let Some(Stmt { kind: StmtKind::Assign { target: Place::Var(v), value }, .. }) =
            block.stmts.last_mut()
            && *v == self.v
        {
            *value = Expr::Call(Func::Fix, [Expr::Var(self.x)].into());
        }
        block.stmts.extend(after.stmts);
        block.term = after.term;
    }
}

/// The variable that a statement sets, and to what.
fn set(stmt: &Stmt) -> Option<(Var, &Expr)> {
    let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind else { return None };
    (stmt.site.comments.is_empty() && stmt.site.skip.is_none()).then_some((*var, value))
}

/// The variable whose sign a block asks for at its end, where it goes on if that is not below 0, and where if it is.
fn sign(block: &Block) -> Option<(Var, BlockId, BlockId)> {
    let TermKind::Branch { cond, then, otherwise } = &block.term.kind else { return None };
    let Cond::Compare(relation, Expr::Var(var), zero) = &**cond else { return None };
    let plain = block.term.site.comments.is_empty() && block.term.site.skip.is_none();
    if zero.constant() != Some(0.0) || !plain {
        return None;
    }
    match relation {
        Relation::GreaterEqual => Some((*var, *then, *otherwise)),
        Relation::Less => Some((*var, *otherwise, *then)),
        _ => None,
    }
}

/// Where a block goes on that turns the sign of a variable, and does nothing else.
fn turns(block: &Block, v: Var) -> Option<BlockId> {
    let ([stmt], TermKind::Jump(to)) = (block.stmts.as_slice(), &block.term.kind) else { return None };
    let turned = match set(stmt)?.1 {
        Expr::Negate(inner) => **inner == Expr::Var(v),
        Expr::Binary(BinOp::Mul, operands) => **operands == [Expr::Var(v), Expr::Number(-1.0)],
        _ => false,
    };
    (turned && set(stmt)?.0 == v && block.term.site.comments.is_empty()).then_some(*to)
}

/// True for a block that takes the whole part of a variable that is not negative, and does nothing else.
fn is_whole(block: &Block, v: Var) -> bool {
    let whole = Expr::Call(Func::Fix, [Expr::Var(v)].into());
    let up = Expr::binary(BinOp::Add, whole.clone(), Expr::Number(1.0));
    let down = Expr::binary(BinOp::Sub, Expr::Var(v), Expr::Number(1.0));
    let is = |stmt: &Stmt, value: &Expr| set(stmt) == Some((v, value));
    match block.stmts.as_slice() {
        [stmt] => is(stmt, &whole),
        [first, second] => is(first, &up) && is(second, &down),
        _ => false,
    }
}

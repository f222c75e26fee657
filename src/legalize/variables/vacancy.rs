//! Variables that are never vacant on the source, in registers that may be on the target.
//!
//! Law: a register that is set to 0 where it is vacant, before anything reads it, is never seen vacant;
//! what it held otherwise it keeps. On the source such a variable holds what an earlier program
//! left, or 0 when cleared, so the guard changes nothing that the source defines.
//! Counter-example without it: `X+R9` with R9 never set moves to 0 on the source; `X#509` with #509 vacant
//! is no X word at all on the target.

use crate::dialect::Question;
use crate::ir::analysis::upward_exposed::{UpwardExposed, roots};
use crate::ir::{
    Block, BlockId, Class, Cond, Expr, Module, Place, Program, Relation, SourceInfo, Stmt, StmtKind, Stmts,
    TermKind, Terminator, Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::put_first;
use thin_vec::{ThinVec, thin_vec};

/// True where there are variables, and only the target's may be vacant.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Variable)
        && !context.source.is(Question::Vacancy)
        && context.target.is(Question::Vacancy)
}

/// Puts guards at the head of every program where a run may begin.
pub fn run(module: &mut Module, _: &mut Context<'_>) {
    let upward_exposed = UpwardExposed::of(module);
    for index in roots(module) {
        let vars: Vec<Var> = upward_exposed
            .at_entry(index)
            .iter()
            .copied()
            .filter(|v| !v.class.nullable() && v.class != Class::Temp)
            .collect();
        guard(&mut module.programs[index], &vars);
    }
}

fn guard(program: &mut Program, vars: &[Var]) {
    let shift = 2 * vars.len() as u32;
    if shift == 0 {
        return;
    }
    let mut blocks = Vec::with_capacity(shift as usize);
    for (at, var) in (0..).zip(vars) {
        let (set, next) = (BlockId(2 * at + 1), BlockId(2 * at + 2));
        let cond = Cond::Compare(Relation::Equal, Expr::Var(*var), Expr::Vacant);
        let zero = StmtKind::Assign { target: Place::Var(*var), value: Expr::Number(0.0) };
        blocks
            .push(block(Stmts::new(), TermKind::Branch { cond: Box::new(cond), then: set, otherwise: next }));
        blocks.push(block(thin_vec![Stmt { kind: zero, site: SourceInfo::default() }], TermKind::Jump(next)));
    }
    put_first(program, blocks);
}

fn block(stmts: Stmts, kind: TermKind) -> Block {
    Block { labels: ThinVec::new(), stmts, term: Terminator { kind, site: SourceInfo::default() } }
}

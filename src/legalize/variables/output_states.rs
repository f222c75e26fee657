//! Outputs that the target switches by a variable alone.
//!
//! Law: a code that switches an output in a block of its own does it when the moves before are done; so does a number
//! that is written to that output, 1 or 0, after a wait where the target works out macro statements early. Side
//! conditions: the target has no code for that output, and a variable for it; nothing else stands in the block.
//! Counter-example: `G1 X5. M21`, where no source says whether the output is switched before the move.

use crate::canon::{Op, Role, Sys};
use crate::dialect::{Control, Question};
use crate::ir::{Expr, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

/// True if the library switches outputs by codes.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.op(Op::OutputOn) || features.op(Op::OutputOff)
}

/// Writes to outputs in the place of codes; true if there were any.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let target = context.target;
    let waits = target.is(Question::LookaheadRunsEarly);
    let mut changed = false;
    for block in &mut program.blocks {
        if !block.stmts.iter().any(|stmt| switched(&stmt.kind, target).is_some()) {
            continue;
        }
        changed = true;
        let mut out = Stmts::with_capacity(block.stmts.len() + 1);
        for stmt in std::mem::take(&mut block.stmts) {
            match switched(&stmt.kind, target) {
                Some((number, on)) => {
                    let site = SourceInfo { comments: Default::default(), ..stmt.site.clone() };
                    if waits {
                        out.push(Stmt { kind: StmtKind::Sync, site });
                    }
                    let place = Place::System(Sys::Output, [Expr::Number(number)].into());
                    let value = Expr::Number(f64::from(u8::from(on)));
                    let sequence = stmt.site.sequence.get().filter(|_| !waits).into();
                    let site = SourceInfo { sequence, ..stmt.site };
                    out.push(Stmt { kind: StmtKind::Assign { target: place, value }, site });
                }
                None => out.push(stmt),
            }
        }
        block.stmts = out;
    }
    changed
}

/// The output that a block switches, and whether it is on then, where the target does it by a variable.
fn switched(kind: &StmtKind, target: &Control) -> Option<(f64, bool)> {
    let nc = kind.nc()?;
    let own = |item: &NcItem| {
        matches!(item, NcItem::Op(Op::OutputOn | Op::OutputOff) | NcItem::Word(Role::Output, Expr::Number(_)))
    };
    let (on, off) = (nc.has(Op::OutputOn), nc.has(Op::OutputOff));
    if on == off || nc.items.len() != 2 || !nc.items.iter().all(own) {
        return None;
    }
    let number = nc.word(Role::Output)?.constant()?;
    let whole = crate::ir::eval::whole(number)?;
    let op = if on { Op::OutputOn } else { Op::OutputOff };
    let has_code = target.code_for(op, &BTreeMap::from([(Role::Output, number)])).is_some();
    let by_variable = [Sys::Output, Sys::OutputInverted]
        .into_iter()
        .any(|state| target.system_address(state, &[whole]).is_some());
    (by_variable && !has_code).then_some((number, on))
}

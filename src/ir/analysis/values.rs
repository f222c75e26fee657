//! Which constants a variable may hold at a place, found backwards from there.

use super::Cfg;
use super::cfg::{entries, labelled};
use super::effects::Summaries;
use crate::canon::Sys;
use crate::ir::{BlockId, Callee, Expr, Place, Program, Stmt, StmtKind, TermKind, Var};
use std::collections::BTreeSet;

/// Something that a variable may hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Constant {
    /// A number.
    Number(f64),
    /// Vacant.
    Vacant,
    /// State of the machine with constant subscripts, as it was when it was read: the motion
    /// code kept at a subprogram's head.
    State(Sys, Vec<f64>),
}

/// More than so many are as good as any.
const MOST: usize = 16;

/// More steps back than so many are not taken.
const STEPS: usize = 100_000;

/// All that `var` may hold before statement `at` of block `id` (past the last: before its
/// terminator). None where something else may reach it: what the caller left, an input, a result.
pub fn values_at(
    program: &Program,
    summaries: &Summaries,
    var: Var,
    id: BlockId,
    at: usize,
) -> Option<Vec<Constant>> {
    let cfg = Cfg::of(program);
    // Where control comes in from what the graph does not show, anything may be held.
    let mut open: BTreeSet<BlockId> = entries(program).chain([BlockId(0)]).collect();
    if summaries.come_back() {
        open.extend(labelled(program));
    }
    let mut found = Vec::new();
    let mut seen = BTreeSet::new();
    let mut work = vec![(id, at, var)];
    let mut steps = STEPS;
    while let Some((id, at, var)) = work.pop() {
        steps = steps.checked_sub(1)?;
        let stmts = &program.block(id)?.stmts;
        let held = stmts.iter().enumerate().take(at).rev().find_map(|(at, stmt)| {
            effect(stmt, var, summaries).map(|effect| (at, effect, stmt.site.skip.is_some()))
        });
        if let Some((at, effect, skipped)) = held {
            match effect {
                Effect::Constant(constant) if found.contains(&constant) => {}
                Effect::Constant(_) if found.len() == MOST => return None,
                Effect::Constant(constant) => found.push(constant),
                Effect::Copy(from) => {
                    if seen.insert((id, at, from)) {
                        work.push((id, at, from));
                    }
                }
                Effect::Unknown => return None,
            }
            // A skipped one leaves what was held before.
            if skipped {
                work.push((id, at, var));
            }
            continue;
        }
        if open.contains(&id) {
            return None;
        }
        for pred in cfg.preds(id) {
            let block = program.block(*pred)?;
            if let TermKind::Call { call, .. } = &block.term.kind
                && (matches!(call.callee, Callee::Block(_)) || summaries.by_call(call).contains(var))
            {
                return None;
            }
            if seen.insert((*pred, usize::MAX, var)) {
                work.push((*pred, usize::MAX, var));
            }
        }
    }
    Some(found)
}

/// What a statement does to a variable.
enum Effect {
    Constant(Constant),
    Copy(Var),
    Unknown,
}

fn effect(stmt: &Stmt, var: Var, summaries: &Summaries) -> Option<Effect> {
    match &stmt.kind {
        StmtKind::Assign { target: Place::Var(target), value } => (*target == var).then(|| of(value)),
        StmtKind::ClearAll(class) => (*class == var.class).then_some(Effect::Constant(Constant::Number(0.0))),
        StmtKind::Nc(nc) => summaries.by_nc(nc).contains(var).then_some(Effect::Unknown),
        kind => {
            let mut written = super::Vars::default();
            kind.target().iter().for_each(|place| written.write(place));
            written.contains(var).then_some(Effect::Unknown)
        }
    }
}

fn of(value: &Expr) -> Effect {
    match value {
        Expr::Vacant | Expr::System(Sys::Empty, _) => Effect::Constant(Constant::Vacant),
        Expr::Var(from) => Effect::Copy(*from),
        Expr::System(state, subscripts) => {
            let subscripts: Option<Vec<f64>> = subscripts.iter().map(Expr::constant).collect();
            subscripts.map_or(Effect::Unknown, |all| Effect::Constant(Constant::State(*state, all)))
        }
        value => value.constant().map_or(Effect::Unknown, |v| Effect::Constant(Constant::Number(v))),
    }
}

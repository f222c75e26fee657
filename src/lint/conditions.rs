//! Conditions: what is always so, and what asks for less than it seems to.

use super::locals::is_vacant;
use super::looked::{Findings, Looked, blocks};
use crate::diag::Code;
use crate::ir::analysis::dataflow::reached;
use crate::ir::{BlockId, Cond, Expr, Relation, TermKind, Var};

/// Vacant is compared for being less or greater, where it counts as 0.
pub(super) fn vacant_order(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, _, block) in blocks(looked.module) {
        let TermKind::Branch { cond, .. } = &block.term.kind else { continue };
        compared(cond, &mut |relation, a, b| {
            let order = !matches!(relation, Relation::Equal | Relation::NotEqual);
            if order && (is_vacant(a) || is_vacant(b)) {
                let message = "this asks whether a value is less or greater than vacant, which counts as 0 here: only \
                               a comparison for equal or not equal tells whether a variable has a value";
                findings.add(
                    looked.module.programs[at].file,
                    Code::VacantOrder,
                    block.term.site.span,
                    message,
                );
            }
        });
    }
}

/// A condition that is always so, or never.
pub(super) fn constant_condition(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, id, block) in blocks(looked.module) {
        let TermKind::Branch { cond, then, otherwise } = &block.term.kind else { continue };
        let Some(holds) = decided(cond) else { continue };
        // A loop without an end of its own is written so; another rule looks at what leaves it.
        let loops = then <= &id || otherwise <= &id || comes_back(looked, at, *then, id);
        if holds && loops {
            continue;
        }
        let message = if holds { "this condition always holds" } else { "this condition never holds" };
        findings.add(looked.module.programs[at].file, Code::ConstantCondition, block.term.site.span, message);
    }
}

fn comes_back(looked: &Looked<'_>, at: usize, from: BlockId, to: BlockId) -> bool {
    let Some(cfg) = looked.cfg(at) else { return false };
    reached([from], |id, go| cfg.succs(id).iter().for_each(|to| go(*to))).contains(&to)
}

/// Whether a condition holds, whatever its variables are; none where they decide.
fn decided(cond: &Cond) -> Option<bool> {
    match cond {
        Cond::Compare(relation, a, b) => match (a.constant(), b.constant()) {
            (Some(a), Some(b)) => Some(holds(*relation, a, b)),
            _ if a == b && matches!(a, Expr::Var(_)) => Some(holds(*relation, 0.0, 0.0)),
            _ => None,
        },
        Cond::And(all) => match all.iter().map(decided).collect::<Option<Vec<_>>>() {
            Some(all) => Some(!all.contains(&false)),
            None if all.iter().any(|cond| decided(cond) == Some(false)) || is_never(all) => Some(false),
            None => None,
        },
        Cond::Or(all) => {
            let not: Vec<Cond> = all.iter().map(|cond| cond.clone().negated()).collect();
            decided(&Cond::And(not)).map(|holds| !holds)
        }
        Cond::Not(inner) => decided(inner).map(|holds| !holds),
        Cond::Switch(_) => None,
    }
}

fn holds(relation: Relation, a: f64, b: f64) -> bool {
    match relation {
        Relation::Equal => a == b,
        Relation::NotEqual => a != b,
        Relation::Less => a < b,
        Relation::LessEqual => a <= b,
        Relation::Greater => a > b,
        Relation::GreaterEqual => a >= b,
    }
}

/// True where no value of a variable meets all of some comparisons with constants.
fn is_never(all: &[Cond]) -> bool {
    let of = |cond: &Cond| match cond {
        Cond::Compare(relation, Expr::Var(var), bound) => Some((*var, *relation, bound.constant()?)),
        Cond::Compare(relation, bound, Expr::Var(var)) => Some((*var, relation.swapped(), bound.constant()?)),
        _ => None,
    };
    let bounds: Vec<(Var, Relation, f64)> = all.iter().filter_map(of).collect();
    bounds.iter().any(|(var, ..)| {
        let mine: Vec<(Relation, f64)> = bounds
            .iter()
            .filter(|(other, ..)| other == var)
            .map(|(_, relation, bound)| (*relation, *bound))
            .collect();
        // If any value meets them, one of the bounds does, or one between two of them, or one beyond all.
        let mut tried: Vec<f64> = mine.iter().map(|(_, bound)| *bound).collect();
        tried.sort_unstable_by(f64::total_cmp);
        let between: Vec<f64> = tried.windows(2).map(|pair| pair[0] / 2.0 + pair[1] / 2.0).collect();
        let beyond = tried
            .first()
            .map(|low| low - low.abs() - 1.0)
            .into_iter()
            .chain(tried.last().map(|high| high + high.abs() + 1.0));
        let tried: Vec<f64> = beyond.chain(between).chain(tried.iter().copied()).collect();
        mine.len() > 1
            && !tried
                .iter()
                .any(|value| mine.iter().all(|(relation, bound)| holds(*relation, *value, *bound)))
    })
}

/// Visits the comparisons of a condition.
pub(super) fn compared(cond: &Cond, f: &mut dyn FnMut(Relation, &Expr, &Expr)) {
    match cond {
        Cond::Compare(relation, a, b) => f(*relation, a, b),
        Cond::And(all) | Cond::Or(all) => all.iter().for_each(|cond| compared(cond, f)),
        Cond::Not(inner) => compared(inner, f),
        Cond::Switch(_) => {}
    }
}

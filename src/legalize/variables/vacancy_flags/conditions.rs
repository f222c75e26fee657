//! Comparisons that tell vacant from 0, as questions to flags.

use crate::ir::analysis::Holds;
use crate::ir::{Cond, Expr, Relation, Var};

/// Calls `f` on what a condition tells vacant from 0.
pub(super) fn asks(cond: &Cond, may: Holds<'_, Expr>, f: &mut dyn FnMut(&Expr)) {
    match cond {
        Cond::Compare(Relation::Equal | Relation::NotEqual, a, b) => {
            for (one, other) in [(a, b), (b, a)] {
                if may(one) && tells(other) {
                    f(one);
                }
            }
        }
        Cond::And(parts) | Cond::Or(parts) => parts.iter().for_each(|part| asks(part, may, f)),
        Cond::Not(inner) => asks(inner, may, f),
        Cond::Compare(..) | Cond::Switch(_) => {}
    }
}

/// True if what is vacant compares with this otherwise than 0 does: nothing equals 5 but 5.
fn tells(other: &Expr) -> bool {
    other.constant().is_none_or(|value| value == 0.0)
}

/// The same condition for variables that are 0 while they are vacant; `flag` gives the flag of what may be vacant.
pub(super) fn rewritten(cond: Cond, flag: &dyn Fn(&Expr) -> Option<Var>) -> Cond {
    let all = |parts: Vec<Cond>| parts.into_iter().map(|part| rewritten(part, flag)).collect();
    match cond {
        Cond::And(parts) => joined(all(parts), false, Cond::And),
        Cond::Or(parts) => joined(all(parts), true, Cond::Or),
        Cond::Not(inner) => {
            let inner = rewritten(*inner, flag);
            settled(&inner).map_or_else(|| Cond::Not(Box::new(inner)), |holds| always(!holds))
        }
        Cond::Compare(relation @ (Relation::Equal | Relation::NotEqual), a, b) => {
            let equal = relation == Relation::Equal;
            compare(equal, a, b, flag).unwrap_or_else(|(a, b)| Cond::Compare(relation, a, b))
        }
        other => other,
    }
}

/// A comparison for equality, or for the opposite; both sides again if no flag has a say.
fn compare(equal: bool, a: Expr, b: Expr, flag: &dyn Fn(&Expr) -> Option<Var>) -> Result<Cond, (Expr, Expr)> {
    let number = |relation, var: Var| Cond::Compare(relation, Expr::Var(var), Expr::Number(0.0));
    let has = |var| number(Relation::Greater, var);
    let has_not = |var| number(Relation::LessEqual, var);
    match (&a, &b) {
        (Expr::Vacant, Expr::Vacant) => return Ok(always(equal)),
        (Expr::Vacant, other) | (other, Expr::Vacant) => {
            return Ok(match flag(other) {
                Some(var) if equal => has_not(var),
                Some(var) => has(var),
                // It is never vacant here.
                None => always(!equal),
            });
        }
        _ => {}
    }
    let flags = [flag(&a).filter(|_| tells(&b)), flag(&b).filter(|_| tells(&a))];
    let relation = if equal { Relation::Equal } else { Relation::NotEqual };
    let first = match flags {
        [None, None] => return Err((a, b)),
        [Some(one), Some(other)] => Cond::Compare(relation, Expr::Var(one), Expr::Var(other)),
        [Some(one), None] | [None, Some(one)] => {
            if equal {
                has(one)
            } else {
                has_not(one)
            }
        }
    };
    let parts = vec![Cond::Compare(relation, a, b), first];
    Ok(if equal { Cond::And(parts) } else { Cond::Or(parts) })
}

/// Parts of which one decides by itself where it `decides`, without those that have no say.
fn joined(mut parts: Vec<Cond>, decides: bool, join: fn(Vec<Cond>) -> Cond) -> Cond {
    let decided = parts.iter().any(|part| settled(part) == Some(decides));
    if decided && !parts.iter().any(Cond::may_alarm) {
        return always(decides);
    }
    parts.retain(|part| settled(part) != Some(!decides));
    match parts.len() {
        0 => always(!decides),
        1 => parts.swap_remove(0),
        _ => join(parts),
    }
}

/// Whether a condition holds that [`always`] made.
pub(super) fn settled(cond: &Cond) -> Option<bool> {
    [true, false].into_iter().find(|holds| *cond == always(*holds))
}

fn always(holds: bool) -> Cond {
    let relation = if holds { Relation::Equal } else { Relation::NotEqual };
    Cond::Compare(relation, Expr::Number(0.0), Expr::Number(0.0))
}

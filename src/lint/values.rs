//! Comparisons for equal of what arithmetic came to.

use super::conditions::compared;
use super::locals::is_vacant;
use super::looked::{Findings, Looked, blocks};
use crate::canon::{Func, Sys};
use crate::diag::Code;
use crate::dialect::Question;
use crate::ir::{BinOp, Class, Expr, Place, Relation, StmtKind, TermKind, Var};
use std::collections::BTreeMap;

/// How exact a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Exact {
    /// A whole number, or vacant.
    Whole,
    /// As somebody wrote it.
    Written,
    /// What arithmetic with fractions came to, or a measured place.
    Computed,
}

/// A variable; a local is one of its program.
type Key = (Option<usize>, Var);

fn key(program: usize, var: Var) -> Key {
    ((!var.class.shared()).then_some(program), var)
}

/// How exact variables are, by all assignments and arguments of the library. What nothing sets is as somebody wrote it.
fn exactness(looked: &Looked<'_>) -> BTreeMap<Key, Exact> {
    let mut sets: Vec<(Key, usize, &Expr)> = Vec::new();
    for (at, _, block) in blocks(looked.module) {
        for stmt in &block.stmts {
            if let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind {
                sets.push((key(at, *var), at, value));
            }
        }
    }
    for site in looked.sites() {
        let Some(callee) = site.callee.filter(|_| site.call.level) else { continue };
        for argument in &site.call.arguments {
            let var = Var { class: Class::Local, number: argument.local };
            sets.push((key(callee, var), site.program, &argument.value));
        }
    }
    let mut known: BTreeMap<Key, Exact> = BTreeMap::new();
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (key, program, value) in &sets {
            let value = exact(value, &|var| self::key(*program, var), &known);
            let mine = known.entry(*key).or_insert(Exact::Whole);
            changed |= *mine < value;
            *mine = (*mine).max(value);
        }
    }
    known
}

fn exact(e: &Expr, key: &dyn Fn(Var) -> Key, known: &BTreeMap<Key, Exact>) -> Exact {
    match e {
        Expr::Number(n) if n.fract() == 0.0 => Exact::Whole,
        Expr::Vacant | Expr::Truth(_) => Exact::Whole,
        Expr::Var(var) => known.get(&key(*var)).copied().unwrap_or(Exact::Written),
        Expr::Negate(a) => exact(a, key, known),
        Expr::Binary(BinOp::Mod | BinOp::And | BinOp::Or | BinOp::Xor, _) => Exact::Whole,
        Expr::Binary(BinOp::Div, _) => Exact::Computed,
        // What nobody computed may be whole: it is not accused.
        Expr::Binary(_, operands) => {
            let [a, b] = [&operands[0], &operands[1]].map(|operand| exact(operand, key, known));
            let fraction = |e: &Expr| e.constant().is_some_and(|n| n.fract() != 0.0);
            match a.max(b) {
                Exact::Written if operands.iter().any(fraction) => Exact::Computed,
                other => other,
            }
        }
        Expr::Call(Func::Fix | Func::Fup | Func::Round | Func::Bin | Func::Bcd | Func::Sign, _) => {
            Exact::Whole
        }
        Expr::Call(Func::Abs | Func::RoundPlaces | Func::RoundIncrement, all) => {
            all.first().map_or(Exact::Whole, |a| exact(a, key, known))
        }
        Expr::Call(Func::Parameter, _) => Exact::Written,
        Expr::Call(..) => Exact::Computed,
        Expr::System(state, _) if is_measured(*state) => Exact::Computed,
        _ => Exact::Written,
    }
}

/// True for a place of an axis or a time: no two are quite the same.
fn is_measured(state: Sys) -> bool {
    use Sys::*;
    matches!(
        state,
        EndPosition
            | MachinePosition
            | WorkPosition
            | SkipPosition
            | ProbePoint
            | AxisPosition
            | TimerHours
            | Analog
    )
}

/// A computed value is compared for being the same as another.
pub(super) fn equal_computed(looked: &Looked<'_>, findings: &mut Findings) {
    if looked.control.number(Question::EqualTolerance).is_some_and(|tolerance| tolerance > 0.0) {
        return;
    }
    let mut known = None;
    for (at, _, block) in blocks(looked.module) {
        let TermKind::Branch { cond, .. } = &block.term.kind else { continue };
        compared(cond, &mut |relation, a, b| {
            let same = matches!(relation, Relation::Equal | Relation::NotEqual);
            if !same || is_vacant(a) || is_vacant(b) {
                return;
            }
            let known = known.get_or_insert_with(|| exactness(looked));
            let key = |var| key(at, var);
            let values = [a, b].map(|e| exact(e, &key, known));
            if values.contains(&Exact::Computed) {
                let message =
                    "a computed value is compared for being exactly the same: the last digit decides";
                let file = looked.module.programs[at].file;
                findings.add(file, Code::EqualComputed, block.term.site.span, message);
            }
        });
    }
}

//! Comparisons for equal of what arithmetic came to.
//!
//! How exact a variable is, is asked at a place: of the values that it may have got on the ways that lead there, in the
//! program, in what it calls, and where it is called. What nothing sets there is as somebody wrote it.

use super::conditions::compared;
use super::locals::is_vacant;
use super::looked::{Findings, Looked, blocks};
use crate::canon::{Func, Sys};
use crate::diag::Code;
use crate::dialect::Question;
use crate::ir::{BinOp, BlockId, Callee, Class, Expr, Place, Relation, StmtKind, TermKind, Var};
use std::collections::{BTreeMap, BTreeSet};

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

/// Before a statement of a block of a program; past the last, before its end.
type At = (usize, BlockId, usize);

/// How many variables deep an answer is looked for.
const DEPTH: usize = 40;

struct Exactness<'l, 'a> {
    looked: &'l Looked<'a>,
    /// Where each variable is set.
    sets: BTreeMap<(usize, Var), Vec<At>>,
    /// Blocks that lead to each block, by program.
    before: BTreeMap<usize, BTreeMap<BlockId, Vec<BlockId>>>,
    /// Answers; while one is looked for, that it adds nothing.
    found: BTreeMap<(At, Var), Exact>,
    /// Blocks and calls that may still be looked at.
    left: usize,
}

/// Blocks and calls that are looked at in a library; past them nothing is accused.
const MOST: usize = 1 << 20;

impl<'l, 'a> Exactness<'l, 'a> {
    fn new(looked: &'l Looked<'a>) -> Self {
        let mut sets: BTreeMap<(usize, Var), Vec<At>> = BTreeMap::new();
        for (program, id, block) in blocks(looked.module) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                if let Some(Place::Var(var)) = stmt.kind.target() {
                    sets.entry((program, *var)).or_default().push((program, id, at));
                }
            }
        }
        Self { looked, sets, before: BTreeMap::new(), found: BTreeMap::new(), left: MOST }
    }

    fn spend(&mut self, steps: usize) -> bool {
        let rest = self.left.checked_sub(steps);
        self.left = rest.unwrap_or_default();
        rest.is_some()
    }

    fn value(&mut self, place: At, e: &Expr, depth: usize) -> Exact {
        match e {
            Expr::Number(n) if n.fract() == 0.0 => Exact::Whole,
            Expr::Vacant | Expr::Truth(_) => Exact::Whole,
            Expr::Var(var) => self.var(place, *var, depth),
            Expr::Negate(a) => self.value(place, a, depth),
            Expr::Binary(BinOp::Mod | BinOp::And | BinOp::Or | BinOp::Xor, _) => Exact::Whole,
            Expr::Binary(BinOp::Div, _) => Exact::Computed,
            Expr::Binary(_, operands) => {
                let fraction = |e: &Expr| e.constant().is_some_and(|n| n.fract() != 0.0);
                let (a, b) = (&operands[0], &operands[1]);
                match self.value(place, a, depth).max(self.value(place, b, depth)) {
                    // What nobody computed may be whole: it is not accused.
                    Exact::Written if fraction(a) || fraction(b) => Exact::Computed,
                    other => other,
                }
            }
            Expr::Call(Func::Fix | Func::Fup | Func::Round | Func::Bin | Func::Bcd | Func::Sign, _) => {
                Exact::Whole
            }
            Expr::Call(Func::Abs | Func::RoundPlaces | Func::RoundIncrement, all) => {
                all.first().map_or(Exact::Whole, |a| self.value(place, a, depth))
            }
            Expr::Call(Func::Parameter, _) => Exact::Written,
            Expr::Call(..) => Exact::Computed,
            Expr::System(state, _) if is_measured(*state) => Exact::Computed,
            _ => Exact::Written,
        }
    }

    fn var(&mut self, place: At, var: Var, depth: usize) -> Exact {
        if depth >= DEPTH {
            return Exact::Written;
        }
        if let Some(found) = self.found.get(&(place, var)) {
            return *found;
        }
        self.found.insert((place, var), Exact::Whole);
        let exact = self.on_ways(place, var, depth + 1);
        self.found.insert((place, var), exact);
        exact
    }

    /// Goes back from a place to what set the variable.
    fn on_ways(&mut self, (program, start, at): At, var: Var, depth: usize) -> Exact {
        let looked = self.looked;
        let Some(body) = looked.module.programs.get(program) else { return Exact::Written };
        let mut exact = Exact::Whole;
        let (mut seen, mut work) = (BTreeSet::new(), vec![(start, at)]);
        'ways: while let Some((id, end)) = work.pop() {
            let Some(block) = body.block(id).filter(|_| self.spend(1)) else { continue };
            for (at, stmt) in block.stmts.iter().enumerate().take(end).rev() {
                if stmt.kind.target() != Some(&Place::Var(var)) {
                    continue;
                }
                exact = exact.max(match &stmt.kind {
                    StmtKind::Assign { value, .. } => self.value((program, id, at), value, depth),
                    _ => Exact::Written,
                });
                if stmt.site.skip.is_none() {
                    continue 'ways;
                }
            }
            if id == BlockId(0) {
                exact = exact.max(self.entered(program, var, depth));
            }
            let before = self.before.entry(program).or_insert_with(|| {
                let mut before: BTreeMap<BlockId, Vec<BlockId>> = BTreeMap::new();
                for (id, block) in body.ids().zip(&body.blocks) {
                    block
                        .term
                        .kind
                        .successors()
                        .into_iter()
                        .for_each(|to| before.entry(to).or_default().push(id));
                }
                before
            });
            for from in before.get(&id).cloned().unwrap_or_default() {
                let Some(block) = body.block(from) else { continue };
                if let TermKind::Call { call, .. } = &block.term.kind {
                    exact = exact.max(self.called(program, &call.callee, call.level, var, depth));
                }
                if seen.insert(from) {
                    work.push((from, block.stmts.len()));
                }
            }
            if exact == Exact::Computed {
                break;
            }
        }
        exact
    }

    /// What a call may leave in a variable.
    fn called(&mut self, program: usize, callee: &Callee, level: bool, var: Var, depth: usize) -> Exact {
        let program = match callee {
            Callee::Block(_) => program,
            Callee::Program(name) if !(level && var.class == Class::Local) => {
                match self.looked.program_of(name) {
                    Some(callee) => callee,
                    None => return Exact::Whole,
                }
            }
            _ => return Exact::Whole,
        };
        let sets = self.sets.get(&(program, var)).cloned().unwrap_or_default();
        let mut exact = Exact::Whole;
        for (program, id, at) in sets {
            let stmt =
                self.looked.module.programs.get(program).and_then(|program| program.block(id)?.stmts.get(at));
            if let Some(StmtKind::Assign { value, .. }) = stmt.map(|stmt| &stmt.kind) {
                exact = exact.max(self.value((program, id, at), value, depth));
            }
        }
        exact
    }

    /// What a program is entered with.
    fn entered(&mut self, program: usize, var: Var, depth: usize) -> Exact {
        let looked = self.looked;
        let mut exact = Exact::Written;
        if !self.spend(looked.sites().len()) {
            return exact;
        }
        for site in looked.sites().iter().filter(|site| site.callee == Some(program)) {
            let end =
                looked.module.programs[site.program].block(site.block).map_or(0, |block| block.stmts.len());
            let place = (site.program, site.block, end);
            exact = exact.max(if site.call.level && var.class == Class::Local {
                let given = site.call.arguments.iter().find(|argument| argument.local == var.number);
                given.map_or(Exact::Whole, |given| self.value(place, &given.value, depth))
            } else {
                self.var(place, var, depth)
            });
        }
        exact
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
    let mut exactness = None;
    for (at, id, block) in blocks(looked.module) {
        let TermKind::Branch { cond, .. } = &block.term.kind else { continue };
        compared(cond, &mut |relation, a, b| {
            let same = matches!(relation, Relation::Equal | Relation::NotEqual);
            if !same || is_vacant(a) || is_vacant(b) {
                return;
            }
            let exactness = exactness.get_or_insert_with(|| Exactness::new(looked));
            let place = (at, id, block.stmts.len());
            if [a, b].map(|e| exactness.value(place, e, 0)).contains(&Exact::Computed) {
                let message =
                    "a computed value is compared for being exactly the same: the last digit decides";
                let file = looked.module.programs[at].file;
                findings.add(file, Code::EqualComputed, block.term.site.span, message);
            }
        });
    }
}

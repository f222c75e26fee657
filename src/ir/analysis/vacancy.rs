//! Which variables may be vacant where.
//!
//! At a program's entry every variable of a nullable class may be vacant, but for those stated
//! to be assigned (arguments that every call gives). Arithmetic never yields vacant; copies do
//! where what they copy may be. A comparison with vacant settles it on each of its ways.

use super::effects::{Seen, Summaries};
use super::{Cfg, Row, Universe, VarSet};
use crate::canon::Sys;
use crate::ir::{
    Bank, BlockId, Callee, Class, Cond, Expr, Place, Program, Relation, Stmt, StmtKind, TermKind, Var,
};
use std::collections::{BTreeSet, VecDeque};

/// What may be vacant in one program.
#[derive(Clone, Debug)]
pub struct Vacancy<'p> {
    program: &'p Program,
    summaries: &'p Summaries,
    universe: Universe,
    /// What may be vacant at the start of each block; none where control does not come.
    before: Vec<Option<Row>>,
}

impl<'p> Vacancy<'p> {
    /// Computes it. `assigned` are never vacant at the entry.
    pub fn of(program: &'p Program, summaries: &'p Summaries, assigned: &BTreeSet<Var>) -> Self {
        let mut vars = VarSet::default();
        program.variables(&mut |var| {
            if var.class.nullable() {
                vars.insert(var);
            }
        });
        for block in &program.blocks {
            // The arguments of a level are locals of the body that it enters.
            if let TermKind::Call { call, .. } = &block.term.kind {
                vars.extend(call.arguments.iter().map(|a| Var { class: Class::Local, number: a.local }));
            }
        }
        let cfg = Cfg::whole(program, summaries.come_back());
        let universe = Universe::new(vars.iter().collect());
        let mut out = Self { program, summaries, universe, before: vec![None; cfg.len()] };
        out.solve(&cfg, assigned);
        out
    }

    fn solve(&mut self, cfg: &Cfg, assigned: &BTreeSet<Var>) {
        let mut entry = self.universe.all();
        assigned.iter().filter_map(|var| self.universe.place(*var)).for_each(|at| entry.remove(at));
        let mut work = VecDeque::new();
        let mut waiting = vec![false; cfg.len()];
        for root in cfg.roots() {
            // A body that a modal call enters is entered with anything.
            let called = *root != BlockId(0) && cfg.preds(*root).is_empty();
            if *root == BlockId(0) || called || self.is_modal(*root) {
                let row = if *root == BlockId(0) { entry.clone() } else { self.universe.all() };
                self.flow(*root, &row);
                work.push_back(*root);
            }
        }
        while let Some(id) = work.pop_front() {
            waiting[id.index()] = false;
            let Some(mut row) = self.before.get(id.index()).cloned().flatten() else { continue };
            if let Some(block) = self.program.block(id) {
                block.stmts.iter().for_each(|stmt| self.stmt(stmt, &mut row));
            }
            for to in cfg.succs(id) {
                let mut row = row.clone();
                self.edge(id, *to, &mut row);
                if self.flow(*to, &row) && !std::mem::replace(&mut waiting[to.index()], true) {
                    work.push_back(*to);
                }
            }
        }
    }

    fn flow(&mut self, to: BlockId, row: &Row) -> bool {
        match self.before.get_mut(to.index()) {
            Some(Some(before)) => before.join(row),
            Some(empty) => {
                *empty = Some(row.clone());
                true
            }
            None => false,
        }
    }

    fn is_modal(&self, id: BlockId) -> bool {
        self.program
            .blocks
            .iter()
            .flat_map(|block| &block.stmts)
            .any(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if call.callee == Callee::Block(id)))
    }

    fn stmt(&self, stmt: &Stmt, row: &mut Row) {
        let sure = stmt.site.skip.is_none();
        match &stmt.kind {
            StmtKind::Assign { target, value } => {
                let vacant = self.yields_vacant(value, row);
                self.write(target, vacant, sure, row);
            }
            // What the operator gives is a number.
            StmtKind::Input { target, .. } => self.write(target, false, sure, row),
            StmtKind::ClearAll(class) if sure => row.subtract(&self.universe.classes(|c| c == *class)),
            StmtKind::Nc(nc) => self.disturb(self.summaries.by_nc(nc).into(), row),
            _ => {}
        }
    }

    fn write(&self, target: &Place, vacant: bool, sure: bool, row: &mut Row) {
        match target {
            Place::Var(var) => {
                let Some(at) = self.universe.place(*var) else { return };
                if vacant {
                    row.insert(at);
                } else if sure {
                    row.remove(at);
                }
            }
            Place::Indirect(Bank::Numbered, _) if vacant => {
                row.join(&self.universe.all());
            }
            Place::Indirect(..) | Place::System(..) => {}
        }
    }

    /// What is written out of sight may be vacant.
    fn disturb(&self, written: Seen<'_>, row: &mut Row) {
        if written.is_empty() {
            return;
        }
        self.universe
            .vars()
            .iter()
            .enumerate()
            .filter(|(_, var)| written.contains(**var))
            .for_each(|(at, _)| row.insert(at));
    }

    /// What the terminator of `from` does on the way to `to`.
    fn edge(&self, from: BlockId, to: BlockId, row: &mut Row) {
        let locals = || self.universe.classes(|class| class == Class::Local);
        let Some(block) = self.program.block(from) else {
            // Behind returns: the locals of a level that ended are not those of its caller.
            row.join(&locals());
            return;
        };
        match &block.term.kind {
            TermKind::Branch { cond, yes, no } if yes != no => self.refine(cond, to == *yes, row),
            TermKind::Call { call, next } => match call.callee {
                Callee::Block(entry) if to == entry && to != *next && call.level => {
                    let outer = row.clone();
                    row.join(&locals());
                    for argument in &call.arguments {
                        let var = Var { class: Class::Local, number: argument.local };
                        let vacant = self.yields_vacant(&argument.value, &outer);
                        self.write(&Place::Var(var), vacant, true, row);
                    }
                }
                Callee::Block(_) => {
                    if to == *next {
                        self.disturb(self.summaries.by_call(call), row);
                    }
                }
                _ => self.disturb(self.summaries.by_call(call), row),
            },
            _ => {}
        }
    }

    fn refine(&self, cond: &Cond, holds: bool, row: &mut Row) {
        match (cond, holds) {
            (Cond::Not(inner), _) => self.refine(inner, !holds, row),
            (Cond::And(all), true) | (Cond::Or(all), false) => {
                all.iter().for_each(|cond| self.refine(cond, holds, row));
            }
            (
                Cond::Compare(relation, Expr::Var(var), other)
                | Cond::Compare(relation, other, Expr::Var(var)),
                _,
            ) => {
                let differs = match relation {
                    Relation::Equal => !holds,
                    Relation::NotEqual => holds,
                    _ => return,
                };
                // Not vacant: unlike vacant, or like something that never is.
                let settled = if differs { is_vacant(other) } else { !self.yields_vacant(other, row) };
                if let Some(at) = self.universe.place(*var).filter(|_| settled) {
                    row.remove(at);
                }
            }
            _ => {}
        }
    }

    fn yields_vacant(&self, e: &Expr, row: &Row) -> bool {
        match e {
            Expr::Var(var) if var.class.nullable() => self.universe.place(*var).is_none_or(|at| row.has(at)),
            e => e.may_be_vacant(),
        }
    }

    /// True where the variable may be vacant before statement `at` of a block (past the last:
    /// before its terminator). False where control does not come.
    pub fn may_be_vacant(&self, id: BlockId, at: usize, var: Var) -> bool {
        self.may_yield_vacant(id, at, &Expr::Var(var))
    }

    /// True where the expression may yield vacant there.
    pub fn may_yield_vacant(&self, id: BlockId, at: usize, e: &Expr) -> bool {
        let Some(Some(before)) = self.before.get(id.index()) else { return false };
        let mut row = before.clone();
        let stmts = self.program.block(id).into_iter().flat_map(|block| &block.stmts);
        stmts.take(at).for_each(|stmt| self.stmt(stmt, &mut row));
        self.yields_vacant(e, &row)
    }

    /// Calls `f` before each statement of a block, and with the number of statements before its
    /// terminator, with what may yield vacant there.
    pub fn forward(&self, id: BlockId, f: &mut dyn FnMut(usize, super::Holds<'_, Expr>)) {
        let Some(Some(before)) = self.before.get(id.index()) else { return };
        let (Some(block), mut row) = (self.program.block(id), before.clone()) else { return };
        for (at, stmt) in block.stmts.iter().enumerate() {
            f(at, &|e| self.yields_vacant(e, &row));
            self.stmt(stmt, &mut row);
        }
        f(block.stmts.len(), &|e| self.yields_vacant(e, &row));
    }
}

fn is_vacant(e: &Expr) -> bool {
    matches!(e, Expr::Vacant | Expr::System(Sys::Empty, _))
}

//! Where locals may have no value, as far as the text of a program and of what it calls shows.
//!
//! Law: a local that is not among those that may be unset has got a value on every way there. A program that is called
//! with the locals of its caller is taken to set whatever it may write: a result is no fault.

use super::locals::is_vacant;
use super::looked::Looked;
use crate::ir::analysis::dataflow::{Analysis, Direction, Steps, reached_among, solve};
use crate::ir::analysis::{BitRow, Cfg, Holds, Universe, Vars, own_call};
use crate::ir::{
    Bank, Block, BlockId, Callee, Class, Cond, Expr, Place, Program, Stmt, StmtKind, TermKind, Var,
};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

struct Rules<'r> {
    looked: &'r Looked<'r>,
    program: &'r Program,
    universe: Universe,
    /// What the parts of the program that calls enter are entered with.
    entered: BTreeMap<BlockId, BitRow>,
    /// What those parts set, with what they call.
    sets: BTreeMap<BlockId, BTreeSet<Var>>,
}

impl Analysis for Rules<'_> {
    type State = BitRow;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, BitRow)> {
        let parts = self.entered.iter().map(|(id, row)| (*id, row.clone()));
        parts.chain([(BlockId(0), self.universe.all())]).collect()
    }

    fn block(&self, id: BlockId, block: &Block, row: &mut BitRow) {
        self.stmts(id, block, row);
        match &block.term.kind {
            TermKind::Call { call, .. } if call.level => {}
            TermKind::Call { call, .. } => match call.callee {
                Callee::Block(entry) => {
                    self.set(row, |var| self.sets.get(&entry).is_some_and(|sets| sets.contains(&var)));
                }
                _ => self.set(row, |var| self.looked.summaries().by_call(call).contains(var)),
            },
            _ => {}
        }
    }

    fn edge<'s>(&self, from: BlockId, to: BlockId, row: &'s BitRow) -> Option<Cow<'s, BitRow>> {
        match self.program.block(from).map(|block| &block.term.kind) {
            Some(TermKind::Branch { cond, then, otherwise }) if then != otherwise => {
                let mut row = row.clone();
                self.refine(cond, to == *then, &mut row);
                Some(Cow::Owned(row))
            }
            _ => Some(Cow::Borrowed(row)),
        }
    }
}

impl Steps for Rules<'_> {
    fn stmt(&self, _: (BlockId, usize), stmt: &Stmt, row: &mut BitRow) {
        match (&stmt.kind, stmt.kind.target()) {
            (StmtKind::Nc(nc), _) => {
                let written: &Vars = self.looked.summaries().by_nc(nc);
                self.set(row, |var| written.contains(var));
            }
            (kind, Some(Place::Var(var))) => {
                let Some(at) = self.universe.place(*var) else { return };
                let unset = matches!(kind, StmtKind::Assign { value, .. } if self.is_unset(value, row));
                if unset {
                    row.insert(at);
                } else if stmt.site.skip.is_none() {
                    row.remove(at);
                }
            }
            _ => {}
        }
    }
}

impl Rules<'_> {
    fn set(&self, row: &mut BitRow, which: impl Fn(Var) -> bool) {
        let all = self.universe.vars().iter().enumerate();
        all.filter(|(_, var)| which(**var)).for_each(|(at, _)| row.remove(at));
    }

    fn is_unset(&self, e: &Expr, row: &BitRow) -> bool {
        match e {
            Expr::Var(var) => self.universe.place(*var).is_some_and(|at| row.has(at)),
            e => is_vacant(e),
        }
    }

    /// What a comparison for equal says of a variable on one of its ways.
    fn refine(&self, cond: &Cond, holds: bool, row: &mut BitRow) {
        cond.likened(holds, &mut |var, other, differs| {
            let settled = if differs { is_vacant(other) } else { !self.is_unset(other, row) };
            if let Some(at) = self.universe.place(var).filter(|_| settled) {
                row.remove(at);
            }
        });
    }
}

/// Calls of parts times blocks up to which a program is looked at.
const MOST: usize = 1 << 22;

/// So deep calls within a program are followed.
const PARTS_DEEP: usize = 16;

/// What each part that calls of its own program enter sets, with what it calls there.
fn sets(program: &Program) -> BTreeMap<BlockId, BTreeSet<Var>> {
    let entries: BTreeSet<BlockId> =
        program.blocks.iter().filter_map(own_call).map(|(entry, ..)| entry).collect();
    let sets = |entry: BlockId| {
        let seen = reached_among(program.blocks.len(), [entry.index()], |at, go| {
            let Some(block) = program.blocks.get(at) else { return };
            block.term.kind.successors().into_iter().for_each(|to| go(to.index()));
            own_call(block).into_iter().for_each(|(entry, ..)| go(entry.index()));
        });
        let blocks = program.blocks.iter().zip(seen).filter(|(_, seen)| *seen).map(|(block, _)| block);
        let targets = blocks.flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.target());
        targets.filter_map(|place| if let Place::Var(var) = place { Some(*var) } else { None }).collect()
    };
    entries.into_iter().map(|entry| (entry, sets(entry))).collect()
}

/// Visits each statement that a run may come to, and with the number of statements the end of each block, with the
/// locals that may have no value there. A program that sets variables by computed numbers is not visited.
pub(super) fn visit(
    looked: &Looked<'_>,
    program: &Program,
    f: &mut dyn FnMut(&Block, usize, Holds<'_, Var>),
) {
    let mut locals = Vec::new();
    program.variables(&mut |var| {
        if var.class == Class::Local {
            locals.push(var);
        }
    });
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let computes = |place: &Place| matches!(place, Place::Indirect(Bank::Numbered, _));
    if locals.is_empty() || stmts.into_iter().any(|stmt| stmt.kind.target().is_some_and(computes)) {
        return;
    }
    let parts = program.blocks.iter().filter_map(own_call).count();
    if parts.saturating_mul(program.blocks.len()) > MOST {
        return;
    }
    let universe = Universe::new(locals);
    let mut rules = Rules { looked, program, universe, entered: BTreeMap::new(), sets: sets(program) };
    let cfg = Cfg::of(program);
    let mut states = solve(&rules, program, &cfg);
    // A part is entered with what its calls have, those in other parts too.
    for _ in 0..PARTS_DEEP {
        let mut changed = false;
        for (id, block) in program.ids().zip(&program.blocks) {
            let (Some((entry, ..)), Some(mut row)) = (own_call(block), states.at(id).cloned()) else {
                continue;
            };
            rules.stmts(id, block, &mut row);
            match rules.entered.get_mut(&entry) {
                Some(before) => changed |= before.join(&row),
                None => {
                    rules.entered.insert(entry, row);
                    changed = true;
                }
            }
        }
        if !changed {
            break;
        }
        states = solve(&rules, program, &cfg);
    }
    let unset = |row: &BitRow, var: Var| rules.universe.place(var).is_some_and(|at| row.has(at));
    for (id, block) in program.ids().zip(&program.blocks) {
        let Some(mut row) = states.at(id).cloned() else { continue };
        rules.each(id, block, &mut row, &mut |at, row| f(block, at, &|var| unset(row, *var)));
        f(block, block.stmts.len(), &|var| unset(&row, *var));
    }
}

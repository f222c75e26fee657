//! Which temporaries are live: may be read before they are written.
//!
//! Nothing outside a program sees its temporaries, so no call reads them but one of a body in the program itself.

use super::effects::moves_values;
use super::{Cfg, Row, Universe, may_come_back};
use crate::ir::{Block, BlockId, Callee, Class, Expr, Module, Place, Program, Site, StmtKind, TermKind, Var};
use std::collections::VecDeque;

/// What the programs of a library do to one another's ways.
#[derive(Clone, Copy, Debug)]
pub struct Ways {
    /// True where a call may come back at a label of its caller; see [`may_come_back`].
    come_back: bool,
    /// True where a modal call runs a body of its own program, which any NC block may enter.
    modal_body: bool,
}

impl Ways {
    /// Of a library.
    pub fn of(module: &Module) -> Self {
        Self { come_back: may_come_back(module), modal_body: module.programs.iter().any(has_modal_body) }
    }
}

/// Liveness of the temporaries of one program.
#[derive(Clone, Debug)]
pub struct Liveness<'p> {
    program: &'p Program,
    ways: Ways,
    universe: Universe,
    /// Live at the start of each block, those two of [`Cfg::whole`] included.
    before: Vec<Row>,
    /// What each block reads before it writes it, and what passes it.
    transfers: Vec<(Row, Row)>,
    cfg: Cfg,
    /// True where a modal call runs a body of the program, whose return may go behind any NC block.
    modal_body: bool,
}

impl<'p> Liveness<'p> {
    /// Computes it.
    pub fn of(program: &'p Program, ways: Ways) -> Self {
        let universe = temporaries(program);
        let cfg = Cfg::whole(program, ways.come_back);
        let modal_body = has_modal_body(program);
        let before = vec![universe.none(); cfg.len()];
        let mut live = Self { program, ways, universe, before, transfers: Vec::new(), cfg, modal_body };
        // Without temporaries there is nothing to find.
        if !live.universe.vars().is_empty() {
            live.transfers = program.blocks.iter().map(|block| live.transfer(block)).collect();
            live.solve();
        }
        live
    }

    fn solve(&mut self) {
        let count = self.cfg.len();
        // Blocks that the entry does not reach are answered for too: they may be kept.
        let mut work: VecDeque<BlockId> = (0..count as u32).rev().map(BlockId).collect();
        let mut waiting = vec![true; count];
        while let Some(id) = work.pop_front() {
            waiting[id.index()] = false;
            let mut row = self.after(id);
            if let Some((reads, passes)) = self.transfers.get(id.index()) {
                row.intersect(passes);
                row.join(reads);
            }
            if self.before[id.index()].join(&row) {
                for pred in self.cfg.preds(id) {
                    if !std::mem::replace(&mut waiting[pred.index()], true) {
                        work.push_back(*pred);
                    }
                }
            }
        }
    }

    /// What a block makes of what is live behind it: of nothing, and of everything.
    fn transfer(&self, block: &Block) -> (Row, Row) {
        let mut rows = [self.universe.none(), self.universe.all()];
        self.term(&block.term.kind, &mut rows);
        block.stmts.iter().rev().for_each(|stmt| self.stmt(&stmt.kind, &stmt.site, &mut rows));
        rows.into()
    }

    /// Live behind a block's terminator.
    fn after(&self, id: BlockId) -> Row {
        let returns = matches!(self.program.block(id), Some(block) if matches!(block.term.kind, TermKind::Return { .. }));
        if returns && self.modal_body {
            return self.universe.all();
        }
        let mut row = self.universe.none();
        self.cfg.succs(id).iter().for_each(|to| {
            row.join(&self.before[to.index()]);
        });
        row
    }

    fn term(&self, kind: &TermKind, rows: &mut [Row]) {
        kind.exprs(&mut |e| self.read(e, rows));
    }

    fn stmt(&self, kind: &StmtKind, site: &Site, rows: &mut [Row]) {
        // What the operator may switch off writes nothing for sure.
        if let Some(Place::Var(var)) = kind.target()
            && site.skip.is_none()
            && let Some(at) = self.universe.place(*var)
        {
            rows.iter_mut().for_each(|row| row.remove(at));
        }
        if let StmtKind::Nc(nc) = kind
            && (self.ways.modal_body || moves_values(nc))
        {
            rows.fill(self.universe.all());
        }
        kind.exprs(&mut |e| self.read(e, rows));
    }

    fn read(&self, e: &Expr, rows: &mut [Row]) {
        e.variables(&mut |var| {
            if let Some(at) = self.universe.place(var) {
                rows.iter_mut().for_each(|row| row.insert(at));
            }
        });
    }

    /// The temporaries live at the start of a block.
    pub fn before(&self, id: BlockId) -> impl Iterator<Item = Var> + '_ {
        self.before.get(id.index()).into_iter().flat_map(|row| self.universe.members(row))
    }

    /// Calls `f` on each statement of a block, last first, with what is live behind it.
    pub fn backward(&self, id: BlockId, f: &mut dyn FnMut(usize, super::Holds<'_, Var>)) {
        let Some(Block { stmts, term, .. }) = self.program.block(id) else { return };
        let mut rows = [self.after(id)];
        self.term(&term.kind, &mut rows);
        for (at, stmt) in stmts.iter().enumerate().rev() {
            f(at, &|var: &Var| self.universe.place(*var).is_some_and(|place| rows[0].has(place)));
            self.stmt(&stmt.kind, &stmt.site, &mut rows);
        }
    }
}

/// The temporaries that a program names.
fn temporaries(program: &Program) -> Universe {
    let mut all = Vec::new();
    program.variables(&mut |var| {
        if var.class == Class::Temp {
            all.push(var);
        }
    });
    Universe::new(all)
}

fn has_modal_body(program: &Program) -> bool {
    program.blocks.iter().flat_map(|block| &block.stmts).any(
        |stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if matches!(call.callee, Callee::Block(_))),
    )
}

//! Which temporaries are live: may be read before they are written.
//!
//! Nothing outside a program sees its temporaries, so no call reads them but one of a body in the program itself.

use super::effects::moves_values;
use super::{Cfg, Temps, may_come_back};
use crate::ir::{Block, BlockId, Callee, Class, Expr, Module, Place, Program, Stmt, StmtKind, TermKind, Var};
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
    /// Live at the start of each block, those two of [`Cfg::whole`] included.
    before: Vec<Temps>,
    /// What each block does to what is live behind it.
    transfers: Vec<Transfer>,
    cfg: Cfg,
    /// True where a modal call runs a body of the program, whose return may go behind any NC block.
    modal_body: bool,
}

/// What a block does to what is live behind it.
#[derive(Clone, Debug)]
struct Transfer {
    /// Live before it, if nothing were behind it.
    reads: Temps,
    /// What it surely writes.
    writes: Temps,
    /// True where all are live somewhere in it, whatever is behind it.
    fills: bool,
}

impl<'p> Liveness<'p> {
    /// Computes it.
    pub fn of(program: &'p Program, ways: Ways) -> Self {
        let cfg = Cfg::whole(program, ways.come_back);
        let modal_body = has_modal_body(program);
        let before = vec![Temps::default(); cfg.len()];
        let mut live = Self { program, ways, before, transfers: Vec::new(), cfg, modal_body };
        live.transfers = program.blocks.iter().map(|block| live.transfer(block)).collect();
        live.solve();
        live
    }

    fn solve(&mut self) {
        let count = self.cfg.len();
        // Blocks that the entry does not reach are answered for too: they may be kept.
        let mut work: VecDeque<BlockId> = (0..count as u32).rev().map(BlockId).collect();
        let mut waiting = vec![true; count];
        while let Some(id) = work.pop_front() {
            waiting[id.index()] = false;
            let live = match self.transfers.get(id.index()) {
                Some(transfer) if transfer.fills => transfer.reads.clone(),
                Some(transfer) => {
                    let mut live = self.after(id);
                    live.subtract(&transfer.writes);
                    live.join(&transfer.reads);
                    live
                }
                None => self.after(id),
            };
            if self.before[id.index()].join(&live) {
                for pred in self.cfg.preds(id) {
                    if !std::mem::replace(&mut waiting[pred.index()], true) {
                        work.push_back(*pred);
                    }
                }
            }
        }
    }

    fn transfer(&self, block: &Block) -> Transfer {
        let (mut reads, mut writes, mut fills) = (Temps::default(), Temps::default(), false);
        read_by_term(&block.term.kind, &mut reads);
        for stmt in block.stmts.iter().rev() {
            self.stmt(stmt, &mut reads);
            fills |= self.fills(&stmt.kind);
            sure(stmt).into_iter().for_each(|temp| writes.insert(temp));
        }
        Transfer { reads, writes, fills }
    }

    /// Live behind a block's terminator.
    fn after(&self, id: BlockId) -> Temps {
        let returns = matches!(self.program.block(id), Some(block) if matches!(block.term.kind, TermKind::Return { .. }));
        if returns && self.modal_body {
            return Temps::all();
        }
        let mut live = Temps::default();
        self.cfg.succs(id).iter().for_each(|to| {
            live.join(&self.before[to.index()]);
        });
        live
    }

    /// Before a statement, of what is live behind it.
    fn stmt(&self, stmt: &Stmt, live: &mut Temps) {
        sure(stmt).into_iter().for_each(|temp| live.remove(temp));
        if self.fills(&stmt.kind) {
            *live = Temps::all();
        }
        stmt.kind.exprs(&mut |e| read(e, live));
    }

    /// True where all are live before the statement.
    fn fills(&self, kind: &StmtKind) -> bool {
        matches!(kind, StmtKind::Nc(nc) if self.ways.modal_body || moves_values(nc))
    }

    /// True where a temporary is live at the start of a block.
    pub fn is_live_before(&self, id: BlockId, temp: Var) -> bool {
        self.before.get(id.index()).is_some_and(|live| temp.class == Class::Temp && live.has(temp.number))
    }

    /// Calls `f` on each statement of a block, last first, with what is live behind it.
    pub fn backward(&self, id: BlockId, f: &mut dyn FnMut(usize, super::Holds<'_, Var>)) {
        let Some(Block { stmts, term, .. }) = self.program.block(id) else { return };
        let mut live = self.after(id);
        read_by_term(&term.kind, &mut live);
        for (at, stmt) in stmts.iter().enumerate().rev() {
            f(at, &|var: &Var| var.class == Class::Temp && live.has(var.number));
            self.stmt(stmt, &mut live);
        }
    }
}

/// The temporary that a statement writes: what the operator may switch off writes nothing for sure.
fn sure(stmt: &Stmt) -> Option<u32> {
    match stmt.kind.target() {
        Some(Place::Var(var)) if var.class == Class::Temp && stmt.site.skip.is_none() => Some(var.number),
        _ => None,
    }
}

fn read_by_term(kind: &TermKind, live: &mut Temps) {
    kind.exprs(&mut |e| read(e, live));
}

fn read(e: &Expr, live: &mut Temps) {
    e.variables(&mut |var| {
        if var.class == Class::Temp {
            live.insert(var.number);
        }
    });
}

fn has_modal_body(program: &Program) -> bool {
    program.blocks.iter().flat_map(|block| &block.stmts).any(
        |stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if matches!(call.callee, Callee::Block(_))),
    )
}

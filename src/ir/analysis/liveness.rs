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
    pub come_back: bool,
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
    cfg: Cfg,
    /// True where a modal call runs a body of the program, whose return may go behind any NC block.
    modal_body: bool,
}

/// What a block does to what is live behind it.
#[derive(Clone, Debug, Default)]
pub struct Transfer {
    /// Live before it, if nothing were behind it.
    pub reads: Temps,
    /// What it surely writes.
    pub writes: Temps,
    /// True where what is live behind it has no say.
    pub fills: bool,
}

/// What is live at the start of each block of a graph; a block without a transfer does nothing.
///
/// Only where something is live is anything done: temporaries live for a few blocks of many.
pub fn live_before(cfg: &Cfg, transfers: &[Transfer]) -> Vec<Temps> {
    let mut before = vec![Temps::default(); cfg.len()];
    // Blocks that the entry does not reach are answered for too: they may be kept.
    let mut work: VecDeque<BlockId> = VecDeque::new();
    let mut waiting = vec![false; cfg.len()];
    let look = |id: BlockId, work: &mut VecDeque<BlockId>, waiting: &mut [bool]| {
        for pred in cfg.preds(id) {
            if !std::mem::replace(&mut waiting[pred.index()], true) {
                work.push_back(*pred);
            }
        }
    };
    for (at, transfer) in
        transfers.iter().enumerate().rev().filter(|(_, transfer)| !transfer.reads.is_empty())
    {
        before[at] = transfer.reads.clone();
        look(BlockId(at as u32), &mut work, &mut waiting);
    }
    while let Some(id) = work.pop_front() {
        waiting[id.index()] = false;
        let transfer = transfers.get(id.index());
        if transfer.is_some_and(|transfer| transfer.fills) {
            continue;
        }
        let mut live = behind(cfg, id, &before);
        transfer.iter().for_each(|transfer| live.subtract(&transfer.writes));
        if before[id.index()].join(&live) {
            look(id, &mut work, &mut waiting);
        }
    }
    before
}

/// What is live where a block ends.
pub fn behind(cfg: &Cfg, id: BlockId, before: &[Temps]) -> Temps {
    let mut live = Temps::default();
    for there in cfg.succs(id).iter().map(|to| &before[to.index()]).filter(|there| !there.is_empty()) {
        live.join(there);
    }
    live
}

impl<'p> Liveness<'p> {
    /// Computes it.
    pub fn of(program: &'p Program, ways: Ways) -> Self {
        let modal_body = has_modal_body(program);
        let cfg = Cfg::whole(program, ways.come_back);
        let mut live = Self { program, ways, before: Vec::new(), cfg, modal_body };
        let transfers: Vec<Transfer> = program.blocks.iter().map(|block| live.transfer(block)).collect();
        live.before = live_before(&live.cfg, &transfers);
        live
    }

    fn transfer(&self, block: &Block) -> Transfer {
        let mut transfer = Transfer { fills: self.returns_anywhere(block), ..Transfer::default() };
        if transfer.fills {
            transfer.reads = Temps::all();
        }
        read_by_term(&block.term.kind, &mut transfer.reads);
        for stmt in block.stmts.iter().rev() {
            self.stmt(stmt, &mut transfer.reads);
            transfer.fills |= self.fills(&stmt.kind);
            sure(stmt).into_iter().for_each(|temp| transfer.writes.insert(temp));
        }
        transfer
    }

    /// True for a block whose return may go behind any NC block.
    fn returns_anywhere(&self, block: &Block) -> bool {
        self.modal_body && matches!(block.term.kind, TermKind::Return { .. })
    }

    /// Live behind a block's terminator.
    fn after(&self, id: BlockId) -> Temps {
        if self.program.block(id).is_some_and(|block| self.returns_anywhere(block)) {
            return Temps::all();
        }
        behind(&self.cfg, id, &self.before)
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

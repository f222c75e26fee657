//! Which temporaries are live: may be read before they are written.
//!
//! Nothing outside a program sees its temporaries, so no call reads them but one of a body in the program itself.

use super::dataflow::{Analysis, Direction, Lattice, States, solve};
use super::effects::moves_values;
use super::{Cfg, Temps, may_come_back};
use crate::ir::{Block, BlockId, Callee, Class, Expr, Module, Place, Program, Stmt, StmtKind, TermKind, Var};
use std::borrow::Cow;

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
    rules: Rules,
    /// Live at the end of each block, those that [`Cfg::whole`] puts past the last one included.
    ends: States<Temps>,
}

/// What a block does to what is live after it.
#[derive(Clone, Debug, Default)]
pub struct Transfer {
    /// Live before it, if nothing were after it.
    pub reads: Temps,
    /// What it surely writes.
    pub writes: Temps,
    /// True where what is live after it has no say.
    pub fills: bool,
}

impl Lattice for Temps {
    fn join(&mut self, other: &Self) -> bool {
        Temps::join(self, other)
    }
}

/// Blocks by their transfers.
struct Transfers<'t>(&'t [Transfer]);

impl Analysis for Transfers<'_> {
    type State = Temps;
    const DIRECTION: Direction = Direction::Backward;
    const AS_THEY_STAND: bool = true;

    /// Only where something is read is anything done: temporaries live for a few blocks of many. Blocks that the entry
    /// does not reach are answered for too: they may be kept.
    fn entries(&self, _: &Cfg) -> Vec<(BlockId, Temps)> {
        let reads = self.0.iter().enumerate().filter(|(_, transfer)| !transfer.reads.is_empty());
        reads.map(|(at, _)| (BlockId(at as u32), Temps::default())).collect()
    }

    fn block(&self, id: BlockId, _: &Block, live: &mut Temps) {
        let Some(transfer) = self.0.get(id.index()) else { return };
        if transfer.fills {
            *live = Temps::default();
        }
        live.subtract(&transfer.writes);
        live.join(&transfer.reads);
    }

    fn edge<'s>(&self, _: BlockId, _: BlockId, live: &'s Temps) -> Option<Cow<'s, Temps>> {
        (!live.is_empty()).then_some(Cow::Borrowed(live))
    }
}

/// What is live at the end of each block of a program, by what its blocks do, and the ways between them. Most programs
/// read each temporary in the block that writes it: then nothing is live at any end, and their ways are not asked for.
pub fn live_after(program: &Program, cfg: impl FnOnce() -> Cfg, transfers: &[Transfer]) -> States<Temps> {
    if transfers.iter().all(|transfer| transfer.reads.is_empty()) {
        return States::default();
    }
    solve(&Transfers(transfers), program, &cfg())
}

/// What statements and ends of blocks do to what is live.
#[derive(Clone, Debug)]
struct Rules {
    ways: Ways,
    /// True where a modal call runs a body of the program, whose return may go to after any NC block.
    modal_body: bool,
}

impl Rules {
    fn transfer(&self, block: &Block) -> Transfer {
        let mut transfer = Transfer { fills: self.returns_anywhere(block), ..Transfer::default() };
        self.end(block, &mut transfer.reads);
        for stmt in block.stmts.iter().rev() {
            self.stmt(stmt, &mut transfer.reads);
            transfer.fills |= self.fills(&stmt.kind);
            sure(stmt).into_iter().for_each(|temp| transfer.writes.insert(temp));
        }
        transfer
    }

    /// True for a block whose return may go to after any NC block.
    fn returns_anywhere(&self, block: &Block) -> bool {
        self.modal_body && matches!(block.term.kind, TermKind::Return { .. })
    }

    /// Before a block's terminator, of what is live after it.
    fn end(&self, block: &Block, live: &mut Temps) {
        if self.returns_anywhere(block) {
            *live = Temps::all();
        }
        block.term.kind.exprs(&mut |e| read(e, live));
    }

    /// Before a statement, of what is live after it.
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
}

impl<'p> Liveness<'p> {
    /// Computes it.
    pub fn of(program: &'p Program, ways: Ways) -> Self {
        let rules = Rules { ways, modal_body: has_modal_body(program) };
        let transfers: Vec<Transfer> = program.blocks.iter().map(|block| rules.transfer(block)).collect();
        let ends = live_after(program, || Cfg::whole(program, ways.come_back), &transfers);
        Self { program, rules, ends }
    }

    /// Calls `f` on each statement of a block, last first, with what is live after it.
    pub fn backward(&self, id: BlockId, f: &mut dyn FnMut(usize, super::Holds<'_, Var>)) {
        let Some(block) = self.program.block(id) else { return };
        let mut live = self.ends.at(id).cloned().unwrap_or_default();
        self.rules.end(block, &mut live);
        for (at, stmt) in block.stmts.iter().enumerate().rev() {
            f(at, &|var: &Var| var.class == Class::Temp && live.has(var.number));
            self.rules.stmt(stmt, &mut live);
        }
    }

    /// True where a temporary is live at the start of a block.
    #[cfg(test)]
    pub fn is_live_before(&self, id: BlockId, temp: Var) -> bool {
        let Some(block) = self.program.block(id) else { return false };
        let mut live = self.ends.at(id).cloned().unwrap_or_default();
        self.rules.end(block, &mut live);
        block.stmts.iter().rev().for_each(|stmt| self.rules.stmt(stmt, &mut live));
        temp.class == Class::Temp && live.has(temp.number)
    }
}

/// The temporary that a statement writes: what the operator may switch off writes nothing for sure.
fn sure(stmt: &Stmt) -> Option<u32> {
    match stmt.kind.target() {
        Some(Place::Var(var)) if var.class == Class::Temp && stmt.site.skip.is_none() => Some(var.number),
        _ => None,
    }
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

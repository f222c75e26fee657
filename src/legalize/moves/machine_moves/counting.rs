//! Whether anything counts from a work offset before one is selected.

use crate::canon::{Op, Sys};
use crate::ir::{Block, BlockId, Callee, Expr, Module, Place, Stmt, StmtKind, TermKind};
use crate::syntax::ProgramName;
use std::collections::BTreeMap;

/// By program and block: true if, from the start of the block, something may count from the offset that is in force.
pub struct Counting {
    names: BTreeMap<ProgramName, usize>,
    blocks: Vec<Vec<bool>>,
}

/// Looks at all programs until nothing changes. A loop that goes round for ever counts nothing.
pub fn of(module: &Module) -> Counting {
    let names =
        module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at))).collect();
    let blocks = module.programs.iter().map(|program| vec![false; program.blocks.len()]).collect();
    let mut all = Counting { names, blocks };
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (index, program) in module.programs.iter().enumerate() {
            for (id, Block { stmts, term, .. }) in program.ids().zip(&program.blocks) {
                let counts = all.after(index, stmts, &term.kind);
                let known = all.blocks.get_mut(index).and_then(|blocks| blocks.get_mut(id.0 as usize));
                changed |= known.is_some_and(|known| std::mem::replace(known, counts) != counts);
            }
        }
    }
    all
}

impl Counting {
    /// True if something counts from the offset that is in force before these statements of a program, or after them.
    pub fn after(&self, index: usize, stmts: &[Stmt], end: &TermKind) -> bool {
        for stmt in stmts {
            let reads = looks(|look| stmt.kind.exprs(look));
            if stmt.site.skip.is_some() || reads {
                return true;
            }
            match &stmt.kind {
                StmtKind::Nc(nc) if nc.has(Op::SelectWork) || nc.has(Op::MachineOnce) => return false,
                StmtKind::Nc(nc) if nc.names_axis() => return true,
                StmtKind::Nc(_) | StmtKind::Comment => {}
                StmtKind::Assign { target: Place::Var(_) | Place::System(Sys::WorkOffset, _), .. } => {}
                _ => return true,
            }
        }
        if looks(|look| end.exprs(look)) {
            return true;
        }
        let at = |index: usize, id: BlockId| {
            self.blocks.get(index).and_then(|blocks| blocks.get(id.0 as usize)).copied().unwrap_or(true)
        };
        match end {
            TermKind::End { .. } => false,
            TermKind::Jump(next) => at(index, *next),
            TermKind::Branch { then, otherwise, .. } => at(index, *then) || at(index, *otherwise),
            // What returns without a selection counts: its `return` does.
            TermKind::Call { call, .. } => match &call.callee {
                Callee::Program(name) => self.names.get(name).is_none_or(|callee| at(*callee, BlockId(0))),
                Callee::Block(entry) => at(index, *entry),
                _ => true,
            },
            _ => true,
        }
    }
}

/// True if state of the machine is read, which may be a position.
fn looks(shown: impl FnOnce(&mut dyn FnMut(&Expr))) -> bool {
    let mut found = false;
    shown(&mut |e| e.walk(&mut |e| found |= matches!(e, Expr::System(..))));
    found
}

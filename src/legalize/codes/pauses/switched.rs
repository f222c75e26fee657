//! What a block skip alone started: it runs where the operator's switch is off, and stands where it is on.

use super::{ends, starts};
use crate::canon::{Op, Running};
use crate::ir::Stmt;
use crate::legalize::Modal;

/// The code that started each, with the level of its block skip, where nothing else started or ended it since in this block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Switched([Option<(Op, u8)>; 2]);

impl Switched {
    /// Takes a statement; `before` is what is in force before it.
    pub fn step(&mut self, stmt: &Stmt, before: &Modal) {
        let Some(nc) = stmt.kind.nc() else { return };
        for running in Running::ALL {
            let (group, _) = ends(running);
            let Some(op) = nc.ops().filter(|op| op.group() == group).last() else { continue };
            let stands = before.op(group).is_some_and(|op| !starts(running).contains(&op));
            let started = stmt.site.skip.filter(|_| stands && starts(running).contains(&op));
            self.0[running as usize] = started.map(|level| (op, level));
        }
    }

    /// The code and the level of its block skip.
    pub fn of(&self, running: Running) -> Option<(Op, u8)> {
        self.0[running as usize]
    }
}

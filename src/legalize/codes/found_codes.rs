//! Codes that a program may have found in force where it reads a modal group.
//!
//! Law: where every way from the start of a run to the reading has a code of the group, what is read is a code of the library. One
//! that no program of it writes is none of them. Side condition: all calls are known. Counter-example: a main program
//! that reads `#4001` before its first motion code, which another program left in force.

use crate::canon::{Group, Op, Sys};
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Callee, Expr, Module, Nc, NcItem, Stmt, StmtKind, TermKind};
use crate::legalize::calls_of;
use std::collections::BTreeSet;

/// The groups that programs read after a code of the library in any case, and the codes that it writes.
pub(super) struct FoundCodes {
    /// By program and group.
    known: BTreeSet<(usize, Group)>,
    /// The G codes of these groups, as operations.
    written: BTreeSet<Op>,
}

impl FoundCodes {
    /// Looks through a library.
    pub(super) fn of(module: &Module) -> Self {
        let mut read: BTreeSet<(usize, Group)> = BTreeSet::new();
        for (index, program) in module.programs.iter().enumerate() {
            let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
            read.extend(stmts.filter_map(reads).map(|group| (index, group)));
        }
        let mut known = BTreeSet::new();
        if !read.is_empty() && is_closed(module) {
            let groups: BTreeSet<Group> = read.iter().map(|(_, group)| *group).collect();
            for group in groups {
                let late = from_outside(module, group);
                let sure = |(index, of): &&(usize, Group)| *of == group && !late.contains(index);
                known.extend(read.iter().filter(sure).copied());
            }
        }
        let all = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
        let written = all.filter_map(|stmt| stmt.kind.nc()).flat_map(|nc| nc.ops()).collect();
        Self { known, written }
    }

    /// True if a program may find this operation in force where it reads the group.
    pub(super) fn may_find(&self, program: usize, op: Op) -> bool {
        !self.known.contains(&(program, op.group())) || self.written.contains(&op)
    }
}

/// The group that a statement reads, where it keeps what it reads.
fn reads(stmt: &Stmt) -> Option<Group> {
    let StmtKind::Assign { value: Expr::System(Sys::Modal, subscripts), .. } = &stmt.kind else {
        return None;
    };
    let number = subscripts.first()?.constant()?;
    Group::ALL.iter().copied().find(|group| group.number().is_some_and(|n| f64::from(n) == number))
}

/// True where every call is of a program of the library, at the place where it stands.
fn is_closed(module: &Module) -> bool {
    let names: BTreeSet<_> = module.programs.iter().filter_map(|program| program.name.as_ref()).collect();
    let blocks = || module.programs.iter().flat_map(|program| &program.blocks);
    let known = |callee: &Callee| match callee {
        Callee::Block(_) => true,
        Callee::Program(name) => names.contains(name),
        Callee::Computed(_) | Callee::Cycle(_) => false,
    };
    let modal = |stmt: &Stmt| matches!(stmt.kind, StmtKind::ModalCall(_));
    let comes_back = |block: &Block| matches!(block.term.kind, TermKind::Return { to: Some(_) });
    blocks().flat_map(calls_of).all(|call| known(&call.callee))
        && !blocks().any(|block| comes_back(block) || block.stmts.iter().any(modal))
}

/// The programs that may read a group before the library wrote a code of it.
fn from_outside(module: &Module, group: Group) -> BTreeSet<usize> {
    let follow = Outside(group);
    let states = OverCalls::of(module, &follow);
    let mut found = BTreeSet::new();
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut outside = states.at(index, id).copied().unwrap_or(true);
            for stmt in &block.stmts {
                if outside && reads(stmt) == Some(group) {
                    found.insert(index);
                }
                follow.step(stmt, &mut outside);
            }
        }
    }
    found
}

/// Whether what is in force of a group may come from before the run.
struct Outside(Group);

impl Outside {
    fn step(&self, stmt: &Stmt, outside: &mut bool) {
        let writes =
            |nc: &Nc| nc.items.iter().any(|item| matches!(item, NcItem::Op(op) if op.group() == self.0));
        *outside &= stmt.site.skip.is_some() || !stmt.kind.nc().is_some_and(writes);
    }
}

impl Follow for Outside {
    type Known = bool;

    fn outside(&self, _: usize) -> bool {
        true
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, outside: &mut bool) {
        block.stmts.iter().for_each(|stmt| self.step(stmt, outside));
    }

    fn lose(&self, outside: &mut bool) {
        *outside = true;
    }
}

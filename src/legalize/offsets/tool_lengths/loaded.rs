//! The tools that programs are run with.

use super::number;
use crate::canon::{Op, Role};
use crate::ir::analysis::dataflow::reached;
use crate::ir::{Callee, Module, Nc, Stmt, TermKind};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// By program: the tool of one that takes up the length of one alone, and changes to none, what it calls included; none for
/// one that is `called`.
pub(super) fn of(module: &Module, called: &[bool]) -> Vec<Option<u32>> {
    let programs = &module.programs;
    let names: BTreeMap<&ProgramName, usize> =
        programs.iter().enumerate().filter_map(|(at, program)| Some((program.name.as_ref()?, at))).collect();
    let stmts = |at: usize| programs[at].blocks.iter().flat_map(|block| &block.stmts);
    let own: Vec<Own> = (0..programs.len()).map(|at| Own::of(stmts(at))).collect();
    let callees = |index: usize, on: &mut dyn FnMut(usize)| {
        for block in &programs[index].blocks {
            let callee = match &block.term.kind {
                TermKind::Call { call, .. } => match &call.callee {
                    Callee::Program(name) => names.get(name),
                    _ => None,
                },
                TermKind::Chain(name) => names.get(name),
                _ => None,
            };
            callee.copied().into_iter().for_each(&mut *on);
        }
    };
    let one = |(index, called): (usize, &bool)| {
        if *called || own[index].changes {
            return None;
        }
        let runs = reached([index], callees);
        if runs.iter().any(|index| own[*index].changes) {
            return None;
        }
        let rows: BTreeSet<u32> = runs.iter().flat_map(|index| own[*index].rows.iter().copied()).collect();
        let mut rows = rows.into_iter();
        rows.next().filter(|_| rows.next().is_none())
    };
    called.iter().enumerate().map(one).collect()
}

/// What a program says of tools by itself.
struct Own {
    /// True where it names a tool, or a length by a computed number.
    changes: bool,
    /// The lengths that it takes up.
    rows: BTreeSet<u32>,
}

impl Own {
    fn of<'s>(stmts: impl Iterator<Item = &'s Stmt>) -> Self {
        let mut own = Self { changes: false, rows: BTreeSet::new() };
        let names = |nc: &Nc| nc.has(Op::ToolChange) || nc.word(Role::Tool).is_some();
        for nc in stmts.filter_map(|stmt| stmt.kind.nc()) {
            own.changes |= names(nc);
            if let Some(row) = nc.word(Role::LengthOffset) {
                match number(row) {
                    Some(row) => own.rows.extend(Some(row).filter(|row| *row > 0)),
                    None => own.changes = true,
                }
            }
        }
        own
    }
}

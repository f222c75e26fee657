//! Locals that one run of a macro leaves for the next one under the same modal call.

use crate::ir::analysis::Cfg;
use crate::ir::{Block, Callee, Class, Expr, Module, Place, Program, TermKind, Var};
use crate::syntax::ProgramName;
use std::collections::BTreeSet;

/// Numbers of locals.
type Locals = BTreeSet<u32>;

/// A local that a macro may read before it writes it, and writes; none where each run begins alike. A macro that is
/// not in the library has none: a diagnostic of its own speaks of it.
pub fn local(module: &Module, name: &ProgramName) -> Option<u32> {
    let program = find(module, name)?;
    let mut written = Locals::new();
    // What shares the level: subprograms, whatever they call at the same level, and where they return to.
    let mut shared = BTreeSet::from([name]);
    let mut work = vec![program];
    while let Some(one) = work.pop() {
        written.extend(one.blocks.iter().flat_map(writes));
        for block in &one.blocks {
            if let TermKind::Call { call, .. } = &block.term.kind
                && let Callee::Program(name) = &call.callee
                && !call.level
                && shared.insert(name)
            {
                work.extend(find(module, name));
            }
        }
    }
    let of_others = shared.iter().filter(|other| **other != name).filter_map(|other| find(module, other));
    let mut read: Locals = of_others.flat_map(|other| other.blocks.iter().flat_map(reads)).collect();
    read.extend(early(program));
    read.intersection(&written).next().copied()
}

/// True where a local of a program may be set in it, or in what runs at its level.
pub fn sets(program: &Program, local: Var) -> bool {
    let calls = |block: &Block| matches!(&block.term.kind, TermKind::Call { call, .. } if !call.level);
    program.blocks.iter().any(|block| calls(block) || writes(block).contains(&local.number))
}

fn find<'m>(module: &'m Module, name: &ProgramName) -> Option<&'m Program> {
    module.programs.iter().find(|program| program.name.as_ref() == Some(name))
}

/// What a program may read before it wrote it.
fn early(program: &Program) -> Locals {
    let cfg = Cfg::of(program);
    let all: Locals = program.blocks.iter().flat_map(writes).collect();
    // What is written on every way to a block; at first, all.
    let mut sure = vec![all; program.blocks.len()];
    if let Some(entry) = sure.first_mut() {
        entry.clear();
    }
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut behind = sure[id.index()].clone();
            behind.extend(writes(block));
            for to in cfg.succs(id) {
                if let Some(there) = sure.get_mut(to.index()) {
                    let before = there.len();
                    there.retain(|local| behind.contains(local));
                    changed |= there.len() != before;
                }
            }
        }
    }
    let mut found = Locals::new();
    for (block, mut sure) in program.blocks.iter().zip(sure) {
        let mut look =
            |e: &Expr, sure: &Locals| found.extend(locals(e).into_iter().filter(|l| !sure.contains(l)));
        for stmt in &block.stmts {
            stmt.kind.exprs(&mut |e| look(e, &sure));
            sure.extend(stmt.kind.target().and_then(written));
        }
        block.term.kind.exprs(&mut |e| look(e, &sure));
    }
    found
}

fn written(place: &Place) -> Option<u32> {
    match place {
        Place::Var(Var { class: Class::Local, number }) => Some(*number),
        _ => None,
    }
}

fn writes(block: &Block) -> Locals {
    block.stmts.iter().filter_map(|stmt| stmt.kind.target().and_then(written)).collect()
}

fn reads(block: &Block) -> Locals {
    let mut out = Locals::new();
    let mut look = |e: &Expr| out.extend(locals(e));
    block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
    block.term.kind.exprs(&mut look);
    out
}

fn locals(e: &Expr) -> Locals {
    let mut out = Locals::new();
    e.variables(&mut |var| {
        if var.class == Class::Local {
            out.insert(var.number);
        }
    });
    out
}

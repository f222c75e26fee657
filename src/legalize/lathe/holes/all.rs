//! What holds of all holes of a program.

use super::drills;
use super::waits::names_offset;
use crate::canon::{Group, Op, Role};
use crate::ir::{Expr, Module, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::{Context, Modal, calls_of};

/// What holds of all holes of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct All {
    /// The waits that are told, each once.
    pub dwells: Vec<Expr>,
    /// The pecks.
    pub pecks: Vec<Expr>,
    /// True where some hole has no peck.
    pub without_peck: bool,
    /// True where a letter that lasts across codes as the wait may have been told by another code.
    pub other_waits: bool,
    /// True where nothing of the library turns the spindle.
    pub stands: bool,
    /// True where all calls of the library stop the spindle before, and the program says nothing of it.
    pub is_stopped: bool,
}

/// Looks at all holes of a program.
pub(super) fn all(program: &Program, states: &[Modal]) -> All {
    let mut all = All::default();
    let keep = |list: &mut Vec<Expr>, value: Option<&Expr>| {
        if let Some(value) = value.filter(|value| !list.contains(value)) {
            list.push(value.clone());
        }
    };
    for (block, state) in program.blocks.iter().zip(states) {
        let mut state = state.clone();
        for stmt in &block.stmts {
            state.step(stmt);
            let Some(nc) = stmt.kind.nc() else { continue };
            all.other_waits |= names_offset(nc);
            if drills(nc, &state).is_some() {
                keep(&mut all.dwells, nc.word(Role::CycleDwell));
                keep(&mut all.pecks, nc.word(Role::CycleQ));
                all.without_peck |= nc.word(Role::CycleQ).is_none();
            }
        }
    }
    all.dwells.retain(|dwell| dwell.constant() != Some(0.0));
    all
}

/// By program: true where the library calls it, each time after a stop of the spindle, and neither it nor what it calls says anything of one.
pub(super) fn stopped(module: &Module, context: &mut Context<'_>) -> Vec<bool> {
    let (facts, called) = (context.modal_facts(module), context.called(module));
    let says = |program: &Program| {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let quiet = |stmt: &Stmt| match &stmt.kind {
            StmtKind::Nc(nc) => nc.items.iter().all(|item| match item {
                NcItem::Op(op) => op.group() != Group::Spindle,
                NcItem::Code(..) => false,
                NcItem::Word(..) => true,
            }),
            StmtKind::ModalCall(_) => false,
            _ => true,
        };
        !stmts.all(quiet) || program.blocks.iter().any(|block| calls_of(block).next().is_some())
    };
    let mut all = vec![None; module.programs.len()];
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            block.stmts.iter().for_each(|stmt| state.step(stmt));
            let by_call = matches!(block.term.kind, TermKind::Call { .. });
            let stops = by_call && state.op(Group::Spindle) == Some(Op::SpindleStop);
            for callee in calls_of(block).flat_map(|call| called.by((index, id), call)) {
                if let Some(held) = all.get_mut(*callee) {
                    *held = Some(held.unwrap_or(true) && stops);
                }
            }
        }
    }
    all.iter().zip(&module.programs).map(|(held, program)| *held == Some(true) && !says(program)).collect()
}

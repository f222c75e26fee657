//! Macro lines in a row, on a control that is said to stop after some without a move.
//!
//! Law: nothing is changed. A loop without a block of words may run any number of macro lines in a row, so it is for review;
//! so is a row of statements that is longer by itself. Counter-example: a loop over the bits of a number.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::Cfg;
use crate::ir::{Block, BlockId, Module, Program, StmtKind, TermKind};
use crate::legalize::Context;
use crate::text::Span;

/// The limit of the table.
const ROW: &str = "macro.lines";

/// Reports loops without a move.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some(most) = context.target.limit(ROW) else { return };
    for (index, program) in module.programs.iter().enumerate() {
        if let Some(span) = loop_without_move(program) {
            let what = format!(
                "this loop makes no move; a report says that the control stops after {most} macro lines in a row \
                 without one: try it, and put a move or a dwell into it if it stops"
            );
            context.add_once(index, "macro lines", Diagnostic::new(Code::Conditional, span, what));
        }
    }
}

/// Where a loop is that passes no block of words and no call.
fn loop_without_move(program: &Program) -> Option<Span> {
    let cfg = Cfg::of(program);
    let count = program.blocks.len();
    let mut kept: Vec<bool> = program.blocks.iter().map(|block| !moves(block)).collect();
    // What no kept block goes to, or goes to none, is on no such loop.
    let mut left: Vec<[usize; 2]> = vec![[0; 2]; count];
    for (at, _) in kept.iter().enumerate().filter(|(_, kept)| **kept) {
        for to in cfg.succs(BlockId(at as u32)).iter().filter(|to| kept.get(to.index()) == Some(&true)) {
            left[at][1] += 1;
            left[to.index()][0] += 1;
        }
    }
    let mut gone: Vec<usize> = (0..count).filter(|at| kept[*at] && left[*at].contains(&0)).collect();
    while let Some(at) = gone.pop() {
        if !std::mem::replace(&mut kept[at], false) {
            continue;
        }
        let id = BlockId(at as u32);
        for (side, near) in [(0, cfg.succs(id)), (1, cfg.preds(id))] {
            for other in
                near.iter().map(|other| other.index()).filter(|other| kept.get(*other) == Some(&true))
            {
                left[other][side] = left[other][side].saturating_sub(1);
                if left[other][side] == 0 {
                    gone.push(other);
                }
            }
        }
    }
    let (block, _) = program.blocks.iter().zip(&kept).find(|(_, kept)| **kept)?;
    let mut spans = block.stmts.iter().map(|stmt| stmt.site.span).chain([block.term.site.span]);
    Some(spans.find(|span| !span.is_empty()).unwrap_or(program.site.span))
}

/// True where the control has something to do but macro lines.
fn moves(block: &Block) -> bool {
    matches!(block.term.kind, TermKind::Call { .. })
        || block.stmts.iter().any(|stmt| match &stmt.kind {
            StmtKind::Nc(nc) => !nc.items.is_empty(),
            StmtKind::Input { .. } | StmtKind::StopMessage { .. } | StmtKind::Alarm { .. } => true,
            _ => false,
        })
}

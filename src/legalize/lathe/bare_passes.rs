//! Codes of turning passes without a word (`G90` in a line of safe codes, from a mill's habit).
//!
//! Law: a pass needs a place; its code alone moves nothing, and whatever says how to move after it ends it. So the code falls away where that
//! comes on every way before a word of an axis. If the pass of an earlier block may be in force there, `G0` stands in its place: what
//! stands alone after it must not make that pass once more. Side condition: nothing between reads the codes in force, calls, returns or
//! ends the run. Counter-example: `G90`, and `X50. Z-20.` in the next block.

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

/// True where there are passes, and the other control may do otherwise while one is in force.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(Op::is_pass) && context.source.name() != context.target.name()
}

/// Leaves such codes out; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let any = |program: &Program| program.blocks.iter().flat_map(|block| &block.stmts).any(is_bare);
    if !module.programs.iter().any(any) {
        return false;
    }
    let facts = context.modal_facts(module);
    let passes = OverCalls::of(module, &Passes);
    let mut found = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            let mut passed = passes.at(index, id).copied().unwrap_or(Passed(true));
            for (at, stmt) in block.stmts.iter().enumerate() {
                if is_bare(stmt) && !state.may_call() && ends_first(program, (id, at + 1)) {
                    found.push((index, id, at, !passed.0));
                }
                state.step(stmt);
                passed.step(stmt);
            }
        }
    }
    for (index, id, at, goes) in &found {
        let block: &mut Block = &mut module.programs[*index].blocks[id.index()];
        let stmt = &mut block.stmts[*at];
        let span = stmt.site.span;
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        match goes {
            true => nc.items.retain(|item| !is_pass(item)),
            false => nc
                .items
                .iter_mut()
                .filter(|item| is_pass(item))
                .for_each(|item| *item = NcItem::Op(Op::Rapid)),
        }
        if nc.items.is_empty() {
            stmt.kind = StmtKind::Comment;
        }
        context.add_once(*index, LEFT_OUT, Diagnostic::new(Code::DoesNothing, span, LEFT_OUT));
    }
    !found.is_empty()
}

const LEFT_OUT: &str = "the code of a turning, threading or facing pass stands without a place, and another code of its group comes before any: it does \
     nothing here, and is left out";

/// True where the pass of an earlier block may be in force. No run begins in one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Passed(bool);

impl Passed {
    fn step(&mut self, stmt: &Stmt) {
        let Some(nc) = stmt.kind.nc().filter(|_| !is_bare(stmt)) else { return };
        let passes =
            nc.ops().any(Op::is_pass) || nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _)));
        let ends = nc.ops().any(|op| op.group() == Group::Motion) && stmt.site.skip.is_none();
        self.0 = passes || self.0 && !ends;
    }
}

impl Lattice for Passed {
    fn join(&mut self, other: &Self) -> bool {
        let joined = self.0 || other.0;
        std::mem::replace(&mut self.0, joined) != joined
    }
}

/// Follows a library.
struct Passes;

impl Follow for Passes {
    type Known = Passed;

    fn outside(&self, _: usize) -> Passed {
        Passed(false)
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Passed) {
        block.stmts.iter().for_each(|stmt| known.step(stmt));
    }

    fn lose(&self, known: &mut Passed) {
        known.0 = true;
    }
}

fn is_pass(item: &NcItem) -> bool {
    matches!(item, NcItem::Op(op) if op.is_pass())
}

/// True for a block with the code of a pass and nothing that the pass would read, or that would make one.
fn is_bare(stmt: &Stmt) -> bool {
    let Some(nc) = stmt.kind.nc() else { return false };
    let modes = |item: &NcItem| match item {
        NcItem::Op(op) => op.is_pass() || op.group() != Group::OneShot && op.auxiliary().is_none(),
        _ => false,
    };
    stmt.site.skip.is_none() && nc.ops().any(Op::is_pass) && nc.items.iter().all(modes)
}

/// True where on every way from a place a code of the group comes before what a pass would take.
fn ends_first(program: &Program, from: (BlockId, usize)) -> bool {
    let (mut work, mut seen) = (vec![from], BTreeSet::new());
    'ways: while let Some((id, first)) = work.pop() {
        let Some(block) = program.block(id) else { return false };
        for stmt in block.stmts.iter().skip(first) {
            match step(stmt) {
                Step::Ends => continue 'ways,
                Step::Takes => return false,
                Step::Passes => {}
            }
        }
        let mut reads = false;
        block.term.kind.exprs(&mut |e| reads |= reads_codes(e));
        match &block.term.kind {
            _ if reads => return false,
            TermKind::Jump(_) | TermKind::Branch { .. } => {
                let next = block.term.kind.successors().into_iter();
                work.extend(next.filter(|id| seen.insert(*id)).map(|id| (id, 0)));
            }
            _ => return false,
        }
    }
    true
}

/// What a statement is to a pass without words.
enum Step {
    /// It says how to move.
    Ends,
    /// The pass would take its words, or nobody knows.
    Takes,
    /// Neither.
    Passes,
}

fn step(stmt: &Stmt) -> Step {
    let mut reads = false;
    stmt.kind.exprs(&mut |e| reads |= reads_codes(e));
    match &stmt.kind {
        _ if reads => Step::Takes,
        StmtKind::Nc(nc) => step_nc(nc, stmt.site.skip.is_some()),
        StmtKind::ModalCall(_) => Step::Takes,
        _ => Step::Passes,
    }
}

fn step_nc(nc: &Nc, skipped: bool) -> Step {
    let of_pass = |item: &NcItem| matches!(item, NcItem::Word(Role::Taper | Role::TaperZ, _));
    let cycles = |op: Op| op.is_lathe_cycle() || op.is_cycle() || op.is_hole();
    let own = |op: Op| op.group() == Group::OneShot && op.auxiliary().is_none() && !cycles(op);
    if nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _)) || of_pass(item))
        || nc.ops().any(cycles)
    {
        return Step::Takes;
    }
    let moves = nc.ops().any(|op| op.group() == Group::Motion && !op.is_pass());
    match (moves, nc.names_axis()) {
        (true, _) if !skipped => Step::Ends,
        (true, _) => Step::Passes,
        (false, true) if !nc.ops().any(own) => Step::Takes,
        _ => Step::Passes,
    }
}

fn reads_codes(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        found |= matches!(e, Expr::System(Sys::ModalNow | Sys::AddressNow, _) | Expr::Indirect(..))
    });
    found
}

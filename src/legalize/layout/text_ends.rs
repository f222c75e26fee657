//! Jumps to the end of the text, in programs that an earlier conversion wrote.
//!
//! Law: an empty block at the end of the text is that end, and whoever jumps there ends there. Where something
//! has to stand after a program, the target gets such a jump; coming back, each round would add one more.
//! Side condition: an earlier conversion wrote the program, so that the jump is its own. Counter-example: `GOTO 90` of a
//! person's, with N90 at the end, which a reader looks for.

use crate::ir::analysis::{Cfg, may_come_back, modal_bodies};
use crate::ir::{Block, BlockId, Module, Program, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

/// True in a library that an earlier conversion wrote.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    context.earlier.is_written()
}

/// Ends the text where these jumps stand, and takes out the block that nothing goes to then; true if there were any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let come_back = may_come_back(module);
    let mut changed = false;
    for program in &mut module.programs {
        let ends: BTreeSet<BlockId> =
            program.ids().zip(&program.blocks).filter(|(_, block)| is_end(block)).map(|(id, _)| id).collect();
        let mut any = false;
        for block in &mut program.blocks {
            if matches!(block.term.kind, TermKind::Jump(to) if ends.contains(&to)) {
                block.term.kind = TermKind::Stray;
                any = true;
            }
        }
        while any && drop_last(program, come_back) {}
        changed |= any;
    }
    changed
}

/// Takes out the last block, if it only ends the text and nothing leads to it; the one before it may be such a block then.
fn drop_last(program: &mut Program, come_back: bool) -> bool {
    let last = BlockId(program.blocks.len().saturating_sub(1) as u32);
    let needless = last != BlockId(0)
        && program.block(last).is_some_and(is_end)
        && Cfg::whole(program, come_back).preds(last).is_empty()
        && modal_bodies(program).all(|body| body != last);
    if needless {
        program.blocks.truncate(last.index());
    }
    needless
}

fn is_end(block: &Block) -> bool {
    let empty = |stmt: &Stmt| stmt.kind == StmtKind::Comment && stmt.site.comments.is_empty();
    let ends = block.term.kind == TermKind::Stray && block.term.site.comments.is_empty();
    ends && block.stmts.iter().all(empty)
}

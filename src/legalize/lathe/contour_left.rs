//! Whether places are absolute or steps after a cycle whose contour says it otherwise.
//!
//! Law: none. Where the contour ends in the other mode, no source says which of the two is in force after the cycle: the
//! control ran the blocks, or only read them. Counter-example: a contour under G91 whose last block has G90.

use super::contours::{contour, last_block};
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::ir::{BlockId, Module, Nc, Program, Stmt};
use crate::legalize::features::Features;
use crate::legalize::{Context, ModalFacts};
use crate::text::Span;

/// True where contours are read, and places may be steps by a mode.
pub fn concerns(features: &Features) -> bool {
    features.any_op(Op::reads_contour) && features.op(Op::Incremental)
}

/// Refuses cycles after which the mode is not known and not said.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for span in open(program, index, &facts) {
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, OPEN).with_help(HELP));
        }
    }
}

fn open(program: &Program, index: usize, facts: &ModalFacts) -> Vec<Span> {
    let mut found = Vec::new();
    for (block, stmts) in program.blocks.iter().enumerate() {
        let mut state = facts.at(index, BlockId(block as u32));
        for (at, stmt) in stmts.stmts.iter().enumerate() {
            state.step(stmt);
            let Some(nc) = stmt.kind.nc().filter(|nc| nc.ops().any(Op::reads_contour)) else { continue };
            let mode = |nc: &Nc| nc.ops().filter(|op| op.group() == Group::Distance).last();
            let Some(left) = contour(program, nc).filter_map(mode).last() else { continue };
            let after = if nc.has(Op::Finish) { Some((block, at)) } else { last_block(program, nc) };
            let told = after.and_then(|after| next(program, after)).is_some_and(|next| mode(next).is_some());
            if state.op(Group::Distance) != Some(left) && !told {
                found.push(stmt.site.span);
            }
        }
    }
    found
}

/// The block of words after a place.
fn next(program: &Program, (block, at): (usize, usize)) -> Option<&Nc> {
    let rest = program.blocks.get(block)?.stmts.iter().skip(at + 1);
    let blocks = program.blocks.iter().skip(block + 1).flat_map(|block| &block.stmts);
    rest.chain(blocks).find_map(|stmt: &Stmt| stmt.kind.nc())
}

const OPEN: &str = "the contour of this cycle ends with steps (G91) or places (G90), and the other was in force before: \
                    which counts after the cycle is not known";
const HELP: &str = "write G90 or G91 into the last block of the contour, or into the block after the cycle";

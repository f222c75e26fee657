//! Sequence numbers that stand more than once in a program, and that a cycle looks its contour up by.
//!
//! Law: a control looks for the number from the first block of the program on, or from the cycle on and then from the first block; no source
//! says which of the two. Where both find the first block with the number, that is the contour's, and a later block does without its number.
//! Side condition: nothing else goes by the numbers: no jump to a later block, no computed one, no return to a number. Counter-example: a number that stands before
//! the cycle and after it.

use super::straight::returns_into;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{BlockId, Expr, Module, Program, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;
use std::collections::BTreeMap;

/// True where a cycle reads a contour.
pub fn concerns(features: &Features) -> bool {
    features.any_op(Op::reads_contour)
}

/// A block, and a statement in it.
type At = (usize, usize);

/// Takes the numbers of later blocks away, where they mean nothing.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if returns_into(module) {
        return;
    }
    for (index, program) in module.programs.iter_mut().enumerate() {
        if program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Computed { .. })) {
            continue;
        }
        for (number, (readers, span)) in readers(program) {
            let places = places(program, number);
            let [first, later @ ..] = places.as_slice() else { continue };
            let from_it =
                |reader: &At| places.iter().find(|place| *place > reader).is_none_or(|place| place == first);
            let is_jumped_to = later.iter().any(|(block, at)| *at == 0 && jumps_to(program, *block));
            if later.is_empty() || is_jumped_to || !readers.iter().all(from_it) {
                continue;
            }
            for (block, at) in later {
                let stmt = program.blocks.get_mut(*block).and_then(|block| block.stmts.get_mut(*at));
                if let Some(stmt) = stmt {
                    stmt.site.sequence = None.into();
                }
            }
            let what = format!(
                "N{number} stands more than once: the cycle is taken to begin or end its contour at the first, which a search from the cycle on \
                 and one from the first block find; the others go without a number"
            );
            let help = "make sure that the control does so, or give one of the blocks another number";
            let told = Diagnostic::new(Code::Conditional, span, what.as_str()).with_help(help);
            context.add_once(index, &what, told.asked_once());
        }
    }
}

/// True where a block is come to in another way than from the block before it: a jump to it goes by its number.
fn jumps_to(program: &Program, block: usize) -> bool {
    let is_it = |to: BlockId| to.index() == block;
    program.blocks.iter().enumerate().any(|(at, from)| match &from.term.kind {
        TermKind::Jump(to) | TermKind::Call { next: to, .. } => is_it(*to) && at + 1 != block,
        TermKind::Branch { then, otherwise, .. } => is_it(*then) || is_it(*otherwise) && at + 1 != block,
        kind => kind.successors().into_iter().any(is_it),
    })
}

/// By number: the cycles that name it, and where the first of them stands in its file.
fn readers(program: &Program) -> BTreeMap<u32, (Vec<At>, Span)> {
    let mut found: BTreeMap<u32, (Vec<At>, Span)> = BTreeMap::new();
    for (block, stmts) in program.blocks.iter().enumerate() {
        for (at, stmt) in stmts.stmts.iter().enumerate() {
            let Some(nc) = stmt.kind.nc().filter(|nc| nc.ops().any(Op::reads_contour)) else { continue };
            for role in [Role::ContourFirst, Role::ContourLast] {
                let Some(number) = nc.word(role).and_then(Expr::constant) else { continue };
                let known = found.entry(number as u32).or_insert_with(|| (Vec::new(), stmt.site.span));
                known.0.push((block, at));
            }
        }
    }
    found
}

/// The blocks with a number, in order.
fn places(program: &Program, number: u32) -> Vec<At> {
    let mut found = Vec::new();
    for (block, stmts) in program.blocks.iter().enumerate() {
        let with =
            stmts.stmts.iter().enumerate().filter(|(_, stmt)| stmt.site.sequence.get() == Some(number));
        found.extend(with.map(|(at, _)| (block, at)));
    }
    found
}

//! Words that are whole numbers, where the target is not known to round what a variable gives them.
//!
//! Law: a control that rounds such a word does what one does that is given the rounded value. Nothing is written where the
//! analysis of values shows that there is no fraction. Counter-example: `S#1` with 599.6, which is S600 on one control and may
//! be S599 on another.

use crate::canon::Func;
use crate::dialect::Question;
use crate::ir::analysis::Ranges;
use crate::ir::{BlockId, Call, Expr, Module, NcItem, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::calls::repeat_loops::fractions;
use crate::legalize::features::{Feature, Features};

/// True if words may be computed, and the source alone rounds them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Computed)
        && context.source.is(Question::IntegerWordRounds)
        && !context.target.is(Question::IntegerWordRounds)
}

/// Rounds what may have a fraction.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let summaries = context.summaries(module);
    let mut changed = false;
    for program in &mut module.programs {
        let ranges = Ranges::of_whole_words(program, &summaries);
        let mut found: Vec<(BlockId, usize, usize)> = Vec::new();
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                for (place, item) in nc.items.iter().enumerate() {
                    let NcItem::Word(role, value) = item else { continue };
                    let open = role.is_integer() && value.constant().is_none() && !value.is_whole();
                    if open && !ranges.at(id, at, value).all_whole() {
                        found.push((id, at, place));
                    }
                }
            }
        }
        // Counts of calls are such words too.
        let counts = fractions(program, &summaries, &|call: &Call| call.count.is_some());
        changed |= !found.is_empty() || !counts.is_empty();
        for id in counts {
            if let TermKind::Call { call, .. } = &mut program.blocks[id.index()].term.kind {
                call.count = call.count.take().map(|count| Expr::Call(Func::Round, [count].into()));
            }
        }
        for (id, at, place) in found {
            if let StmtKind::Nc(nc) = &mut program.blocks[id.index()].stmts[at].kind
                && let NcItem::Word(_, value) = &mut nc.items[place]
            {
                let old = std::mem::replace(value, Expr::Vacant);
                *value = Expr::Call(Func::Round, [old].into());
            }
        }
    }
    changed
}

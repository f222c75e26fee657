//! Coolant through the spindle, and the code that ends coolant.
//!
//! Law: where the code that ends coolant ends the one through the spindle too, as on the source, and does not on the target, the
//! target's own code for that stands before it. Where nobody says what it does, both machines are asked, once. Side condition:
//! the one through the spindle may be on there: a block that switches it on may come before, and none that ends it. Counter-example:
//! `M89`, `M9`, which says both.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::behind::behind;
use crate::ir::{Module, NcItem, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

const QUESTION: Question = Question::CoolantOffThrough;

const MORE: &str = "the code that ends coolant ends the coolant through the spindle too on the target, and not on the source: make sure that \
     it need not go on";

const GOES_ON: &str = "the code that ends coolant ends the coolant through the spindle too on the source, and not on the target: name the target's \
     code that ends it in the target's profile, with op = \"coolant.through.off\"";

/// True between two machines, where programs switch coolant through the spindle on.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::ThroughSpindle)
        && features.op(Op::CoolantOff)
        && !context.source.is_same_machine(context.target)
}

/// Writes the code that ends the one through the spindle; true where it did.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let found = open_ends(module);
    let answer = |control: &Control| {
        let row = control.behaviour(QUESTION)?;
        matches!(row.value.as_str(), "true" | "false").then(|| row.value == "true")
    };
    let answers = (answer(context.source), answer(context.target));
    let has = context.target.code_for(Op::ThroughSpindleOff, &BTreeMap::new()).is_some();
    match answers {
        (Some(ours), Some(theirs)) if ours == theirs => false,
        (Some(true), Some(false)) if has => write(module, &found),
        (Some(ours), Some(_)) => {
            let (code, what) = if ours { (Code::NoEquivalent, GOES_ON) } else { (Code::Conditional, MORE) };
            for (index, span) in found {
                context.add_once(index, what, Diagnostic::new(code, span, what));
            }
            false
        }
        _ => {
            for (index, span) in found {
                context.rests_on_source(index, span, QUESTION);
                context.rests_on_target(index, span, QUESTION);
            }
            false
        }
    }
}

/// The ends of coolant that may find the one through the spindle on.
fn open_ends(module: &Module) -> BTreeSet<(usize, Span)> {
    let has = |stmt: &Stmt, all: &[Op]| stmt.kind.nc().is_some_and(|nc| nc.ops().any(|op| all.contains(&op)));
    let begins = |stmt: &Stmt| has(stmt, &[Op::ThroughSpindle]);
    let ends = |stmt: &Stmt| {
        stmt.site.skip.is_none() && has(stmt, &[Op::ThroughSpindleOff, Op::CoolantOff, Op::ToolChange])
    };
    let mut found = BTreeSet::new();
    behind(module, begins, ends, |index, stmt| {
        if has(stmt, &[Op::CoolantOff]) && !has(stmt, &[Op::ThroughSpindleOff]) {
            found.insert((index, stmt.site.span));
        }
    });
    found
}

fn write(module: &mut Module, found: &BTreeSet<(usize, Span)>) -> bool {
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            let stmts = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::replace(&mut block.stmts, stmts) {
                if let StmtKind::Nc(nc) = &mut stmt.kind
                    && nc.has(Op::CoolantOff)
                    && found.contains(&(index, stmt.site.span))
                {
                    let at = nc.items.iter().position(|item| *item == NcItem::Op(Op::CoolantOff));
                    nc.items.insert(at.unwrap_or_default(), NcItem::Op(Op::ThroughSpindleOff));
                    changed = true;
                }
                block.stmts.push(stmt);
            }
        }
    }
    changed
}

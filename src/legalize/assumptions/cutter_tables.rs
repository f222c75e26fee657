//! Cutter tables that hold radii on one machine and diameters on the other.
//!
//! Nothing is changed: `G41 D2` is `G41 D2` on both. The number in the table is not, and a person types it in. It is told once for
//! a library; where nobody says what one of the tables holds, that is asked. What a program writes into the tables is converted
//! elsewhere. Counter-example: a table of diameters that is copied by hand, after which each contour is off by a radius.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question, Side};
use crate::ir::{Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;
use std::collections::BTreeSet;

const QUESTION: Question = Question::RadiusOffsetTable;

/// True for mills whose programs compensate by a cutter's radius.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let comp = features.op(Op::RadiusLeft) || features.op(Op::RadiusRight);
    let mills = [context.source, context.target].iter().all(|control| control.machine() == Machine::Mill);
    comp && mills && !context.source.is_same_machine(context.target)
}

/// Tells of tables that differ, and asks what they hold.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let tables = [context.source, context.target].map(holds);
    let uses: Vec<(usize, Span)> = (0..)
        .zip(&module.programs)
        .filter_map(|(index, program)| {
            let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
            let comp = |kind: &StmtKind| kind.has_op(Op::RadiusLeft) || kind.has_op(Op::RadiusRight);
            Some((index, stmts.find(|stmt| comp(&stmt.kind))?.site.span))
        })
        .collect();
    match tables {
        [Some(ours), Some(theirs)] if ours != theirs => {
            let what = format!(
                "the cutter table of the old machine holds {}, that of the new one {}: {} each number{} before you type it in, its wear too",
                name(ours),
                name(theirs),
                if ours { "double" } else { "halve" },
                numbers(module)
            );
            for (index, span) in uses {
                context.add_once(
                    index,
                    &what,
                    Diagnostic::new(Code::Conditional, span, what.clone()).asked_once(),
                );
            }
        }
        [Some(_), Some(_)] => {}
        [ours, _] => {
            let side = if ours.is_none() { Side::Source } else { Side::Target };
            for (index, span) in uses {
                context.unconfirmed(index, side, span, QUESTION.fact(), QUESTION.meaning());
            }
        }
    }
}

/// What the table of a control holds: true for radii; none if nobody says.
fn holds(control: &Control) -> Option<bool> {
    match control.behaviour(QUESTION)?.value.as_str() {
        "radius" => Some(true),
        "diameter" => Some(false),
        _ => None,
    }
}

fn name(radii: bool) -> &'static str {
    if radii { "radii" } else { "diameters" }
}

/// How many numbers are named, at the most.
const MOST: usize = 12;

/// The offsets that the programs name, for a person to go through.
fn numbers(module: &Module) -> String {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let named = stmts.filter_map(|stmt| stmt.kind.nc()?.word(Role::RadiusOffset).and_then(Expr::constant));
    let all: BTreeSet<u32> = named.filter(|number| *number >= 1.0).map(|number| number as u32).collect();
    if all.is_empty() || all.len() > MOST {
        return String::new();
    }
    let all: Vec<String> = all.into_iter().map(|number| number.to_string()).collect();
    format!(" (offsets {})", all.join(", "))
}

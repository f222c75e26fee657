//! Tool offsets, and work offsets by a computed number, that the target does not have.
//!
//! Law: a word that names an offset names one that the target has, and a code that writes one too. Counter-example: `G43 H120 Z5.`
//! for a control with 99 offsets. How many there are is the table's row, or `offsets` of the machine profile where the machine has less. Side condition: a
//! variable holds numbers that its program gives it; what calls give is the matter of `argument_offsets`, and of what an
//! operator gives nothing is known.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, turret_parts};
use crate::ir::analysis::{Assigned, Constant, Ranges, Values};
use crate::ir::{BlockId, Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::cell::LazyCell;

/// The words that name an offset.
pub(super) const NAMES: [Role; 2] = [Role::LengthOffset, Role::RadiusOffset];

/// True if the library names offsets, and the target's table says how many there are.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let names = NAMES.iter().chain(&[Role::Turret]).any(|role| features.role(*role));
    (names || features.any_op(writes)) && last(context.target).is_some()
}

/// Refuses numbers past the last one.
pub fn run(module: &Module, context: &mut Context<'_>) {
    work_offsets(module, context);
    let Some(last) = last(context.target) else { return };
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter().enumerate() {
        let assigned = Assigned::new(program, &summaries);
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                let of = |value: &Expr| numbers(value, &assigned, (id, at));
                let named = NAMES.iter().filter_map(|role| nc.word(*role)).flat_map(of);
                let indexed = nc.word(Role::Turret).into_iter().flat_map(of).map(|word| turret_parts(word).1);
                let written = nc.word(Role::OffsetRow).filter(|_| nc.ops().any(writes));
                let written = written.into_iter().flat_map(of).map(row);
                let numbers = named.chain(indexed).chain(written);
                for number in numbers.filter(|number| *number > f64::from(last)) {
                    let title = &context.target.dialect().title;
                    let what = format!("this block names tool offset {number}, and the {title} has {last}");
                    let help = "give the tool an offset that the machine has; 'offsets' in its profile may say that it has less \
                                than its table";
                    let found = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help);
                    context.add(index, found);
                }
            }
        }
    }
}

/// Refuses work offsets whose number is computed, where it is known to be one that the target has no code for.
fn work_offsets(module: &Module, context: &mut Context<'_>) {
    let summaries = context.summaries(module);
    let target = context.target;
    let lacks = |number: f64| {
        target.code_for(Op::SelectWork, &[(Role::WorkOffset, number)].into_iter().collect()).is_none()
    };
    for (index, program) in module.programs.iter().enumerate() {
        let ranges = LazyCell::new(|| Ranges::of_whole_words(program, &summaries));
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let number = stmt.kind.nc().filter(|nc| nc.has(Op::SelectWork));
                let number = number.and_then(|nc| nc.word(Role::WorkOffset));
                let Some(number) = number.filter(|number| number.constant().is_none()) else { continue };
                let is_past = match ranges.at(id, at, number) {
                    Values::Few(numbers) => numbers.into_iter().any(lacks),
                    // Numbers are without gaps from the first additional one on.
                    Values::Between { low, high, .. } => {
                        low > 0.0 && high.is_finite() && lacks(low) && lacks(high)
                    }
                };
                if is_past {
                    let title = &target.dialect().title;
                    let what = format!(
                        "the number of the work offset is computed, and is one that the {title} does not have"
                    );
                    let help =
                        "'work_offsets' of its machine profile says how many it has: give the parts others";
                    let found = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help);
                    context.add(index, found);
                }
            }
        }
    }
}

/// True for a code that writes a row of the table of tool offsets.
fn writes(op: Op) -> bool {
    use Op::*;
    matches!(op, WriteLength | WriteLengthWear | WriteRadius | WriteRadiusWear | WriteOffset | WriteTurret)
}

/// The offset that a row is: of a lathe's geometry the number is this much higher.
fn row(number: f64) -> f64 {
    const GEOMETRY: f64 = 10_000.0;
    if number > GEOMETRY { number - GEOMETRY } else { number }
}

/// The numbers that a word may have, as far as its program gives them.
fn numbers(value: &Expr, assigned: &Assigned<'_>, (id, at): (BlockId, usize)) -> Vec<f64> {
    let held = match value {
        Expr::Var(var) => assigned.at(*var, id, at).unwrap_or_default(),
        _ => Vec::new(),
    };
    let held = held.into_iter().filter_map(|held| match held {
        Constant::Number(number) => Some(number),
        _ => None,
    });
    value.constant().into_iter().chain(held).collect()
}

/// The number of the last tool offset, where the maker or the profile says it.
pub(super) fn last(control: &Control) -> Option<u32> {
    let stated = control.profile().offsets.is_some();
    let rows = control.dialect().system.iter().filter(|row| row.state.is_tool_offset());
    let rows = rows.filter(|row| stated || row.origin.is_confirmed());
    let of_rows = rows.filter_map(|row| row.subscripts.first()).map(|run| run.from + run.count - 1).max();
    of_rows.or(control.profile().offsets)
}

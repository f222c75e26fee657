//! Tool offsets that the target does not have.
//!
//! Law: a word that names a tool offset names one that the target has. Counter-example: `G43 H120 Z5.` for a control with 99
//! offsets. How many there are is the table's row, or `offsets` of the machine profile where the machine has less. Side condition: a
//! variable holds numbers that its program gives it; what calls give is the matter of `argument_offsets`, and of what an
//! operator gives nothing is known.

use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Assigned, Constant};
use crate::ir::{BlockId, Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The words that name an offset.
pub(super) const NAMES: [Role; 2] = [Role::LengthOffset, Role::RadiusOffset];

/// True if the library names offsets, and the target's table says how many there are.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    NAMES.iter().any(|role| features.role(*role)) && last(context.target).is_some()
}

/// Refuses numbers past the last one.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some(last) = last(context.target) else { return };
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter().enumerate() {
        let assigned = Assigned::new(program, &summaries);
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                let values = NAMES.iter().filter_map(|role| nc.word(*role));
                let numbers = values.flat_map(|value| numbers(value, &assigned, (id, at)));
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
    rows.filter_map(|row| row.subscripts.first()).map(|run| run.from + run.count - 1).max()
}

//! Tool offsets that the target does not have.
//!
//! Law: a word that names a tool offset names one that the target has. Counter-example: `G43 H120 Z5.` for a control with 99
//! offsets. How many there are is the table's row, or `offsets` of the machine profile where the machine has less. A computed
//! number is for the verifier's runs.

use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The words that name an offset.
const NAMES: [Role; 2] = [Role::LengthOffset, Role::RadiusOffset];

/// True if the target's table says how many offsets there are.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    last(context.target).is_some()
}

/// Refuses numbers past the last one.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some(last) = last(context.target) else { return };
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            let numbers = NAMES.iter().filter_map(|role| nc.word(*role)?.constant());
            for number in numbers.filter(|number| *number > f64::from(last)) {
                let what = format!(
                    "tool offset {number}: the {} has {last}, with what its profile says ('offsets')",
                    context.target.dialect().title
                );
                let help = "give the tool an offset that the machine has";
                context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help));
            }
        }
    }
}

/// The number of the last tool offset, where the maker or the profile says it.
fn last(control: &Control) -> Option<u32> {
    let stated = control.profile().offsets.is_some();
    let rows = control.dialect().system.iter().filter(|row| row.state.is_tool_offset());
    let rows = rows.filter(|row| stated || row.origin.is_confirmed());
    rows.filter_map(|row| row.subscripts.first()).map(|run| run.from + run.count - 1).max()
}

//! Settings under which a code means what no row of a table says.
//!
//! Nothing is changed. Law: a program is refused where it uses such a code, or moves where the setting is of all moves. Only a
//! setting that the profile of a machine states counts: most machines have the other value, and nobody is asked.
//! Counter-example: a setting with which `G91 X5.` counts increments in its own block alone.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Setting};
use crate::ir::{Module, Nc};
use crate::legalize::Context;

/// True where the profile of one of two machines states such a setting.
pub fn concerns(context: &Context<'_>) -> bool {
    let controls = [context.source, context.target];
    !context.source.is_same_machine(context.target)
        && controls.iter().any(|control| control.barred().next().is_some())
}

/// Refuses what the settings give another meaning.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for control in [context.source, context.target] {
        for (row, value, ops) in control.barred() {
            for (index, program) in module.programs.iter().enumerate() {
                let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
                let mut found = stmts.filter(|stmt| stmt.kind.nc().is_some_and(|nc| is_of(nc, ops)));
                if let Some(stmt) = found.next() {
                    let finding = told(control, row, value);
                    context.add(index, Diagnostic { span: stmt.site.span, ..finding });
                }
            }
        }
    }
}

fn is_of(nc: &Nc, ops: &[Op]) -> bool {
    if ops.is_empty() { nc.moves() } else { nc.ops().any(|op| ops.contains(&op)) }
}

fn told(control: &Control, row: &Setting, value: &str) -> Diagnostic {
    let (kind, number) = row.name.split_once('.').unwrap_or(("setting", &row.name));
    let what = format!(
        "{kind} {number} of the {} is '{value}' by its profile, and programs are converted as if it were not: {}",
        control.dialect().title,
        row.meaning
    );
    let help = "set the machine so that codes mean what its manual says, and say so in its profile";
    Diagnostic::new(Code::NoEquivalent, Default::default(), what).with_help(help)
}

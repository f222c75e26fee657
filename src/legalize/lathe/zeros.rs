//! Codes of a lathe that set a zero or write a table, whose words count otherwise as increments.
//!
//! Law: none, it only reports. A set position moves by its increments, and G10 L2 adds them to the work offset (docs/lathe.md Z6, Z8); what increments do
//! to the local shift, and what G91 does to a tool offset, which has letters of its own for them, no source says: they are refused.
//! Counter-example: `G91 G52 Z2.`, which may shift by 2 or to 2.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine};
use crate::ir::{Expr, Module, Nc, NcItem};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The codes whose axis words say a zero, or what stands in a table.
const ZEROS: [Op; 4] = [Op::SetPosition, Op::LocalShift, Op::WriteWork, Op::WriteTurret];

/// True for a block that sets a zero by axis words, or writes a table.
pub(super) fn sets_zero(nc: &Nc) -> bool {
    let axis = |role: &Role| Role::STEPS.iter().any(|(whole, step)| whole == role || step == role);
    let words = nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if axis(role)));
    words && nc.ops().any(|op| ZEROS.contains(&op))
}

/// True for a block that adds to a table under G91.
pub(super) fn adds(nc: &Nc) -> bool {
    nc.has(Op::WriteWork)
}

/// True where a lathe's library has such codes.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.source.machine() == Machine::Lathe
        && [Op::LocalShift, Op::WriteWork, Op::WriteTurret].iter().any(|op| features.op(*op))
}

/// Refuses increments of which no source says what they do.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    facts.each(module, &mut |index, stmt, _, after| {
        let Some(nc) = stmt.kind.nc().filter(|nc| sets_zero(nc)) else { return };
        let steps = Role::STEPS.iter().any(|(_, step)| nc.word(*step).is_some());
        let places = Role::STEPS.iter().any(|(whole, _)| nc.word(*whole).is_some());
        let by_mode = after.op(Group::Distance) == Some(Op::Incremental);
        let found = [
            (nc.has(Op::LocalShift) && (steps || by_mode)).then_some((SHIFT, SHIFT_HELP)),
            (nc.has(Op::WriteWork) && steps).then_some((WORK, WORK_HELP)),
            (nc.has(Op::WriteTurret) && places && by_mode).then_some((TOOL, TOOL_HELP)),
        ];
        let shift = nc.word(Role::OffsetRow).and_then(Expr::constant) == Some(0.0);
        let lost = [Op::WriteWork, Op::WriteTurret].into_iter().find(|op| shift && nc.has(*op));
        let all = lost.filter(|op| !takes_shift(context.target, *op)).map(|_| (ALL, ALL_HELP));
        for (what, help) in found.into_iter().flatten().chain(all) {
            let told = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help);
            context.add_once(index, &format!("{what} {:?}", stmt.site.span), told);
        }
    });
}

/// True where a control writes the shift of all zeros by the number 0 of that code.
fn takes_shift(control: &Control, op: Op) -> bool {
    let mut rows = control.dialect().codes.iter().filter(|row| row.op == op);
    rows.any(|row| {
        let parts = row.shift.get(&Role::OffsetRow);
        parts.is_none_or(|parts| {
            parts.iter().any(|part| (i64::from(part.first)..=i64::from(part.last)).contains(&-part.add))
        })
    })
}

const ALL: &str = "the shift of all zeros is written by P0, and the target has no code for that";
const ALL_HELP: &str =
    "write the shift into the work offsets that the part needs (G10 L2 P1), or as a local shift (G52)";
const SHIFT: &str =
    "an increment of the local shift (G52): no source says whether it adds to the shift or replaces it";
const SHIFT_HELP: &str = "write the whole shift with X and Z, under G90 where the control has it";
const WORK: &str =
    "U or W beside G10 L2 or L20: no source says that a work offset takes an increment by these letters";
const WORK_HELP: &str = "write the whole offset with X and Z";
const TOOL: &str =
    "X or Z of a tool offset under G91: no source says whether it adds, as U and W do, or replaces";
const TOOL_HELP: &str = "write G90 before it, or U and W for what is added";

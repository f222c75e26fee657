//! M codes and tool words in the drilling blocks of a lathe.
//!
//! Law: none. Such a code acts between the position and the hole, as the clamp of C does, and the control undoes it after the hole by a code
//! that only the builder knows: on another control nothing is sure to be the same, so it is refused. Between two machines of one control the
//! block stays as it is, and what the builder's code does there is asked as anywhere else. Counter-example: `C90. M31`, where M31 clamps the
//! spindle before the drill goes down and M32 lets it go after.

use super::holes;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Module, NcItem};
use crate::legalize::Context;

/// Refuses them, unless both machines have one control.
pub fn run(module: &Module, context: &mut Context<'_>) {
    if context.source.name() == context.target.name() {
        return;
    }
    holes::each(module, context, |index, span, nc, context| {
        if nc.items.iter().any(acts) {
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, WHAT).with_help(HELP));
        }
    });
}

fn acts(item: &NcItem) -> bool {
    match item {
        NcItem::Code(letter, _) => *letter == 'M',
        NcItem::Op(op) => {
            op.auxiliary().is_some()
                || matches!(op, Op::Stop | Op::OptionalStop | Op::TurretIndex | Op::RigidTaps)
        }
        NcItem::Word(role, _) => matches!(role, Role::Turret),
    }
}

const WHAT: &str = "an M code or a tool word in a drilling block acts between the position and the hole, as the clamp of C does, and ends \
                    after the hole: no source says how the target does that";
const HELP: &str = "give the position, the code, and each hole blocks of their own, with the code that ends it after the hole";

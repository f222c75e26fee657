//! Work offsets that are selected after a position that the program set.
//!
//! Law: the code that says where the tool stands shifts all work offsets on some controls until it is taken back, and on
//! others lasts until an offset is selected. Where it is not known that both controls do the same, a selection that may come
//! after such a code is told. That no offset at all is chosen is refused: it may end the position that was set on one
//! control, and leave it on the other. Side condition: an offset that is selected before is meant alike.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::Module;
use crate::ir::analysis::behind::behind;
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where there may be such a selection, and it is not known that both controls do the same then.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let both = features.op(Op::SetPosition) && (features.op(Op::SelectWork) || features.op(Op::ShiftCancel));
    both && !context.agree(Question::SelectEndsSetPosition)
}

/// Reports selections after a set position.
pub fn run(module: &Module, context: &mut Context<'_>) {
    behind(
        module,
        |stmt| stmt.kind.has_op(Op::SetPosition),
        |_| false,
        |index, stmt| {
            if stmt.kind.has_op(Op::ShiftCancel) {
                let what = "all work offsets are taken away while a position that the program set may be in force: no \
                            source says for both controls whether that goes too. Select a work offset before";
                context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
            } else if stmt.kind.has_op(Op::SelectWork) {
                let what = "a work offset is selected while a position that the program set may be in \
                            force: it is not known for both controls whether that ends it";
                context.add_once(index, what, Diagnostic::new(Code::Conditional, stmt.site.span, what));
            }
        },
    );
}

//! Rotations in increments, after another rotation.
//!
//! Law: the angle of a rotation under G91 is added to the one before, or stands for it, as a setting of each control says. Nothing
//! is changed: a program is refused where the two controls are known to differ, and the settings are asked where they are not known.
//! Side conditions: the first rotation of a run adds to nothing; one under G90 says the whole angle. Where it ends: whether an end
//! of the rotation ends the angle that is added to as well, no source says.
//! Counter-example: `G68 X0. Y0. R30.`, `G91 G68 R30.`, which turns by 60 degrees or by 30.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::{Module, Stmt};
use crate::legalize::each_step::each_step;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

const ADDS: Question = Question::RotationAdds;

const ENDED: &str = "the angle of this rotation adds to the one before, which an end of the rotation has come after, and no source says \
     whether it begins at 0 again then: write G90 and the whole angle";

/// True if the library rotates and counts in increments, and both tables say something of it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    [context.source, context.target].iter().all(|control| control.behaviour(ADDS).is_some())
        && !context.source.is_same_machine(context.target)
        && features.any_op(|op| op == Op::RotateOn)
        && features.any_op(|op| op == Op::Incremental)
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    each_step(module, &facts, step, |index, stmt, (before, adds): (Angle, bool)| {
        if !adds {
            return;
        }
        let span = stmt.site.span;
        context.rests_on_source(index, span, ADDS);
        context.rests_on_target(index, span, ADDS);
        context.must_agree(index, span, ADDS);
        if before.ended && (context.source.is(ADDS) || context.target.is(ADDS)) {
            context.add_once(index, ENDED, Diagnostic::new(Code::Conditional, span, ENDED));
        }
    });
}

/// What rotations may have left, on some way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Angle {
    /// One is in force.
    turned: bool,
    /// One was ended.
    ended: bool,
}

impl Lattice for Angle {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self { turned: self.turned || other.turned, ended: self.ended || other.ended };
        std::mem::replace(self, joined) != joined
    }
}

/// Takes a statement; true for a rotation whose angle may be added to another.
fn step(stmt: &Stmt, state: &mut Modal, angle: &mut Angle) -> bool {
    state.step(stmt);
    let Some(nc) = stmt.kind.nc() else { return false };
    let before = *angle;
    let whole = state.op(Group::Distance) == Some(Op::Absolute);
    if nc.has(Op::RotateOn) {
        *angle = Angle { turned: true, ended: before.ended && !whole };
    } else if nc.has(Op::RotateOff) {
        *angle = Angle { turned: false, ended: before.ended || before.turned };
    }
    // A block that may be skipped leaves what was.
    if stmt.site.skip.is_some() {
        angle.join(&before);
    }
    nc.has(Op::RotateOn) && !whole && (before.turned || before.ended)
}

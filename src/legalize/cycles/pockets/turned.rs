//! Round pockets in coordinates that are turned.
//!
//! Law: a circle about the place where the tool stands is the same circle in coordinates that are turned. So are the arcs that are written
//! for it, in increments. Side conditions: the rotation begins in the blocks that run right before, in the plane of the pocket, and a block
//! after it goes to a place of X and Y in it, so that the increments count from there on each control. Where the half circle goes out is
//! taken to turn too: the metal that is cut is the same. Counter-example: `G68 R30.` and `G13` in the next block, of which controls do not
//! agree where an increment leads.

use crate::canon::{Group, Op, Role};
use crate::ir::{Block, Nc};
use crate::legalize::Modal;

/// What is told of such a pocket, once.
pub(super) const TOLD: &str = "a round pocket (G12, G13) stands in turned coordinates: the circles are the same, and the half circle that leads out to \
                               them is taken to be turned too. Make sure that nothing is in its way where it goes out otherwise";

/// True where the tool stands at a place of the turned coordinates; `state` is in force at the pocket.
pub(super) fn is_known(block: &Block, place: usize, state: &Modal) -> bool {
    if state.op(Group::Distance) != Some(Op::Absolute) {
        return false;
    }
    let mut goes = false;
    for stmt in block.stmts.iter().take(place).rev() {
        let Some(nc) = stmt.kind.nc() else { continue };
        if nc.has(Op::RotateOn) {
            return goes && stmt.site.skip.is_none();
        }
        if nc.ops().any(|op| matches!(op.group(), Group::Plane | Group::Distance)) {
            return false;
        }
        goes |= stmt.site.skip.is_none() && goes_there(nc);
    }
    false
}

/// True for a move to a place of X and Y.
fn goes_there(nc: &Nc) -> bool {
    let both = nc.word(Role::X).is_some() && nc.word(Role::Y).is_some();
    both && !nc.ops().any(|op| matches!(op.group(), Group::OneShot | Group::Cycle))
}

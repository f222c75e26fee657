//! The retract plane of a drilling cycle, which R0 holds.
//!
//! A program may give R0 another value while a cycle is in force. The next hole then begins from the new plane, if
//! the control takes the plane from R0 at each hole: such a hole names R0 as its plane, so that the target follows.

use super::reading::Reading;
use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::ir::{Bank, Expr, NcItem, Place, Program, StmtKind};
use crate::lower::fadal::build::{Lowering, PLANE, Planes};
use crate::text::Span;

impl<'b> Lowering<'b> {
    /// R0 is the retract plane too: setting it while a cycle is in force moves the plane.
    pub fn scratches_plane(&mut self, place: &Place, span: Span) {
        let hit = match place {
            Place::Var(var) => *var == PLANE,
            Place::Indirect(bank, _) => *bank == Bank::Parametric,
            Place::System(..) => false,
        };
        if !hit || !self.in_cycle() || self.rely(Question::CycleR0Kept, span) == Some("false") {
            return;
        }
        self.planes.moved.get_or_insert(span);
    }

    /// R0 as a word of another code, such as an angle, while a cycle is in force.
    pub(super) fn takes_plane(&mut self, role: Role, span: Span) -> Option<()> {
        if role == Role::CycleR || !self.in_cycle() || self.control.behaviour(Question::CycleR0Kept).is_none()
        {
            return Some(());
        }
        if self.rely(Question::CycleR0Kept, span) == Some("false") {
            return Some(());
        }
        let what = "R0 is the retract plane of the drilling cycle in force, and no manual says what this value makes \
                    of the plane: end the cycle with G80 before this block, and give it again after it";
        self.refuse(span, what)
    }

    /// Notes a block that drills by the cycle in force, and may name no plane.
    pub(super) fn notes_hole(&mut self, reading: &Reading<'b, '_>, axes: bool, incremental: bool) {
        let codes = reading.codes;
        let aside = codes.takes_axes() || codes.has(Op::MachineOnce);
        let names = reading.items.iter().any(|item| matches!(item, NcItem::Word(Role::CycleR, _)));
        if !(axes || codes.has(Op::CycleHere)) || aside || names || !self.in_cycle() {
            return;
        }
        self.planes.holes.push(reading.span);
        if incremental {
            self.planes.incremental.get_or_insert(reading.span);
        }
    }

    /// Says so where holes after a new value of R0 cannot be given their plane.
    pub fn check_planes(&mut self) {
        let Some(moved) = self.planes.moved else { return };
        if self.planes.by_word {
            let what = "a word R gave the cycle its plane before, and it is not known which of the two counts now: write \
                        the plane as R0 with its sign in the block of the cycle";
            self.findings.not_understood(moved, what);
        }
        if let Some(span) = self.planes.incremental {
            let what = "R0 gets another value while a drilling cycle is in force, and this hole may count in increments: \
                        write G90, or give the cycle again with its plane";
            self.findings.not_understood(span, what);
        }
    }
}

/// Gives holes after a new value of R0 their plane.
pub fn name_planes(program: &mut Program, planes: &Planes) {
    if planes.moved.is_none() {
        return;
    }
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        let drills = nc.names_axis() || nc.has(Op::CycleHere);
        if drills && planes.holes.contains(&stmt.site.span) {
            nc.items.push(NcItem::Word(Role::CycleR, Expr::Var(PLANE)));
        }
    }
}

//! The retract plane of a drilling cycle that goes on from another, or that is told none.
//!
//! Laws: a plane that a cycle was told lasts for the cycles after it, until cycles are cancelled; the first cycle after that, if it
//! is told none, has the plane that the tool stands in. Where the target's cycle reads its plane from a variable that other blocks
//! set too, the plane is told. Side condition: it is a known number, and the cycles, and the last move along Z, stand in absolute
//! coordinates. Counter-example: `G91 G81 R-2.`, whose plane counts from where the tool is.

use super::hole_moves::keeps_height;
use crate::canon::{Group, Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, solve};
use crate::ir::analysis::modal::Modal;
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, Place, Stmt, StmtKind, TermKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, ModalFacts};

/// True if there are cycles, and the target's read their planes from a variable.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(Op::is_cycle) && reads_variable(context.target) && !reads_variable(context.source)
}

fn reads_variable(control: &Control) -> bool {
    let mut rows = control.dialect().codes.iter().filter(|row| row.op.is_cycle());
    rows.any(|row| control.parametric(Role::CycleR, Some(row)).is_some())
}

/// Tells planes again.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let rules = Follows { facts: &facts, index };
        let starts = solve(&rules, program, &Cfg::of(program));
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let mut modal = facts.at(index, id);
            let mut plane = starts.at(id).copied().unwrap_or(Plane::Unknown);
            for stmt in &mut block.stmts {
                let before = plane;
                plane.step(stmt, &mut modal);
                let absolute = modal.op(Group::Distance) == Some(Op::Absolute);
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if nc.ops().any(Op::is_cycle)
                    && nc.word(Role::CycleR).is_none()
                    && absolute
                    && let Plane::Known(number) | Plane::Stands(number) = before
                {
                    nc.items.push(NcItem::Word(Role::CycleR, Expr::Number(number)));
                }
            }
        }
    }
}

/// The plane that a cycle was told before.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Plane {
    Known(f64),
    /// No cycle is in force, and the tool stands at this place along Z.
    Stands(f64),
    Unknown,
}

impl Plane {
    fn step(&mut self, stmt: &Stmt, modal: &mut Modal) {
        modal.step(stmt);
        let drills = modal.op(Group::Cycle).is_some_and(Op::is_cycle);
        let absolute = modal.op(Group::Distance) == Some(Op::Absolute);
        let Some(nc) = stmt.kind.nc() else {
            let keeps = matches!(
                stmt.kind,
                StmtKind::Comment
                    | StmtKind::Assign { target: Place::Var(_), .. }
                    | StmtKind::StopMessage { .. }
            );
            if matches!(stmt.kind, StmtKind::ModalCall(_)) || !keeps && matches!(self, Self::Stands(_)) {
                *self = Self::Unknown;
            }
            return;
        };
        let now = if !drills {
            let off =
                modal.op(Group::Cycle) == Some(Op::CycleOff) && modal.op(Group::Plane) == Some(Op::PlaneXy);
            self.stood(nc, absolute).filter(|_| off).map_or(Self::Unknown, Self::Stands)
        } else if let Some(value) = nc.word(Role::CycleR) {
            value.constant().filter(|_| absolute).map_or(Self::Unknown, Self::Known)
        } else if let (Self::Stands(number), true) = (*self, absolute) {
            Self::Known(number)
        } else {
            *self
        };
        *self = if stmt.site.skip.is_some() && *self != now { Self::Unknown } else { now };
    }

    /// The place along Z after a block without a cycle, where it is known.
    fn stood(self, nc: &Nc, absolute: bool) -> Option<f64> {
        let lasts = |op: Op| keeps_height(op) || matches!(op.group(), Group::LengthComp | Group::WorkOffset);
        let named = |role| nc.word(role).is_some();
        if nc.items.iter().any(|item| matches!(item, NcItem::Code(..))) || !nc.ops().all(lasts) {
            return None;
        }
        if let Some(to) = nc.word(Role::Z) {
            return to.constant().filter(|_| absolute);
        }
        let stays = nc.ops().all(keeps_height) && !named(Role::LengthOffset) && !named(Role::WorkOffset);
        match self {
            Self::Stands(number) if stays => Some(number),
            _ => None,
        }
    }
}

impl Lattice for Plane {
    fn join(&mut self, other: &Self) -> bool {
        let joined = if self == other { *self } else { Self::Unknown };
        std::mem::replace(self, joined) != joined
    }
}

struct Follows<'f> {
    facts: &'f ModalFacts,
    index: usize,
}

impl Analysis for Follows<'_> {
    type State = Plane;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Plane)> {
        cfg.roots().iter().map(|root| (*root, Plane::Unknown)).collect()
    }

    fn block(&self, id: BlockId, block: &Block, plane: &mut Plane) {
        let mut modal = self.facts.at(self.index, id);
        block.stmts.iter().for_each(|stmt| plane.step(stmt, &mut modal));
        if matches!(block.term.kind, TermKind::Call { .. }) {
            *plane = Plane::Unknown;
        }
    }
}

//! The retract plane of a drilling cycle that goes on from another.
//!
//! Law: a plane that a cycle was told lasts for the cycles after it, until cycles are cancelled; where the target's cycle reads
//! its plane from a variable that other blocks set too, the plane is told again. Side condition: it is a known number, and
//! both cycles stand in absolute coordinates. Counter-example: `G91 G81 R-2.`, whose plane counts from where the tool is.

use crate::canon::{Group, Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, solve};
use crate::ir::analysis::modal::Modal;
use crate::ir::{Block, BlockId, Expr, Module, NcItem, Stmt, StmtKind, TermKind};
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
                    && let Plane::Known(number) = before
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
    Unknown,
}

impl Plane {
    fn step(&mut self, stmt: &Stmt, modal: &mut Modal) {
        modal.step(stmt);
        let drills = modal.op(Group::Cycle).is_some_and(Op::is_cycle);
        if !drills || matches!(stmt.kind, StmtKind::ModalCall(_)) {
            *self = Self::Unknown;
        }
        let Some(nc) = stmt.kind.nc() else { return };
        if let Some(value) = nc.word(Role::CycleR) {
            let absolute = modal.op(Group::Distance) == Some(Op::Absolute);
            let now = value.constant().filter(|_| absolute).map_or(Self::Unknown, Self::Known);
            *self = if stmt.site.skip.is_some() && *self != now { Self::Unknown } else { now };
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

//! Tool lengths and cutter radii that a program writes while they may be in force.
//!
//! Law: a cell of the table that is written before its number is named counts the same on every control. One that is in force
//! counts from the next block on, or when its number is named again, as a parameter of the control says: where the program goes
//! on before it names the number, it rests on that. Nothing is changed. Side conditions: the length moves Z alone, the radius X, Y
//! and Z; a length that no program names is none. Counter-example: `G43 H1`, `#2001=#2001-0.1`, `G1 Z-5.`

use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::{Control, Machine, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::{Expr, Module, Nc, Place, Stmt, StmtKind};
use crate::legalize::each_step::each_step;
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal, Setting};

const LENGTH: Question = Question::LengthActiveImmediately;
const RADIUS: Question = Question::RadiusActiveImmediately;

/// True if the library writes such a cell, between two mills whose tables both say something of it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let says = |control: &&Control| {
        control.machine() == Machine::Mill
            && [LENGTH, RADIUS].iter().all(|one| control.behaviour(*one).is_some())
    };
    [context.source, context.target].iter().all(says)
        && !context.source.is_same_machine(context.target)
        && (features.has(Feature::System) || features.any_op(|op| cell_of(op).is_some()))
        && (features.role(Role::LengthOffset) || features.role(Role::RadiusOffset))
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    if !stmts().any(|stmt| written(&stmt.kind).is_some()) {
        return;
    }
    let facts = context.modal_facts(module);
    each_step(module, &facts, step, |index, stmt, (_, rests)| {
        for question in rests.into_iter().flatten() {
            context.rests_on_source(index, stmt.site.span, question);
            context.rests_on_target(index, stmt.site.span, question);
            context.must_agree(index, stmt.site.span, question);
        }
    });
}

/// What was written while it was in force, and not named since, on some way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Stale {
    length: bool,
    radius: bool,
}

impl Lattice for Stale {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self { length: self.length || other.length, radius: self.radius || other.radius };
        std::mem::replace(self, joined) != joined
    }
}

/// Takes a statement; what it rests on.
fn step(stmt: &Stmt, state: &mut Modal, stale: &mut Stale) -> [Option<Question>; 2] {
    let before = *stale;
    if let Some((cell, row)) = written(&stmt.kind) {
        match cell {
            Cell::Length => stale.length |= length_in_force(state, row),
            Cell::Radius => stale.radius |= radius_in_force(state),
            Cell::Both => {
                stale.length |= length_in_force(state, row);
                stale.radius |= radius_in_force(state);
            }
        }
    }
    state.step(stmt);
    let Some(nc) = stmt.kind.nc() else { return [None, None] };
    let names = |role: Role, group: Group| nc.word(role).is_some() || nc.ops().any(|op| op.group() == group);
    stale.length &= !names(Role::LengthOffset, Group::LengthComp);
    stale.radius &= !names(Role::RadiusOffset, Group::RadiusComp);
    let rests = [
        (stale.length && goes(nc, &[Role::Z, Role::CycleR])).then_some(LENGTH),
        (stale.radius && goes(nc, &[Role::X, Role::Y, Role::Z])).then_some(RADIUS),
    ];
    // A block that may be skipped leaves what was.
    if stmt.site.skip.is_some() {
        stale.join(&before);
    }
    rests
}

fn goes(nc: &Nc, along: &[Role]) -> bool {
    nc.moves() && !nc.has(Op::MachineOnce) && along.iter().any(|role| nc.word(*role).is_some())
}

/// What a cell of the table holds.
#[derive(Clone, Copy)]
enum Cell {
    Length,
    Radius,
    /// One number for both.
    Both,
}

/// The cell that a statement writes, and its row where that is a number.
fn written(kind: &StmtKind) -> Option<(Cell, Option<f64>)> {
    if let StmtKind::Nc(nc) = kind {
        let cell = nc.ops().find_map(cell_of)?;
        return Some((cell, nc.word(Role::OffsetRow).and_then(Expr::constant)));
    }
    let StmtKind::Assign { target: Place::System(state, subscripts), .. } = kind else { return None };
    let cell = match state {
        Sys::LengthGeometry | Sys::LengthWear => Cell::Length,
        Sys::RadiusGeometry | Sys::RadiusWear | Sys::DiameterGeometry | Sys::DiameterWear => Cell::Radius,
        Sys::DiameterOrRadius | Sys::DiameterOrRadiusWear => Cell::Radius,
        Sys::ToolOffset => Cell::Both,
        _ => return None,
    };
    Some((cell, subscripts.first().and_then(Expr::constant)))
}

/// The cell that a code writes.
fn cell_of(op: Op) -> Option<Cell> {
    match op {
        Op::WriteLength | Op::WriteLengthWear => Some(Cell::Length),
        Op::WriteRadius | Op::WriteRadiusWear => Some(Cell::Radius),
        Op::WriteOffset => Some(Cell::Both),
        _ => None,
    }
}

fn length_in_force(state: &Modal, row: Option<f64>) -> bool {
    match state.of(Group::LengthComp) {
        Setting::Known(Op::LengthOff, _) => false,
        Setting::Known(_, Some(there)) => row.is_none_or(|row| row == f64::from(there)),
        Setting::Known(_, None) => true,
        Setting::Unknown => state.names_length(),
    }
}

fn radius_in_force(state: &Modal) -> bool {
    matches!(state.op(Group::RadiusComp), Some(Op::RadiusLeft | Op::RadiusRight))
}

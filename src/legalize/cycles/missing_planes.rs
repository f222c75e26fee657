//! Drilling cycles that are told no retract plane.
//!
//! Law: a plane that a cycle was told lasts until cycles are off, on every control. Where none was told, each control has a plane of its
//! own: nothing is changed, and the program rests on what both do. Side conditions: a program that returns and that is entered in a cycle may have been told
//! one; on a way on which it may have been told, nothing is said. Counter-example: `G81 R2. Z-5.`, then `X10. Z-8.`, which has the plane of the first hole.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::{Module, Stmt};
use crate::legalize::each_step::each_step;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

const QUESTION: Question = Question::CycleRMissing;

/// True if the library drills, between two mills of which the source's table asks it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let is_mill = |control: &Control| control.machine() == Machine::Mill;
    is_mill(context.source)
        && is_mill(context.target)
        && context.source.behaviour(QUESTION).is_some()
        && features.any_op(drills)
}

fn drills(op: Op) -> bool {
    op.is_cycle() && op != Op::CycleOther
}

/// True where a plane may have been told since cycles were off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Told(bool);

impl Lattice for Told {
    fn join(&mut self, other: &Self) -> bool {
        self.0.join(&other.0)
    }
}

/// What a cycle begins with.
#[derive(Clone, Copy, PartialEq)]
enum Begins {
    /// No cycle begins, or one that has its plane.
    Told,
    /// No plane: true where cycles were off before it.
    Without(bool),
}

fn step(stmt: &Stmt, state: &mut Modal, told: &mut Told) -> Begins {
    let off = state.op(Group::Cycle) == Some(Op::CycleOff);
    state.step(stmt);
    let before = Told(told.0 && !off);
    *told = before;
    if state.op(Group::Cycle) == Some(Op::CycleOff) {
        *told = Told(false);
    }
    let Some(nc) = stmt.kind.nc() else { return Begins::Told };
    if nc.word(Role::CycleR).or(nc.word(Role::CycleRStep)).is_some() {
        // Under a block skip it may not have been; so it may have been.
        *told = Told(true);
        return Begins::Told;
    }
    if before.0 || !nc.ops().any(drills) { Begins::Told } else { Begins::Without(off) }
}

/// Says where programs rest on it.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let returns: Vec<bool> = module.programs.iter().map(|program| program.returns()).collect();
    each_step(module, &facts, step, |index, stmt, (_, begins)| {
        let Begins::Without(off) = begins else { return };
        if !off && returns.get(index) == Some(&true) {
            return;
        }
        let span = stmt.site.span;
        context.rests_on_source(index, span, QUESTION);
        if context.target.behaviour(QUESTION).is_some() {
            context.rests_on_target(index, span, QUESTION);
            context.must_agree(index, span, QUESTION);
        } else if context.source.behaviour(QUESTION).is_some_and(|row| row.value == "zero") {
            let finding = Diagnostic::new(Code::NoEquivalent, span, ZERO);
            context.add_once(index, ZERO, finding.with_help("write the retract plane into the block"));
        }
    });
}

const ZERO: &str = "this drilling cycle is told no retract plane, which is then 0 on the source, and the place of the tool on the target";

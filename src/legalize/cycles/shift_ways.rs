//! Which way a boring cycle moves the tool off the wall, where its code says only how far.
//!
//! Law: a parameter or a setting of the machine says the way. Where both are known and the same the word stays; where they differ, the words of the
//! target for both axes say it, if its code has them. Side conditions: the plane is that of X and Y, and the shift stands in the block that begins
//! the cycle, after none or the same: a cycle before may leave its own words. Counter-example: `Q0.2` on a machine that goes off along
//! X in minus and on one that goes in plus: the bar is drawn along the wall.

use crate::canon::{Func, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side, matters};
use crate::ir::{Expr, Module, Nc, NcItem, Program, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use std::collections::BTreeMap;
use thin_vec::thin_vec;

/// The cycles with a shift.
const BORES: [Op; 2] = [Op::CycleFineBore, Op::CycleBackBore];

/// A way: along the second axis of the plane or the first, and in minus or plus.
pub(super) type Way = (bool, bool);

/// True where there are such cycles.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.any_op(|op| BORES.contains(&op))
}

/// The way of a machine, if it is known.
pub(super) fn way(control: &Control) -> Option<Way> {
    match control.behaviour(Question::CycleShift).map(|row| row.value.as_str()) {
        Some("x+") => Some((false, false)),
        Some("x-") => Some((false, true)),
        Some("y+") => Some((true, false)),
        Some("y-") => Some((true, true)),
        _ => control.has_tried(matters::SHIFT).then_some((false, false)),
    }
}

/// True where the code of a cycle takes a word.
fn takes(control: &Control, op: Op, role: Role) -> bool {
    control.code_for(op, &BTreeMap::new()).is_some_and(|row| row.takes(role))
}

/// Says the way where the machines differ in it, and asks where one of them is not known.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let states = program.ids().map(|id| facts.at(index, id)).collect();
        changed |= each(program, states, index, context);
    }
    changed
}

fn each(program: &mut Program, states: Vec<Modal>, index: usize, context: &mut Context<'_>) -> bool {
    let (source, target) = (context.source, context.target);
    let (here, there) = (way(source), way(target));
    let mut changed = false;
    for (block, mut state) in program.blocks.iter_mut().zip(states) {
        for stmt in &mut block.stmts {
            let before = state.op(Group::Cycle);
            state.step(stmt);
            let span = stmt.site.span;
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            let Some(op) = nc.ops().find(|op| BORES.contains(op)) else {
                let lasts = before.is_some_and(|op| BORES.contains(&op));
                if lasts
                    && nc.word(Role::CycleQ).is_some()
                    && here.is_some()
                    && there.is_some()
                    && here != there
                {
                    context
                        .add(index, Diagnostic::new(Code::NoEquivalent, span, LATER).with_help(LATER_HELP));
                }
                continue;
            };
            if !takes(source, op, Role::CycleQ)
                || !takes(target, op, Role::CycleQ)
                || nc.word(Role::CycleQ).is_none()
            {
                continue;
            }
            let clear = before.is_some_and(|op| op == Op::CycleOff || BORES.contains(&op));
            let flat = !context.features.op(Op::PlaneZx) && !context.features.op(Op::PlaneYz);
            let has = [Role::CycleI, Role::CycleJ].iter().all(|role| takes(target, op, *role));
            let says = has && clear && flat;
            match (here, there) {
                (Some(here), Some(there)) if here == there => {}
                (None, None) => {
                    context.rests_on_source(index, span, Question::CycleShift);
                    // Once the way of the source is known, the words say it there.
                    if !says {
                        context.rests_on_target(index, span, Question::CycleShift);
                    }
                }
                (None, Some(_)) => {
                    let help = source.to_settle(Question::CycleShift.fact(), Side::Source);
                    context.add_once(
                        index,
                        UNKNOWN,
                        Diagnostic::new(Code::NoEquivalent, span, UNKNOWN).with_help(help),
                    );
                }
                (Some(way), there) => {
                    if says {
                        write(nc, way);
                        changed = true;
                        continue;
                    }
                    let (what, help) = match there {
                        Some(_) => (DIFFER, DIFFER_HELP.to_owned()),
                        None => (UNKNOWN, target.to_settle(Question::CycleShift.fact(), Side::Target)),
                    };
                    context.add_once(
                        index,
                        what,
                        Diagnostic::new(Code::NoEquivalent, span, what).with_help(help),
                    );
                }
            }
        }
    }
    changed
}

/// Writes how far the tool goes along each axis in the place of the one word.
pub(super) fn write(nc: &mut Nc, (second, minus): Way) {
    for item in &mut nc.items {
        let NcItem::Word(role @ Role::CycleQ, value) = item else { continue };
        let far = match value.constant() {
            Some(by) => Expr::Number(if minus { -by.abs() } else { by.abs() }),
            None => {
                let far = Expr::Call(Func::Abs, thin_vec![value.clone()]);
                if minus { Expr::Negate(Box::new(far)) } else { far }
            }
        };
        *role = if second { Role::CycleJ } else { Role::CycleI };
        *value = far;
    }
}

const UNKNOWN: &str = "which way the boring bar leaves the wall is known of one of the two machines and not of the other: the wrong way draws it along the \
                       wall or into it";
const DIFFER: &str = "the two machines move the boring bar off the wall in different ways: the target would draw it along the wall or into it";
const DIFFER_HELP: &str = "set the target's machine as the source's, and write so in its profile; or, where the target's code has words for both axes, write G17, \
                           and G80 before the cycle";
const LATER: &str = "another shift of the boring bar than where the cycle began, and the two machines move it off the wall in different ways";
const LATER_HELP: &str = "write the code of the cycle again in this block, with all its words";

//! Arcs of more than half a turn by their radius, on a control of which no source says which arc a radius below 0 is.
//!
//! Law: such an arc is the one about its centre, and where that lies follows from its start, its end and the radius. The centre is
//! rounded to 0.00001 of the unit, less than the control resolves. Side conditions: the plane is XY, the target counts I and J from
//! the start, and where the arc begins is known: the words that named it last, or G91. Counter-example: `G2 X5. R-10.` after a call
//! that moves, which is refused until the target's profile says which arc that is.

use super::short_arcs::{centre, is_arc, other_planes};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::analysis::Modal;
use crate::ir::analysis::programmed::Programmed;
use crate::ir::{Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;

/// True if the target counts centres from the start, and no source says what a radius below 0 is there.
pub fn concerns(target: &Control) -> bool {
    let is = |question, value| target.behaviour(question).is_some_and(|row| row.value == value);
    is(Question::ArcRadiusNegative, "unknown") && is(Question::ArcCentre, "incremental")
}

/// Writes longer arcs by their centre.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let summaries = context.summaries(module);
    let planes = other_planes(module, context);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let starts = Programmed::of(program, &summaries, &|id| facts.at(index, id));
        for (id, block) in program.ids().zip(program.blocks.iter_mut()).collect::<Vec<_>>() {
            let mut state = facts.at(index, id);
            let mut here = starts.at(id).cloned();
            for stmt in &mut block.stmts {
                let start = here.as_ref().and_then(Programmed::words);
                state.step(stmt);
                here.iter_mut().for_each(|here| here.step(stmt, &state, &summaries));
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                let radius = nc.word(Role::ArcRadius).and_then(Expr::constant).filter(|radius| *radius < 0.0);
                let Some(radius) = radius.filter(|_| is_arc(nc, &state)) else { continue };
                let in_xy = match state.op(Group::Plane) {
                    Some(plane) => plane == Op::PlaneXy,
                    None => !planes[index],
                };
                match way(nc, &state, start).filter(|_| in_xy).and_then(|way| of(way, radius, &state)) {
                    Some([i, j]) => {
                        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::ArcRadius, _)));
                        let words = [(Role::ArcI, i), (Role::ArcJ, j)];
                        nc.items.extend(words.map(|(role, word)| NcItem::Word(role, Expr::Number(word))));
                    }
                    None => {
                        let title = &context.target.dialect().title;
                        let what = format!(
                            "an arc of more than 180 degrees by its radius: no source says which arc that is on a {title}, and \
                             its centre is not known"
                        );
                        let settled =
                            context.target.to_settle(Question::ArcRadiusNegative.fact(), Side::Target);
                        let help = format!(
                            "write I and J, or X and Y in absolute numbers in the move before; or {settled}"
                        );
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
                    }
                }
            }
        }
    }
}

fn of(way: [f64; 2], radius: f64, state: &Modal) -> Option<[f64; 2]> {
    centre(way, radius, state.op(Group::Motion) == Some(Op::ArcCcw))
}

/// The way from the start of an arc to its end, where it is a number.
fn way(nc: &Nc, state: &Modal, start: Option<[Expr; 2]>) -> Option<[f64; 2]> {
    let incremental = state.op(Group::Distance)? == Op::Incremental;
    let start = start.map(|start| start.map(|word| word.constant()));
    let mut way = [0.0; 2];
    for (axis, role) in [Role::X, Role::Y].into_iter().enumerate() {
        let Some(end) = nc.word(role) else { continue };
        let before = if incremental { Some(0.0) } else { start.and_then(|start| start[axis]) };
        way[axis] = end.constant()? - before?;
    }
    Some(way)
}

//! Places in machine coordinates that lie elsewhere on the target, as its profile says.
//!
//! Law: a move in machine coordinates to exactly such a place gets the words of the place where it lies on the target. The source is followed
//! as if it named them. Side conditions: all its axis words are numbers, none is an increment, and they count in
//! the unit of that profile. Counter-example: `G20 G53 X-11.` in a library of millimetres.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Units};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::{Context, Modal, ModalFacts};
use std::collections::HashSet;

/// A statement, by its program, its block and its place there.
pub(super) type At = (usize, BlockId, usize);

/// Gives them their words; where that was.
pub(super) fn run(module: &mut Module, facts: &ModalFacts, context: &mut Context<'_>) -> HashSet<At> {
    let mut moved = HashSet::new();
    let source = context.source;
    if source.places_there().is_empty() {
        return moved;
    }
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let mut state = facts.at(index, id);
            for (at, stmt) in block.stmts.iter_mut().enumerate() {
                state.step(stmt);
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                let Some(place) = place(nc, &state) else { continue };
                let Some(there) = source.places_there().of(&place, inch(&state, source)) else { continue };
                put(nc, there);
                moved.insert((index, id, at));
                context.add_once(index, MOVED, Diagnostic::new(Code::PlaceMoved, stmt.site.span, MOVED));
            }
        }
    }
    moved
}

const MOVED: &str = "the place of the old machine is written as the one where it lies on this machine, as the profile says under \
                     'machine_places'";

/// The place that a block goes to in machine coordinates; `state` is what is in force in it.
fn place(nc: &Nc, state: &Modal) -> Option<Vec<(Role, f64)>> {
    let of_machine = nc.has(Op::MachineOnce) || nc.has(Op::ShiftCancel);
    if !of_machine || state.op(Group::Distance) == Some(Op::Incremental) {
        return None;
    }
    let mut place = Vec::new();
    for item in &nc.items {
        let NcItem::Word(role, value) = item else { continue };
        if role.is_step() {
            return None;
        }
        if role.is_axis() {
            place.push((*role, value.constant()?));
        }
    }
    Some(place).filter(|place| !place.is_empty())
}

/// True where numbers are inches; none where neither the program nor the source's profile says it.
fn inch(state: &Modal, source: &Control) -> Option<bool> {
    match state.op(Group::Units) {
        Some(op) => Some(op == Op::Inch),
        None => source.units().map(|units| units == Units::Inch),
    }
}

/// Puts words in the place of those of the axes.
fn put(nc: &mut Nc, there: &[(Role, f64)]) {
    let is_axis = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis());
    let first = nc.items.iter().position(is_axis).unwrap_or(nc.items.len());
    nc.items.retain(|item| !is_axis(item));
    let words = there.iter().map(|(role, number)| NcItem::Word(*role, Expr::Number(*number)));
    for (at, word) in words.enumerate() {
        nc.items.insert(first + at, word);
    }
}

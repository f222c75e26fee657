//! Places in machine coordinates that lie elsewhere on the target, as its profile says.
//!
//! Law: a move in machine coordinates to exactly such a place gets the words of the place where it lies on the target. The source is followed
//! as if it named them. So does the block of a lathe that takes the tool offset away and goes to such a place. Side conditions: all its
//! axis words are numbers, or variables that hold one constant of the program there; none is an increment, nor is it under G91 where the
//! source does not take such words for places; and they count in the unit of that profile.
//! Counter-examples: `G20 G53 X-11.` in a library of millimetres; `G53 X#10` where `#10` may be one of two.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Units};
use crate::ir::analysis::{Assigned, Constant, Values, evaluate, tool_word};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, StmtKind, Var};
use crate::legalize::{Context, Modal, ModalFacts};
use std::collections::{HashMap, HashSet};

/// A statement, by its program, its block and its place there.
pub(super) type At = (usize, BlockId, usize);

/// Gives them their words; where that was.
pub(super) fn run(module: &mut Module, facts: &ModalFacts, context: &mut Context<'_>) -> HashSet<At> {
    let mut moved: HashMap<At, Vec<(Role, f64)>> = HashMap::new();
    let source = context.source;
    if source.places_there().is_empty() {
        return HashSet::new();
    }
    let summaries = context.summaries(module);
    let in_steps =
        source.behaviour(Question::MachineUnderIncremental).is_some_and(|row| row.value == "place");
    for (index, program) in module.programs.iter().enumerate() {
        let assigned = Assigned::new(program, &summaries);
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for (at, stmt) in block.stmts.iter().enumerate() {
                state.step(stmt);
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                let number = |value: &Expr| number(value, &|var| assigned.at(var, id, at));
                let Some(place) = place(nc, &state, in_steps, &number) else { continue };
                let Some(there) = source.places_there().of(&place, inch(&state, source)) else { continue };
                moved.insert((index, id, at), there.to_vec());
                context.add_once(index, MOVED, Diagnostic::new(Code::PlaceMoved, stmt.site.span, MOVED));
            }
        }
    }
    for ((index, id, at), there) in &moved {
        let stmt =
            module.programs[*index].blocks.get_mut(id.index()).and_then(|block| block.stmts.get_mut(*at));
        if let Some(StmtKind::Nc(nc)) = stmt.map(|stmt| &mut stmt.kind) {
            put(nc, there);
        }
    }
    moved.into_keys().collect()
}

/// The number that a value is, where its variables hold one constant each.
fn number(value: &Expr, assigned: &dyn Fn(Var) -> Option<Vec<Constant>>) -> Option<f64> {
    let held = |var: Var| match assigned(var).as_deref() {
        Some([Constant::Number(number)]) => Values::of(vec![*number]),
        _ => Values::ANY,
    };
    value.constant().or_else(|| match evaluate(value, &held) {
        Values::Few(all) if all.len() == 1 => all.first().copied(),
        _ => None,
    })
}

const MOVED: &str = "the place of the old machine is written as the one where it lies on this machine, as the profile says under \
                     'machine_places'";

/// The place that a block goes to in machine coordinates, or without a tool offset; `state` is what is in force in it, `in_steps` is true
/// where the source takes such words for places under G91 too, and `number` says what a word is.
fn place(
    nc: &Nc,
    state: &Modal,
    in_steps: bool,
    number: &dyn Fn(&Expr) -> Option<f64>,
) -> Option<Vec<(Role, f64)>> {
    let once = nc.has(Op::MachineOnce);
    let of_machine = once || nc.has(Op::ShiftCancel) || without_offset(nc);
    let steps = state.op(Group::Distance) == Some(Op::Incremental);
    if !of_machine || steps && !(once && in_steps) {
        return None;
    }
    let mut place = Vec::new();
    for item in &nc.items {
        let NcItem::Word(role, value) = item else { continue };
        if role.is_step() {
            return None;
        }
        if role.is_axis() {
            place.push((*role, number(value)?));
        }
    }
    Some(place).filter(|place| !place.is_empty())
}

/// True for a move of a lathe whose T word takes the tool offset away: its place hangs on the machine's zero.
pub(super) fn without_offset(nc: &Nc) -> bool {
    let home = nc.has(Op::ReferenceReturn) || nc.has(Op::Reference2);
    nc.moves() && !home && tool_word::takes_offset(nc) == Some(true)
}

/// True if numbers are inches; none if neither the program nor the source's profile says it.
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

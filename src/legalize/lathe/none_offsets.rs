//! Moves after a T word with offset 00, on lathes that do not take the same away by it.
//!
//! Law: none. A place in work coordinates under offset 00 counts with the geometry of the tool before, where 00 takes the wear alone away,
//! and without it where 00 takes the whole offset away. Where the two controls are known to differ the move is refused; where nobody
//! says it of one, it is asked once, and told with the first such place. A return to the reference position, a place in machine coordinates and an increment
//! are alike, and so is all that comes after the next T word with an offset.
//! Counter-example: `G0 X4. Z3. T0100`, a safe place on one machine and past the end of travel on the other.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question, Side};
use crate::ir::{Module, Nc};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

const QUESTION: Question = Question::TurretNone;

/// What a control answers to a question, where it is known.
pub(super) fn answer(control: &Control, question: Question) -> Option<&str> {
    control.behaviour(question).map(|row| row.value.as_str()).filter(|value| *value != "unknown")
}

/// True for a library with T words, between two lathes that do not answer a question alike.
pub(super) fn turns_apart(question: Question, features: &Features, context: &Context<'_>) -> bool {
    let (ours, theirs) = (answer(context.source, question), answer(context.target, question));
    let alike = ours.is_some() && ours == theirs;
    let turns = [context.source, context.target].iter().all(|one| one.machine() == Machine::Lathe);
    turns && features.role(Role::Turret) && !alike && !context.source.is_same_machine(context.target)
}

/// True for lathes that do not answer alike.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    turns_apart(QUESTION, features, context)
}

const HELP: &str = "write the way to the tool change as G28 U0 W0, or as a place in machine coordinates with G53; or end with the \
                    offset of the tool still in force";

/// Looks at each move.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let known = answer(context.source, QUESTION).is_some() && answer(context.target, QUESTION).is_some();
    facts.each(module, &mut |index, stmt, _, after| {
        if !after.turret_none || !stmt.kind.nc().is_some_and(|nc| goes_to_place(nc, after)) {
            return;
        }
        let span = stmt.site.span;
        if known {
            let (one, other) = match answer(context.source, QUESTION) {
                Some("wear") => (Side::Source, Side::Target),
                _ => (Side::Target, Side::Source),
            };
            let what = format!(
                "a place under offset 00: on the {one} 00 takes the wear of the tool alone away, on the {other} its whole offset, so the \
                 move goes to another place"
            );
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(HELP));
            return;
        }
        let mut told = Diagnostic::new(Code::Conditional, span, OPEN).with_help(OPEN_HELP);
        for (control, side) in [(context.source, Side::Source), (context.target, Side::Target)] {
            let setting = control.setting_of(QUESTION).filter(|_| answer(control, QUESTION).is_none());
            let Some(row) = setting else { continue };
            told = if side == Side::Source {
                told.lacking(row.name.clone())
            } else {
                told.lacking_there(row.name.clone())
            };
        }
        context.rests_on_source(index, span, QUESTION);
        context.rests_on_target(index, span, QUESTION);
        context.add_once(index, OPEN, told.asked_once());
    });
}

const OPEN: &str = "a place under offset 00: one of the two lathes takes the whole tool offset away by 00, and of the other no one says \
                    whether its geometry stays: if it does, this move goes to another place on the target";
const OPEN_HELP: &str = "say in the machine's profile what its offset 00 takes away; or write the way to the tool change as G28 U0 W0, or \
                         as a place in machine coordinates with G53";

/// True for a block that names a place in work coordinates.
fn goes_to_place(nc: &Nc, after: &Modal) -> bool {
    let steps = after.op(Group::Distance) == Some(Op::Incremental);
    let places = [Role::X, Role::Y, Role::Z].into_iter().any(|role| nc.word(role).is_some());
    // A code that takes the words for something else goes nowhere; a return goes by the place that it names.
    let aside = |op: Op| op == Op::MachineOnce || (op.takes_axes() && !op.is_return());
    places && !steps && !nc.ops().any(aside)
}

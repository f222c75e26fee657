//! What a program takes from outside, by its text.

use super::input::Inputs;
use super::reader::{Locals, Reader};
use crate::canon::Sys;
use crate::control::ProgramRef;
use crate::control::scenario::SharedRows;
use crate::dialect::{Control, Question};
use crate::syntax::{Item, ItemKind, Label};
use crate::verify::compare::lacks_messages;
use crate::verify::sides::Side;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Reads a program that is held against one on the `other` side: only if that has locals can both be given some.
pub fn inputs(side: &Side<'_>, program: ProgramRef, other: &Side<'_>) -> Inputs {
    let locals = if other.has_locals() { Locals::All } else { Locals::None };
    let order: Vec<u32> = labels(side, program).into_iter().take(LABELS).collect();
    set_for(inputs_by(side, program, locals, &order), side, other)
}

/// Where the target selects no unit, both machines are set to the one that the source selects: the target checks it. Where
/// only the target has stops with messages, a text before a stop of the source is one there. What the profiles say of the
/// machines is so in all runs, those of edited texts too.
pub fn set_for(found: Inputs, source: &Side<'_>, target: &Side<'_>) -> Inputs {
    let inch = found.inch.or(found.selected.filter(|_| !target.selects_unit()));
    let sets_named = lacks_messages(source.control) && !lacks_messages(target.control);
    let apart = |kept: &dyn Fn(&Control) -> bool| kept(source.control) && !kept(target.control);
    let unworn = found.unworn && !keeps_wear(target.control) || apart(&keeps_wear);
    let unworn_lengths = apart(&|control| control.system_runs(Sys::LengthWear).next().is_some());
    let zero_is_home =
        source.control.behaviour(Question::LengthOffZero).is_some_and(|row| row.value == "home");
    let second_home = target.control.second_home();
    let peck_clearance = [source, target].into_iter().find_map(|side| side.control.peck_clearance());
    let one_table = one_table(source.control, target.control).map(Arc::new);
    let found = Inputs { inch, sets_named, unworn, unworn_lengths, one_table, ..found };
    Inputs { zero_is_home, second_home, peck_clearance, ..found }
}

/// How rows stand in both tables, where the source has one number a row for lengths and radii, and the target has two. The other way round
/// no one number is both of a row.
fn one_table(source: &Control, target: &Control) -> Option<SharedRows> {
    let rows = source.one_table().filter(|_| target.holds_offsets_apart())?;
    let radii = source.behaviour(Question::RadiusOffsetTable).is_some_and(|row| row.value == "radius");
    Some(SharedRows { per: if radii { 1.0 } else { 2.0 }, rows })
}

/// True where a control keeps the wear of a tool's radius in a place of its own.
fn keeps_wear(control: &Control) -> bool {
    let kept = |state| control.system_runs(state).next().is_some();
    [Sys::RadiusWear, Sys::DiameterWear, Sys::DiameterOrRadiusWear].into_iter().any(kept)
}

/// Labels that a computed jump is sent to, at the most, where one side is looked at.
const LABELS: usize = 20;

/// The numbers that jumps in a program can find.
pub fn labels(side: &Side<'_>, program: ProgramRef) -> BTreeSet<u32> {
    let items = side.text(program).iter().flat_map(|block| &block.items);
    let number = |item: &Item| match &item.kind {
        ItemKind::Sequence { number, .. } | ItemKind::Label(Label::Number(number)) => Some(*number),
        _ => None,
    };
    items.filter_map(number).collect()
}

/// Reads a program whose computed jumps are sent to these labels, and that may be given these `locals`.
pub(super) fn inputs_by(side: &Side<'_>, program: ProgramRef, locals: Locals<'_>, order: &[u32]) -> Inputs {
    let mut reader = Reader::new(side.control, locals);
    for (at, one) in side.links().called_from(program, |_| true).into_iter().enumerate() {
        reader.own = if at == 0 { locals } else { Locals::None };
        reader.labels =
            if at == 0 { order.to_vec() } else { labels(side, one).into_iter().take(LABELS).collect() };
        side.text(one).iter().for_each(|block| reader.items(&block.items, at == 0));
    }
    let way = side.control.behaviour(Question::RotaryWay);
    Inputs {
        rotary: side.links().rotary(),
        turns_by_sign: way.is_some_and(|row| row.value == "sign"),
        many_tools: has_many_tools(side),
        ..reader.finish()
    }
}

/// True if a table of tool offsets has more rows than two digits count.
fn has_many_tools(side: &Side<'_>) -> bool {
    let rows = side.control.dialect().system.iter().filter(|row| row.state.is_tool_offset());
    rows.filter_map(|row| row.subscripts.first()).any(|subscript| subscript.count > 99)
}

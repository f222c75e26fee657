//! The circumstances of a run on the target, from those of the source.

use crate::canon::{Group, Op};
use crate::control::trace::EventKind;
use crate::control::{Run, Scenario};
use crate::dialect::{Control, Units};
use crate::ir::flag_of;
use crate::verify::compare::lacks_messages;
use crate::verify::sides::{Side, SymbolMap, class_of};
use std::collections::BTreeMap;

/// Both machines are set to the unit of the one that states any: what a program does not say itself is for
/// the shop to see to, or what it checks ([`super::inputs::Inputs::inch`]).
pub fn unit(side: &Side<'_>, other: &Side<'_>) -> Option<bool> {
    side.control.units().or(other.control.units()).map(|units| units == Units::Inch)
}

/// The unit that the operator sets a target to whose programs cannot select one: that which the source comes to. In
/// the other one the target's check stops it before anything moves.
pub fn set_by_hand(target: &Side<'_>, run: &Run) -> Option<bool> {
    if target.control.units().is_some() || target.selects_unit() {
        return None;
    }
    run.modes.iter().find(|op| op.group() == Group::Units).map(|op| *op == Op::Inch)
}

/// The same circumstances on the target: variables by their names there. One that has none is left out; `theirs` are
/// those that the target alone has.
///
/// A register that nothing has set yet may be vacant there: a conversion that is run first has to see to it, one that
/// is `called` finds what its callers left. `run` is what the source did in them.
pub fn on_target(
    (scenario, run): (&Scenario, &Run),
    names: &SymbolMap,
    (source, target): (&Side<'_>, &Side<'_>),
    (called, theirs): (bool, &BTreeMap<String, f64>),
) -> Scenario {
    let mut out = scenario.clone();
    out.sets_named = lacks_messages(target.control) && !lacks_messages(source.control);
    out.inch = scenario.set_to_inch.or(set_by_hand(target, run)).or(unit(target, source)).or(scenario.inch);
    out.variables.clear();
    for (name, value) in &scenario.variables {
        let nullable = class_of(source.control, name).is_some_and(|class| class.nullable);
        if *value == 0.0 && !nullable && !called {
            continue;
        }
        if let Some(name) = names.variable(name, source.control, target.control) {
            out.variables.insert(name, *value);
        }
        // Whoever gives a variable a value on a target without vacancy says so in its flag.
        if let Some(flag) = names.variable(&flag_of(name), source.control, target.control) {
            out.variables.insert(flag, 1.0);
        }
    }
    // What a program that is called finds its callers have seen to, whether it is known to read it or not.
    if called {
        let never_vacant =
            |name: &String| class_of(source.control, name).is_some_and(|class| !class.nullable);
        let all = names.variables.keys().cloned().chain(banked(names, source.control));
        for name in all.filter(|name| never_vacant(name)) {
            if let Some(there) = names.variable(&name, source.control, target.control) {
                out.variables.entry(there).or_insert(0.0);
            }
        }
    }
    out.variables.extend(theirs.iter().map(|(name, value)| (name.clone(), *value)));
    // Emulations take more blocks than what they stand for.
    out.steps = scenario.steps.saturating_mul(20);
    out
}

/// The variables that computed numbers may reach, which are named all at once.
fn banked<'n>(names: &'n SymbolMap, control: &'n Control) -> impl Iterator<Item = String> + 'n {
    let letters = names.variables.keys().filter_map(|name| name.strip_suffix("(..)"));
    letters.flat_map(|letter| {
        let rows = control.classes().iter().filter(move |row| row.name == letter);
        rows.flat_map(|row| row.first..=row.last).map(move |number| format!("{letter}{number}"))
    })
}

/// How many answers a run took: after the last one of the scenario they were 0.
pub fn asked(run: &Run) -> usize {
    run.events.iter().filter(|event| matches!(event.what, EventKind::Asked { .. })).count()
}

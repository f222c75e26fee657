//! Which class of the target's variables a temporary must be in, by the places where it stands.
//!
//! Most controls take any variable anywhere. One whose words take variables of one class alone has few of them, so that
//! only what stands in words gets one: those colours are counted apart from all others.

use crate::dialect::{Control, OperandPlace, VariableClass};
use crate::ir::{Class, Expr, Program, Var};
use crate::legalize::expressions::split::place_of;
use crate::legalize::rewrite;
use foldhash::HashMap;
use std::collections::BTreeSet;

/// Colours of a class of its own begin with a multiple of this.
pub(super) const APART: u32 = 1_000_000;

/// The classes that some place of the target asks for, in order.
pub(super) fn classes(target: &Control) -> BTreeSet<&str> {
    OperandPlace::ALL.iter().filter_map(|place| target.form(*place)?.class.as_deref()).collect()
}

/// By temporary, the first of the colours that it may have; those that may have any are left out.
pub(super) fn first_colours(program: &mut Program, target: &Control) -> HashMap<u32, u32> {
    let mut found = HashMap::default();
    let classes: Vec<&str> = classes(target).into_iter().collect();
    if classes.is_empty() {
        return found;
    }
    let mut note = |e: &mut Expr, place: OperandPlace| {
        let class = target.form(place).and_then(|form| form.class.as_deref());
        let at = class.and_then(|class| classes.iter().position(|other| *other == class));
        let (Some(at), Some(number)) = (at, temporary(e)) else { return };
        found.insert(number, APART * (at as u32 + 1));
    };
    for block in &mut program.blocks {
        for stmt in &mut block.stmts {
            rewrite::statement(&mut stmt.kind, &mut |e, position| note(e, place_of(position)));
        }
        rewrite::terminator(&mut block.term.kind, &mut |e, position| note(e, place_of(position)));
    }
    found
}

/// The temporary that an operand is, whatever its sign.
fn temporary(e: &Expr) -> Option<u32> {
    match e {
        Expr::Var(Var { class: Class::Temp, number }) => Some(*number),
        Expr::Negate(inner) => temporary(inner),
        _ => None,
    }
}

/// The class that a colour is counted in, if it is one apart.
pub(super) fn class_of_colour(var: Var, target: &Control) -> Option<&str> {
    if !matches!(var.class, Class::Temp | Class::Static) {
        return None;
    }
    let at = (var.number / APART).checked_sub(1)?;
    classes(target).into_iter().nth(at as usize)
}

/// The rows of the target that anything may have a register of: those before a number that is in the free space.
pub(super) fn is_general(row: &VariableClass, target: &Control) -> bool {
    !matches!(row.class.as_str(), "local" | "letter") && !classes(target).contains(row.class.as_str())
}

/// True if programs of the target have local variables.
pub(in crate::legalize) fn has_locals(target: &Control) -> bool {
    target.classes().iter().any(|row| row.class == "local")
}

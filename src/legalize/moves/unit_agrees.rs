//! Units of programs for a control that takes another one than it is set to for a fault.
//!
//! Law: a code for a unit does nothing there but to agree with the setting. Side condition: the target's profile says the unit. A
//! program that names the other one stops at an alarm, so the machine is set for the job: that is asked once for the library. What lengths
//! the settings of a lathe hold then, its cycles ask for themselves. On a lathe that is set to one unit nothing runs that comes to both: a
//! program that names both, or calls one that names the other one, or comes to a length before it names the other one, is refused.
//! Counter-example: `G21` below a block in inches, with `units = "inch"`.

use super::turned_units::{Turned, named_below};
use super::units::open;
use crate::assume::Predicate;
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Machine, Question};
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

/// True if the library names a unit that the target's profile does not.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let other = Turned::of(context.target);
    context.target.is(Question::UnitsAgree) && other.is_some_and(|other| features.op(other.op))
}

/// Tells of the programs that name the other unit, at the first block that does, and of those that come to both.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some(turned) = Turned::of(context.target) else { return };
    let is_lathe = context.target.machine() == Machine::Lathe;
    let title = context.target.dialect().title.clone();
    let what = format!(
        "the program names {}, and the {title} is set to {}: that is an alarm there",
        turned.program, turned.profile
    );
    let help = format!(
        "set the machine to {0} before such a program. If all programs are in {0}, say so in its profile (units); if the setting is \
         turned with each job, leave units out of it",
        turned.program
    );
    let both = if is_lathe { in_both(module, turned, context) } else { Vec::new() };
    for (index, program) in module.programs.iter().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let own = stmts.find(|stmt| stmt.kind.has_op(turned.op)).map(|stmt| stmt.site.span);
        if both.get(index) == Some(&true) {
            let what = format!(
                "this runs in inches and in millimetres, one after the other: the {title} is set to one of them, and the other one is an alarm there"
            );
            let span = own.unwrap_or(program.site.span);
            let help = "write all of it in one unit, with its code in the first block, and the programs that it calls too";
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
            continue;
        }
        if let Some(span) = own {
            let finding =
                Diagnostic::new(Code::Conditional, span, what.clone()).with_help(help.clone()).asked_once();
            let finding = if is_lathe { finding.assuming(Predicate::SetTo(turned.op)) } else { finding };
            context.add_once(index, &what, finding);
        }
    }
}

/// By program: true where a run of it names both units, or comes to a length in the unit of the profile before it names the other one.
fn in_both(module: &Module, turned: Turned, context: &mut Context<'_>) -> Vec<bool> {
    let facts = context.modal_facts(module);
    let called = context.called(module);
    let open = open(module, &facts, &called, false);
    let named = named_below(module, &called.pairs(module));
    let both = |(named, open): (&BTreeSet<Op>, bool)| {
        named.contains(&turned.op) && (open || named.contains(&turned.own()))
    };
    named.iter().zip(open).map(both).collect()
}

//! Arguments that every call of the library gives a value: nobody is asked whether they have one.
//!
//! What asks for them on the source is settled then. It is told, for a program that is written for the target later may
//! leave one out.

use crate::diag::{Code, Diagnostic};
use crate::ir::{Class, Cond, Expr, Module, Program, Relation, TermKind, Var};
use crate::legalize::Context;
use crate::legalize::registers::names::{in_a_sentence, numbered_name};
use std::collections::BTreeSet;

/// Tells of the programs that ask, and keeps for the lock what is always given.
pub(super) fn tell(module: &Module, always: &[BTreeSet<u32>], context: &mut Context<'_>) {
    for (index, (program, always)) in module.programs.iter().zip(always).enumerate() {
        let Some(name) = program.name.clone().filter(|_| !always.is_empty()) else { continue };
        let said = |number: &u32| numbered_name(Var { class: Class::Local, number: *number }, context.source);
        let asked: Vec<String> = asked(program, always).iter().filter_map(said).collect();
        context.always.insert(name, always.iter().filter_map(said).collect());
        if !asked.is_empty() {
            let what = format!(
                "every call in the library gives {} a value: what the program does without is left out",
                in_a_sentence(&asked)
            );
            context.add(index, Diagnostic::new(Code::AlwaysGiven, program.site.span, what));
        }
    }
}

/// Those of these locals that a program holds against what has no value.
fn asked(program: &Program, always: &BTreeSet<u32>) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for block in &program.blocks {
        if let TermKind::Branch { cond, .. } = &block.term.kind {
            in_condition(cond, &mut found);
        }
    }
    &found & always
}

fn in_condition(cond: &Cond, found: &mut BTreeSet<u32>) {
    match cond {
        Cond::Compare(Relation::Equal | Relation::NotEqual, Expr::Var(var), Expr::Vacant)
        | Cond::Compare(Relation::Equal | Relation::NotEqual, Expr::Vacant, Expr::Var(var))
            if var.class == Class::Local =>
        {
            found.insert(var.number);
        }
        // Parsers limit how deep conditions nest.
        Cond::And(parts) | Cond::Or(parts) => parts.iter().for_each(|part| in_condition(part, found)),
        Cond::Not(inner) => in_condition(inner, found),
        _ => {}
    }
}

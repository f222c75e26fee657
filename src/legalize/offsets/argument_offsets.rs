//! Tool offsets that calls give and the target does not have.
//!
//! Law: where a program names a tool offset by an argument that it sets nowhere itself, each call of it gives one that the
//! target has. Counter-example: `G65 P9010 H120` of a program with `G43 H#11`, for a control with 99 offsets. Side condition:
//! the call gives a number; what it computes is not known here.

use super::offset_numbers::{NAMES, last};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Call, Callee, Class, Expr, Module, Place, Program, StmtKind, TermKind, Var};
use crate::legalize::Context;
use std::collections::BTreeSet;

/// Refuses calls that give numbers past the last one.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some(last) = last(context.target) else { return };
    let named: Vec<BTreeSet<u32>> = module.programs.iter().map(named).collect();
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            let TermKind::Call { call, .. } = &block.term.kind else { continue };
            let Some(number) = past(call, module, &named, last) else { continue };
            let title = &context.target.dialect().title;
            let what = format!("this call gives tool offset {number}, and the {title} has {last}");
            let help = "give the tool an offset that the machine has; 'offsets' in its profile may say that it has less than \
                        its table";
            let found = Diagnostic::new(Code::NoEquivalent, block.term.site.span, what).with_help(help);
            context.add(index, found);
        }
    }
}

/// The number past the last one that a call gives for an offset.
fn past(call: &Call, module: &Module, named: &[BTreeSet<u32>], last: u32) -> Option<f64> {
    let Callee::Program(name) = &call.callee else { return None };
    let callee = module.programs.iter().position(|program| program.name.as_ref() == Some(name))?;
    let offsets = named.get(callee)?;
    let given = call.arguments.iter().filter(|argument| call.level && offsets.contains(&argument.local));
    given.filter_map(|argument| argument.value.constant()).find(|number| *number > f64::from(last))
}

/// The locals by which a program names offsets, and which it does not set.
fn named(program: &Program) -> BTreeSet<u32> {
    let (mut named, mut set) = (BTreeSet::new(), BTreeSet::new());
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        if let StmtKind::Nc(nc) = &stmt.kind {
            let values = NAMES.iter().filter_map(|role| nc.word(*role));
            named.extend(values.filter_map(|value| match value {
                Expr::Var(Var { class: Class::Local, number }) => Some(*number),
                _ => None,
            }));
        }
        match stmt.kind.target() {
            Some(Place::Var(var)) => {
                set.insert(var.number);
            }
            // By a computed number it may set any of them.
            Some(_) => return BTreeSet::new(),
            None => {}
        }
    }
    named.difference(&set).copied().collect()
}

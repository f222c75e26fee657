//! Codes that the target takes for a fault while another one is in force.
//!
//! A control may refuse a tool change under cutter compensation, or a cycle that is set in increments. The source's need
//! not mind, so the program is refused here, and not at the machine. The same goes for words that may not stand beside a
//! code, and for values below 0. What is in force is followed through the library;
//! where it is not known, because callers differ or nothing says it, only the verifier's runs can find it.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Forbidden};
use crate::ir::{BlockId, Module, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;
use std::collections::BTreeMap;

/// True if the target has such codes.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    !context.target.dialect().forbidden.is_empty()
}

/// Refuses what the target would stop at.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &block.stmts {
                let before = state.clone();
                state.step(stmt);
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                let value = |role| nc.word(role).map(|value| value.constant());
                // What the source takes for a fault too was said of it.
                let clash = context.target.clash(|op| nc.has(op), value);
                if let Some(clash) = clash.filter(|_| !context.is_faulty(index, stmt.site.span)) {
                    let what = context.target.clash_in_words(clash);
                    let found = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what);
                    let help = clash.row.help.clone();
                    let found = if let Some(help) = help { found.with_help(help) } else { found };
                    context.add(index, found);
                }
                for op in nc.ops() {
                    // A code of the same group ends the other one: what was in force until then counts.
                    let state = |other: Op| if other.group() == op.group() { &before } else { &state };
                    let in_force = |other: Op| state(other).op(other.group()) == Some(other);
                    check(op, in_force, stmt.site.span, index, context);
                }
            }
            if let TermKind::End { rewind } = block.term.kind {
                let op = if rewind { Op::EndRewind } else { Op::End };
                let in_force = |other: Op| state.op(other.group()) == Some(other);
                check(op, in_force, block.term.site.span, index, context);
            }
        }
    }
}

/// Refuses a code that is a fault under one in force.
fn check(op: Op, in_force: impl Fn(Op) -> bool, span: Span, index: usize, context: &mut Context<'_>) {
    let Some(row) = context.target.forbids(op, &in_force) else { return };
    let under = row.under.iter().copied().find(|under| in_force(*under));
    if let Some(question) = &row.asks {
        // A source that has the row too ran the program as it is.
        let ran = context.source.forbids(op, &in_force).is_some_and(|own| own.asks.is_some());
        if ran || context.target.allows(row) {
            return;
        }
        let what = format!(
            "{}: its makers' manuals say not to write it so",
            describe(op, under, row, context.target)
        );
        let help = format!(
            "end it in a block before, and begin it again after; or, where the machine takes the code, write in its profile, under \
             [behaviours]: \"{question}\" = \"kept\""
        );
        let told = Diagnostic::new(Code::Conditional, span, what).with_help(help);
        return context.add_once(index, &format!("forbidden {} {under:?}", op.name()), told);
    }
    let what = describe(op, under, row, context.target);
    let help = "end it in a block before, or write the part without it";
    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
}

fn describe(op: Op, under: Option<Op>, row: &Forbidden, target: &Control) -> String {
    let spelled = |op: Op| match target.code_for(op, &BTreeMap::new()) {
        Some(code) => code.code.clone(),
        None => op.meaning().trim().trim_end_matches('.').to_lowercase(),
    };
    let under = under.map(spelled).unwrap_or_default();
    let fault = if row.asks.is_some() { "may be a fault" } else { "is a fault" };
    format!("{} while {under} is in force {fault} on the target ({})", spelled(op), row.origin.source)
}

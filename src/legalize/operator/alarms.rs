//! Numbers of alarms outside of what a control takes.
//!
//! Law: an alarm of a number that both controls take is an alarm of that number on both. What a control does with
//! another number is in no source; such an alarm stays, for review.

use crate::assume::Predicate;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::text::Span;

/// Reports alarm numbers that are too large, no whole number above 0, or not known.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let most = |control: &Control| {
        control.behaviour(Question::AlarmMax).and_then(|row| row.value.parse().ok()).unwrap_or(f64::INFINITY)
    };
    let (here, there) = (most(context.source), most(context.target));
    for (index, program) in module.programs.iter().enumerate() {
        let mut past = Vec::new();
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Alarm { number, .. } = &stmt.kind else { continue };
            check(number, (here, there), index, stmt.site.span, context);
            past.extend(number.constant().filter(|n| *n > there).map(|n| (n, stmt.site.span)));
        }
        too_large(past, there, index, context);
    }
}

/// Reports the numbers of a program that the target is not said to take, all at once.
fn too_large(past: Vec<(f64, Span)>, there: f64, index: usize, context: &mut Context<'_>) {
    let Some((_, span)) = past.first().copied() else { return };
    let mut numbers: Vec<f64> = past.into_iter().map(|(number, _)| number).collect();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    let named: Vec<String> = numbers.iter().take(NAMED).map(f64::to_string).collect();
    let more = match numbers.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let (title, alarm) =
        (&context.target.dialect().title, if numbers.len() == 1 { "another alarm" } else { "other alarms" });
    let what = format!(
        "{title} is said to take alarm numbers up to {there}: {}{more} may show as {alarm}",
        named.join(", ")
    );
    context.add(index, Diagnostic::new(Code::Conditional, span, what));
}

/// So many numbers are named; of the others it is said how many there are.
const NAMED: usize = 5;

fn check(number: &Expr, (here, there): (f64, f64), index: usize, span: Span, context: &mut Context<'_>) {
    match number.constant() {
        Some(n) if n < 1.0 || n.fract() != 0.0 => {
            let what = format!("no source says what an alarm with the number {n} does");
            context.add_once(index, &what, Diagnostic::new(Code::Conditional, span, what.clone()));
        }
        Some(n) if n > here => {
            context.rests_on_source(index, span, Question::AlarmMax);
        }
        None if there < here => {
            let what = format!(
                "the number of the alarm is computed: make sure that it is 1 to {there}, which \
                         the target is said to take"
            );
            let finding = Diagnostic::new(Code::Conditional, span, what).assuming(Predicate::Alarms(there));
            context.add_once(index, "computed alarm", finding);
        }
        _ => {}
    }
}

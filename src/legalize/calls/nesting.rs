//! Calls that nest deeper than the target takes.
//!
//! Law: where calls from a program cannot nest deeper than the target's limits, both controls reach the same
//! programs. Where a chain of calls outside of circles is longer, the target stops with an alarm that the source does not
//! raise: it is refused. Where programs call each other in a circle, or a call is computed, how deep they nest is for
//! data to decide: then the limit is a condition. Side condition: a call that leaves the library counts as one level;
//! `link` reports those. Where calls reach parts of the same program alone, [`super::inlined`] writes out what nests
//! deeper.

mod routines;

use crate::assume::Predicate;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Limit, Side, to_confirm};
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::calls::merged;
use crate::text::Span;
use routines::{Edge, Routines};

/// The limits, and which calls count for each: those that open a level of locals or those that do not.
const LIMITS: [(&str, [bool; 2]); 3] =
    [("call.all", [true, true]), ("call.macro", [false, true]), ("call.subprogram", [true, false])];

/// Reports programs whose calls may nest too deep.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let target = context.target;
    if merged::concerns(target) {
        return;
    }
    let known = |name: &str| context.source.limit_row(name).filter(|row| row.origin.is_settled())?.max;
    // A source that takes no more stops first.
    let here: Vec<Option<u32>> = LIMITS.iter().map(|(name, _)| known(name)).collect();
    let limits = LIMITS.iter().zip(&here).filter_map(|((name, counted), here)| {
        let row = target.limit_row(name)?;
        let most = row.max?;
        here.is_none_or(|here| here > most).then_some((row, most, counted))
    });
    let mut limits: Vec<(&Limit, u32, &[bool; 2])> = limits.collect();
    let Some(highest) = limits.iter().map(|(_, most, _)| *most).max() else { return };
    limits.sort_by_key(|(_, most, _)| *most);
    let routines = Routines::of(module, highest);
    // How deep the source nests calls of each kind before it stops itself; none if it has no limit.
    let own = |at: usize| here[at].map(|most: u32| routines.depths(most, &LIMITS[at].1));
    let (macros, subprograms) = (own(1), own(2));
    let stops_at = |at: usize| Some(macros.as_ref()?[at] + subprograms.as_ref()?[at]);
    for sure in [true, false] {
        for (row, most, counted) in &limits {
            let depths = if sure { routines.longest(counted) } else { routines.depths(most + 1, counted) };
            for (program, routine) in routines.mains.iter().enumerate() {
                if depths[*routine] > *most && stops_at(*routine).is_none_or(|stops| stops > *most) {
                    let below = |edge: &&Edge| depths[edge.to] + u32::from(counted[usize::from(edge.level)]);
                    let deepest = routines.calls[*routine].iter().max_by_key(below);
                    let span = deepest.map_or(Span::default(), |edge| edge.span);
                    let sure = sure.then_some(depths[*routine]);
                    report(program, span, (row, *most, counted), sure, context);
                }
            }
        }
    }
}

/// Reports a program; `deep` where its calls surely nest so deep.
fn report(
    index: usize,
    span: Span,
    (row, most, counted): (&Limit, u32, &[bool; 2]),
    deep: Option<u32>,
    context: &mut Context<'_>,
) {
    let title = &context.target.dialect().title;
    let kind = match row.name.as_str() {
        "call.macro" => "macro calls",
        "call.subprogram" => "subprogram calls",
        _ => "calls",
    };
    let how = match deep {
        Some(deep) => format!("{kind} nest {deep} deep from here, but"),
        None => format!("{kind} may nest deeper from here, but"),
    };
    let what = format!("{how} {title} takes {most} levels and stops with an alarm at more");
    let finding = match (row.origin.is_settled(), deep) {
        (false, _) => {
            let fact = format!("limit:{}", row.name);
            Diagnostic::new(Code::UnconfirmedFact, span, what).with_help(to_confirm(&fact, Side::Target))
        }
        (true, None) => Diagnostic::new(Code::Conditional, span, what),
        (true, Some(_)) => Diagnostic::new(Code::NoEquivalent, span, what)
            .with_help("move one of the calls up to a program nearer the main program"),
    };
    let predicate = Predicate::Nesting { limit: row.name.as_str().into(), counts: *counted, most };
    context.add_once(index, "nesting", finding.assuming(predicate));
}

//! Calls that nest deeper than the target takes.
//!
//! Law: where calls from a program cannot nest deeper than the target's limits, both controls reach the same
//! programs. Where they may, the target can stop with an alarm that the source does not raise; so may it where
//! programs call each other in a circle. Side condition: a modal call counts where it is set, not in the programs that are
//! called under it, and a computed call counts for nothing; `link` reports those.

use super::{Context, calls_of, reachable, span_of};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Limit, Side, to_confirm};
use crate::ir::{BlockId, Callee, Module};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::BTreeMap;

/// The limits, and which calls count for each: those that open a level of locals or those that do not.
const LIMITS: [(&str, [bool; 2]); 3] =
    [("call.all", [true, true]), ("call.macro", [false, true]), ("call.subprogram", [true, false])];

/// Reports programs whose calls may nest too deep.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let (source, target) = (context.source, context.target);
    let limits = LIMITS.iter().filter_map(|(name, counted)| {
        let row = target.limit_row(name)?;
        let most = row.max?;
        // A source that takes no more stops first.
        let here = source.limit_row(name).filter(|row| row.origin.confirmed).and_then(|row| row.max);
        here.is_none_or(|here| here > most).then_some((row, most, counted))
    });
    let limits: Vec<(&Limit, u32, &[bool; 2])> = limits.collect();
    if limits.is_empty() {
        return;
    }
    let routines = Routines::of(module);
    for (row, most, counted) in limits {
        let depths = routines.depths(most + 1, counted);
        for (program, routine) in routines.mains.iter().enumerate() {
            if depths[*routine] > most {
                let deepest = |edge: &&Edge| depths[edge.to] + u32::from(counted[usize::from(edge.level)]);
                let span =
                    routines.calls[*routine].iter().max_by_key(deepest).map_or(Span::default(), |e| e.span);
                report(program, span, (row, most), target, context);
            }
        }
    }
}

fn report(index: usize, span: Span, (row, most): (&Limit, u32), target: &Control, context: &mut Context<'_>) {
    let title = &target.dialect().title;
    let kind = match row.name.as_str() {
        "call.macro" => "macro calls",
        "call.subprogram" => "subprogram calls",
        _ => "calls",
    };
    let what = format!(
        "{kind} may nest deeper from here than the {most} levels of {title}: it would stop with an alarm"
    );
    let fact = format!("limit:{}", row.name);
    if row.origin.confirmed {
        context.add_once(index, "nesting", Diagnostic::new(Code::Conditional, span, what));
    } else {
        let finding = Diagnostic::new(Code::UnconfirmedFact, span, what).with_fact(&*fact);
        let finding = finding.with_help(to_confirm(&fact, Side::Target));
        context.add_once(index, "nesting", finding);
    }
}

/// What can be called, and what each calls.
struct Routines {
    calls: Vec<Vec<Edge>>,
    /// Who calls each.
    callers: Vec<Vec<usize>>,
    /// The routine that each program begins with.
    mains: Vec<usize>,
}

struct Edge {
    to: usize,
    level: bool,
    span: Span,
}

impl Routines {
    fn of(module: &Module) -> Self {
        let named: BTreeMap<&ProgramName, usize> =
            module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.as_ref()?, at))).collect();
        let mut found: BTreeMap<(usize, BlockId), usize> = BTreeMap::new();
        let mut order = Vec::new();
        let mut place = |routine: (usize, BlockId), order: &mut Vec<(usize, BlockId)>| {
            *found.entry(routine).or_insert_with(|| {
                order.push(routine);
                order.len() - 1
            })
        };
        let first = BlockId(0);
        let mains = (0..module.programs.len()).map(|at| place((at, first), &mut order)).collect();
        let mut routines = Self { calls: Vec::new(), callers: Vec::new(), mains };
        while let Some(&(at, entry)) = order.get(routines.calls.len()) {
            let mut edges = Vec::new();
            let program = &module.programs[at];
            for block in reachable(program, entry).into_iter().filter_map(|id| program.block(id)) {
                for call in calls_of(block) {
                    let to = match &call.callee {
                        Callee::Program(name) => named.get(name).map(|at| (*at, first)),
                        Callee::Block(id) => Some((at, *id)),
                        Callee::Computed(_) | Callee::Cycle(_) => None,
                    };
                    if let Some(to) = to {
                        let span = span_of(block, call);
                        edges.push(Edge { to: place(to, &mut order), level: call.level, span });
                    }
                }
            }
            routines.calls.push(edges);
        }
        routines.callers = vec![Vec::new(); routines.calls.len()];
        for (from, edges) in routines.calls.iter().enumerate() {
            edges.iter().for_each(|edge| routines.callers[edge.to].push(from));
        }
        routines
    }

    /// How deep calls nest from each routine, up to `most`: that is where circles end.
    fn depths(&self, most: u32, counted: &[bool; 2]) -> Vec<u32> {
        let mut depths = vec![0; self.calls.len()];
        let mut work: Vec<usize> = (0..self.calls.len()).collect();
        while let Some(at) = work.pop() {
            let below = |edge: &Edge| depths[edge.to] + u32::from(counted[usize::from(edge.level)]);
            let deep = self.calls[at].iter().map(below).max().unwrap_or(0).min(most);
            if deep > depths[at] {
                depths[at] = deep;
                work.extend(&self.callers[at]);
            }
        }
        depths
    }
}

//! Variables that a library shares and only sets to constants, where numbers of variables are counted from them: `#[#111+5]`.
//!
//! What they hold is known, so there is no question about each number. What remains is told once for the library: the
//! conversion holds as long as the programs that set them go on setting them so.

use crate::assume::Predicate;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{SharedValues, Summaries, Values, evaluate};
use crate::ir::{Bank, BlockId, Callee, Expr, Module, Program, Var};
use crate::legalize::variables::banks::each_index;
use crate::legalize::{Context, calls_of};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// What such variables hold in the programs of a library.
#[derive(Default)]
pub(super) struct Shared {
    /// By program, before statements of blocks.
    held: BTreeMap<(usize, BlockId, usize, Var), Values>,
    /// By program, where it begins.
    at_entry: BTreeMap<(usize, Var), f64>,
    /// What each is set to, and the names of the programs that do.
    sets: BTreeMap<Var, (Values, BTreeSet<String>)>,
    /// True where programs of the library call some that it does not have.
    calls_outside: bool,
}

impl Shared {
    /// Works it out for a library.
    pub(super) fn of(module: &Module, summaries: &Summaries) -> Self {
        let mut shared = Self::default();
        let Some(values) = SharedValues::of(module, summaries) else { return shared };
        let names: BTreeSet<_> = module.programs.iter().filter_map(|program| program.name.as_ref()).collect();
        let mut calls = module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
        let is_missing = |callee: &Callee| matches!(callee, Callee::Program(name) if !names.contains(name));
        shared.calls_outside = calls.any(|call| is_missing(&call.callee));
        for (index, program) in module.programs.iter().enumerate() {
            each_index(program, &mut |bank, number, _, id, at| {
                number.variables(&mut |var| {
                    if bank == Bank::Numbered
                        && let Some(found) = values.at(index, (id, at), var)
                    {
                        shared.held.insert((index, id, at, var), found);
                        shared.meet(index, var, &values, module);
                    }
                });
            });
        }
        shared
    }

    /// Takes in where a variable is set, and what a program begins with.
    fn meet(&mut self, index: usize, var: Var, values: &SharedValues<'_>, module: &Module) {
        if let Some(Values::Few(first)) = values.at_entry(index, var)
            && let Some(first) = first.first()
        {
            self.at_entry.insert((index, var), *first);
        }
        self.sets.entry(var).or_insert_with(|| {
            let name = |program: &Program| program.name.as_ref().map(ToString::to_string);
            let sets = values.set(var);
            let by = sets.iter().filter_map(|set| name(module.programs.get(set.program)?)).collect();
            (Values::of(sets.iter().map(|set| set.value).collect()), by)
        });
    }

    /// What a computed number of a program may be, where `other` says what other variables may be; none if no such variable
    /// stands in it. The variables are added to `rests`.
    pub(super) fn number(
        &self,
        (program, id, at): (usize, BlockId, usize),
        number: &Expr,
        other: &dyn Fn(Var) -> Values,
        rests: &mut BTreeSet<Var>,
    ) -> Option<Values> {
        let held = |var: Var| self.held.get(&(program, id, at, var));
        let mut any = false;
        number.variables(&mut |var| {
            if held(var).is_some() {
                any = true;
                rests.insert(var);
            }
        });
        any.then(|| evaluate(number, &|var| held(var).cloned().unwrap_or_else(|| other(var))))
    }

    /// Says what a program rests on.
    pub(super) fn tell(&self, index: usize, span: Span, var: Var, context: &mut Context<'_>) {
        let Some((values, by)) = self.sets.get(&var) else { return };
        let name = super::named(context.source, var.number.into());
        let numbers = match values {
            Values::Few(all) => all.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or "),
            Values::Between { low, high, .. } => format!("{low} to {high}"),
        };
        let sets = if by.len() > 1 { "set" } else { "sets" };
        let by = by.iter().map(String::as_str).collect::<Vec<_>>().join(" and ");
        let what = format!("numbers of variables are counted from {name}, which {by} {sets} to {numbers}");
        let mut help = format!("if somebody sets {name} to another number, convert the library again");
        if self.calls_outside {
            help += "; programs that are not in the library must return to the block after their call";
        }
        let held = self.at_entry.get(&(index, var));
        let predicate = held.map_or(Predicate::Unseen, |value| Predicate::Holds(name.into(), *value));
        let told = Diagnostic::new(Code::Conditional, span, what.clone()).with_help(help);
        context.add_once(index, &what, told.assuming(predicate).asked_once());
    }
}

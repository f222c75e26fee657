//! What every call of a program gives a value: it is not vacant at the program's entry. And what the program gives one
//! whenever it returns: it is not vacant after the call.

use super::marks::Names;
use crate::ir::analysis::computed_calls::{CalledPrograms, may_empty};
use crate::ir::analysis::{Around, CallGraph, Filled, Holds, Summaries, Vacancy, VarSet};
use crate::ir::{Call, Class, Expr, Module, Program, TermKind, Var};
use crate::legalize::calls_of;
use std::collections::{BTreeMap, BTreeSet};

/// By program, what is known of its entries; callers are looked at before what they call.
pub(super) struct Entries {
    /// The programs, callers first.
    pub order: Vec<usize>,
    /// What a program names and may be vacant, and what all programs see of what its callees name.
    pub named: Vec<BTreeSet<Var>>,
    /// What all calls so far give a value; none before the first.
    set: Vec<Option<BTreeSet<Var>>>,
    /// Programs that calls come back to: of them only what the text of each call says is known.
    cyclic: Vec<bool>,
    /// Programs that some call runs.
    runs: Vec<bool>,
    given: BTreeMap<usize, BTreeSet<Var>>,
}

impl Entries {
    pub fn of(module: &Module, names: &Names) -> Self {
        let mut calls = vec![BTreeSet::new(); module.programs.len()];
        let mut modal: Vec<usize> = Vec::new();
        for (index, program) in module.programs.iter().enumerate() {
            for block in &program.blocks {
                let ends = matches!(block.term.kind, TermKind::Call { .. });
                for (at, call) in calls_of(block).enumerate() {
                    let to = names.callees(index, call);
                    // A modal call runs at moves, whatever is vacant there.
                    if !ends || at + 1 < calls_of(block).count() {
                        modal.extend(to.iter().copied());
                    }
                    calls[index].extend(to.into_iter().map(|to| (to, false)));
                }
                if let TermKind::Chain(name) = &block.term.kind {
                    let to = names.find(name);
                    modal.extend(to);
                    calls[index].extend(to.map(|to| (to, false)));
                }
            }
        }
        let mut runs = vec![false; module.programs.len()];
        calls.iter().flatten().for_each(|(to, _)| runs[*to] = true);
        let graph = CallGraph::new(calls);
        let component = graph.components();
        let mut members: BTreeMap<usize, usize> = BTreeMap::new();
        component.iter().for_each(|component| *members.entry(*component).or_default() += 1);
        let shared = |index: usize| members.get(&component[index]).is_some_and(|members| *members > 1);
        let cyclic = (0..module.programs.len()).map(|index| {
            modal.contains(&index) || graph.callees(index).any(|to| to == index) || shared(index)
        });
        let cyclic = cyclic.collect();
        let order = graph.callees_first().into_iter().rev().collect();
        let mut named: Vec<BTreeSet<Var>> = module.programs.iter().map(named).collect();
        for caller in graph.callees_first() {
            let of_callees = graph.callees(caller).flat_map(|callee| &named[callee]);
            let shared: Vec<Var> = of_callees.copied().filter(|var| var.class.shared()).collect();
            named[caller].extend(shared);
        }
        let given = CalledPrograms::of(module).given(module);
        Self { order, named, set: vec![None; module.programs.len()], cyclic, runs, given }
    }

    /// What every called program leaves with a number when it returns, whatever it found; callees are looked at first.
    pub fn filled(&self, module: &Module, names: &Names, summaries: &Summaries) -> Filled {
        let (mut filled, assigned) = (Filled::new(), BTreeSet::new());
        for index in self.order.iter().rev().copied().filter(|index| self.runs[*index]) {
            let program = &module.programs[index];
            let Some(name) = program.name.as_ref().filter(|name| names.find(name) == Some(index)) else {
                continue;
            };
            let named = &self.named[index];
            let around = Around { assigned: &assigned, called: true, named, filled: &filled };
            let found = Vacancy::around(program, summaries, around).filled();
            filled.insert(name.clone(), found);
        }
        filled
    }

    /// What is not vacant at a program's entry.
    pub fn of_program(&self, index: usize) -> BTreeSet<Var> {
        let set = if self.cyclic[index] { self.given.get(&index) } else { self.set[index].as_ref() };
        set.cloned().unwrap_or_default()
    }

    /// True if a call enters the program.
    pub fn is_called(&self, index: usize) -> bool {
        self.set[index].is_some() || self.cyclic[index]
    }

    /// Notes a call: a new level has what the arguments give, and all else is as the caller has it. The next run of a
    /// call that repeats finds what the run before left.
    pub fn enter(
        &mut self,
        caller: usize,
        callee: usize,
        call: &Call,
        left: &Left<'_>,
        may: Holds<'_, Expr>,
    ) {
        let gives = |var: &&Var| match call.arguments.iter().rfind(|argument| argument.local == var.number) {
            Some(argument) if call.level && var.class == Class::Local => !may(&argument.value),
            _ if call.level && var.class == Class::Local => false,
            _ => self.named[caller].contains(var) && !may(&Expr::Var(**var)),
        };
        let keeps = |var: &&Var| !call.repeats() || left.keeps(callee, call, **var);
        let set: BTreeSet<Var> = self.named[callee].iter().filter(gives).filter(keeps).copied().collect();
        match &mut self.set[callee] {
            Some(all) => all.retain(|var| set.contains(var)),
            none => *none = Some(set),
        }
    }
}

/// What runs of called programs leave.
pub(super) struct Left<'l> {
    pub module: &'l Module,
    pub summaries: &'l Summaries,
    pub filled: &'l Filled,
}

impl Left<'_> {
    /// True where a run of the callee leaves a number in a variable that held one when it began.
    fn keeps(&self, callee: usize, call: &Call, var: Var) -> bool {
        let Some(name) = &self.module.programs[callee].name else { return false };
        let own = call.level && var.class == Class::Local;
        let filled = || self.filled.get(name).is_some_and(|filled| filled.contains(&var));
        own || !self.summaries.by_program(name).contains(var)
            || filled()
            || !may_empty(&self.module.programs[callee], var)
    }
}

fn named(program: &Program) -> BTreeSet<Var> {
    let mut vars = VarSet::default();
    program.variables(&mut |var| {
        if var.class.nullable() {
            vars.insert(var);
        }
    });
    vars.iter().collect()
}

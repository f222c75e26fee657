//! Which locals are the same variable: those of one level, in all programs that share it.

use crate::dialect::Control;
use crate::ir::analysis::CallGraph;
use crate::ir::{Call, Callee, Class, LOCAL_FLAGS, Module, Program, TermKind, Var, flag_of};
use crate::legalize::calls_of;
use crate::legalize::registers::statics::named_at_stop;
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// A local of a program.
type Local = (usize, u32);

/// The static of each local.
pub(super) struct Levels {
    of: BTreeMap<Local, u32>,
    names: BTreeMap<u32, String>,
    programs: BTreeMap<ProgramName, usize>,
    count: usize,
}

impl Levels {
    pub fn of(module: &Module, source: &Control) -> Self {
        let programs: BTreeMap<ProgramName, usize> =
            module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at))).collect();
        let count = module.programs.len();
        let mut levels = Self { of: BTreeMap::new(), names: BTreeMap::new(), programs, count };
        let mut callees = vec![BTreeSet::new(); count];
        let mut named: Vec<BTreeSet<u32>> =
            module.programs.iter().map(|program| &locals(program) | &asked(program, source)).collect();
        for (index, program) in module.programs.iter().enumerate() {
            for call in program.blocks.iter().flat_map(calls_of) {
                for callee in levels.callees(index, call) {
                    callees[index].insert((callee, call.level));
                    named[callee].extend(call.arguments.iter().map(|argument| argument.local));
                }
            }
            for block in &program.blocks {
                if let TermKind::Chain(name) = &block.term.kind {
                    callees[index].extend(levels.programs.get(name).map(|callee| (*callee, false)));
                }
            }
        }
        // What a callee names of the level that it shares, its caller has too.
        CallGraph::new(callees.clone()).bottom_up(&mut named, |mine, theirs, level| {
            let before = mine.len();
            if !level {
                mine.extend(theirs.iter().copied());
            }
            mine.len() != before
        });
        let mut same = Same(BTreeMap::new());
        for (caller, callees) in callees.iter().enumerate() {
            for (callee, _) in callees.iter().filter(|(_, level)| !level) {
                named[*callee].iter().for_each(|local| same.join((caller, *local), (*callee, *local)));
            }
        }
        let mut numbers: BTreeMap<Local, u32> = BTreeMap::new();
        for (index, locals) in named.iter().enumerate() {
            for local in locals {
                let next = numbers.len() as u32 + 1;
                let number = *numbers.entry(same.first((index, *local))).or_insert(next);
                levels.of.insert((index, *local), number);
                levels.names.entry(number).or_insert_with(|| describe(&module.programs[index], *local));
            }
        }
        levels
    }

    /// The static of a local.
    pub fn of_local(&self, program: usize, local: u32) -> Var {
        Var { class: Class::Static, number: self.of.get(&(program, local)).copied().unwrap_or(0) }
    }

    /// True if the static is a local of the level that the program runs in.
    pub fn has(&self, program: usize, var: Var) -> bool {
        self.of.range((program, 0)..(program + 1, 0)).any(|(_, number)| *number == var.number)
    }

    /// The locals of the level that the program runs in, and their statics.
    pub fn locals(&self, program: usize) -> impl Iterator<Item = (u32, Var)> + '_ {
        let of = self.of.range((program, 0)..(program + 1, 0));
        of.map(|((_, local), number)| (*local, Var { class: Class::Static, number: *number }))
    }

    /// What people call the locals of the level that the program runs in.
    pub fn held(&self, program: usize, source: &Control) -> Vec<(Var, String)> {
        let name = |local| source.numbered().map(|before| format!("{before}{local}")).unwrap_or_default();
        let held = self.of.range((program, 0)..(program + 1, 0)).map(|((_, local), number)| {
            let name = match local.checked_sub(LOCAL_FLAGS) {
                Some(local) => flag_of(&name(local)),
                None => name(*local),
            };
            (Var { class: Class::Static, number: *number }, name)
        });
        held.collect()
    }

    /// What people call it.
    pub fn name(&self, var: Var) -> String {
        self.names.get(&var.number).cloned().unwrap_or_default()
    }

    /// The programs that a call may run: all of them if its number is computed.
    pub fn callees(&self, caller: usize, call: &Call) -> Vec<usize> {
        match &call.callee {
            Callee::Program(name) => self.programs.get(name).copied().into_iter().collect(),
            Callee::Block(_) => vec![caller],
            Callee::Computed(_) => (0..self.count).collect(),
            Callee::Cycle(_) => Vec::new(),
        }
    }
}

/// The locals that a program names.
fn locals(program: &Program) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    program.variables(&mut |var| {
        if var.class == Class::Local {
            found.insert(var.number);
        }
    });
    found
}

/// The locals that a program names in the texts of its stops alone: whoever reads one sets the variable of that level.
fn asked(program: &Program, source: &Control) -> BTreeSet<u32> {
    let rows = || source.classes().iter().filter(|row| row.class == "local");
    let prefixes: Vec<&str> = rows().map(|row| row.name.as_str()).collect();
    let number = |name: String| {
        let row = rows().find(|row| name.starts_with(row.name.as_str()))?;
        let number = name.strip_prefix(row.name.as_str())?.parse().ok()?;
        (row.first..=row.last).contains(&number).then_some(number)
    };
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.flat_map(|stmt| named_at_stop(stmt, &prefixes)).filter_map(number).collect()
}

fn describe(program: &Program, local: u32) -> String {
    let local = match local.checked_sub(LOCAL_FLAGS) {
        Some(local) => format!("whether local {local} has a value"),
        None => format!("local {local}"),
    };
    match &program.name {
        Some(ProgramName::Number(number)) => format!("{local} of program {number}"),
        Some(ProgramName::Name(name)) => format!("{local} of program {name}"),
        None => local,
    }
}

/// Locals that are one variable: each leads to an earlier one.
struct Same(BTreeMap<Local, Local>);

impl Same {
    fn first(&mut self, local: Local) -> Local {
        let mut first = local;
        while let Some(next) = self.0.get(&first) {
            first = *next;
        }
        if first != local {
            self.0.insert(local, first);
        }
        first
    }

    fn join(&mut self, a: Local, b: Local) {
        let (a, b) = (self.first(a), self.first(b));
        if a != b {
            self.0.insert(a.max(b), a.min(b));
        }
    }
}

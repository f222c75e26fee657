//! Which constants the variables that a library shares hold at a place.
//!
//! What is followed are the variables in computed numbers to which the programs of the library assign constants and nothing
//! else: the number of the first variable of a block of them, which one program sets and all others count from. A literal
//! in a program that others call is what it is, for nobody edits that from job to job; one that stands at the head of a
//! program that nothing calls is an input, and its variable is not followed. Law: a run that begins at a program that
//! nothing calls, and that nobody disturbs, gives such a variable one of the values found for it wherever it comes.
//! Counter-examples: an operator who changes the variable by hand, and a program outside the library that calls one of it, or
//! that returns to a block of its caller by its number.

use super::cfg::labelled;
use super::over_calls::{Follow, OverCalls, called};
use super::ranges::{Ranges, Values, evaluate, head_literals, in_numbers};
use super::{Summaries, Vars};
use crate::ir::{
    Bank, Block, BlockId, Call, Callee, Class, Expr, Module, Place, Program, Stmt, StmtKind, TermKind, Var,
};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// The shared variables of a library and what they hold.
pub struct SharedValues<'m> {
    rules: Rules<'m>,
    over: OverCalls<Vec<Values>>,
}

/// One of them is set: by the program at this place in the library, to this value.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// The program.
    pub program: usize,
    /// The value.
    pub value: f64,
}

struct Rules<'m> {
    module: &'m Module,
    /// The variables that are followed, and where they are set.
    vars: BTreeMap<Var, Vec<Set>>,
    /// The programs that may write any of them: they do not know under which number they write.
    lost: BTreeSet<usize>,
    /// By program, those that it, or what it calls, may write.
    written: Vec<BTreeSet<Var>>,
    /// By program, what other variables in computed numbers may be.
    ranges: Vec<Option<Ranges<'m>>>,
    names: BTreeMap<&'m ProgramName, usize>,
    /// By program, the blocks that calls of it may come back to by their numbers.
    open: Vec<BTreeSet<BlockId>>,
    summaries: &'m Summaries,
}

impl<'m> SharedValues<'m> {
    /// Of a library; none if it has no such variable.
    pub fn of(module: &'m Module, summaries: &'m Summaries) -> Option<Self> {
        let is_modal = |stmt: &Stmt| matches!(stmt.kind, StmtKind::ModalCall(_));
        let stmts =
            || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
        if stmts().any(is_modal) {
            return None;
        }
        let vars = candidates(module);
        if vars.is_empty() {
            return None;
        }
        let mut rules = Rules::new(module, vars, summaries);
        loop {
            let over = OverCalls::of(module, &rules);
            let found = Self { rules, over };
            let lost = found.lost();
            if lost.is_subset(&found.rules.lost) {
                return Some(found);
            }
            rules = found.rules;
            rules.lost.extend(lost);
            rules.written = rules.all_written();
        }
    }

    /// What one of them may hold before a statement of a block; none if it is not followed, or may be anything.
    pub fn at(&self, program: usize, (id, at): (BlockId, usize), var: Var) -> Option<Values> {
        let place = self.rules.place(var)?;
        let mut known = self.over.at(program, id)?.clone();
        self.rules.come_back((program, id), &mut known);
        let block = self.rules.module.programs.get(program)?.block(id)?;
        for (before, stmt) in block.stmts.iter().enumerate().take(at) {
            self.rules.stmt((program, id, before), stmt, &mut known);
        }
        known.into_iter().nth(place).filter(|values| *values != Values::ANY)
    }

    /// What one of them holds where a program begins; none if that may be anything.
    pub fn at_entry(&self, program: usize, var: Var) -> Option<Values> {
        self.at(program, (BlockId(0), 0), var)
    }

    /// Where one of them is set.
    pub fn set(&self, var: Var) -> &[Set] {
        self.rules.vars.get(&var).map_or(&[], Vec::as_slice)
    }

    /// The programs that write something under a number counted from such a variable where nobody knows that.
    fn lost(&self) -> BTreeSet<usize> {
        let is_lost = |index: usize, program: &Program| {
            writes(program).any(|(id, at, number)| {
                let mut unknown = false;
                number.variables(&mut |var| {
                    let followed = self.rules.vars.contains_key(&var);
                    // Where no run comes nothing is written.
                    let comes = self.over.at(index, id).is_some();
                    unknown |= followed && comes && self.at(index, (id, at), var).is_none();
                });
                unknown
            })
        };
        let programs = self.rules.module.programs.iter().enumerate();
        programs.filter(|(index, program)| is_lost(*index, program)).map(|(index, _)| index).collect()
    }
}

impl<'m> Rules<'m> {
    fn new(module: &'m Module, vars: BTreeMap<Var, Vec<Set>>, summaries: &'m Summaries) -> Self {
        let called = called(module);
        let ranges = |(index, program): (usize, &'m Program)| {
            writes(program).next()?;
            let inputs = !called[index] || !program.returns();
            Some(if inputs {
                Ranges::of(program, summaries)
            } else {
                Ranges::of_constants(program, summaries, in_numbers(program))
            })
        };
        let ranges = module.programs.iter().enumerate().map(ranges).collect();
        let named = |(at, program): (usize, &'m Program)| Some((program.name.as_ref()?, at));
        let names = module.programs.iter().enumerate().filter_map(named).collect();
        let (lost, written, open) = (BTreeSet::new(), Vec::new(), Vec::new());
        let mut rules = Self { module, vars, lost, written, ranges, names, open, summaries };
        rules.open = module.programs.iter().map(|program| rules.come_back_to(program)).collect();
        rules.written = rules.all_written();
        rules
    }

    /// The blocks of a program that what it calls may come back to by their numbers. What is not in the library is taken to
    /// return to the block after its call.
    fn come_back_to(&self, program: &Program) -> BTreeSet<BlockId> {
        let names_block = |callee: &Program| {
            let mut terms = callee.blocks.iter().map(|block| &block.term.kind);
            terms.any(|term| matches!(term, TermKind::Return { to: Some(_) }))
        };
        let may = |block: &Block| match &block.term.kind {
            TermKind::Call { call, .. } => match &call.callee {
                Callee::Program(name) => {
                    self.names.get(name).is_some_and(|index| names_block(&self.module.programs[*index]))
                }
                Callee::Block(_) => names_block(program),
                Callee::Computed(_) | Callee::Cycle(_) => true,
            },
            _ => false,
        };
        if program.blocks.iter().any(may) { labelled(program).collect() } else { BTreeSet::new() }
    }

    /// What is known where a call may come back to a block by its number.
    fn come_back(&self, (program, id): (usize, BlockId), known: &mut [Values]) {
        if self.open.get(program).is_some_and(|open| open.contains(&id)) {
            known.fill(Values::ANY);
        }
    }

    fn place(&self, var: Var) -> Option<usize> {
        self.vars.keys().position(|other| *other == var)
    }

    /// By program, what it may write, and what it calls.
    fn all_written(&self) -> Vec<BTreeSet<Var>> {
        let programs = &self.module.programs;
        let known: Vec<Values> = self.vars.values().map(|sets| of_sets(sets)).collect();
        let own = |index: usize| {
            if self.lost.contains(&index) {
                return self.vars.keys().copied().collect();
            }
            let mut written = BTreeSet::new();
            let program = &programs[index];
            for (id, block) in program.ids().zip(&program.blocks) {
                for (at, stmt) in block.stmts.iter().enumerate() {
                    written.extend(self.hit((index, id, at), stmt, &known));
                }
            }
            written
        };
        let mut written: Vec<BTreeSet<Var>> = (0..programs.len()).map(own).collect();
        let mut changed = true;
        while std::mem::take(&mut changed) {
            for (index, program) in programs.iter().enumerate() {
                for block in &program.blocks {
                    let TermKind::Call { call, .. } = &block.term.kind else { continue };
                    let more: BTreeSet<Var> = match &call.callee {
                        Callee::Block(_) => continue,
                        Callee::Program(name) if self.names.contains_key(name) => {
                            written[self.names[name]].clone()
                        }
                        _ => self.vars.keys().copied().collect(),
                    };
                    let before = written[index].len();
                    written[index].extend(more);
                    changed |= written[index].len() > before;
                }
            }
        }
        written
    }

    /// The variables that a statement may write.
    fn hit(
        &self,
        (program, id, at): (usize, BlockId, usize),
        stmt: &Stmt,
        known: &[Values],
    ) -> BTreeSet<Var> {
        let all = self.vars.keys().copied();
        match &stmt.kind {
            StmtKind::Assign { target: Place::Indirect(bank, number), .. }
            | StmtKind::Input { target: Place::Indirect(bank, number), .. } => {
                let numbers = self.number((program, id, at), number, known).numbers();
                let named =
                    |var: &Var| Vars::bank(*bank).contains(&var.class) && numbers.contains(var.number);
                all.filter(named).collect()
            }
            StmtKind::ClearAll(class) => all.filter(|var| var.class == *class).collect(),
            StmtKind::Nc(nc) => {
                let written = self.summaries.by_nc(nc);
                all.filter(|var| written.contains(*var)).collect()
            }
            kind => {
                let target = kind.target();
                all.filter(|var| matches!(target, Some(Place::Var(other)) if other == var)).collect()
            }
        }
    }

    /// What a computed number may be.
    fn number(&self, (program, id, at): (usize, BlockId, usize), number: &Expr, known: &[Values]) -> Values {
        let ranges = self.ranges.get(program).and_then(Option::as_ref);
        evaluate(number, &|var| match self.place(var) {
            Some(place) => known.get(place).cloned().unwrap_or(Values::ANY),
            None => ranges.map_or(Values::ANY, |ranges| ranges.at(id, at, &Expr::Var(var))),
        })
    }

    fn stmt(&self, place: (usize, BlockId, usize), stmt: &Stmt, known: &mut [Values]) {
        let hit = self.hit(place, stmt, known);
        for (at, var) in self.vars.keys().enumerate().filter(|(_, var)| hit.contains(var)) {
            let Some(known) = known.get_mut(at) else { continue };
            let value = match &stmt.kind {
                StmtKind::Assign { target: Place::Var(other), value } if other == var => value.constant(),
                _ => None,
            };
            *known = match value.map(Values::one) {
                Some(value) if stmt.site.skip.is_some() => known.join(&value),
                Some(value) => value,
                None => Values::ANY,
            };
        }
    }
}

impl Follow for Rules<'_> {
    type Known = Vec<Values>;

    fn outside(&self, _: usize) -> Vec<Values> {
        vec![Values::ANY; self.vars.len()]
    }

    fn stmts(&self, (program, id): (usize, BlockId), block: &Block, known: &mut Vec<Values>) {
        self.come_back((program, id), known);
        for (at, stmt) in block.stmts.iter().enumerate() {
            self.stmt((program, id, at), stmt, known);
        }
    }

    fn lose(&self, known: &mut Vec<Values>) {
        known.fill(Values::ANY);
    }

    fn returned(&self, program: usize, call: &Call, before: &Vec<Values>, after: &mut Vec<Values>) {
        let written = match &call.callee {
            Callee::Program(name) => self.names.get(name).and_then(|index| self.written.get(*index)),
            // A part of the program itself.
            Callee::Block(_) => self.written.get(program),
            Callee::Computed(_) | Callee::Cycle(_) => None,
        };
        let Some(written) = written else { return };
        for ((var, before), after) in self.vars.keys().zip(before).zip(after) {
            if !written.contains(var) {
                after.clone_from(before);
            }
        }
    }
}

/// The variables in computed numbers that programs share and only set to constants, and where they do.
fn candidates(module: &Module) -> BTreeMap<Var, Vec<Set>> {
    let is_shared = |var: &Var| matches!(var.class, Class::Common | Class::Retained);
    let mut vars: BTreeMap<Var, Vec<Set>> = BTreeMap::new();
    for program in &module.programs {
        vars.extend(in_numbers(program).into_iter().filter(is_shared).map(|var| (var, Vec::new())));
    }
    if vars.is_empty() {
        return vars;
    }
    let called = called(module);
    for (index, program) in module.programs.iter().enumerate() {
        let is_edited = !called[index] || !program.returns();
        let inputs: BTreeSet<(BlockId, usize)> = if is_edited {
            head_literals(program).into_iter().map(|(id, at, _)| (id, at)).collect()
        } else {
            BTreeSet::new()
        };
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let Some(Place::Var(var)) = stmt.kind.target() else { continue };
                let Some(sets) = vars.get_mut(var) else { continue };
                let value = match &stmt.kind {
                    StmtKind::Assign { value, .. } => value.constant(),
                    _ => None,
                };
                match value.filter(|_| !inputs.contains(&(id, at))) {
                    Some(value) => sets.push(Set { program: index, value }),
                    None => _ = vars.remove(var),
                }
            }
        }
    }
    vars.retain(|_, sets| !sets.is_empty());
    vars
}

fn of_sets(sets: &[Set]) -> Values {
    Values::of(sets.iter().map(|set| set.value).collect())
}

/// Where a program writes variables with computed numbers, and these numbers.
fn writes(program: &Program) -> impl Iterator<Item = (BlockId, usize, &Expr)> {
    program.ids().zip(&program.blocks).flat_map(|(id, block)| {
        block.stmts.iter().enumerate().filter_map(move |(at, stmt)| match stmt.kind.target()? {
            Place::Indirect(Bank::Numbered, number) => Some((id, at, &**number)),
            _ => None,
        })
    })
}

#[cfg(test)]
mod tests;

//! Registers that an earlier conversion took for values in between become temporaries again.
//!
//! Law: its head says `SCRATCH R5 V48`: nobody looks at what they hold when the program is done. So what a program only
//! keeps there from one of its own statements to another is no variable of the shop's, and needs no register of that
//! name.
//!
//! Side condition, of the whole library: each program that names such a register says so at its head, and every read of
//! it finds what this program wrote before, on every way, with no call between that may write it. A called part is a
//! program of its own here, which the target may make of it: what goes into it and out of it stays a variable. None is
//! vacant where someone tells that from 0. No operator gives it, no computed number and no clearing reaches it, no
//! earlier run has it in its lock, and it has no name. Counter-example: a person took R5 for the depth that a
//! subprogram reads; there the read comes first, and R5 stays a variable in all programs.

use crate::ir::analysis::dataflow::{Analysis, Cursor, Direction, Steps, solve};
use crate::ir::analysis::{BitRow, Cfg, Summaries, Universe, Vacancy};
use crate::ir::constant_part;
use crate::ir::{Bank, Block, BlockId, Callee, Expr, Module, Place, Program, Stmt, StmtKind, TermKind, Var};
use crate::legalize::features::{Feature, Features};
use crate::legalize::registers::names::{keeps_number, name_of};
use crate::legalize::rewrite::highest_temp;
use crate::legalize::{Context, calls_of};
use crate::syntax::Label;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// From here on numbers are the system's, where it has any.
const FIRST_STATE: f64 = 1000.0;

/// True where heads name such registers, and what stands around the library is known.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.earlier.has_between() && features.has(Feature::Variable) && !context.goes_on
}

/// Makes temporaries of them; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut scratch = claimed(module, context);
    if scratch.is_empty() || module.programs.iter().any(is_open) {
        return false;
    }
    for program in &module.programs {
        let these = scratch.clone();
        reached(program, &these, &mut |var| _ = scratch.remove(&var));
    }
    let summaries = context.summaries(module);
    for program in &module.programs {
        for var in exposed(program, &summaries, &scratch) {
            scratch.remove(&var);
        }
    }
    if scratch.is_empty() {
        return false;
    }
    module.programs.iter_mut().for_each(|program| rename(program, &scratch));
    true
}

/// The variables that every program which names them says to be such.
fn claimed(module: &Module, context: &Context<'_>) -> BTreeSet<Var> {
    let (mut yes, mut no) = (BTreeSet::new(), BTreeSet::new());
    let mut names: BTreeMap<Var, Option<String>> = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        let between = context.earlier.between.get(index);
        program.variables(&mut |var| {
            let name = names.entry(var).or_insert_with(|| name_of(var, module, context.source));
            let claims = name.as_ref().is_some_and(|name| {
                between.is_some_and(|between| between.contains(name))
                    && !context.locked.variables.contains_key(name)
            });
            let may = claims
                && var.class.shared()
                && !module.names.contains_key(&var)
                && !keeps_number(var, context);
            if may {
                yes.insert(var)
            } else {
                no.insert(var)
            };
        });
    }
    yes.retain(|var| !no.contains(var));
    yes
}

/// True for a program that runs what nobody can tell.
fn is_open(program: &Program) -> bool {
    let mut calls = program.blocks.iter().flat_map(calls_of);
    calls.any(|call| matches!(call.callee, Callee::Computed(_) | Callee::Cycle(_)))
        || program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Chain(_)))
}

/// Calls `f` with each of these that is written otherwise than by an assignment, or reached by a computed number.
fn reached(program: &Program, these: &BTreeSet<Var>, f: &mut dyn FnMut(Var)) {
    let by_number = |bank: Bank, number: &Expr, f: &mut dyn FnMut(Var)| {
        let classes = crate::ir::analysis::Vars::bank(bank);
        // One that is counted from the system's numbers is supposed to stay among those.
        let system = bank == Bank::Numbered && constant_part(number).is_some_and(|part| part >= FIRST_STATE);
        let may = |var: &&Var| !system || f64::from(var.number) >= FIRST_STATE;
        these.iter().filter(|var| classes.contains(&var.class)).filter(may).for_each(|var| f(*var));
    };
    let mut look = |e: &Expr| {
        e.walk(&mut |part| {
            if let Expr::Indirect(bank, number) = part {
                by_number(*bank, number, f);
            }
        });
    };
    for block in &program.blocks {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
        block.term.kind.exprs(&mut look);
    }
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        match &stmt.kind {
            StmtKind::Input { target: Place::Var(var), .. } | StmtKind::SetNames { first: var, .. } => {
                f(*var)
            }
            StmtKind::ClearAll(class) => {
                these.iter().filter(|var| var.class == *class).for_each(|var| f(*var));
            }
            StmtKind::Assign { target: Place::Indirect(bank, number), .. }
            | StmtKind::Input { target: Place::Indirect(bank, number), .. } => by_number(*bank, number, f),
            _ => {}
        }
    }
}

/// Those that a program may read before it wrote them, or that may be vacant where it asks for that.
fn exposed(program: &Program, summaries: &Summaries, these: &BTreeSet<Var>) -> BTreeSet<Var> {
    let mut found = BTreeSet::new();
    let mut named = false;
    program.variables(&mut |var| named |= these.contains(&var));
    if !named {
        return found;
    }
    let universe = Universe::new(these.iter().copied().collect());
    let returns = |block: &Block| matches!(block.term.kind, TermKind::Return { to: Some(_) });
    let looked_for = summaries.come_back() || program.blocks.iter().any(returns);
    let rules = Unwritten { program, summaries, universe, looked_for };
    let states = solve(&rules, program, &Cfg::of(program));
    let vacancy = Vacancy::of(program, summaries, &BTreeSet::new());
    let mut written = BTreeSet::new();
    let targets = program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.target());
    written.extend(targets.filter_map(|place| if let Place::Var(var) = place { Some(*var) } else { None }));
    let mut cursor = Cursor::default();
    for (id, block) in program.ids().zip(&program.blocks) {
        for at in 0..=block.stmts.len() {
            let row = cursor.seek(&rules, &states, program, (id, at));
            let mut read = |e: &Expr| {
                e.variables(&mut |var| {
                    if rules.universe.place(var).is_some_and(|at| match row {
                        Some(row) => row.has(at),
                        // No run comes there; what is read is written somewhere all the same.
                        None => !written.contains(&var),
                    }) {
                        found.insert(var);
                    }
                });
            };
            match block.stmts.get(at) {
                Some(stmt) => stmt.kind.exprs(&mut read),
                None => block.term.kind.exprs(&mut read),
            }
            let mut asked = |e: &Expr| {
                asks(e, &mut |var| {
                    if these.contains(&var) && vacancy.may_be_vacant(id, at, var) {
                        found.insert(var);
                    }
                });
            };
            match block.stmts.get(at) {
                Some(stmt) => stmt.kind.exprs(&mut asked),
                None => block.term.kind.exprs(&mut asked),
            }
        }
    }
    found
}

/// Calls `f` with each variable of a value of which it makes a difference whether it is vacant or 0.
fn asks(e: &Expr, f: &mut dyn FnMut(Var)) {
    match e {
        Expr::Var(var) => f(*var),
        Expr::Negate(inner) => asks(inner, f),
        Expr::Truth(cond) => cond.exprs(&mut |side| asks(side, f)),
        e => e.exprs(&mut |part| {
            if !matches!(part, Expr::Var(_)) {
                asks(part, f);
            }
        }),
    }
}

/// Follows which of the variables may hold something else than what the program wrote.
struct Unwritten<'u> {
    program: &'u Program,
    summaries: &'u Summaries,
    universe: Universe,
    /// True where a run may come back to a sequence number.
    looked_for: bool,
}

impl Unwritten<'_> {
    /// What a part and the parts that it calls may write.
    fn written_from(&self, entry: BlockId) -> impl Iterator<Item = usize> + '_ {
        let (mut seen, mut open) = (BTreeSet::from([entry]), vec![entry]);
        while let Some(block) = open.pop().and_then(|id| self.program.block(id)) {
            let called = match &block.term.kind {
                TermKind::Call { call, .. } => match call.callee {
                    Callee::Block(entry) => Some(entry),
                    _ => None,
                },
                _ => None,
            };
            open.extend(block.term.kind.successors().into_iter().chain(called).filter(|id| seen.insert(*id)));
        }
        let stmts = seen.into_iter().filter_map(|id| self.program.block(id)).flat_map(|block| &block.stmts);
        stmts.filter_map(|stmt| match stmt.kind.target() {
            Some(Place::Var(var)) => self.universe.place(*var),
            _ => None,
        })
    }
}

impl Analysis for Unwritten<'_> {
    type State = BitRow;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, BitRow)> {
        // A run may come back to a number that another program names: nobody can tell what was written there.
        let labelled = self.program.ids().zip(&self.program.blocks).filter(|(_, block)| {
            self.looked_for && block.labels.iter().any(|label| matches!(label, Label::Number(_)))
        });
        let ids = cfg.roots().iter().copied().chain(labelled.map(|(id, _)| id));
        ids.map(|id| (id, self.universe.all())).collect()
    }

    fn block(&self, id: BlockId, block: &Block, row: &mut BitRow) {
        self.stmts(id, block, row);
    }

    fn edge<'s>(&self, from: BlockId, _: BlockId, row: &'s BitRow) -> Option<Cow<'s, BitRow>> {
        let block = self.program.block(from)?;
        let TermKind::Call { call, .. } = &block.term.kind else { return Some(Cow::Borrowed(row)) };
        if let Callee::Block(entry) = call.callee {
            let mut row = row.clone();
            self.written_from(entry).for_each(|at| row.insert(at));
            return Some(Cow::Owned(row));
        }
        let (mut row, written) = (row.clone(), self.summaries.by_call(call));
        for (at, _) in self.universe.vars().iter().enumerate().filter(|(_, var)| written.contains(**var)) {
            row.insert(at);
        }
        Some(Cow::Owned(row))
    }
}

impl Steps for Unwritten<'_> {
    fn stmt(&self, _: (BlockId, usize), stmt: &Stmt, row: &mut BitRow) {
        match &stmt.kind {
            StmtKind::Assign { target: Place::Var(var), .. } if stmt.site.skip.is_none() => {
                self.universe.place(*var).into_iter().for_each(|at| row.remove(at));
            }
            StmtKind::Nc(nc) => {
                let written = self.summaries.by_nc(nc);
                let vars = self.universe.vars().iter().enumerate();
                vars.filter(|(_, var)| written.contains(**var)).for_each(|(at, _)| row.insert(at));
            }
            _ => {}
        }
    }
}

/// Gives a program temporaries in their place. An assignment of one stands behind no block that people count.
fn rename(program: &mut Program, these: &BTreeSet<Var>) {
    let first = highest_temp(program) + 1;
    let temps: BTreeMap<Var, Var> = (first..)
        .zip(these)
        .map(|(number, var)| (*var, Var { class: crate::ir::Class::Temp, number }))
        .collect();
    let mut change = |e: &mut Expr| {
        e.walk_mut(&mut |part| {
            if let Expr::Var(var) = part
                && let Some(temp) = temps.get(var)
            {
                *var = *temp;
            }
        });
    };
    for block in &mut program.blocks {
        for stmt in &mut block.stmts {
            stmt.kind.exprs_mut(&mut change);
            if let StmtKind::Assign { target: Place::Var(var), .. } = &mut stmt.kind
                && let Some(temp) = temps.get(var)
            {
                *var = *temp;
                stmt.site.sequence = None.into();
            }
        }
        block.term.kind.exprs_mut(&mut change);
    }
}

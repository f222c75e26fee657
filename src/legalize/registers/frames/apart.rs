//! Locals that the library shares with programs outside it: what it gives to those, and what those give to it.
//!
//! Law: such a local is a variable that all programs see, with a name of its own (`#2 of O9010`), for whoever is outside
//! looks for it there. A call of a program that is not in the library sets before it what it gives. Side condition: who
//! reads or sets them on the target knows which they are; the pass `interface` says it once registers are taken.
//! Counter-example: a register that holds `#2` of O9010 for one call and something else before the next.

use super::Levels;
use super::calls::number;
use crate::dialect::Control;
use crate::ir::{Callee, Class, Expr, Module, Place, Program, SourceInfo, Stmt, StmtKind, TermKind, Var};
use crate::legalize::registers::interface::{Interface, Shared};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// Such variables have numbers from here on.
const FIRST: u32 = 90_000_000;

/// Sets what programs outside the library are given before the calls, which give no arguments any more.
pub(super) fn give(module: &mut Module, source: &Control, interface: &mut Interface) {
    let known: BTreeSet<ProgramName> = module.programs.iter().filter_map(|p| p.name.clone()).collect();
    let mut vars: BTreeMap<(ProgramName, u32), Var> = BTreeMap::new();
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut held: BTreeMap<Var, String> = BTreeMap::new();
        let once = temporaries_of_one_use(program);
        for block in &mut program.blocks {
            let span = block.term.site.span;
            let TermKind::Call { call, .. } = &mut block.term.kind else { continue };
            let Callee::Program(name) = &call.callee else { continue };
            if !call.level || known.contains(name) || call.arguments.is_empty() {
                continue;
            }
            let called = interface.given.entry(name.clone()).or_default();
            called.calls.push((index, span));
            for argument in std::mem::take(&mut call.arguments) {
                let next = Var { class: Class::Global, number: FIRST + vars.len() as u32 };
                let var = *vars.entry((name.clone(), argument.local)).or_insert(next);
                let shared = Shared::of(var, argument.local, source);
                held.insert(var, shared.name_in(name));
                called.shared.insert(argument.local, shared);
                // What a temporary holds for this alone goes straight to its place.
                if let Expr::Var(temp) = &argument.value
                    && once.contains(temp)
                    && let Some(place) = set_in(&mut block.stmts, *temp)
                {
                    *place = Place::Var(var);
                    continue;
                }
                let kind = StmtKind::Assign { target: Place::Var(var), value: number(argument.value) };
                block.stmts.push(Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } });
            }
        }
        module.names.extend(held.clone());
        program.held.extend(held);
    }
}

/// The temporaries that one statement sets and one place reads.
fn temporaries_of_one_use(program: &Program) -> BTreeSet<Var> {
    let mut uses: BTreeMap<Var, (usize, usize)> = BTreeMap::new();
    let mut read = |e: &Expr| {
        e.variables(&mut |var| uses.entry(var).or_default().0 += 1);
    };
    for block in &program.blocks {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut read));
        block.term.kind.exprs(&mut read);
    }
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        if let Some(Place::Var(var)) = stmt.kind.target() {
            uses.entry(*var).or_default().1 += 1;
        }
    }
    let once = uses.into_iter().filter(|(var, uses)| var.class == Class::Temp && *uses == (1, 1));
    once.map(|(var, _)| var).collect()
}

/// Where these statements set a variable, whether or not the operator skips other blocks.
fn set_in(stmts: &mut [Stmt], var: Var) -> Option<&mut Place> {
    stmts.iter_mut().rev().filter(|stmt| stmt.site.skip.is_none()).find_map(|stmt| match &mut stmt.kind {
        StmtKind::Assign { target, .. } if *target == Place::Var(var) => Some(target),
        _ => None,
    })
}

/// What programs outside the library give to one of its own: the locals that it reads before it sets them. False if
/// another program takes one of them too, for then it has two names.
pub(super) fn take(
    index: usize,
    vars: &[Var],
    (levels, source): (&Levels, &Control),
    name: Option<&ProgramName>,
    interface: &mut Interface,
) -> bool {
    let Some(name) = name.filter(|_| vars.iter().all(|var| !interface.renamed.contains_key(var))) else {
        return false;
    };
    for (local, var) in levels.locals(index).filter(|(_, var)| vars.contains(var)) {
        let to = Var { class: Class::Global, number: FIRST + interface.len() as u32 };
        let shared = Shared::of(to, local, source);
        interface.renamed.insert(var, (to, shared.name_in(name)));
        interface.taken.entry(index).or_default().push(shared);
    }
    true
}

/// Turns the locals that a program takes from outside into variables that all programs see.
pub(super) fn rename(module: &mut Module, interface: &Interface) {
    if interface.renamed.is_empty() {
        return;
    }
    let change = |var: &mut Var| {
        if let Some((to, _)) = interface.renamed.get(var) {
            *var = *to;
        }
    };
    for program in &mut module.programs {
        program.held.iter_mut().for_each(|(var, _)| change(var));
        each_var(program, &change);
    }
    module.names.extend(interface.renamed.values().cloned());
}

/// Calls `change` on each variable that the blocks of a program name.
pub(super) fn each_var(program: &mut Program, change: &dyn Fn(&mut Var)) {
    let each = |e: &mut Expr| {
        e.walk_mut(&mut |e| {
            if let Expr::Var(var) = e {
                change(var);
            }
        });
    };
    for block in &mut program.blocks {
        for stmt in &mut block.stmts {
            stmt.kind.exprs_mut(&mut { each });
            match &mut stmt.kind {
                StmtKind::Assign { target: Place::Var(var), .. }
                | StmtKind::Input { target: Place::Var(var), .. } => change(var),
                _ => {}
            }
        }
        block.term.kind.exprs_mut(&mut { each });
    }
}

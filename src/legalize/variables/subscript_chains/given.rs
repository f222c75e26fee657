//! Numbers that calls give to a program, which counts variables by them.
//!
//! `G65 P9001 V500` tells O9001 where its answer goes. All calls of the library say so, as far as they give literals and the
//! program leaves that local alone: the comparisons stop with an alarm where another number comes.

use crate::ir::eval::{self, Memory};
use crate::ir::{Call, Callee, Class, Expr, Module, Place, Program, StmtKind};
use crate::legalize::calls_of;
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// By local, the literals that the calls of a program give it.
pub(super) type Given = BTreeMap<u32, BTreeSet<u32>>;

/// By name, what calls give to the programs of a library.
pub(super) fn given(module: &Module) -> BTreeMap<ProgramName, Given> {
    let mut calls: BTreeMap<&ProgramName, Vec<&Call>> = BTreeMap::new();
    for call in module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of) {
        match &call.callee {
            Callee::Program(name) => calls.entry(name).or_default().push(call),
            // Any program may be called with anything.
            Callee::Computed(_) => return BTreeMap::new(),
            Callee::Block(_) | Callee::Cycle(_) => {}
        }
    }
    let mut found = BTreeMap::new();
    for program in &module.programs {
        let Some(name) = &program.name else { continue };
        let Some(calls) = calls.get(name).filter(|calls| calls.iter().all(|call| call.level)) else {
            continue;
        };
        let set = set_in(program);
        let locals: BTreeSet<u32> =
            calls.iter().flat_map(|call| &call.arguments).map(|argument| argument.local).collect();
        let given: Given = locals
            .into_iter()
            .filter(|local| !set.contains(local))
            .filter_map(|local| {
                let each = calls.iter().map(|call| {
                    let argument = call.arguments.iter().rfind(|argument| argument.local == local)?;
                    eval::whole(argument.value.constant().filter(|value| value.fract() == 0.0)?)
                });
                Some((local, each.collect::<Option<BTreeSet<u32>>>()?))
            })
            .collect();
        found.insert(name.clone(), given);
    }
    found
}

/// The locals that a program sets by name.
fn set_in(program: &Program) -> BTreeSet<u32> {
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let targets = stmts.filter_map(|stmt| match (&stmt.kind, stmt.kind.target()) {
        (_, Some(Place::Var(var))) => Some(*var),
        (StmtKind::Input { target: Place::Var(var), .. }, _) => Some(*var),
        _ => None,
    });
    targets.filter(|var| var.class == Class::Local).map(|var| var.number).collect()
}

/// The values of a number that hangs on one given local; none if it does not.
pub(super) fn values(number: &Expr, given: &Given) -> Option<BTreeSet<u32>> {
    let mut vars = BTreeSet::new();
    number.variables(&mut |var| _ = vars.insert(var));
    let (var, true) = (vars.pop_first()?, vars.is_empty()) else { return None };
    let local = given.get(&var.number).filter(|_| var.class == Class::Local)?;
    let each = local.iter().map(|value| {
        let mut number = number.clone();
        number.walk_mut(&mut |e| {
            if *e == Expr::Var(var) {
                *e = Expr::Number(f64::from(*value));
            }
        });
        let number = eval::number(&number, &Memory::new()).ok().filter(|number| number.fract() == 0.0)?;
        eval::whole(number).filter(|number| *number > 0)
    });
    each.collect()
}

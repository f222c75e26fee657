//! Blocks of variables that computed numbers are counted from, where nothing bounds how far: `#198=100+2*#1` and then `#[#198]`.
//!
//! Nothing is supposed of such a number, and yet people mean it to stay in the block of variables where its constant part
//! lies: an array that a caller fills. So the conversion takes its own registers elsewhere, where there are any.

use crate::dialect::{Control, VariableClass};
use crate::ir::analysis::Numbers;
use crate::ir::{Class, Expr, Module, Place, Program, StmtKind, Var, constant_part};
use std::collections::BTreeSet;

/// From which number on a constant names a variable, and not a count.
const FIRST: f64 = 100.0;

/// The blocks of the source's variables that these numbers of variables, each of a program, are counted from.
pub(super) fn blocks(module: &Module, numbers: &[(usize, Expr)], source: &Control) -> Numbers {
    let mut runs = Vec::new();
    let mut asked: BTreeSet<(usize, Var)> = BTreeSet::new();
    let mut open: Vec<(usize, Var)> = Vec::new();
    for (index, number) in numbers {
        look(*index, number, source, &mut runs, &mut open);
    }
    while let Some((index, var)) = open.pop() {
        if !asked.insert((index, var)) {
            continue;
        }
        let shared = !matches!(var.class, Class::Local | Class::Temp);
        let programs = module.programs.iter().enumerate();
        for (at, program) in programs.filter(|(at, _)| shared || *at == index) {
            each_value(program, var, &mut |value| look(at, value, source, &mut runs, &mut open));
        }
    }
    Numbers::of(runs)
}

/// Notes the block that a value is counted from, or the variables that it is made of.
fn look(
    index: usize,
    value: &Expr,
    source: &Control,
    runs: &mut Vec<(u32, u32)>,
    open: &mut Vec<(usize, Var)>,
) {
    let base = constant_part(value).filter(|base| *base >= FIRST && *base <= f64::from(u32::MAX));
    match base.and_then(|base| source.numbered_class(base as u32)) {
        Some(row) => runs.push(block(row, source)),
        None => value.variables(&mut |var| open.push((index, var))),
    }
}

/// The block that a row is part of: it may stand in the table as several rows, as some numbers must be bought.
fn block(row: &VariableClass, source: &Control) -> (u32, u32) {
    let (mut first, mut last) = (row.first, row.last);
    let alike = |other: &&VariableClass| other.name == row.name && other.class == row.class;
    let mut beside = || {
        let rows = source.classes().iter().filter(alike);
        let beside =
            |other: &&VariableClass| other.last + 1 == first || other.first == last.saturating_add(1);
        rows.clone().find(beside).map(|other| (first, last) = (first.min(other.first), last.max(other.last)))
    };
    while beside().is_some() {}
    (first, last)
}

/// Calls `f` with each value that a program gives to a variable.
fn each_value(program: &Program, var: Var, f: &mut dyn FnMut(&Expr)) {
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        if let StmtKind::Assign { target: Place::Var(to), value } = &stmt.kind
            && *to == var
        {
            f(value);
        }
    }
}

//! Which variables are followed: those that a question is about, and what they are made of or compared with.

use crate::ir::analysis::VarSet;
use crate::ir::analysis::dataflow::reached;
use crate::ir::{Call, Callee, Cond, Expr, NcItem, Place, Program, StmtKind, TermKind, Var};
use std::collections::{BTreeMap, BTreeSet};

/// Most variables that are followed.
const VARS: usize = 64;

/// The variables in words that are whole numbers.
pub(super) fn in_whole_words(program: &Program) -> BTreeSet<Var> {
    let mut found = VarSet::default();
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        let StmtKind::Nc(nc) = &stmt.kind else { continue };
        for item in &nc.items {
            if let NcItem::Word(role, value) = item
                && role.is_integer()
            {
                add(value, &mut found);
            }
        }
    }
    found.iter().collect()
}

/// The variables in computed numbers.
pub(in crate::ir::analysis) fn in_numbers(program: &Program) -> BTreeSet<Var> {
    let mut found = VarSet::default();
    for block in &program.blocks {
        let mut note = |e: &Expr| {
            e.walk(&mut |e| {
                if let Expr::Indirect(_, index) = e {
                    add(index, &mut found);
                }
            });
        };
        for stmt in &block.stmts {
            stmt.kind.exprs(&mut note);
            stmt.kind.target().iter().for_each(|place| note(&place.read()));
        }
        block.term.kind.exprs(&mut note);
        match &block.term.kind {
            TermKind::Computed { value, .. } => add(value, &mut found),
            TermKind::Return { to: Some(value) } => add(value, &mut found),
            TermKind::Call { call, .. } => numbered(call, &mut found),
            _ => {}
        }
    }
    found.iter().collect()
}

/// Variables in the numbers of codes.
pub(super) fn in_codes(program: &Program) -> BTreeSet<Var> {
    let mut found = VarSet::default();
    for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
        let StmtKind::Nc(nc) = &stmt.kind else { continue };
        for item in &nc.items {
            if let NcItem::Code(_, value) = item {
                add(value, &mut found);
            }
        }
    }
    found.iter().collect()
}

/// These variables, and those that they depend on: what they are made of, and what they are compared with.
pub(super) fn followed(program: &Program, found: BTreeSet<Var>) -> BTreeSet<Var> {
    if found.is_empty() {
        return found;
    }
    let mut others: BTreeMap<Var, VarSet> = BTreeMap::new();
    for block in &program.blocks {
        for stmt in &block.stmts {
            if let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind {
                add(value, others.entry(*var).or_default());
            }
        }
        if let TermKind::Branch { cond, .. } = &block.term.kind {
            compared(cond, &mut |a, b| {
                for (a, b) in [(a, b), (b, a)] {
                    if let Expr::Var(var) = a {
                        add(b, others.entry(*var).or_default());
                    }
                }
            });
        }
    }
    let found =
        reached(found, |var, go| others.get(&var).iter().for_each(|all| all.iter().for_each(&mut *go)));
    if found.len() > VARS { BTreeSet::new() } else { found }
}

/// The variables that the program assigns, or a branch looks at: of others nothing is ever known.
pub(super) fn told_of(program: &Program) -> VarSet {
    let mut told = VarSet::default();
    for block in &program.blocks {
        let targets = block.stmts.iter().filter_map(|stmt| stmt.kind.target());
        told.extend(targets.filter_map(|place| if let Place::Var(var) = place { Some(*var) } else { None }));
        if let TermKind::Branch { cond, .. } = &block.term.kind {
            cond.exprs(&mut |e| add(e, &mut told));
        }
    }
    told
}

fn add(e: &Expr, found: &mut impl Extend<Var>) {
    e.variables(&mut |var| found.extend([var]));
}

fn numbered(call: &Call, found: &mut VarSet) {
    if let Callee::Computed(number) = &call.callee {
        add(number, found);
    }
}

/// Calls `f` on the operands of each comparison.
pub(super) fn compared(cond: &Cond, f: &mut dyn FnMut(&Expr, &Expr)) {
    let mut work = vec![cond];
    while let Some(cond) = work.pop() {
        match cond {
            Cond::Compare(_, a, b) => f(a, b),
            Cond::And(parts) | Cond::Or(parts) => work.extend(parts),
            Cond::Not(inner) => work.push(inner),
            Cond::Switch(_) => {}
        }
    }
}

/// The constants that conditions compare with, and their neighbours: where loops end.
pub(super) fn stops(program: &Program) -> Vec<f64> {
    let mut all = Vec::new();
    for block in &program.blocks {
        if let TermKind::Branch { cond, .. } = &block.term.kind {
            compared(cond, &mut |a, b| {
                for number in [a, b].into_iter().filter_map(Expr::constant) {
                    all.extend([number - 1.0, number, number + 1.0]);
                }
            });
        }
    }
    all.sort_unstable_by(f64::total_cmp);
    all.dedup();
    all
}

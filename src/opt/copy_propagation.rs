//! Copy propagation.
//!
//! **Law.** After `t = s` and before the next write of either, reading `t` is reading `s`.
//!
//! **Side condition.** `t` is a temporary; at `-O2` it may be any variable without a name whose
//! assignment has no comment, where `s` is a number. `s` is a number or a variable that is never
//! vacant. Reads in words of an NC block and in arguments are left alone. Assignments stay.
//!
//! **Counter-examples.** `tmp.1 = #2` with `#2` vacant: `tmp.1` is 0, and `#3 = tmp.1` must not
//! make `#3` vacant. A word that becomes a constant may no longer stand in one block with
//! words that are variables, and one that becomes a variable may not be one that words take: hence the words, and hence not after legalization.

use super::pass::{Level, Library, Pass};
use crate::ir::analysis::{Summaries, Vars};
use crate::ir::{Class, Expr, Place, Program, Stmt, StmtKind, TermKind, Var};
use std::collections::{BTreeMap, BTreeSet};

/// The pass.
pub struct CopyPropagation;

impl Pass for CopyPropagation {
    fn name(&self) -> &'static str {
        "copy-propagation"
    }

    fn keeps_legal(&self) -> bool {
        false
    }

    fn asks_what_calls_write(&self) -> bool {
        true
    }

    fn run(&self, program: &mut Program, library: &Library, level: Level) {
        if level < Level::O2 && program.temporaries().next().is_none() {
            return;
        }
        for block in &mut program.blocks {
            let mut copies = Available { sources: BTreeMap::new(), named: &library.named, level };
            for stmt in &mut block.stmts {
                if !matches!(stmt.kind, StmtKind::Nc(_) | StmtKind::ModalCall(_)) {
                    stmt.kind.exprs_mut(&mut |e| copies.replace(e));
                }
                copies.step(stmt, &library.summaries);
            }
            if !matches!(block.term.kind, TermKind::Call { .. }) {
                block.term.kind.exprs_mut(&mut |e| copies.replace(e));
            }
        }
    }
}

/// What is known at a place of a block.
struct Available<'k> {
    sources: BTreeMap<Var, Expr>,
    named: &'k BTreeSet<Var>,
    level: Level,
}

impl Available<'_> {
    fn replace(&self, e: &mut Expr) {
        match e {
            Expr::Var(var) => {
                if let Some(source) = self.sources.get(var) {
                    *e = source.clone();
                }
            }
            e => e.exprs_mut(&mut |operand| self.replace(operand)),
        }
    }

    fn step(&mut self, stmt: &Stmt, summaries: &Summaries) {
        self.forget(stmt, summaries);
        if stmt.site.skip.is_none()
            && let StmtKind::Assign { target: Place::Var(copy), value } = &stmt.kind
            && self.is_copy(stmt, *copy, value)
        {
            self.sources.insert(*copy, value.clone());
        }
    }

    /// Forgets what a statement may change.
    fn forget(&mut self, stmt: &Stmt, summaries: &Summaries) {
        if self.sources.is_empty() {
            return;
        }
        let mut written = Vars::default();
        stmt.kind.target().iter().for_each(|place| written.write(place));
        match &stmt.kind {
            StmtKind::ClearAll(class) => {
                written.classes.insert(*class);
            }
            StmtKind::Nc(nc) => {
                written.join(summaries.by_nc(nc));
            }
            _ => {}
        }
        self.sources.retain(|copy, source| {
            let stale = matches!(source, Expr::Var(var) if written.contains(*var));
            !written.contains(*copy) && !stale
        });
    }

    fn is_copy(&self, stmt: &Stmt, copy: Var, value: &Expr) -> bool {
        let number = matches!(value, Expr::Number(_));
        if copy.class == Class::Temp {
            return number || matches!(value, Expr::Var(var) if !var.class.nullable() && *var != copy);
        }
        self.level >= Level::O2 && number && !self.named.contains(&copy) && stmt.site.comments.is_empty()
    }
}

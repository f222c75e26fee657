//! Locals of a macro that get a default where a call gives them no number.
//!
//! Law: a run that finds the default which an earlier run set does what a run does that finds the local vacant and sets it again.
//! Side conditions: each assignment of the local stands alone under the test that it is vacant, and both ways go on together right
//! after it; all assign the same value, which is a number or is computed from locals that the macro never sets. Whoever asks what the
//! macro reads takes a test so as setting the local: after it the local has a number on both ways, and the same one in each run.
//! Counter-examples: `IF[#17EQ#0]THEN#17=#500`, where `#500` may have changed; `#17=#17+1` after it; a test on some ways only, and a
//! read on the others.

use crate::ir::analysis::Arrivals;
use crate::ir::{BlockId, Class, Cond, Expr, Module, Place, Program, Relation, StmtKind, TermKind, Var};
use std::collections::{BTreeMap, BTreeSet};

/// The local that the end of a block tests for being vacant, where it goes if so, and where if not.
fn test(kind: &TermKind) -> Option<(u32, BlockId, BlockId)> {
    let TermKind::Branch { cond, then, otherwise } = kind else { return None };
    let Cond::Compare(relation, a, b) = &**cond else { return None };
    let local = match (a, b) {
        (Expr::Var(Var { class: Class::Local, number }), Expr::Vacant)
        | (Expr::Vacant, Expr::Var(Var { class: Class::Local, number })) => *number,
        _ => return None,
    };
    match relation {
        Relation::Equal => Some((local, *then, *otherwise)),
        Relation::NotEqual => Some((local, *otherwise, *then)),
        _ => None,
    }
}

/// True for a number, or what is computed from locals that nothing sets.
fn is_fixed(value: &Expr, set: &BTreeSet<u32>) -> bool {
    let mut fixed = !value.may_be_vacant();
    value.walk(&mut |part| {
        fixed &= match part {
            Expr::Var(var) => var.class == Class::Local && !set.contains(&var.number),
            Expr::System(..) | Expr::Indirect(..) | Expr::Truth(_) | Expr::Increments(_) => false,
            _ => true,
        };
    });
    fixed
}

/// The tests of locals that only get a default in a program, by the blocks that end in them. `set` are all locals that it, and what
/// runs at its level, may set; those of `elsewhere` are set by others than single assignments in this program.
pub fn tests(
    module: &Module,
    program: &Program,
    set: &BTreeSet<u32>,
    elsewhere: &BTreeSet<u32>,
) -> BTreeMap<BlockId, u32> {
    let found =
        program.ids().zip(&program.blocks).filter_map(|(id, block)| Some((id, test(&block.term.kind)?)));
    let found: Vec<_> = found.collect();
    if found.is_empty() {
        return BTreeMap::new();
    }
    let mut ends = module.programs.iter().flat_map(|program| &program.blocks);
    let returns = ends.any(|block| matches!(block.term.kind, TermKind::Return { to: Some(_) }));
    let ways = Arrivals::of_program(program, |_| returns);
    // By the block with the assignment.
    let mut defaults: BTreeMap<BlockId, (BlockId, u32, &Expr)> = BTreeMap::new();
    for (id, (local, vacant, goes_on)) in found {
        let Some(block) = program.block(vacant) else { continue };
        let mut acts = block.stmts.iter().filter(|stmt| stmt.kind != StmtKind::Comment);
        if let (Some(stmt), None, TermKind::Jump(to)) = (acts.next(), acts.next(), &block.term.kind)
            && let StmtKind::Assign { target: Place::Var(Var { class: Class::Local, number }), value } =
                &stmt.kind
            && *number == local
            && *to == goes_on
            && stmt.site.skip.is_none()
            && ways.is_only_from(vacant.index(), id.index())
            && is_fixed(value, set)
        {
            defaults.insert(vacant, (id, local, value));
        }
    }
    let other = |local: u32| {
        let mut values = defaults.values().filter(|default| default.1 == local).map(|default| default.2);
        let first = values.next();
        let assigns = |stmt: &crate::ir::Stmt| matches!(stmt.kind.target(), Some(Place::Var(Var { class: Class::Local, number })) if *number == local);
        let mut blocks = program.ids().zip(&program.blocks).filter(|(id, _)| !defaults.contains_key(id));
        elsewhere.contains(&local)
            || values.any(|value| Some(value) != first)
            || blocks.any(|(_, block)| block.stmts.iter().any(assigns))
    };
    let own = defaults.values().filter(|default| !other(default.1));
    own.map(|(id, local, _)| (*id, *local)).collect()
}

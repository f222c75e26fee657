//! Where a signed variable in a word, or in an argument of a call, may be vacant.
//!
//! `X#1` is dropped when #1 is vacant. That `X-#1` is dropped too, no source says. It
//! matters only where the variable may be vacant there, so that is what is looked for:
//! forward over the blocks, with what assignments and tests make sure of.

use crate::ir::analysis::dataflow::{Every, Flow};
use crate::ir::{
    BlockId, Call, Callee, Class, Cond, Expr, Nc, NcItem, Place, Program, Relation, StmtKind, TermKind, Var,
};
use crate::text::Span;
use std::collections::BTreeSet;

/// Variables that are sure to hold a number.
type Sure = BTreeSet<Var>;

/// The first blocks with a signed variable that may be vacant there.
#[derive(Default)]
pub struct Signed {
    /// In a word.
    pub word: Option<Span>,
    /// In an argument of a call.
    pub argument: Option<Span>,
}

/// Where a program has them. With `returns_anywhere` a called program may return to any label.
pub fn signed_variables(program: &Program, returns_anywhere: bool) -> Signed {
    let mut found = Signed::default();
    // A modal call runs after moves, and what it does to shared variables is not known here.
    let modal = (program.blocks.iter().flat_map(|block| &block.stmts))
        .any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
    let at_entry = solve(program, returns_anywhere, modal);
    for (block, sure) in program.blocks.iter().zip(at_entry) {
        let Some(Every(mut sure)) = sure else { continue };
        for stmt in &block.stmts {
            if signed(&stmt.kind).any(|var| !sure.contains(&var)) {
                found.word.get_or_insert(stmt.site.span);
            }
            if let StmtKind::ModalCall(call) = &stmt.kind
                && given(call).any(|var| !sure.contains(&var))
            {
                found.argument.get_or_insert(stmt.site.span);
            }
            step(&stmt.kind, &mut sure);
            if modal {
                sure.retain(|var| var.class == Class::Local);
            }
        }
        if let TermKind::Call { call, .. } = &block.term.kind
            && given(call).any(|var| !sure.contains(&var))
        {
            found.argument.get_or_insert(block.term.site.span);
        }
    }
    found
}

/// The variables that stand in an argument with a sign before them.
fn given(call: &Call) -> impl Iterator<Item = Var> + '_ {
    call.arguments.iter().filter_map(|argument| signed_variable(&argument.value))
}

fn signed_variable(value: &Expr) -> Option<Var> {
    match value {
        Expr::Negate(inner) => match **inner {
            Expr::Var(var) if var.class.nullable() => Some(var),
            _ => None,
        },
        _ => None,
    }
}

/// The variables that stand in a word with a sign before them.
fn signed(kind: &StmtKind) -> impl Iterator<Item = Var> + '_ {
    let items = match kind {
        StmtKind::Nc(Nc { items }) => items.as_slice(),
        _ => &[],
    };
    items.iter().filter_map(|item| match item {
        NcItem::Word(_, value) => signed_variable(value),
        _ => None,
    })
}

/// What is sure at the head of each block; none if control never comes.
fn solve(program: &Program, returns_anywhere: bool, modal: bool) -> Vec<Option<Every<Var>>> {
    let mut heads = Flow::new(program.blocks.len());
    heads.flow(0, &Every(Sure::new()));
    let calls = |block: &&crate::ir::Block| matches!(block.term.kind, TermKind::Call { .. });
    if returns_anywhere && program.blocks.iter().any(|block| calls(&block)) {
        for (at, block) in program.blocks.iter().enumerate() {
            if !block.labels.is_empty() {
                heads.flow(at, &Every(Sure::new()));
            }
        }
    }
    while let Some(at) = heads.pop() {
        let (Some(block), Some(head)) = (program.blocks.get(at), heads.state(at)) else { continue };
        let mut sure = head.0.clone();
        block.stmts.iter().for_each(|stmt| step(&stmt.kind, &mut sure));
        if modal {
            sure.retain(|var| var.class == Class::Local);
        }
        let mut flow = |to: BlockId, sure: Sure| {
            heads.flow(to.index(), &Every(sure));
        };
        match &block.term.kind {
            TermKind::Branch { cond, then, otherwise } => {
                let mut held = sure.clone();
                learn(cond, true, &mut held);
                flow(*then, held);
                learn(cond, false, &mut sure);
                flow(*otherwise, sure);
            }
            TermKind::Call { call, next } => {
                if let Callee::Block(entry) = call.callee {
                    flow(entry, Sure::new());
                }
                sure.retain(|var| call.level && var.class == Class::Local);
                flow(*next, sure);
            }
            kind => {
                for to in kind.successors() {
                    flow(to, sure.clone());
                }
            }
        }
    }
    heads.into_states()
}

fn step(kind: &StmtKind, sure: &mut Sure) {
    if let StmtKind::Assign { target, value } = kind {
        let vacant = match value {
            Expr::Var(var) => var.class.nullable() && !sure.contains(var),
            other => other.may_be_vacant(),
        };
        match target {
            Place::Var(var) if vacant => {
                sure.remove(var);
            }
            Place::Var(var) => {
                sure.insert(*var);
            }
            Place::Indirect(..) if vacant => sure.clear(),
            _ => {}
        }
    }
}

/// What a condition makes sure of when it holds, or when it does not.
fn learn(cond: &Cond, holds: bool, sure: &mut Sure) {
    match cond {
        Cond::And(all) if holds => all.iter().for_each(|cond| learn(cond, true, sure)),
        Cond::Or(any) if !holds => any.iter().for_each(|cond| learn(cond, false, sure)),
        Cond::Not(inner) => learn(inner, !holds, sure),
        Cond::Compare(relation, Expr::Var(var), other) => {
            let relation = if holds { *relation } else { relation.negated() };
            let bound = other.constant();
            // Vacant counts as 0 in the four orders.
            let excluded = match relation {
                Relation::NotEqual => *other == Expr::Vacant,
                Relation::Equal => bound.is_some(),
                Relation::Greater => bound.is_some_and(|bound| bound >= 0.0),
                Relation::GreaterEqual => bound.is_some_and(|bound| bound > 0.0),
                Relation::Less => bound.is_some_and(|bound| bound <= 0.0),
                Relation::LessEqual => bound.is_some_and(|bound| bound < 0.0),
            };
            if excluded {
                sure.insert(*var);
            }
        }
        _ => {}
    }
}

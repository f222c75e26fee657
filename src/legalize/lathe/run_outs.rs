//! The codes that let threads run out at their end or not, for a target that has no such codes.
//!
//! Law: a thread of many passes whose run-out is switched off has a run-out of 0. Side condition: which of the two codes is in force is known: the
//! last one before the thread says it, with no other way in between, or no program of the library switches it off. Counter-example: a
//! single pass (G92), whose run-out on the target only a parameter of the machine says.

use super::straight::entered_straight;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Expr, Module, Nc, NcItem, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

const CODES: [Op; 2] = [Op::ThreadRunOutOn, Op::ThreadRunOutOff];

/// True where such a code stands, and the target has none.
pub fn concerns(features: &Features, target: &Control) -> bool {
    CODES.iter().any(|op| features.op(*op) && target.code_for(*op, &BTreeMap::new()).is_none())
}

/// Tells threads their run-out by a word, and drops the codes.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let never_off = !context.features.op(Op::ThreadRunOutOff);
    let single = !never_off && context.features.op(Op::ThreadingPass);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let straight = entered_straight(program);
        let mut on = never_off.then_some(true);
        for (block, straight) in program.blocks.iter_mut().zip(straight) {
            if !straight {
                on = never_off.then_some(true);
            }
            let mut out = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::take(&mut block.stmts) {
                let refused = step(&mut stmt, &mut on, never_off, single);
                if let Some((what, help)) = refused {
                    let told = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help);
                    context.add(index, told);
                }
                if stmt.kind.nc().is_some_and(|nc| nc.items.is_empty()) {
                    stmt.kind = StmtKind::Comment;
                    if stmt.site.comments.is_empty() && stmt.site.sequence.get().is_none() {
                        continue;
                    }
                }
                out.push(stmt);
            }
            block.stmts = out;
        }
    }
}

/// Takes a statement; why it is refused, and what to do.
fn step(
    stmt: &mut Stmt,
    on: &mut Option<bool>,
    never_off: bool,
    single: bool,
) -> Option<(&'static str, &'static str)> {
    let skipped = stmt.site.skip.is_some();
    let StmtKind::Nc(nc) = &mut stmt.kind else { return None };
    let thread = nc.has(Op::Threading);
    let code = nc.ops().filter(|op| CODES.contains(op)).last();
    if let Some(code) = code {
        nc.items.retain(|item| !matches!(item, NcItem::Op(op) if CODES.contains(op)));
        let now = Some(code == Op::ThreadRunOutOn);
        *on = if never_off || !skipped || *on == now { now } else { None };
        if thread {
            return Some((BESIDE, "give the M code a block of its own"));
        }
        if single && code == Op::ThreadRunOutOff {
            return Some((SINGLE, "write these threads with G76 or G32"));
        }
    }
    if !thread {
        return None;
    }
    match *on {
        Some(true) => None,
        Some(false) => {
            ends_straight(nc);
            None
        }
        None => Some((UNKNOWN, "write M23 or M24 in a block right before the thread")),
    }
}

/// A thread without a run-out.
fn ends_straight(nc: &mut Nc) {
    nc.items.push(NcItem::Word(Role::ThreadRunOut, Expr::Number(0.0)));
}

const BESIDE: &str = "M23 or M24 beside a thread: whether it counts for that thread no source says";
const SINGLE: &str = "M24 in a library with threads by G92: by what a single pass of the target runs out only a parameter of it says";
const UNKNOWN: &str = "whether this thread runs out is not known: a program of the library switches that off (M24), and no code before it says \
                       which is in force";

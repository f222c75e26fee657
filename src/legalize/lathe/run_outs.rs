//! The codes that let threads run out at their end or not, for a target that has no such codes.
//!
//! Law: a thread of many passes whose run-out is switched off has a run-out of 0. Side condition: which of the two codes is in force is known: the
//! last one before the thread says it, with no other way in between, or its program switches it off nowhere and is linked with no other one; where
//! another program of the library does, a person must accept that the end of a program switches it on. Counter-example: a
//! single pass (G92), whose run-out on the target only a parameter of the machine says.

use super::straight::entered_straight;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

const CODES: [Op; 2] = [Op::ThreadRunOutOn, Op::ThreadRunOutOff];

/// True where such a code stands, and the target has none.
pub fn concerns(features: &Features, target: &Control) -> bool {
    CODES.iter().any(|op| features.op(*op) && target.code_for(*op, &BTreeMap::new()).is_none())
}

/// Tells threads their run-out by a word, and drops the codes.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let linked = linked(module, context);
    // A single pass in a program that this one may call, or that may call it.
    let beyond = linked.iter().any(|index| module.programs.get(*index).is_some_and(has_pass));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let straight = entered_straight(program);
        let never_off =
            !context.features.op(Op::ThreadRunOutOff) || !linked.contains(&index) && !may_switch_off(program);
        if never_off && let Some(span) = thread(program).filter(|_| context.features.op(Op::ThreadRunOutOff))
        {
            let told = Diagnostic::new(Code::Conditional, span, ELSEWHERE).with_help(ELSEWHERE_HELP);
            context.add_once(index, ELSEWHERE, told.asked_once());
        }
        let passes = has_pass(program);
        let single = linked.contains(&index) && beyond;
        let mut on = never_off.then_some(true);
        // Whether a single pass is in force.
        let mut in_pass = Some(false);
        for (block, straight) in program.blocks.iter_mut().zip(straight) {
            if !straight {
                on = never_off.then_some(true);
                in_pass = (!passes).then_some(false);
            }
            let mut out = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::take(&mut block.stmts) {
                in_pass = motion(&stmt).or(in_pass);
                let refused = step(&mut stmt, &mut on, never_off, single || in_pass != Some(false));
                let straight = !single && on != Some(true) && stmt.kind.has_op(Op::ThreadingPass);
                let refused = refused.or(straight.then_some((SINGLE, SINGLE_HELP)));
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

/// The programs that call others, that others call, or that return to who knows whom.
fn linked(module: &Module, context: &Context<'_>) -> BTreeSet<usize> {
    let ways = |program: &Program| {
        let mut blocks = program.blocks.iter();
        blocks.any(|block| matches!(block.term.kind, TermKind::Return { .. } | TermKind::Call { .. }))
    };
    let own = module.programs.iter().enumerate().filter(|(_, program)| ways(program)).map(|(index, _)| index);
    let called = context.called(module).pairs(module).into_iter().map(|(_, callee)| callee);
    let any = context.features.has(Feature::Modal) || context.features.has(Feature::MachineCode);
    if any { (0..module.programs.len()).collect() } else { own.chain(called).collect() }
}

/// True where the text of a program switches the run-out off.
fn may_switch_off(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| stmt.kind.has_op(Op::ThreadRunOutOff))
}

/// The first thread that may run out.
fn thread(program: &Program) -> Option<Span> {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let threads = |stmt: &&Stmt| stmt.kind.has_op(Op::Threading) || stmt.kind.has_op(Op::ThreadingPass);
    stmts.find(threads).map(|stmt| stmt.site.span)
}

/// True for a program with single passes of threads.
fn has_pass(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| stmt.kind.has_op(Op::ThreadingPass))
}

/// Whether a block puts a single pass in force; none if it names no motion, or may be skipped.
fn motion(stmt: &Stmt) -> Option<bool> {
    let nc = stmt.kind.nc()?;
    let op = nc.ops().filter(|op| op.group() == Group::Motion || op.is_lathe_cycle()).last()?;
    let passes = op == Op::ThreadingPass;
    (passes || stmt.site.skip.is_none()).then_some(passes)
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
            return Some((SINGLE, SINGLE_HELP));
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

const ELSEWHERE: &str = "a program of the library switches the run-out of threads off (M24): the threads of the others are taken to run out, as if the end \
                         of a program, and a reset, switch it on again";
const ELSEWHERE_HELP: &str =
    "make sure that it is so on the machine, or write M23 at the start of these programs";
const BESIDE: &str = "M23 or M24 beside a thread: whether it counts for that thread no source says";
const SINGLE: &str = "a thread by G92 may come while its run-out is switched off (M24): by what a single pass of the target runs out only a parameter of it says";
const SINGLE_HELP: &str = "write M23 before these threads, or write them with G76 or G32";
const UNKNOWN: &str = "whether this thread runs out is not known: a program of the library switches that off (M24), and no code before it says \
                       which is in force";

//! Waiting for the moves, and how far a control reads ahead.
//!
//! Law: a statement that waits until all moves are done is needed only where the target runs macro
//! statements early; there, a block that stops reading ahead stands for it where the target has one; else reading ahead is
//! limited to the least and empty blocks hold it back. Where the target has no such limit, none is set; if it has a block that stops
//! reading ahead, a program that sets a limit waits before it reads where the machine is. Both change when a
//! value is read or an output is switched, never what is computed; hence review diagnostics. A limit in a program that
//! reads no state of the machine and has no common variable is dropped with a note; what `outside` says of common variables holds for the others. Side condition: no cutter compensation is in force, under which the
//! target takes no limit; where the library compensates, the limit is taken off again after the empty blocks.

use super::outside;
use super::waits::hold;
use crate::assume::Predicate;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::analysis::may_come_back;
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::{
    Block, Expr, Module, Nc, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind,
};
use crate::legalize::layout::blanks::is_empty;
use crate::legalize::layout::emptied::drop_emptied;
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;
use std::collections::BTreeMap;

/// Empty blocks after a limit of one: the control reads two blocks more than it is told.
pub(super) const HOLD_BACK: usize = 3;

/// Replaces waits and limits that the target has not.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let waits = context.target.statement("wait").is_some();
    let limits = context.target.code_for(Op::LimitLookahead, &BTreeMap::new()).is_some();
    let early = context.target.is(Question::LookaheadRunsEarly);
    let stops = context.target.statement("lookahead.stop").is_some();
    let reads: Vec<bool> = module.programs.iter().map(reads_state).collect();
    let shares: Vec<bool> = module.programs.iter().map(outside::shares).collect();
    if !waits && !limits && stops && early {
        let come_back = may_come_back(module);
        for (program, shares) in module.programs.iter_mut().zip(&shares) {
            if !is_limited(program) {
                continue;
            }
            if *shares {
                outside::hold(program);
            }
            hold(program, come_back, false, None);
        }
    }
    let compensates = module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts).any(compensates);
    let mut entry = context.entry.clone();
    // Programs start without compensation: only what one begins may be in force.
    entry.start_in(Op::RadiusOff);
    let facts = if compensates { ModalFacts::of(module, &entry) } else { ModalFacts::unknown() };
    // The empty blocks after a limit are there for it.
    let mut is_dropped = false;
    replace_statements(module, &facts, |index, state, stmt, out| {
        if compensates {
            state.step(&stmt);
        }
        let span = stmt.site.span;
        is_dropped &= is_empty(&stmt);
        if is_dropped {
            return;
        }
        match stmt.kind {
            StmtKind::Sync if !waits && stops && early && holds(out) => {
                out.push(Stmt { kind: StmtKind::Nc(Nc::default()), site: stmt.site });
            }
            StmtKind::Sync if !waits && stops && early => {
                // The source may have such a block itself, and does the same there.
                if context.source.statement("lookahead.stop").is_none() {
                    say_stop(index, compensates.then_some(&*state), span, context);
                }
                out.push(Stmt {
                    kind: StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::MachineOnce)] }),
                    site: stmt.site,
                });
            }
            StmtKind::Sync if !waits && limits && early => {
                say_limit(index, compensates.then_some(&*state), span, context);
                limit(stmt.site, compensates, out);
            }
            StmtKind::Sync if !waits => {
                say_unlimited(index, early, span, context);
                out.push(Stmt { kind: StmtKind::Nc(Nc::default()), site: stmt.site });
            }
            StmtKind::LimitLookahead(_) if !limits => {
                let told = match (reads.get(index), shares.get(index)) {
                    (Some(false), Some(false)) => Diagnostic::new(Code::QualityDropped, span, UNREAD),
                    (Some(false), _) if stops && early => Diagnostic::new(Code::QualityDropped, span, SHARED),
                    _ => {
                        let what = if stops && early { HELD } else { DROPPED };
                        Diagnostic::new(Code::Conditional, span, what).asked_once()
                    }
                };
                context.add_once(
                    index,
                    "lookahead",
                    told.assuming(Predicate::Substitute(Op::LimitLookahead)),
                );
                out.push(Stmt { kind: StmtKind::Nc(Nc::default()), site: stmt.site });
                is_dropped = true;
            }
            kind => out.push(Stmt { kind, site: stmt.site }),
        }
    });
    module.programs.iter_mut().flat_map(|p| &mut p.blocks).for_each(|block| _ = drop_emptied(block));
}

const DROPPED: &str = "the limit on reading ahead is dropped: the target has none, so the blocks after it may read inputs, switch outputs and write common variables early";

const HELD: &str = "the limit on reading ahead is dropped: the target has none. It waits in its place where the program has common variables, and before each place \
     that it reads, but the blocks after the limit may read inputs and switch outputs early";

const SHARED: &str = "the limit on reading ahead is dropped: the target has none. It waits in its place, and before it writes a common variable that \
     this program does not read, until the moves before are done";

const UNREAD: &str = "the limit on reading ahead is dropped: the target has none, and nothing in this program reads or writes what reading \
     ahead could change";

/// True for a program that limits how far the control reads ahead.
fn is_limited(program: &Program) -> bool {
    let limits =
        |stmt: &Stmt| matches!(&stmt.kind, StmtKind::LimitLookahead(to) if to.constant() != Some(0.0));
    program.blocks.iter().flat_map(|block| &block.stmts).any(limits)
}

/// True where the last block with words before this place stops reading ahead: nothing has moved since.
fn holds(out: &Stmts) -> bool {
    let words = |stmt: &Stmt| stmt.kind.nc().filter(|nc| !nc.items.is_empty()).cloned();
    let calls = out.iter().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
    !calls && out.iter().rev().find_map(words).is_some_and(|nc| nc.items == [NcItem::Op(Op::MachineOnce)])
}

/// True where a program reads or writes state of the machine, or calls what may.
fn reads_state(program: &Program) -> bool {
    let mut reads = false;
    let mut look = |e: &Expr| e.walk(&mut |e| reads |= matches!(e, Expr::System(..) | Expr::Indirect(..)));
    for block in &program.blocks {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
        block.term.kind.exprs(&mut look);
    }
    let writes = |stmt: &Stmt| {
        matches!(stmt.kind.target(), Some(Place::System(..) | Place::Indirect(..)))
            || matches!(stmt.kind, StmtKind::ModalCall(_) | StmtKind::Sync | StmtKind::Output(_))
    };
    let calls = |block: &Block| matches!(block.term.kind, TermKind::Call { .. });
    reads || program.blocks.iter().any(|block| calls(block) || block.stmts.iter().any(writes))
}

/// Says that the block which stops reading ahead is no block for cutter compensation.
fn say_stop(index: usize, state: Option<&Modal>, span: Span, context: &mut Context<'_>) {
    let Some(state) = state.filter(|state| state.op(Group::RadiusComp) != Some(Op::RadiusOff)) else {
        return;
    };
    let is_on = state.op(Group::RadiusComp).is_some();
    let what = "a wait for the moves where cutter compensation may be in force: the block that stops the target's reading \
                ahead would lift it there";
    let help = "put the wait before the compensation begins, or after it ends";
    let code = if is_on { Code::NoEquivalent } else { Code::Conditional };
    context.add_once(index, what, Diagnostic::new(code, span, what).with_help(help));
}

fn compensates(stmt: &Stmt) -> bool {
    let StmtKind::Nc(nc) = &stmt.kind else { return false };
    let begins =
        |item: &NcItem| matches!(item, NcItem::Op(Op::RadiusLeft | Op::RadiusRight) | NcItem::Code('G', _));
    nc.items.iter().any(begins)
}

/// A limit of one block and the empty ones; taken off again where it must not stay.
pub(super) fn limit(site: SourceInfo, taken_off: bool, out: &mut Stmts) {
    let span = site.span;
    let empty = || Stmt { kind: StmtKind::Comment, site: SourceInfo { span, ..SourceInfo::default() } };
    let to = |count: f64| StmtKind::LimitLookahead(Expr::Number(count));
    out.push(Stmt { kind: to(1.0), site });
    out.extend(std::iter::repeat_with(empty).take(HOLD_BACK));
    if taken_off {
        out.push(Stmt { kind: to(0.0), ..empty() });
    }
}

/// Says what the limit rests on; `state` where the library has cutter compensation.
fn say_limit(index: usize, state: Option<&Modal>, span: Span, context: &mut Context<'_>) {
    let what = match state.map(|state| state.op(Group::RadiusComp)) {
        Some(Some(Op::RadiusLeft | Op::RadiusRight)) => {
            let what = "a wait under cutter compensation: the target does not take a limit on reading \
                        ahead there";
            let help = "put the wait before the compensation begins, or after it ends";
            return context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
        }
        Some(None) => {
            "the wait becomes a limit on reading ahead and three empty blocks: make sure that no cutter \
             compensation is in force here, because the target does not take the limit then"
        }
        Some(Some(_)) => {
            "the wait becomes a limit on reading ahead and three empty blocks; the limit ends after them"
        }
        None => {
            "the wait becomes a limit on reading ahead and three empty blocks; the limit stays in force \
             after them"
        }
    };
    let told = Diagnostic::new(Code::Conditional, span, what);
    // Without compensation it is the maker's own way to wait: how far the machine reads ahead is one question for all.
    let is_open = matches!(state.map(|state| state.op(Group::RadiusComp)), Some(None));
    context.add_once(index, what, if is_open { told } else { told.asked_once() });
}

/// Says what becomes of a wait where the target has neither a wait nor a limit.
fn say_unlimited(index: usize, early: bool, span: Span, context: &mut Context<'_>) {
    let waits = context.target.behaviour(Question::SystemReadWaits);
    if early || !waits.is_some_and(|b| b.value == "true" && b.origin.is_confirmed()) {
        let what = "the source waits here until all moves are done; no manual confirms that the target \
                    waits before it reads a position";
        context.unconfirmed(index, Side::Target, span, Question::SystemReadWaits.fact(), what);
    }
}

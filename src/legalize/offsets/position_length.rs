//! Positions that hold the tool length on one control, and not on the other.
//!
//! Law: the place of the spindle is that of the tip and the length in force, which controls keep in a variable of its
//! own; so one is the other with that variable added or taken away. A variable that is added and taken away at once goes, as
//! it is read at one moment. Where no length can be in force nothing is asked.
//! Where it ends: a position of an axis that is computed.

use crate::canon::{Group, Op, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::constant_part;
use crate::ir::eval::whole;
use crate::ir::{Bank, BinOp, BlockId, Expr, Module, Program, TermKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, ModalFacts, Setting, rewrite_program};
use crate::text::Span;

/// Whether positions hold the tool length.
pub(in crate::legalize) const FACT: Question = Question::PositionLength;
/// The axis of the length.
pub(in crate::legalize) const DEPTH: u32 = 3;
const Z: f64 = DEPTH as f64;

/// Adds the length to positions, or takes it away; true if there are any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    // The offsets of a lathe's tool are those of its T word, along X as along Z: its positions are work coordinates (docs/lathe.md).
    if context.source.machine() == Machine::Lathe {
        return false;
    }
    let row = |control: &Control| {
        control.behaviour(FACT).map(|row| (row.value == "added", row.origin.is_confirmed()))
    };
    let (ours, theirs) = (row(context.source), row(context.target));
    if ours == theirs && (context.source.name() == context.target.name() || ours == Some((true, true))) {
        return false;
    }
    let reads_any = |features: &Features| features.has(Feature::System) || features.has(Feature::Indirect);
    let mut asks: Vec<usize> =
        (0..module.programs.len()).filter(|index| context.may_concern(*index, reads_any)).collect();
    asks.retain(|index| self::asks(&module.programs[*index], context.source));
    if asks.is_empty() {
        return false;
    }
    let added = |row: Option<(bool, bool)>| row.is_some_and(|(added, _)| added);
    let facts = context.modal_facts(module);
    for index in asks {
        let Some((span, computed)) = reads(&module.programs[index], index, &facts, context.source) else {
            continue;
        };
        context.rests_on_source(index, span, FACT);
        context.rests_on_target(index, span, FACT);
        let op = match (added(ours), added(theirs)) {
            (true, false) => BinOp::Add,
            (false, true) => BinOp::Sub,
            _ => continue,
        };
        if let Some(span) = computed {
            let what = "the axis of this position is computed: the position may include the tool length on one \
                 control and not on the other";
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
        }
        rewrite_program(&mut module.programs[index], is_depth, &mut |e, _, _| match e {
            e if is_depth(&e) => {
                let length = Expr::System(Sys::ActiveOffset, [Expr::Number(Z)].into());
                Expr::binary(op, e, length)
            }
            e => e,
        });
        settle(&mut module.programs[index]);
    }
    true
}

/// Leaves out a length that is added and taken away at once, as where an earlier conversion did the opposite.
fn settle(program: &mut Program) {
    let mut look = |e: &mut Expr| {
        e.walk_mut(&mut |e| {
            if let Some(position) = without_length(e) {
                *e = position.clone();
            }
        });
    };
    for block in &mut program.blocks {
        block.stmts.iter_mut().for_each(|stmt| stmt.kind.exprs_mut(&mut look));
        block.term.kind.exprs_mut(&mut look);
    }
}

/// The position in `position + length - length`, or with the signs the other way.
fn without_length(e: &Expr) -> Option<&Expr> {
    let Expr::Binary(outer, operands) = e else { return None };
    let Expr::Binary(inner, parts) = &operands[0] else { return None };
    let undone = matches!((outer, inner), (BinOp::Add, BinOp::Sub) | (BinOp::Sub, BinOp::Add));
    let length = |e: &Expr| matches!(e, Expr::System(Sys::ActiveOffset, axis) if axis.first().and_then(Expr::constant) == Some(Z));
    (undone && length(&operands[1]) && operands[1] == parts[1] && is_depth(&parts[0])).then_some(&parts[0])
}

/// True for a program that reads a position which may be along the axis of the length.
fn asks(program: &Program, source: &Control) -> bool {
    let mut any = false;
    let mut look = |e: &Expr| e.walk(&mut |e| any = any || is_depth(e) || is_computed(e, source));
    for block in &program.blocks {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
        block.term.kind.exprs(&mut look);
    }
    any
}

/// Where a program first reads a position along the axis of the length while one may be in force, and where it reads one
/// of a computed axis.
fn reads(
    program: &Program,
    index: usize,
    facts: &ModalFacts,
    source: &Control,
) -> Option<(Span, Option<Span>)> {
    let ends = program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::End { .. }));
    let (mut depth, mut computed) = (None, None);
    for (at, block) in program.blocks.iter().enumerate() {
        let mut state = facts.at(index, BlockId(at as u32));
        let mut look = |e: &Expr, span: Span, off: bool| {
            e.walk(&mut |e| {
                if off {
                } else if is_depth(e) {
                    depth.get_or_insert(span);
                } else if is_computed(e, source) {
                    computed.get_or_insert(span);
                }
            });
        };
        for stmt in &block.stmts {
            let off = is_off(state.of(Group::LengthComp), ends && !state.names_length());
            stmt.kind.exprs(&mut |e| look(e, stmt.site.span, off));
            state.step(stmt);
        }
        let off = is_off(state.of(Group::LengthComp), ends && !state.names_length());
        block.term.kind.exprs(&mut |e| look(e, block.term.site.span, off));
    }
    depth.or(computed).map(|span| (span, computed))
}

/// True where no length is in force; a main program starts without one.
fn is_off(length: Setting, main: bool) -> bool {
    match length {
        Setting::Known(op, _) => op == Op::LengthOff,
        _ => main,
    }
}

/// The states that tell where an axis is.
pub(in crate::legalize) const fn is_position(state: Sys) -> bool {
    matches!(state, Sys::WorkPosition | Sys::SkipPosition | Sys::AxisPosition)
}

fn position(e: &Expr) -> Option<&Expr> {
    match e {
        Expr::System(state, axis) if is_position(*state) => axis.first(),
        _ => None,
    }
}

fn is_depth(e: &Expr) -> bool {
    position(e).and_then(Expr::constant) == Some(Z)
}

/// True for a position of a computed axis; people count axes from 1, so `#[5040+#1]` is one.
fn is_computed(e: &Expr, source: &Control) -> bool {
    let Expr::Indirect(Bank::Numbered, number) = e else {
        return position(e).is_some_and(|axis| axis.constant().is_none());
    };
    let start = constant_part(number).and_then(whole);
    let first = start.and_then(|start| source.numbered_state(start.saturating_add(1)));
    first.is_some_and(|(state, ..)| is_position(state))
}

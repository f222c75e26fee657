//! What a program rests on that hangs on values nobody knows before it runs.
//!
//! A divisor may be zero, the argument of a root negative, a subscript no whole number, the end of an arc its start; a
//! cycle's planes may be used in the other mode of coordinates than they were given in. The conversion takes both
//! controls to do the same then. Where no source says what one of them does, a person has to look.

use crate::canon::{Func, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side, matters};
use crate::ir::{BinOp, Expr, Module, Nc, NcItem, StmtKind, TermKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;

/// True where something is computed or called, a cycle stands, or an arc by its radius has an end that counts increments.
pub fn concerns(features: &Features) -> bool {
    let computed =
        [Feature::Computed, Feature::System, Feature::Indirect].into_iter().any(|thing| features.has(thing));
    computed
        || features.has(Feature::Call)
        || features.any_op(Op::is_cycle)
        || features.role(Role::ArcRadius) && features.has(Feature::Increments)
}

/// Reports what the programs of a library rest on.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let cycles = context.features.any_op(Op::is_cycle);
    let modal = cycles.then(|| ModalFacts::of(module, &Modal::unknown()));
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = modal.as_ref().map(|modal| modal.at(index, id));
            for stmt in &block.stmts {
                let span = stmt.site.span;
                stmt.kind.exprs(&mut |e| e.walk(&mut |e| value(e, index, span, context)));
                if let Some(place) = stmt.kind.target() {
                    value(&place.read(), index, span, context);
                }
                if let StmtKind::Nc(nc) = &stmt.kind {
                    if let Some(state) = &state
                        && mixes(nc, state)
                    {
                        both(context, index, span, Question::CyclePlanesFrozen);
                    }
                    arc(nc, index, span, context);
                    if nc.word(Role::Repeat).is_some_and(|count| count.constant().is_none_or(|n| n < 1.0)) {
                        context.must_agree(index, span, Question::CycleL0Stores);
                    }
                }
                if let Some(state) = &mut state {
                    state.step(stmt);
                }
            }
            let span = block.term.site.span;
            block.term.kind.exprs(&mut |e| e.walk(&mut |e| value(e, index, span, context)));
            if let TermKind::Call { call, .. } = &block.term.kind
                && call.count.is_some()
                && !call.arguments.is_empty()
            {
                context.must_agree(index, span, Question::CallRepeatReloadsArguments);
            }
        }
    }
}

fn both(context: &mut Context<'_>, program: usize, span: Span, question: Question) {
    context.rests_on_source(program, span, question);
    context.rests_on_target(program, span, question);
    context.must_agree(program, span, question);
}

fn value(e: &Expr, index: usize, span: Span, context: &mut Context<'_>) {
    match e {
        Expr::Binary(BinOp::Div, operands) if operands[1].constant().is_none() => {
            both(context, index, span, Question::DivideByZero);
        }
        Expr::Call(Func::Sqrt, arguments) if !arguments.iter().all(never_negative) => {
            both(context, index, span, Question::SqrtOfNegative);
        }
        Expr::System(state, subscripts) if subscripts.iter().any(|e| e.constant().is_none()) => {
            let what = format!(
                "the number of '{state}' is computed: make sure that both controls have it; a number that \
                 one of them does not have means something unknown"
            );
            context.add_once(index, &what, Diagnostic::new(Code::Conditional, span, what.clone()));
        }
        Expr::Indirect(_, number) if makes_fractions(number) => {
            both(context, index, span, Question::IndexOfFraction)
        }
        _ => {}
    }
}

/// True where whole numbers may give one that is none. Variables that count are taken to.
fn makes_fractions(e: &Expr) -> bool {
    let mut found = false;
    if !e.is_whole() {
        e.walk(&mut |e| {
            found |= matches!(e, Expr::Binary(BinOp::Div, ..))
                || matches!(e, Expr::Number(value) if value.fract() != 0.0);
        });
    }
    found
}

/// True for squares, magnitudes, numbers, and their sums, products and quotients.
fn never_negative(e: &Expr) -> bool {
    match e {
        Expr::Number(value) => *value >= 0.0,
        Expr::Call(Func::Abs | Func::Sqrt, _) => true,
        Expr::Binary(BinOp::Mul, factors) if factors[0] == factors[1] => true,
        Expr::Binary(BinOp::Add | BinOp::Mul | BinOp::Div, operands) => operands.iter().all(never_negative),
        _ => false,
    }
}

/// True where a block drills by planes that may have been given in the other mode of coordinates.
fn mixes(nc: &Nc, state: &Modal) -> bool {
    let axes = nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_axis()));
    let goes_on = !nc.ops().any(|op| op.is_cycle() || matches!(op, Op::CycleOff));
    let incremental = nc.has(Op::Incremental)
        || (!nc.has(Op::Absolute) && state.op(Group::Distance) == Some(Op::Incremental));
    axes && goes_on && incremental && state.op(Group::Cycle).is_some_and(Op::is_cycle)
}

/// An arc by its radius whose end may be its start.
fn arc(nc: &Nc, index: usize, span: Span, context: &mut Context<'_>) {
    let computed = |item: &NcItem| match item {
        NcItem::Word(role, value) => {
            (role.is_axis() || *role == Role::ArcRadius) && value.constant().is_none()
        }
        _ => false,
    };
    if nc.word(Role::ArcRadius).is_some() && nc.items.iter().any(computed) {
        let name = "machine:arc.radius.full.circle";
        let confirmed =
            |control: &crate::dialect::Control| control.profile().confirm.iter().any(|fact| fact == name);
        if !confirmed(context.source) || !confirmed(context.target) {
            let side = if confirmed(context.target) { Side::Source } else { Side::Target };
            let what = format!("no manual confirms '{name}': {}", matters::meaning(name).unwrap_or_default());
            context.unconfirmed(index, side, span, name, what);
        }
    }
}

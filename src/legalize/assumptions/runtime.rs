//! What a program rests on that hangs on values nobody knows before it runs.
//!
//! A divisor may be zero, the argument of a root negative, a subscript no whole number, the end of an arc its start; a
//! cycle's planes may be used in the other mode of coordinates than they were given in. The conversion takes both
//! controls to do the same then. Where no source says what one of them does, a person has to look.

use super::mistakes::{closed_arc, no_result};
use super::standing::{Spindle, Standing, goes_somewhere, turned_by_cycle};
use crate::canon::{Func, Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::analysis::{Assigned, Constant};
use crate::ir::{BinOp, BlockId, Expr, Module, Nc, NcItem, StmtKind, TermKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;
use std::cell::Cell;

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
    let starts =
        context.source.is(Question::CycleStartsSpindle) && !context.target.is(Question::CycleStartsSpindle);
    // Of a lathe's holes only taps are known to: the others may be those of a live tool, or of none that turns.
    let (starts, taps_start) = (starts && context.source.machine() == Machine::Mill, starts);
    // A rigid tap turns the spindle itself, whatever stood before it.
    // A code chooses which spindle taps, where some taps are a live tool's: the main one may not be it.
    let of_one_spindle = !context.features.any_op(Op::is_live_tap);
    let rigid = of_one_spindle && is_rigid(context.source, context.target);
    // Rigid taps by a code turn the spindle themselves too.
    let taps = context.features.op(Op::RigidTaps)
        && context.target.machine() == Machine::Mill
        && !context.target.is(Question::CycleStartsSpindle)
        || taps_start;
    let asks = |nc: &Nc, before: &Modal| {
        let tapping = is_tapping(nc, before);
        (starts || taps && tapping) && !(rigid && tapping)
    };
    let standing = Standing::of(context.source, context.target);
    let modal = cycles.then(|| ModalFacts::of(module, &Modal::unknown()));
    let stood = (cycles && (starts || taps)).then(|| OverCalls::of(module, &standing));
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter().enumerate() {
        let assigned = Assigned::new(program, &summaries);
        // What is said of a divisor is said once a program.
        let divides = Cell::new(false);
        let zero = |e: &Expr, place| {
            let may = !divides.get() && may_be_zero(e, &assigned, place);
            divides.set(divides.get() || may);
            may
        };
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = modal.as_ref().map(|modal| modal.at(index, id));
            let mut spindle =
                stood.as_ref().and_then(|stood| stood.at(index, id)).copied().unwrap_or_default();
            // A code for rigid taps stood, or a rigid tap is in force: the target's turns the spindle.
            let mut turning = false;
            for (at, stmt) in block.stmts.iter().enumerate() {
                let span = stmt.site.span;
                let zero = |e: &Expr| zero(e, (id, at));
                stmt.kind.exprs(&mut |e| e.walk(&mut |e| value(e, index, span, &zero, context)));
                if let Some(place) = stmt.kind.target() {
                    value(&place.read(), index, span, &zero, context);
                }
                let before = spindle;
                spindle = standing.after(&stmt.kind, spindle);
                if let StmtKind::Nc(nc) = &stmt.kind {
                    if let Some(state) = &state
                        && mixes(nc, state)
                    {
                        both(context, index, span, Question::CyclePlanesFrozen);
                    }
                    closed_arc(nc, index, span, context);
                    let ends = |op: Op| op == Op::CycleOff || op.is_cycle() && !op.is_tap();
                    turning = standing.turns(nc) || turning && !nc.ops().any(ends);
                    if turning {
                        if standing.turns(nc) && (before.stands || before.lost)
                            || state.as_ref().is_some_and(|s| taps_unseen(nc, s))
                        {
                            context.rests_on_target(index, span, Question::TapRigidTurns);
                        }
                    } else if let Some(state) = state.as_ref().filter(|state| asks(nc, state))
                        && turned_by_cycle(nc, spindle.stands && !spindle.otherwise, state)
                    {
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, STANDS));
                        spindle = Spindle { stands: false, otherwise: true, ..spindle };
                    } else if let Some(state) = state.as_ref().filter(|state| asks(nc, state))
                        && (taps_unseen(nc, state)
                            || turned_by_cycle(nc, spindle.stands || spindle.lost, state))
                    {
                        context.add_once(
                            index,
                            MAY_STAND,
                            Diagnostic::new(Code::Conditional, span, MAY_STAND),
                        );
                    }
                    if nc.word(Role::Repeat).is_some_and(|count| count.constant().is_none_or(|n| n < 1.0)) {
                        context.must_agree(index, span, Question::CycleL0Stores);
                        if goes_somewhere(nc, state.as_ref()) {
                            stored_place(context, index, span);
                        }
                    }
                }
                if let Some(state) = &mut state {
                    state.step(stmt);
                }
            }
            let span = block.term.site.span;
            let zero = |e: &Expr| zero(e, (id, block.stmts.len()));
            block.term.kind.exprs(&mut |e| e.walk(&mut |e| value(e, index, span, &zero, context)));
            if let TermKind::Call { call, .. } = &block.term.kind
                && call.count.is_some()
                && !call.arguments.is_empty()
            {
                context.must_agree(index, span, Question::CallRepeatReloadsArguments);
            }
        }
    }
}

/// False where a divisor is a number, or a variable that holds nothing but numbers which the program gives it.
fn may_be_zero(e: &Expr, assigned: &Assigned<'_>, (id, at): (BlockId, usize)) -> bool {
    let is_zero = |constant: &Constant| !matches!(constant, Constant::Number(number) if *number != 0.0);
    match e {
        Expr::Var(var) => {
            assigned.at(*var, id, at).is_none_or(|all| all.is_empty() || all.iter().any(is_zero))
        }
        e => e.constant().is_none(),
    }
}

fn both(context: &mut Context<'_>, program: usize, span: Span, question: Question) {
    context.rests_on_source(program, span, question);
    context.rests_on_target(program, span, question);
    context.must_agree(program, span, question);
}

fn value(e: &Expr, index: usize, span: Span, zero: &dyn Fn(&Expr) -> bool, context: &mut Context<'_>) {
    match e {
        Expr::Binary(BinOp::Div, operands) if zero(&operands[1]) => {
            no_result(context, index, span, Question::DivideByZero);
        }
        Expr::Call(Func::Sqrt, arguments) if !arguments.iter().all(never_negative) => {
            no_result(context, index, span, Question::SqrtOfNegative);
        }
        Expr::System(state, subscripts)
            if subscripts.iter().any(|e| e.constant().is_none())
                && !has_all(*state, subscripts.len(), context) =>
        {
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

/// True where the target has the state by each number that the source has it by.
fn has_all(state: Sys, subscripts: usize, context: &Context<'_>) -> bool {
    let has = |control: &Control, number: u32| control.system_address(state, &[number]).is_some();
    let mut ours = (1..NUMBERS).filter(|number| has(context.source, *number)).peekable();
    subscripts == 1 && ours.peek().is_some() && ours.all(|number| has(context.target, number))
}

/// No control has offsets of more numbers.
const NUMBERS: u32 = 1000;

const PLACE: &str = "of one of the two controls alone it is known whether it goes to a position beside a repeat count of 0: write the \
     position into a block of its own, after the end of the cycle, or say it of the other control in its machine profile, \
     as cycle.l0.moves";

/// A position beside a count of 0 must be gone to by both controls, or by neither.
fn stored_place(context: &mut Context<'_>, index: usize, span: Span) {
    both(context, index, span, Question::CycleL0Moves);
    let known = |control: &Control| {
        control.behaviour(Question::CycleL0Moves).is_some_and(|row| row.value != "unknown")
    };
    if known(context.source) != known(context.target) {
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, PLACE));
    }
}

const STANDS: &str = "the spindle stands here, and the source's cycle starts it by itself; the target's does not: write M3 or \
     M4 with the speed into a block before the cycle, and before the code for rigid taps where there is one";

const MAY_STAND: &str = "it is not known here that the spindle turns, and the source's cycle starts it by itself; the target's does not: \
     write M3 or M4 before it";

/// True for a target whose taps are rigid, by a code of their own that turns the spindle, or all of them as by that code. On a lathe the
/// code is written before each tap that is rigid on the source.
fn is_rigid(source: &Control, target: &Control) -> bool {
    let answer = |control: &Control| control.behaviour(Question::TapRigid).map(|row| row.value.clone());
    let has_code = target.code_for(Op::RigidTaps, &std::collections::BTreeMap::new()).is_some();
    has_code
        && match target.machine() {
            Machine::Mill => matches!(answer(target).as_deref(), Some("always" | "code")),
            Machine::Lathe => answer(source).as_deref() == Some("always"),
        }
}

/// True where a block begins a tap, or one is in force.
fn is_tapping(nc: &Nc, before: &Modal) -> bool {
    nc.ops().find(|op| op.is_cycle()).or(before.op(Group::Cycle)).is_some_and(Op::is_tap)
}

/// True where a block begins a tap, and nothing has said whether the spindle turns.
fn taps_unseen(nc: &Nc, before: &Modal) -> bool {
    let says = nc.ops().any(|op| op.group() == Group::Spindle);
    !says && before.op(Group::Spindle).is_none() && nc.ops().any(|op| op.is_tap() && !op.is_live_tap())
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

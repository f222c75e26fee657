//! What parameters of a machine decide: whether a code of the tool length moves its axis, and how a rotary axis goes.
//!
//! Nothing is changed. A question is asked where a program shows the difference, and a program is refused where the two
//! controls are known to differ. Side conditions: a length that is in force already, none that is ended, and one that a
//! return along Z ended move nothing; a word of Z that may be vacant must have a value, which is told; a feed of inverse time is
//! the same for all axes. Counter-example: `G43 H1`, `X5.`, which
//! crosses the part at another height where the code alone has moved Z.

use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question, Side};
use crate::ir::analysis::Vacancy;
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::modal::Ways;
use crate::ir::{Expr, Module, Nc};
use crate::legalize::features::Features;
use crate::legalize::moves::mains::facts_from_reset;
use crate::legalize::moves::rotary_places::{AXES, Places, RotaryPlaces, TURN, Way, degrees};
use crate::legalize::{Context, Modal, Setting};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// True if the library names tool lengths, or moves rotary axes, between two mills.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    are_mills(context)
        && (features.any_op(|op| op.group() == Group::LengthComp)
            || [Role::A, Role::B, Role::C, Role::LengthOffset, Role::RadiusOffset]
                .into_iter()
                .any(|role| features.role(role)))
}

/// True for two mills that are not one and the same.
pub(in crate::legalize) fn are_mills(context: &Context<'_>) -> bool {
    [context.source, context.target].iter().all(|control| control.machine() == Machine::Mill)
        && !context.source.is_same_machine(context.target)
}

/// True if the library names tool lengths, and their codes are known to move the axis on `mover` and not on `other`.
pub(in crate::legalize) fn moves_on_one(
    features: &Features,
    context: &Context<'_>,
    [mover, other]: [&Control; 2],
) -> bool {
    let moves = |control: &Control| control.is(Question::LengthMoves);
    are_mills(context)
        && moves(mover)
        && !moves(other)
        && other.behaviour(Question::LengthMoves).is_none_or(|row| row.value != "unknown")
        && (features.any_op(|op| op.group() == Group::LengthComp) || features.role(Role::LengthOffset))
}

/// Says what programs rest on.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = facts_from_reset(module, context);
    let mut copied = BTreeSet::new();
    facts.each(module, &mut |index, stmt, before, _| {
        let Some(nc) = stmt.kind.nc() else { return };
        if names_length(nc) && moves_by_code(nc, before) {
            rests(Question::LengthMoves, index, stmt.site.span, context);
        }
        if names_length(nc) && changes_length(nc, before) && nc.word(Role::Z).is_some() {
            copied.insert((index, stmt.site.span));
        }
        // On some controls what stands beside such a move gets a block of its own.
        let told = context.target.behaviour(Question::LengthMoves).is_some_and(|row| row.value != "unknown");
        if told && nc.has(Op::MachineOnce) && nc.ops().any(|op| op.group() == Group::LengthComp) {
            context.rests_on_target(index, stmt.site.span, Question::LengthMoves);
        }
        if nc.word(Role::RadiusOffset).is_some() && context.target.is(Question::RadiusByLengthWord) {
            let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, RADIUS_BY_H);
            context.add_once(index, RADIUS_BY_H, finding.with_help(RADIUS_BY_D));
        }
    });
    lone_where_vacant(module, &copied, context);
    let turns = |nc: &Nc| AXES.iter().any(|role| nc.word(*role).is_some());
    let mut all = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    if !all.any(|stmt| stmt.kind.nc().is_some_and(turns)) {
        return;
    }
    let (source, way) = (context.source, Way::of(context.source));
    let places = RotaryPlaces::of(module, &facts, source, &context.origins);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let (mut state, mut here): (Modal, Places) = (facts.at(index, id), places.at(index, id));
            for stmt in &block.stmts {
                let (before, from) = (state.clone(), here.clone());
                state.step(stmt);
                here.step(stmt, (&before, &state), way, source);
                if let Some(nc) = stmt.kind.nc() {
                    rotary(nc, &state, &from, (index, stmt.site.span), context);
                }
            }
        }
    }
}

/// Says what blocks rest on whose word of Z may be vacant: those among `placed` change the length and have one.
fn lone_where_vacant(module: &Module, placed: &BTreeSet<(usize, Span)>, context: &mut Context<'_>) {
    let question = Question::LengthMoves;
    let open = |control: &Control| control.behaviour(question).is_some_and(|row| row.value == "unknown");
    let [of_source, of_target] = [context.source, context.target].map(open);
    let known = !of_source && !of_target;
    if placed.is_empty() || known && context.source.is(question) == context.target.is(question) {
        return;
    }
    let (given, none) = (CalledPrograms::of(module).given(module), BTreeSet::new());
    let summaries = context.summaries(module);
    let mut found: BTreeMap<(usize, String), Vec<Span>> = BTreeMap::new();
    for index in placed.iter().map(|(index, _)| *index).collect::<BTreeSet<_>>() {
        let Some(program) = module.programs.get(index) else { continue };
        let vacancy = Vacancy::of(program, &summaries, given.get(&index).unwrap_or(&none));
        for (id, at) in vacancy.absent(&|nc, role| role == Role::Z && names_length(nc)) {
            let stmt = program.block(id).and_then(|block| block.stmts.get(at));
            let Some(stmt) = stmt.filter(|stmt| placed.contains(&(index, stmt.site.span))) else { continue };
            let word = stmt.kind.nc().and_then(|nc| nc.word(Role::Z));
            let what = word.map(|word| spoken(word, context.source)).unwrap_or_default();
            let places = found.entry((index, what)).or_default();
            if !places.contains(&stmt.site.span) {
                places.push(stmt.site.span);
            }
        }
    }
    for ((index, word), places) in found {
        let Some(first) = places.first().copied() else { continue };
        if of_source {
            context.rests_on_source(index, first, question);
        }
        if of_target {
            context.rests_on_target(index, first, question);
        }
        if !known {
            continue;
        }
        let what = format!(
            "Z of this block is {word}: where that is vacant, one of the two controls moves Z by the tool length, and the other does not"
        );
        let told = Diagnostic::new(Code::Conditional, first, what.clone()).with_help(HAS_VALUE);
        context.add_once(index, &what, told.assuming(Predicate::LengthAxis(places)));
    }
}

/// A word as a person says it.
fn spoken(word: &Expr, source: &Control) -> String {
    let name = source.numbered().unwrap_or_default();
    match word {
        Expr::Var(var) => format!("{name}{}", var.number),
        Expr::Negate(inner) => spoken(inner, source),
        _ => "a variable whose number is computed".into(),
    }
}

const HAS_VALUE: &str = "make sure that it has a value in each run";

const RADIUS_BY_H: &str = "the number of a cutter radius is written with D, and the target takes it from H";

const RADIUS_BY_D: &str = "set parameter 5001.2 of the target to 0, and say so in its profile";

/// True where a block has something to say of the tool length.
pub(in crate::legalize) fn names_length(nc: &Nc) -> bool {
    nc.word(Role::LengthOffset).is_some() || nc.ops().any(|op| op.group() == Group::LengthComp)
}

/// True where a block changes the tool length and has no word of Z.
pub(in crate::legalize) fn moves_by_code(nc: &Nc, before: &Modal) -> bool {
    nc.word(Role::Z).is_none() && changes_length(nc, before)
}

/// True where a block may bring another tool length into force.
fn changes_length(nc: &Nc, before: &Modal) -> bool {
    let lost = before.length_lost;
    let gone = lost.is_home || lost.by_reference == Ways::Every || lost.by_machine_move == Ways::Every;
    let row = nc.word(Role::LengthOffset).map(|row| row.constant().map(|row| row as u32));
    let begins = nc.has(Op::LengthPlus) || nc.has(Op::LengthMinus);
    let in_force = before.of(Group::LengthComp);
    let is_off = matches!(in_force, Setting::Known(Op::LengthOff, _));
    let may_be = !is_off && lost.is_held && !gone;
    match row {
        _ if nc.has(Op::LengthOff) => may_be,
        Some(Some(0)) => may_be,
        // The same row again.
        Some(Some(row)) => match in_force {
            Setting::Known(op, Some(there)) if there == row && !gone => begins && !nc.has(op),
            _ => begins || !is_off,
        },
        Some(None) => begins || !is_off,
        None => begins && (gone || !matches!(in_force, Setting::Known(op, _) if nc.has(op))),
    }
}

/// What a word of a rotary axis rests on.
fn rotary(nc: &Nc, after: &Modal, from: &Places, (index, span): (usize, Span), context: &mut Context<'_>) {
    let aside = nc.ops().any(|op| op.takes_axes() || op == Op::ReferenceReturn || op == Op::Reference2);
    if aside || AXES.iter().all(|role| nc.word(*role).is_none()) {
        return;
    }
    if after.op(Group::Distance) != Some(Op::Incremental) && !goes_alike(nc, from, context) {
        let by_sign = [context.source, context.target].map(|control| Way::of(control) == Way::Sign);
        match by_sign {
            // The angles are written as the other control turns.
            [true, false] => context.rests_on_target(index, span, Question::RotaryWay),
            [false, true] => context.rests_on_source(index, span, Question::RotaryWay),
            _ if Way::differ(context.source, context.target) => {}
            _ => rests(Question::RotaryWay, index, span, context),
        }
        open_way(index, span, context);
    }
    let feeds = after.op(Group::Motion).is_some_and(|op| op != Op::Rapid) && !nc.has(Op::RapidOnce);
    let drills = after.op(Group::Cycle).is_some_and(Op::is_cycle);
    if feeds && !drills && after.op(Group::FeedMode) != Some(Op::FeedInverse) {
        feed_of_rotary(index, span, context);
    }
}

/// True where the axes go the same way to the angles of a block on every control that they may stand for. Between angles
/// that are less than half a turn apart an axis with turns and one that takes the shorter way do; one that goes by the sign
/// does too where the angle is no smaller than the one before it.
fn goes_alike(nc: &Nc, from: &Places, context: &Context<'_>) -> bool {
    let open =
        |control: &Control| control.behaviour(Question::RotaryWay).is_some_and(|row| row.value == "unknown");
    let way = Way::of(context.source);
    let any = way == Way::Sign || open(context.source) || open(context.target);
    AXES.into_iter().enumerate().filter_map(|(axis, role)| Some((axis, nc.word(role)?))).all(
        |(axis, word)| {
            let Some(angle) = degrees(word, context.source) else { return false };
            let within_half = |parts: i64| parts >= 0 && 2 * parts < TURN;
            let stands = from.of(axis);
            match stands.turns(way, angle).filter(|_| !stands.loose) {
                _ if !any => (0.0..180.0).contains(&angle),
                Some(turns) => turns.iter().all(|(from, by)| *by >= 0 && within_half(from + by)),
                None => false,
            }
        },
    )
}

/// A way that is not known of a control may be another one than that of the other: the answer decides whether the
/// program is the same.
fn open_way(index: usize, span: Span, context: &mut Context<'_>) {
    let question = Question::RotaryWay;
    let open = |control: &Control| control.behaviour(question).is_some_and(|row| row.value == "unknown");
    let side = match (open(context.source), open(context.target)) {
        (true, _) => Side::Source,
        (_, true) => Side::Target,
        _ => return,
    };
    let control = if side == Side::Source { context.source } else { context.target };
    let finding =
        Diagnostic::new(Code::Conditional, span, WAY).with_help(control.to_settle(question.fact(), side));
    context.add_once(index, WAY, finding);
}

const WAY: &str = "a rotary axis goes to an angle that is not within half a turn, and the way that it goes there is not known of \
     one of the two controls: it may turn the other way round";

/// What the feed of a rotary axis rests on.
fn feed_of_rotary(index: usize, span: Span, context: &mut Context<'_>) {
    let row = |control: &Control| control.behaviour(Question::RotaryFeed).cloned();
    let known =
        [row(context.source), row(context.target)].map(|row| row.filter(|row| row.value != "unknown"));
    if let [Some(ours), Some(theirs)] = &known
        && ours.value != theirs.value
    {
        let (surface, control) = match ours.value == "surface" {
            true => (ours, context.source),
            false => (theirs, context.target),
        };
        let note = surface.origin.note.as_deref().map_or(String::new(), |note| format!(" ({note})"));
        let finding = Diagnostic::new(Code::NoEquivalent, span, FEEDS);
        let help = format!(
            "write the feed in inverse time, with G93; or, if the {} counts degrees as well, write rotary.feed = \"degrees\" under \
             [behaviours] in its profile{note}",
            control.dialect().title
        );
        return context.add_once(index, FEEDS, finding.with_help(help));
    }
    rests(Question::RotaryFeed, index, span, context);
}

const FEEDS: &str = "the feed per minute of this rotary axis is degrees on one of the two controls, and on the other the way of the \
     surface by a diameter that the machine is set to";

/// Asks a question, first of the control whose table has no answer; refuses where the answers are known to differ. A control
/// whose table is silent is like most others.
pub(in crate::legalize) fn rests(question: Question, index: usize, span: Span, context: &mut Context<'_>) {
    let open = |control: &Control| control.behaviour(question).is_some_and(|row| row.value == "unknown");
    let [ours, theirs] =
        [context.source, context.target].map(|control| control.behaviour(question).is_some());
    let any_open = open(context.source) || open(context.target);
    let sides = [(Side::Source, ours, open(context.source)), (Side::Target, theirs, open(context.target))];
    for (side, has_row, is_open) in sides {
        match side {
            _ if !has_row || any_open && !is_open => {}
            Side::Source => context.rests_on_source(index, span, question),
            Side::Target => context.rests_on_target(index, span, question),
        }
    }
    let moves = |control: &Control| control.is(question);
    if question == Question::LengthMoves && ours != theirs && moves(context.source) != moves(context.target) {
        let finding = Diagnostic::new(Code::NoEquivalent, span, MOVES);
        return context.add_once(index, MOVES, finding.with_help(NAME_Z));
    }
    context.must_agree(index, span, question);
}

const MOVES: &str = "a code of the tool length without Z: one of the two controls moves Z by the length here";

const NAME_Z: &str = "write Z into the block of the code";

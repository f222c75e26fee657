//! The tool length after a return to the reference position, a move in machine coordinates or a tool change.
//!
//! Laws: a length that the source cancelled there is ended by the next block that places something along its axis; one
//! that the source kept is named again in that block. Both say outright what is in force, so that the target's own
//! answer does not count. Side condition of the second: the number of the length is known from the text. Where the
//! program names the length again before it counts, as after a tool change, nothing is asked.
//! Side condition of both: the block surely moves along that axis. A code of the length alone may move it on some
//! controls, so where the words may be vacant, or the repeat of a cycle none, the difference is told.
//! Counter-example: `G49 Z#4` with `#4` vacant, which the source makes nothing of.

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::modal::Ways;
use crate::ir::analysis::{Summaries, Vacancy};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind};
use crate::legalize::calls::standing::tied_to;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal, Setting};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

const RETURN: Question = Question::ReferenceLength;
const MOVE: Question = Question::MachineMoveLength;
const CHANGE: Question = Question::ChangeLength;
const Z: f64 = 3.0;

/// A question that the length in force hangs on, and the ways here that ask it.
struct Asked {
    question: Question,
    /// What it hangs on there on the target, where a return may be written as a move in machine coordinates.
    there: &'static [Question],
    /// The axis of the length moved.
    along: bool,
    ways: Ways,
}

impl Asked {
    /// Whether the source cancels the length there; none if no source says.
    fn cancels_here(&self, source: &Control) -> Option<bool> {
        self.answer(self.question, source)
    }

    /// Whether the target does; none if no source says, or it hangs on what is written.
    fn cancels_there(&self, target: &Control) -> Option<bool> {
        let mut answers = self.there.iter().map(|question| self.answer(*question, target));
        let first = answers.next()?;
        first.filter(|_| answers.all(|other| other == first))
    }

    fn answer(&self, question: Question, control: &Control) -> Option<bool> {
        match control.behaviour(question)?.value.as_str() {
            "kept" => Some(false),
            "cancelled" => Some(true),
            "cancelled.along" => Some(self.along),
            _ => None,
        }
    }

    fn is_sure(&self, target: &Control) -> bool {
        let is_settled =
            |question: &Question| target.behaviour(*question).is_some_and(|row| row.origin.is_settled());
        self.there.iter().all(is_settled)
    }
}

/// By program, what the length hangs on after a return on the target: one to the second reference position, of the program or of one
/// that runs with it, becomes a move in machine coordinates where the target has no code for it.
fn after_returns(module: &Module, context: &mut Context<'_>) -> Vec<&'static [Question]> {
    let features = Features::of(&module.programs);
    let moves =
        features.op(Op::Reference2) && context.target.code_for(Op::Reference2, &BTreeMap::new()).is_none();
    if !moves {
        return vec![&[RETURN]; module.programs.len()];
    }
    let returns = |program: &Program| Features::of_program(program).op(Op::Reference2);
    let seconds = module.programs.iter().enumerate().filter(|(_, program)| returns(program));
    let moved = tied_to(seconds.map(|(index, _)| index), &context.called(module).pairs(module));
    let both: &[Question] = if features.op(Op::ReferenceReturn) { &[RETURN, MOVE] } else { &[MOVE] };
    (0..module.programs.len()).map(|index| if moved.contains(&index) { both } else { &[RETURN] }).collect()
}

/// Says which length is in force where a return, a move in machine coordinates or a tool change may have cancelled it.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let alike = |question| context.source.behaviour(question) == context.target.behaviour(question);
    if context.source.name() == context.target.name() && [RETURN, MOVE, CHANGE].into_iter().all(alike) {
        return;
    }
    let facts = context.modal_facts(module);
    let absent = absent(module);
    let features = Features::of(&module.programs);
    let drills = features.any_op(Op::is_cycle);
    let after = after_returns(module, context);
    for ((index, program), returns) in module.programs.iter_mut().enumerate().zip(after) {
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let mut state = facts.at(index, id);
            for (at, stmt) in block.stmts.iter_mut().enumerate() {
                if is_lost(&state) {
                    let absent = absent.get(&(index, id, at)).map_or(&[][..], Vec::as_slice);
                    settle(stmt, &Place { state: &state, absent, drills, returns }, index, context);
                }
                state.step(stmt);
            }
            let mut reads = false;
            block.term.kind.exprs(&mut |e| reads |= reads_depth(e));
            if reads && is_lost(&state) {
                told(&questions(&state, returns), index, block.term.site.span, context);
            }
        }
    }
}

/// By program, block and statement: the axes and planes whose words may not be there, for what they hold may be vacant.
fn absent(module: &Module) -> BTreeMap<(usize, BlockId, usize), Vec<Role>> {
    let places = |role: Role| role.is_axis() || role == Role::CycleR;
    let unsigned = |value: &Expr| match value {
        Expr::Negate(inner) => Expr::clone(inner),
        value => value.clone(),
    };
    let words = |nc: &Nc| {
        let words = nc.items.iter().filter_map(|item| match item {
            NcItem::Word(role, value) if places(*role) => Some((*role, unsigned(value))),
            _ => None,
        });
        words.filter(|(_, value)| value.may_be_vacant()).collect::<Vec<_>>()
    };
    let unsure = |program: &Program| {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        stmts.any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if !words(nc).is_empty()))
    };
    let mut found = BTreeMap::new();
    if !module.programs.iter().any(unsure) {
        return found;
    }
    let (summaries, given) = (Summaries::of(module), CalledPrograms::of(module).given(module));
    let none = BTreeSet::new();
    for (index, program) in module.programs.iter().enumerate().filter(|(_, program)| unsure(program)) {
        let vacancy = Vacancy::of(program, &summaries, given.get(&index).unwrap_or(&none));
        for (id, block) in program.ids().zip(&program.blocks) {
            vacancy.forward(id, &mut |at, may| {
                let Some(StmtKind::Nc(nc)) = block.stmts.get(at).map(|stmt| &stmt.kind) else { return };
                let vacant = words(nc).into_iter().filter(|(_, value)| may(value));
                let roles: Vec<Role> = vacant.map(|(role, _)| role).collect();
                if !roles.is_empty() {
                    found.insert((index, id, at), roles);
                }
            });
        }
    }
    found
}

/// Where a statement stands.
struct Place<'p> {
    state: &'p Modal,
    /// The words that may not be there.
    absent: &'p [Role],
    /// True if some program of the library drills by cycles.
    drills: bool,
    /// What the length hangs on after a return on the target.
    returns: &'static [Question],
}

/// True where something may have cancelled the length.
fn is_lost(state: &Modal) -> bool {
    !questions(state, &[RETURN]).is_empty()
}

/// The questions that the length in force hangs on.
fn questions(state: &Modal, returns: &'static [Question]) -> Vec<Asked> {
    let lost = state.length_lost;
    let asked = |question, there: &'static [Question], along, ways| Asked { question, there, along, ways };
    let all = [
        asked(RETURN, returns, true, lost.by_reference),
        asked(RETURN, returns, false, lost.by_other_axes),
        asked(MOVE, &[MOVE], true, lost.by_machine_move),
        asked(CHANGE, &[CHANGE], true, lost.by_change),
    ];
    all.into_iter().filter(|asked| asked.ways != Ways::None).collect()
}

/// A statement that may be the first to count with the length.
fn settle(stmt: &mut Stmt, place: &Place<'_>, index: usize, context: &mut Context<'_>) {
    let (state, span) = (place.state, stmt.site.span);
    let mut reads = false;
    stmt.kind.exprs(&mut |e| reads |= reads_depth(e));
    let questions = questions(state, place.returns);
    if reads {
        return told(&questions, index, span, context);
    }
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    match places(nc, place) {
        Ways::None => return,
        Ways::Some => return told(&questions, index, span, context),
        Ways::Every => {}
    }
    rests(&questions, Side::Source, index, span, context);
    let (source, target) = (context.source, context.target);
    let same = |asked: &Asked| {
        let ours = asked.cancels_here(source);
        ours.is_some() && ours == asked.cancels_there(target) && asked.is_sure(target)
    };
    if questions.iter().all(same) {
        // A common fact has its note.
        rests(&questions, Side::Target, index, span, context);
        return;
    }
    // Where no source says, emulated controls keep it.
    let cancels = |asked: &&Asked| asked.cancels_here(source) == Some(true);
    let named = match state.of(Group::LengthComp) {
        Setting::Known(op @ (Op::LengthPlus | Op::LengthMinus), Some(row)) => Some((op, row)),
        _ => None,
    };
    let gone = questions
        .iter()
        .filter(cancels)
        .map(|asked| asked.ways)
        .reduce(|a, b| if a == Ways::Every { a } else { b });
    match (gone, named) {
        (Some(Ways::Every), _) => nc.items.insert(0, NcItem::Op(Op::LengthOff)),
        (None, Some((op, row))) => {
            nc.items.insert(0, NcItem::Op(op));
            nc.items.push(NcItem::Word(Role::LengthOffset, Expr::Number(f64::from(row))));
        }
        _ => told(&questions, index, span, context),
    }
}

/// On which ways a block places something along the axis of the length, in coordinates of the program, by the length in
/// force before it: with what its words hold, and the cycle that may be in force.
fn places(nc: &Nc, place: &Place<'_>) -> Ways {
    let aside = |op: Op| {
        matches!(op, Op::MachineOnce | Op::WriteWork | Op::LocalShift | Op::Dwell)
            || op.group() == Group::LengthComp
    };
    let repeats = nc.word(Role::Repeat).map(Expr::constant);
    // Words that are kept for later place nothing yet.
    if nc.word(Role::LengthOffset).is_some() || nc.ops().any(aside) || repeats == Some(Some(0.0)) {
        return Ways::None;
    }
    let mut words = place.state.clone();
    words.step_words(nc);
    let depth = |role: Role| role == Role::Z && words.op(Group::Distance) != Some(Op::Incremental);
    let cycle = words.op(Group::Cycle);
    // A hole is placed by the words of any axis, but none by a block that goes to the reference position, or that says how it
    // moves and names no cycle.
    let goes = |op: Op| matches!(op, Op::ReferenceReturn | Op::Reference2) || op.group() == Group::Motion;
    let moves = nc.ops().any(goes) && !nc.ops().any(Op::is_cycle);
    let hole = |role: Role| !moves && role.is_axis() && cycle.map_or(place.drills, Op::is_cycle);
    let roles = nc.items.iter().filter_map(|item| match item {
        NcItem::Word(role, _) => Some(*role),
        _ => None,
    });
    let mut ways = Ways::None;
    for role in roles.filter(|role| *role == Role::CycleR || depth(*role) || hole(*role)) {
        // In increments a hole counts from where the tool stands, but for planes that were given before.
        let counts = words.op(Group::Distance) != Some(Op::Incremental);
        let known = depth(role) || counts && (role == Role::CycleR || cycle.is_some());
        let sure = known && !place.absent.contains(&role) && repeats.is_none_or(|count| count.is_some());
        ways = if sure {
            Ways::Every
        } else if ways == Ways::None {
            Ways::Some
        } else {
            ways
        };
    }
    ways
}

/// True where an expression reads a position of the program along the axis of the length.
fn reads_depth(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        if let Expr::System(state, axis) = e {
            use Sys::{AxisPosition, EndPosition, SkipPosition, WorkPosition};
            let position = matches!(state, AxisPosition | EndPosition | SkipPosition | WorkPosition);
            found |= position && axis.first().and_then(Expr::constant).is_none_or(|axis| axis == Z);
        }
    });
    found
}

/// Tells what the length in force rests on, where nothing can be put in.
fn told(questions: &[Asked], index: usize, span: Span, context: &mut Context<'_>) {
    rests(questions, Side::Source, index, span, context);
    rests(questions, Side::Target, index, span, context);
    // Where no source says, emulated controls keep it.
    let here = |asked: &Asked| asked.cancels_here(context.source).unwrap_or(false);
    let differs = |asked: &Asked| {
        let mut answers = asked.there.iter().map(|question| asked.answer(*question, context.target));
        answers.any(|answer| answer.unwrap_or(false) != here(asked))
    };
    if questions.iter().any(differs) {
        let changed = questions.iter().any(|asked| asked.question == CHANGE);
        let what = match changed {
            true => {
                "the tool length matters here: the tool change before it cancels the length on one control and \
                     not on the other"
            }
            false => {
                "the tool length matters here: the return to the reference position or the move in machine \
                      coordinates before it cancels the length on one control and not on the other"
            }
        };
        let help = "after it, name the length again (G43 with H) or end it (G49)";
        context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
    }
}

fn rests(questions: &[Asked], side: Side, index: usize, span: Span, context: &mut Context<'_>) {
    for asked in questions {
        match side {
            Side::Source => context.rests_on_source(index, span, asked.question),
            Side::Target => {
                asked.there.iter().for_each(|question| context.rests_on_target(index, span, *question));
            }
        }
    }
}

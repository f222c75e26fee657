//! The tool length after a return to the reference position or a move in machine coordinates.
//!
//! Laws: a length that the source cancelled there is ended by the next block that places something along its axis; one
//! that the source kept is named again in that block. Both say outright what is in force, so that the target's own
//! answer does not count. Side condition of the second: the number of the length is known from the text. Where the
//! program names the length again before it counts, as after a tool change, nothing is asked.

use super::modal::Ways;
use super::{Context, Modal, ModalFacts, Setting};
use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Side};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, Stmt, StmtKind};
use crate::text::Span;

const RETURN: &str = "reference.length";
const MOVE: &str = "machine.move.length";
const Z: f64 = 3.0;

/// A question that the length in force hangs on, and the ways here that ask it.
struct Question {
    name: &'static str,
    /// The axis of the length moved.
    along: bool,
    ways: Ways,
}

impl Question {
    /// Whether a control cancels the length there; none where no source says.
    fn cancels(&self, control: &Control) -> Option<bool> {
        match control.behaviour(self.name)?.value.as_str() {
            "kept" => Some(false),
            "cancelled" => Some(true),
            "cancelled.along" => Some(self.along),
            _ => None,
        }
    }

    fn is_sure(&self, control: &Control) -> bool {
        control.behaviour(self.name).is_some_and(|row| row.origin.confirmed)
    }
}

/// Says which length is in force where a return or a move in machine coordinates may have cancelled it.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let alike = |name| context.source.behaviour(name) == context.target.behaviour(name);
    if context.source.name() == context.target.name() && alike(RETURN) && alike(MOVE) {
        return;
    }
    let facts = ModalFacts::of(module, &context.entry);
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                if !questions(&state).is_empty() {
                    settle(stmt, &state, index, context);
                }
                state.step(stmt);
            }
            let mut reads = false;
            block.term.kind.exprs(&mut |e| reads |= reads_depth(e));
            if reads && !questions(&state).is_empty() {
                told(&state, index, block.term.site.span, context);
            }
        }
    }
}

/// The questions that the length in force hangs on.
fn questions(state: &Modal) -> Vec<Question> {
    let lost = state.length_lost;
    let all = [
        (RETURN, true, lost.by_reference),
        (RETURN, false, lost.by_other_axes),
        (MOVE, true, lost.by_machine_move),
    ];
    let all = all.into_iter().map(|(name, along, ways)| Question { name, along, ways });
    all.filter(|question| question.ways != Ways::None).collect()
}

/// A statement that may be the first to count with the length.
fn settle(stmt: &mut Stmt, state: &Modal, index: usize, context: &mut Context<'_>) {
    let span = stmt.site.span;
    let mut reads = false;
    stmt.kind.exprs(&mut |e| reads |= reads_depth(e));
    if reads {
        return told(state, index, span, context);
    }
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    if !places(nc, state) {
        return;
    }
    let questions = questions(state);
    rests(&questions, Side::Source, index, span, context);
    let (source, target) = (context.source, context.target);
    let same = |question: &Question| {
        let ours = question.cancels(source);
        ours.is_some() && ours == question.cancels(target) && question.is_sure(target)
    };
    if questions.iter().all(same) {
        return;
    }
    // Where no source says, emulated controls keep it.
    let cancels = |question: &&Question| question.cancels(source) == Some(true);
    let named = match state.of(Group::LengthComp) {
        Setting::Known(op @ (Op::LengthPlus | Op::LengthMinus), Some(row)) => Some((op, row)),
        _ => None,
    };
    let gone = questions
        .iter()
        .filter(cancels)
        .map(|question| question.ways)
        .reduce(|a, b| if a == Ways::Every { a } else { b });
    match (gone, named) {
        (Some(Ways::Every), _) => nc.items.insert(0, NcItem::Op(Op::LengthOff)),
        (None, Some((op, row))) => {
            nc.items.insert(0, NcItem::Op(op));
            nc.items.push(NcItem::Word(Role::LengthOffset, Expr::Number(f64::from(row))));
        }
        _ => told(state, index, span, context),
    }
}

/// True where a block places something along the axis of the length, in coordinates of the program, by the length in
/// force before it.
fn places(nc: &Nc, state: &Modal) -> bool {
    let aside = |op: Op| {
        matches!(op, Op::MachineOnce | Op::WriteWork | Op::LocalShift | Op::Dwell)
            || op.group() == Group::LengthComp
    };
    let distance = nc.ops().filter(|op| op.group() == Group::Distance).last();
    let incremental = distance.or(state.op(Group::Distance)) == Some(Op::Incremental);
    let depth = nc.word(Role::Z).is_some() && !incremental;
    (depth || nc.word(Role::CycleR).is_some())
        && nc.word(Role::LengthOffset).is_none()
        && !nc.ops().any(aside)
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
fn told(state: &Modal, index: usize, span: Span, context: &mut Context<'_>) {
    let questions = questions(state);
    rests(&questions, Side::Source, index, span, context);
    rests(&questions, Side::Target, index, span, context);
    let cancels = |question: &Question, control: &Control| question.cancels(control).unwrap_or(false);
    if questions.iter().any(|question| cancels(question, context.source) != cancels(question, context.target))
    {
        let what = "the tool length counts here after a return to the reference position or a move in machine coordinates, which cancels it on one of the controls and not on the other";
        let help = "name the length again after it (G43 with H), or end it (G49)";
        context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
    }
}

fn rests(questions: &[Question], side: Side, index: usize, span: Span, context: &mut Context<'_>) {
    for question in questions {
        match side {
            Side::Source => context.rests_on_source(index, span, question.name),
            Side::Target => context.rests_on_target(index, span, question.name),
        }
    }
}

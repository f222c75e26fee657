//! Tool changes that take Z to the tool change position by themselves.
//!
//! A program rests on it where it goes on after a tool change before it has placed Z, and did not take Z to its zero before
//! the change: by G28 or by G53 Z0. Any other place of the machine, and a second reference position, is none. Side conditions: a move of Z alone in absolute coordinates places it; what is not known is taken to rest on it.
//! Counter-example: `G1 Z-10.`, `T2 M6`, `G0 X50.`, which crosses the part where the change leaves Z alone.

use super::shop::{are_mills, rests};
use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Expr, Module, Nc, Stmt};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;

/// True if the library changes tools, between two mills whose tables both say something of it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let says = |control: &Control| control.behaviour(Question::ChangeRetracts).is_some();
    are_mills(context) && features.op(Op::ToolChange) && says(context.source) && says(context.target)
}

/// Says where programs rest on it.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let heights = Heights { facts: &facts };
    let known = OverCalls::of(module, &heights);
    let is_alarm = |control: &Control| {
        control.behaviour(Question::ChangeRetracts).is_some_and(|row| row.value == "alarm")
    };
    let alarms = is_alarm(context.target) && !is_alarm(context.source);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let Some(height) = known.at(index, id) else { continue };
            let (mut height, mut state) = (*height, facts.at(index, id));
            for stmt in &block.stmts {
                if alarms && !height.home && stmt.kind.has_op(Op::ToolChange) {
                    context.add_once(
                        index,
                        ALARM,
                        Diagnostic::new(Code::NoEquivalent, stmt.site.span, ALARM),
                    );
                }
                if let Some(rest) = step(stmt, &mut state, &mut height) {
                    told(rest, (index, stmt.site.span), context);
                }
            }
            let mut reads = false;
            block.term.kind.exprs(&mut |e| reads |= reads_height(e));
            if reads && height.changed {
                told(Rest::Height, (index, block.term.site.span), context);
            }
        }
    }
}

/// How a statement rests on where a tool change left Z.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rest {
    /// It goes on at rapid from there, to a place that it names or across.
    Across,
    /// It cuts or drills at that height, moves Z by increments, or reads it.
    Height,
}

const HIGHER: &str = "the tool change of the target takes Z to its position first, and the source leaves it where it is: the tool goes on from \
     higher up than on the old machine";

const ALARM: &str = "the tool change of the target stops with an alarm if Z is not at its position: write G91 G28 Z0 and G90 before it";

/// Says what a statement rests on. A source that stops if Z is not at the position has it there in every program that runs.
fn told(rest: Rest, (index, span): (usize, Span), context: &mut Context<'_>) {
    let question = Question::ChangeRetracts;
    let answer = |control: &Control| {
        control.behaviour(question).map_or("unknown", |row| row.value.as_str()).to_owned()
    };
    match (answer(context.source).as_str(), answer(context.target).as_str()) {
        ("alarm", _) => context.rests_on_source(index, span, question),
        (_, "alarm") => {}
        ("false", "true") if rest == Rest::Across => {
            context.add_once(index, HIGHER, Diagnostic::new(Code::Conditional, span, HIGHER).asked_once());
        }
        _ => rests(question, index, span, context),
    }
}

/// What is known of the height of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Height {
    /// On some way a tool change may have moved Z, and nothing has placed it since.
    changed: bool,
    /// On every way the program took Z to its zero, and has not moved it since.
    home: bool,
}

impl Lattice for Height {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self { changed: self.changed || other.changed, home: self.home && other.home };
        std::mem::replace(self, joined) != joined
    }
}

struct Heights<'f> {
    facts: &'f ModalFacts,
}

impl Follow for Heights<'_> {
    type Known = Height;

    fn outside(&self, _: usize) -> Height {
        Height { changed: false, home: false }
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, height: &mut Height) {
        let mut state = self.facts.at(index, id);
        for stmt in &block.stmts {
            step(stmt, &mut state, height);
        }
    }

    fn lose(&self, height: &mut Height) {
        height.home = false;
    }
}

/// Takes a statement; how it rests on where a tool change left Z.
fn step(stmt: &Stmt, state: &mut Modal, height: &mut Height) -> Option<Rest> {
    state.step(stmt);
    let before = *height;
    let mut reads = false;
    stmt.kind.exprs(&mut |e| reads |= reads_height(e));
    let Some(nc) = stmt.kind.nc() else { return (reads && before.changed).then_some(Rest::Height) };
    let rests = moved(nc, state, height);
    if nc.has(Op::ToolChange) {
        height.changed = !height.home;
    }
    if stmt.site.skip.is_some() {
        height.join(&before);
    }
    let steps = nc.word(Role::Z).is_some() && state.op(Group::Distance) != Some(Op::Absolute);
    let drills = state.op(Group::Cycle).is_some_and(Op::is_cycle);
    let rapid = state.op(Group::Motion) == Some(Op::Rapid) && !drills;
    let rest = if reads || steps || !rapid { Rest::Height } else { Rest::Across };
    (before.changed && (reads || rests)).then_some(rest)
}

/// Takes the moves of a block; true where they depend on the height from before.
fn moved(nc: &Nc, state: &Modal, height: &mut Height) -> bool {
    let (z, names) = (nc.word(Role::Z).is_some(), nc.names_axis());
    let returns = nc.ops().any(|op| matches!(op, Op::ReferenceReturn | Op::Home));
    let goes = returns || nc.has(Op::Reference2);
    if goes && (z || !names) || nc.has(Op::MachineOnce) && z {
        *height = Height { changed: false, home: returns || nc.word(Role::Z).is_some_and(is_zero) && !goes };
        return false;
    }
    if nc.has(Op::SetPosition) {
        return z;
    }
    if !names || nc.ops().any(Op::takes_axes) {
        return false;
    }
    let others = nc
        .items
        .iter()
        .any(|item| matches!(item, crate::ir::NcItem::Word(role, _) if role.is_axis() && *role != Role::Z));
    let places = z && state.op(Group::Distance) == Some(Op::Absolute);
    *height = Height { changed: height.changed && !places, home: height.home && !z };
    !places || others
}

fn is_zero(value: &Expr) -> bool {
    matches!(value, Expr::Increments(0.0)) || value.constant() == Some(0.0)
}

/// True where an expression reads a place along Z.
fn reads_height(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        if let Expr::System(
            Sys::AxisPosition | Sys::EndPosition | Sys::WorkPosition | Sys::MachinePosition,
            axis,
        ) = e
        {
            found |= axis.first().and_then(Expr::constant).is_none_or(|axis| axis == 3.0);
        }
    });
    found
}

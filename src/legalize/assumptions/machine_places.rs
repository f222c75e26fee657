//! Places in machine coordinates, which are places of the old machine.
//!
//! A move in machine coordinates, and a work offset that a program writes as numbers, name places that hang on
//! where the machine has its zero, how far it goes, and what stands on its table. The words are the same on the target, and the
//! place is not. It is asked once of the target, whose profile may say where one lies. Side conditions: zero of an axis is the reference position, where both controls are
//! of one family; of Z it is so on all. What is read from the machine (a position, an offset that was saved) is the target's own, and
//! what a program compares it with is not, but for 0 and for what it read there too. A way by increments from the reference position
//! leads to such a place too.
//! Counter-example: `G53 X-300.`, which is past the end of a smaller machine.

use super::from_home::{FromHome, Homes};
use super::moved_places::{At, without_offset};
use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::analysis::calls_of;
use crate::ir::{Class, Cond, Expr, Module, Nc, NcItem, Place, Stmt, StmtKind, TermKind, Var};
use crate::legalize::calls::standing::tied_to;
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;
use std::collections::{BTreeSet, HashMap, HashSet};

/// What is asked of moves to such places, and of work offsets that are written as numbers.
const MOVES: Question = Question::MachinePlaces;
const OFFSETS: Question = Question::WorkPlaces;

/// True if a program may name such a place, between machines of which nobody says that they have the same ones.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let ops = [Op::MachineOnce, Op::ShiftCancel, Op::WriteWork, Op::ReferenceReturn, Op::Reference2];
    let names = ops.iter().any(|op| features.op(*op));
    (names || features.has(Feature::System) || features.role(Role::Turret))
        && !context.source.is_same_machine(context.target)
        && (!context.source.places_there().is_empty()
            || [MOVES, OFFSETS]
                .iter()
                .any(|question| context.target.behaviour(*question).is_none_or(|row| row.value != "same")))
}

/// Gives the moves to places of the old machine that the target's profile says to lie elsewhere their words there, and asks of the
/// target what its places are, where programs name others; true if any was given.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let frames = frames(module, context);
    let moved = super::moved_places::run(module, &facts, context);
    ask(module, &facts, &frames, &moved, context);
    !moved.is_empty()
}

fn ask(
    module: &Module,
    facts: &ModalFacts,
    frames: &[usize],
    moved: &HashSet<At>,
    context: &mut Context<'_>,
) {
    let numbers = Numbers::of(module);
    let read = read_places(module, frames);
    let selected = selected(module);
    let homes = moves_from_home(module).then(|| Homes::of(module, facts));
    let answer = |question| context.target.behaviour(question).map(|row| row.value.clone());
    let [moves, offsets] = [MOVES, OFFSETS].map(answer);
    // Zero is where each machine has its home, as the shop says.
    let home = moves.as_deref() == Some("home");
    let one_family = home || context.source.dialect().family == context.target.dialect().family;
    // Under G91 the words are a way on some machines.
    let in_steps = context.source.behaviour(Question::MachineUnderIncremental);
    let in_steps = in_steps.is_some_and(|row| row.value == "increments");
    // Where the geometry stays, a place counts from the tool as ever.
    let away = context.source.behaviour(Question::TurretNone).is_none_or(|row| row.value != "wear");
    for (index, program) in module.programs.iter().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let cancels = stmts.any(|stmt| stmt.kind.has_op(Op::ShiftCancel));
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            let mut home = homes.as_ref().map(|homes| homes.at(index, id));
            for (at, stmt) in block.stmts.iter().enumerate() {
                state.step(stmt);
                if let (Some(home), Some(homes)) = (&mut home, &homes) {
                    if moves.as_deref() != Some("same") && steps_from(*home, stmt, &state, &numbers) {
                        tell((index, stmt.site.span), (MOVES, moves.as_deref()), STEPPED, context);
                    }
                    home.step(stmt, &state, homes.modes);
                }
                if moved.contains(&(index, id, at)) {
                    continue;
                }
                let names = match &stmt.kind {
                    StmtKind::Nc(nc) => of_block(nc, &state, &numbers, [one_family, in_steps, cancels, away]),
                    StmtKind::Assign { target: Place::System(Sys::WorkOffset, row), value } => {
                        // Under an offset of 0 places are those of the machine.
                        let zero = value.constant() == Some(0.0);
                        zero && selects(row, &selected) || numbers.is_place(None, value, one_family)
                    }
                    _ => false,
                };
                let writes = stmt.kind.nc().is_none_or(|nc| nc.has(Op::WriteWork));
                let (question, answer) = if writes { (OFFSETS, &offsets) } else { (MOVES, &moves) };
                if !names || answer.as_deref() == Some("same") {
                    continue;
                }
                let what = match stmt.kind.nc() {
                    Some(nc) if without_offset(nc) => WITHOUT,
                    _ => NAMED,
                };
                tell((index, stmt.site.span), (question, answer.as_deref()), what, context);
            }
            let TermKind::Branch { cond, .. } = &block.term.kind else { continue };
            let span = block.term.site.span;
            let frame = frames.get(index).copied().unwrap_or_default();
            for state in compared(cond, &|var| read.get(&key(frame, var)).copied(), &numbers) {
                let offset = state == Sys::WorkOffset;
                let (question, answer) = if offset { (OFFSETS, &offsets) } else { (MOVES, &moves) };
                if answer.as_deref() != Some("same") {
                    tell((index, span), (question, answer.as_deref()), COMPARED, context);
                }
            }
        }
    }
}

const NAMED: &str = "this is a place in machine coordinates of the old machine: say in the target's profile where it lies on the new one \
                     (machine_places = [\"X-11. as X-300.\"])";
const WITHOUT: &str = "no tool offset is in force in this block, so its place hangs on the zero and the size of the old machine: say in the target's \
                       profile where it lies on the new one (machine_places = [\"X-500. Z-50. as X-200. Z-100.\"])";
const STEPPED: &str = "this way begins at the reference position and leads to a place in machine coordinates of the old machine: write the way \
                       of the new one into the conversion";
const COMPARED: &str = "a work offset or a machine position is compared with a number of the old machine: write the number of the new one into \
                        the conversion";

/// The work offsets that the programs of a library select.
fn selected(module: &Module) -> BTreeSet<u64> {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let chosen = stmts.filter_map(|stmt| stmt.kind.nc()).filter(|nc| nc.has(Op::SelectWork));
    chosen.filter_map(|nc| nc.word(Role::WorkOffset)?.constant()).map(f64::to_bits).collect()
}

/// True where an offset, by its subscripts, is one of these.
fn selects(row: &[Expr], selected: &BTreeSet<u64>) -> bool {
    row.first().and_then(Expr::constant).is_some_and(|number| selected.contains(&number.to_bits()))
}

/// True where a program goes home.
fn moves_from_home(module: &Module) -> bool {
    let mut stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let home = |op: Op| matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::MachineOnce);
    stmts.any(|stmt| stmt.kind.nc().is_some_and(|nc| nc.ops().any(home)))
}

/// True where a block moves an axis by an increment from the reference position; the increment is a number of the program.
fn steps_from(home: FromHome, stmt: &Stmt, state: &Modal, numbers: &Numbers) -> bool {
    stmt.kind
        .nc()
        .is_some_and(|nc| home.steps(nc, state).any(|(role, way)| numbers.is_place(Some(role), way, true)))
}

/// Tells of a place where the answer is that it is another one, and asks where there is none.
fn tell(
    (index, span): (usize, Span),
    (question, answer): (Question, Option<&str>),
    what: &'static str,
    context: &mut Context<'_>,
) {
    if matches!(answer, Some("other" | "home")) {
        context.add(index, Diagnostic::new(Code::Conditional, span, what));
    } else {
        context.unconfirmed(index, Side::Target, span, question.fact(), question.meaning());
    }
}

/// For each program a number that all have that see the same locals: those that call one another without a new level.
fn frames(module: &Module, context: &mut Context<'_>) -> Vec<usize> {
    let called = context.called(module);
    let mut pairs = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let calls = calls_of(block).filter(|call| !call.level);
            pairs.extend(calls.flat_map(|call| called.by((index, id), call)).map(|callee| (index, *callee)));
        }
    }
    let mut frames: Vec<usize> = (0..module.programs.len()).collect();
    let mut open: BTreeSet<usize> = pairs.iter().flat_map(|(caller, callee)| [*caller, *callee]).collect();
    while let Some(first) = open.pop_first() {
        for tied in tied_to([first], &pairs) {
            open.remove(&tied);
            frames.iter_mut().skip(tied).take(1).for_each(|frame| *frame = first);
        }
    }
    frames
}

/// What a variable is in programs of a frame: a local is another one in each.
fn key(frame: usize, var: Var) -> (Option<usize>, Var) {
    ((var.class == Class::Local).then_some(frame), var)
}

/// The variables that hold one place which was read from the machine, with or without numbers: a work offset, or a position.
fn read_places(module: &Module, frames: &[usize]) -> HashMap<(Option<usize>, Var), Sys> {
    let mut read = HashMap::new();
    // Twice, for what goes through another variable.
    for (program, frame) in module.programs.iter().zip(frames).chain(module.programs.iter().zip(frames)) {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind else { continue };
            if let Some(state) = one_place([value], &|var| read.get(&key(*frame, var)).copied()) {
                read.insert(key(*frame, *var), state);
            }
        }
    }
    read
}

/// The place that expressions hold, if they hold one: the difference of two is no place.
fn one_place<'e>(all: impl IntoIterator<Item = &'e Expr>, read: &dyn Fn(Var) -> Option<Sys>) -> Option<Sys> {
    let mut found = Vec::new();
    all.into_iter().for_each(|value| {
        value.walk(&mut |part| match part {
            Expr::System(state @ (Sys::WorkOffset | Sys::MachinePosition), _) => found.push(*state),
            Expr::Var(var) => found.extend(read(*var)),
            _ => {}
        });
    });
    match found.as_slice() {
        [state] => Some(*state),
        _ => None,
    }
}

/// Visits what a value is made of; the numbers of what it reads from the machine are no part of it.
fn parts<'e>(value: &'e Expr, f: &mut dyn FnMut(&'e Expr)) {
    f(value);
    if !matches!(value, Expr::System(..)) {
        value.exprs(&mut |operand| parts(operand, f));
    }
}

/// What a condition holds against numbers of its program: a work offset, or a position.
fn compared(cond: &Cond, read: &dyn Fn(Var) -> Option<Sys>, numbers: &Numbers) -> Vec<Sys> {
    match cond {
        Cond::Compare(_, a, b) => {
            let place = one_place([a, b], read);
            place.filter(|_| has_number([a, b], read, numbers)).into_iter().collect()
        }
        Cond::And(all) | Cond::Or(all) => all.iter().flat_map(|one| compared(one, read, numbers)).collect(),
        Cond::Not(inner) => compared(inner, read, numbers),
        Cond::Switch(_) => Vec::new(),
    }
}

/// True where the rest of a comparison is numbers of the program, and not 0 alone.
fn has_number(all: [&Expr; 2], read: &dyn Fn(Var) -> Option<Sys>, numbers: &Numbers) -> bool {
    let (mut number, mut other) = (false, false);
    for value in all {
        parts(value, &mut |part| match part {
            Expr::Number(value) => number |= *value != 0.0,
            Expr::Var(var) if read(*var).is_some() => {}
            Expr::Var(var) => match numbers.0.get(var) {
                Some(false) => number = true,
                _ => other = true,
            },
            Expr::System(Sys::WorkOffset | Sys::MachinePosition, _) => {}
            Expr::System(..) | Expr::Indirect(..) => other = true,
            _ => {}
        });
    }
    number && !other
}

/// True if a block names such a place; `state` is what is in force in it.
fn of_block(
    nc: &Nc,
    state: &Modal,
    numbers: &Numbers,
    [one_family, in_steps, cancels, away]: [bool; 4],
) -> bool {
    let steps = state.op(Group::Distance) == Some(Op::Incremental);
    let cancelled = match state.op(Group::WorkOffset) {
        Some(op) => op == Op::ShiftCancel,
        None => state.may_be_cancelled || cancels,
    };
    let shiftless = cancelled && nc.moves() || away && without_offset(nc);
    let once = nc.has(Op::MachineOnce) && !(steps && in_steps);
    let counts = once || !steps && (shiftless || nc.has(Op::WriteWork));
    // A shift of all work offsets is no place.
    let shift =
        nc.has(Op::WriteWork) && nc.word(Role::OffsetRow).is_some_and(|row| row.constant() == Some(0.0));
    let returns = nc.has(Op::ReferenceReturn) || nc.has(Op::Reference2);
    counts
        && !shift
        && !returns
        && nc.items.iter().any(|item| match item {
            NcItem::Word(role, value) if role.is_axis() && !role.is_step() => {
                numbers.is_place(Some(*role), value, one_family)
            }
            _ => false,
        })
}

/// The variables of a library that programs set, each true where something that was read from the machine may be in it.
struct Numbers(HashMap<Var, bool>);

impl Numbers {
    fn of(module: &Module) -> Self {
        let stmts =
            || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
        let mut all: HashMap<Var, bool> = HashMap::new();
        let mut changed = true;
        while std::mem::take(&mut changed) {
            for stmt in stmts() {
                let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind else { continue };
                let was = all.get(var).copied();
                let read = was == Some(true) || !is_own(value, &|var| all.get(&var) != Some(&true));
                changed |= was != Some(read);
                all.insert(*var, read);
            }
        }
        Self(all)
    }

    /// True for a value that is a place of the old machine. One that nothing in the library sets is an argument beside an axis, and beside an
    /// offset what was in force before.
    fn is_place(&self, axis: Option<Role>, value: &Expr, one_family: bool) -> bool {
        match value.constant() {
            Some(number) => number != 0.0 || axis.is_some_and(|role| role != Role::Z) && !one_family,
            None => is_own(value, &|var| self.0.get(&var).map_or(axis.is_some(), |read| !read)),
        }
    }
}

/// True for a value that the program makes of numbers and of such variables alone.
fn is_own(value: &Expr, is_number: &dyn Fn(Var) -> bool) -> bool {
    let mut own = true;
    value.walk(&mut |part| {
        own &= match part {
            Expr::Var(var) => is_number(*var),
            Expr::System(..) | Expr::Indirect(..) => false,
            _ => true,
        };
    });
    own
}

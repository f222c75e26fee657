//! Running the active drilling cycle at the present place.
//!
//! Law: on the target a cycle runs in each block that has a position; giving it the place where the tool
//! stands (`X#5001 Y#5002` in absolute coordinates, `X0 Y0` in incremental ones) runs it there. The end of the block
//! before is what is given, where the target has that: the present position may be read ahead of the moves. In the
//! block that defines the cycle nothing need be added where that block runs the cycle anyway. A block that defines a
//! cycle without a position, or without any word, runs it where the tool stands or only stores it: the target is told by a place, or by a
//! repeat of none, where the two controls do not agree. So is a block that names a new depth or plane alone for the cycle
//! in force, and one with a word of a rotary axis alone.
//! Under a rotation the present place would be turned once more; there the block gets the words that
//! last named the place, where they still have their values.
//! Side condition: absolute or incremental is known; the cycle's planes stay what they are.

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::behind::in_other_planes;
use crate::ir::analysis::programmed::Programmed;
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use std::collections::BTreeMap;

/// What the two controls do with a block of a cycle that has no position.
#[derive(Clone, Copy)]
struct Bare {
    question: Question,
    /// True where nothing need be added: they do the same, or the source is taken not to drill and the target does not.
    agree: bool,
    /// True where the source drills.
    drills: bool,
}

impl Bare {
    fn of(question: Question, source: &Control, target: &Control) -> Self {
        // A control whose table is silent of it takes a rotary axis for a place.
        let silent = (question == Question::CycleRunsByRotary).then(|| "true".to_owned());
        let answer = |control: &Control| {
            let row = control.behaviour(of(question, control));
            row.map(|row| row.value.clone()).or(silent.clone())
        };
        let (ours, theirs) = (answer(source), answer(target));
        let drills = ours.as_deref() == Some("true");
        Self { question, agree: ours == theirs || !drills && theirs.as_deref() == Some("false"), drills }
    }
}

/// The question that a control's table answers: one that is silent of blocks without any word takes them as others.
fn of(question: Question, control: &Control) -> Question {
    if question == Question::CycleRunsWithoutWords { control.of_wordless_cycles() } else { question }
}

/// Replaces the code that runs a cycle where the tool stands.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let native = context.target.code_for(Op::CycleHere, &BTreeMap::new()).is_some();
    let facts = context.modal_facts(module);
    let bare_ones = [
        Question::CycleRunsWithoutAxes,
        Question::CycleRunsByDepth,
        Question::CycleRunsByRotary,
        Question::CycleRunsWithoutWords,
    ]
    .map(|question| Bare::of(question, context.source, context.target));
    if native && bare_ones.iter().all(|bare| bare.agree) {
        return;
    }
    let has = |state| context.target.system_runs(state).next().is_some();
    let stands = [Sys::EndPosition, Sys::WorkPosition].into_iter().find(|state| has(*state));
    let summaries = context.summaries(module);
    let turned = in_other_planes(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let named = Programmed::of(program, &summaries, &|id| facts.at(index, id));
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            let mut named = named.at(BlockId(at as u32)).cloned();
            for stmt in &mut block.stmts {
                state.step(stmt);
                named.iter_mut().for_each(|named| named.step(stmt, &state, &summaries));
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                let (defines, here) = (nc.ops().any(Op::is_cycle), nc.has(Op::CycleHere) && !native);
                // New words of the cycle in force: where the state is known, it is that of the block's end.
                let tells = !defines
                    && state.op(Group::Cycle).is_some_and(Op::is_cycle)
                    && tells_depth(nc, state.op(Group::Plane));
                nc.items.retain(|item| native || *item != NcItem::Op(Op::CycleHere));
                let across = across(state.op(Group::Plane));
                let placed = across.iter().any(|(role, _)| nc.word(*role).is_some());
                let span = stmt.site.span;
                let turns = (defines || state.op(Group::Cycle).is_some_and(Op::is_cycle)) && tells_turn(nc);
                let bare = (defines || tells || turns)
                    && !nc.has(Op::CycleHere)
                    && !here
                    && !placed
                    && nc.word(Role::Repeat).is_none();
                let wordless = defines && !tells_depth(nc, state.op(Group::Plane));
                let Bare { question, agree, drills } = bare_ones[match (turns, wordless) {
                    (true, _) => 2,
                    (_, true) => 3,
                    _ => usize::from(!defines),
                }];
                let asked = here || bare && !agree;
                // Under compensation the tool stands beside the words.
                let beside = matches!(state.op(Group::RadiusComp), Some(Op::RadiusLeft | Op::RadiusRight));
                let words = || {
                    let words = named.as_ref().and_then(Programmed::words);
                    words.filter(|_| across[0].0 == Role::X && !beside)
                };
                if asked && !placed && state.op(Group::Plane).is_none() && turned.contains(&(index, span)) {
                    let what = "the plane is not known here, so neither is the axis that the cycle drills along: \
                         write G17, G18 or G19 before it";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                    continue;
                }
                if bare && !context.source.is_same_machine(context.target) {
                    let has = |control: &Control| !turns || control.behaviour(question).is_some();
                    if has(context.source) {
                        context.rests_on_source(index, span, of(question, context.source));
                    }
                    if agree && has(context.target) {
                        context.rests_on_target(index, span, of(question, context.target));
                    }
                }
                let here = here || bare && drills && !agree;
                if turns && bare && !drills && !agree {
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, TURNS));
                    continue;
                }
                let what = if bare && !drills && !agree {
                    nc.items.push(NcItem::Word(Role::Repeat, Expr::Number(0.0)));
                    let stores = context.target.behaviour(Question::CycleL0Stores);
                    let settled = stores.is_some_and(|row| row.value == "true" && row.origin.is_settled());
                    (!settled).then_some(STORED)
                } else if here && !placed && state.op(Group::Rotation) == Some(Op::RotateOn) {
                    match words() {
                        Some([x, y]) => {
                            nc.items.extend([NcItem::Word(Role::X, x), NcItem::Word(Role::Y, y)]);
                            Some(
                                "the cycle runs at the rotated position: the block names that position \
                                  again",
                            )
                        }
                        None => {
                            let what = "the cycle runs where the tool stands, and the rotation would turn \
                                        that position once more: write the position into the block of the \
                                        cycle";
                            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                            None
                        }
                    }
                } else if here && !placed {
                    let words = words();
                    if stands.is_none() && words.is_none() && state.op(Group::Distance) == Some(Op::Absolute)
                    {
                        let what = "the cycle runs where the tool stands, which is not known here: write X and Y \
                                    into the block of the cycle";
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                        continue;
                    }
                    let stands = stands.filter(|_| !turns || words.is_none());
                    place(nc, across, state.op(Group::Distance), (stands, words))
                        .err()
                        .or((!defines && !turns)
                            .then_some("the cycle runs where the tool stands: the block names that position"))
                } else {
                    None
                };
                if let Some(what) = what {
                    let unknown = here && state.op(Group::Distance).is_none();
                    let code = if unknown { Code::NoEquivalent } else { Code::Conditional };
                    context.add_once(index, what, Diagnostic::new(code, span, what));
                }
            }
        }
    }
}

const STORED: &str = "a count of 0 keeps this block from drilling: the source is taken to store a cycle without a position. Check that \
                      the target stores a cycle with such a count";
const TURNS: &str = "a rotary axis turns alone while a drilling cycle is in force: the source drills nothing there, and the target does: end \
     the cycle (G80) before it";

/// True where a block turns a rotary axis. Codes that take the word for themselves do not.
fn tells_turn(nc: &Nc) -> bool {
    let aside = nc.ops().any(|op| op.takes_axes() || op == Op::MachineOnce || op.group() == Group::Motion);
    let returns = nc.ops().any(|op| op.is_return() || op == Op::CycleOff);
    !aside && !returns && [Role::A, Role::B, Role::C].iter().any(|role| nc.word(*role).is_some())
}

/// True where a block names the depth or the retract plane of a cycle. Codes that take the word for themselves are none.
fn tells_depth(nc: &Nc, plane: Option<Op>) -> bool {
    let along = match plane {
        Some(Op::PlaneZx) => Role::Y,
        Some(Op::PlaneYz) => Role::X,
        _ => Role::Z,
    };
    let aside = nc.ops().any(|op| op.takes_axes() || op == Op::MachineOnce || op.is_return());
    !aside && (nc.word(Role::CycleR).is_some() || nc.word(along).is_some())
}

/// The axes of a plane and their numbers: a cycle's position is in them, its depth along the third one.
fn across(plane: Option<Op>) -> [(Role, f64); 2] {
    match plane {
        Some(Op::PlaneZx) => [(Role::Z, 3.0), (Role::X, 1.0)],
        Some(Op::PlaneYz) => [(Role::Y, 2.0), (Role::Z, 3.0)],
        _ => [(Role::X, 1.0), (Role::Y, 2.0)],
    }
}

/// Adds the present place to a block.
fn place(
    nc: &mut Nc,
    across: [(Role, f64); 2],
    distance: Option<Op>,
    (stands, named): (Option<Sys>, Option<[Expr; 2]>),
) -> Result<(), &'static str> {
    let words = match distance {
        Some(Op::Absolute) => {
            let [(a, x), (b, y)] = across;
            let [first, second] = match (stands, named) {
                (Some(state), _) => [x, y].map(|axis| Expr::System(state, [Expr::Number(axis)].into())),
                (None, Some(words)) => words,
                (None, None) => return Err("the cycle runs where the tool stands, which is not known here"),
            };
            [NcItem::Word(a, first), NcItem::Word(b, second)]
        }
        Some(Op::Incremental) => across.map(|(role, _)| NcItem::Word(role, Expr::Number(0.0))),
        _ => {
            return Err("the cycle runs where the tool stands, and it is not known whether G90 or G91 is \
                         in force: write one of them before it");
        }
    };
    let at = nc.items.iter().position(|item| matches!(item, NcItem::Word(..))).unwrap_or(nc.items.len());
    nc.items.splice(at..at, words);
    Ok(())
}

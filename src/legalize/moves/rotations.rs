//! A rotation of coordinates, by arithmetic, on a target that has none.
//!
//! Law: under a rotation by the angle w about (cx, cy) the point (x, y) is `cx + (x - cx)*COS[w] - (y - cy)*SIN[w]`,
//! `cy + (x - cx)*SIN[w] + (y - cy)*COS[w]`; a distance, and a centre that counts from the start of its arc, is turned without
//! the centre. The sine, the cosine and the centre are kept in registers, where they are no numbers, and followed over jumps and
//! calls. A cycle that runs where the tool stands gets the words that last named the place, turned.
//!
//! Side conditions, each refused by name: the plane is XY; whether a rotation is in force is known at each move; its block says
//! its angle and its centre in absolute numbers; a move of one axis alone comes after one of both, whose words still
//! have their values; nothing under it asks for the position or chooses another frame. Counter-example: `G68 X0 Y0 R30.` and then
//! `G1 X10.`, whose Y is where the tool was before, turned back.

mod words;

use super::short_arcs::{Vacant, other_planes, vacant};
use crate::canon::{Func, Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::analysis::programmed::Programmed;
use crate::ir::analysis::{Modal, ModalFacts};
use crate::ir::{
    Block, BlockId, Class, Expr, Module, NcItem, Place, SourceInfo, Stmt, StmtKind, Stmts, TermKind, Var,
    statics_of,
};
use crate::legalize::Context;
use crate::legalize::rewrite::highest_temp;
use std::collections::{BTreeMap, BTreeSet};
use words::{Turned, turn};

/// True if the target has no rotation.
pub fn concerns(target: &Control) -> bool {
    target.code_for(Op::RotateOn, &BTreeMap::new()).is_none()
}

/// The registers of the cosine, the sine and the centre.
const REGISTERS: [Var; 4] = {
    const fn register(number: u32) -> Var {
        Var { class: Class::Static, number: statics_of::ROTATION + number }
    }
    [register(0), register(1), register(2), register(3)]
};

const BARE: &str = "this rotation does not say its angle and the X and Y of its centre, and what it takes for them no source says: write them";
const RELATIVE: &str = "a rotation where it is not known that G90 is in force: write G90 before it";
const PLANE: &str = "a rotation in another plane than XY, or under an unknown one: write G17 before it";
const MIXED: &str = "a rotation is in force on some of the ways to this block, and the target has none: end it with G69 on every way";
const FRAME: &str = "this chooses what coordinates count from, or turns them otherwise, under a rotation, and the target has no rotation: \
     end it with G69 before this block";
const POSITION: &str =
    "this reads the position under a rotation, and the target has none: its position is the turned one";
const RETURNS: &str = "this returns with a rotation in force to callers that are not in the library, and the target has none: end it with \
     G69 before";
const MOVED: &str =
    "the centre of the rotation is taken to stay where its block puts it after a move in increments";
const ENDS: &str =
    "a rotation is in force at the end of this program: the next one is taken not to go on in it";

/// Whether a rotation is in force.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    Off,
    /// True where a move of both axes was made under it.
    On(bool),
    /// On some ways.
    Mixed,
}

impl Lattice for Known {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        *self = match (before, *other) {
            (Known::On(a), Known::On(b)) => Known::On(a && b),
            (a, b) if a == b => a,
            _ => Known::Mixed,
        };
        *self != before
    }
}

impl Known {
    /// Takes a statement; `modal` is what is in force after it.
    fn step(&mut self, stmt: &Stmt, modal: &Modal) {
        let StmtKind::Nc(nc) = &stmt.kind else { return };
        let before = *self;
        let words = [Role::X, Role::Y].map(|role| nc.word(role).is_some());
        let absolute = modal.op(Group::Distance) == Some(Op::Absolute);
        if nc.has(Op::RotateOff) {
            *self = Known::Off;
        } else if nc.has(Op::RotateOn) {
            *self = Known::On(false);
        } else if let Known::On(placed) = self {
            let other = nc.ops().any(|op| op.group() == Group::OneShot && op != Op::CycleHere);
            *placed = match words {
                [true, true] if absolute && !other => true,
                [false, false] if !other => *placed || nc.has(Op::CycleHere),
                _ => *placed && absolute && !other,
            };
        }
        if stmt.site.skip.is_some() {
            self.join(&before);
        }
    }
}

struct Rules<'r> {
    facts: &'r ModalFacts,
}

impl Follow for Rules<'_> {
    type Known = Known;

    fn outside(&self, _: usize) -> Known {
        Known::Off
    }

    fn stmts(&self, (program, id): (usize, BlockId), block: &Block, known: &mut Known) {
        let mut modal = self.facts.at(program, id);
        for stmt in &block.stmts {
            modal.step(stmt);
            known.step(stmt, &modal);
        }
    }

    fn lose(&self, known: &mut Known) {
        if *known != Known::Off {
            *known = Known::Mixed;
        }
    }
}

/// Turns what stands under rotations.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let summaries = context.summaries(module);
    let called = context.called(module);
    let (given, none) = (called.given(module), BTreeSet::new());
    let callees: BTreeSet<usize> = called.pairs(module).into_iter().map(|(_, callee)| callee).collect();
    let planes = other_planes(module, context);
    let known = OverCalls::of(module, &Rules { facts: &facts });
    let same = one_centre(module);
    let centre = same.map(|at| at.map(Expr::Number));
    let centre = centre.unwrap_or([Expr::Var(REGISTERS[2]), Expr::Var(REGISTERS[3])]);
    // A centre that is always the same numbers needs no registers.
    let registers = &REGISTERS[..if same.is_some() { 2 } else { 4 }];
    let ccw = context.source.behaviour(Question::RotationDirection).is_none_or(|row| row.value != "cw");
    for (index, program) in module.programs.iter_mut().enumerate() {
        let named = Programmed::of(program, &summaries, &|id| facts.at(index, id));
        let vacant = vacant(program, &summaries, given.get(&index).unwrap_or(&none));
        let mut temps = highest_temp(program);
        let mut findings: Vec<(Code, &'static str, crate::text::Span)> = Vec::new();
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let Some(mut here) = known.at(index, id).copied() else { continue };
            let (mut state, mut place) = (facts.at(index, id), named.at(id).cloned());
            let mut out = Stmts::with_capacity(block.stmts.len());
            for (stmt, vacant) in std::mem::take(&mut block.stmts).into_iter().zip(&vacant[at]) {
                let words = place.as_ref().and_then(Programmed::words);
                let before = here;
                state.step(&stmt);
                here.step(&stmt, &state);
                place.iter_mut().for_each(|place| place.step(&stmt, &state, &summaries));
                let span = stmt.site.span;
                let mut refuse = |what| findings.push((Code::NoEquivalent, what, span));
                let mut reads = false;
                stmt.kind.exprs(&mut |e| reads |= reads_position(e));
                if before != Known::Off && reads {
                    refuse(POSITION);
                }
                let StmtKind::Nc(nc) = &stmt.kind else {
                    out.push(stmt);
                    continue;
                };
                if nc.has(Op::RotateOn) || nc.has(Op::RotateOff) {
                    let plane = match state.op(Group::Plane) {
                        Some(op) => op != Op::PlaneXy,
                        None => planes[index],
                    };
                    let bad = match (plane, state.op(Group::Distance) == Some(Op::Absolute)) {
                        (true, _) => Some(PLANE),
                        (_, false) => Some(RELATIVE),
                        _ => None,
                    };
                    bad.filter(|_| nc.has(Op::RotateOn)).into_iter().for_each(&mut refuse);
                    if nc.has(Op::RotateOn) {
                        context.rests_on_source(index, span, Question::RotationDirection);
                    }
                    if let Err(what) = set(stmt, vacant, (ccw, registers), &mut out) {
                        refuse(what);
                    }
                    continue;
                }
                let moves = nc.word(Role::X).is_some() || nc.word(Role::Y).is_some() || nc.has(Op::CycleHere);
                let arc = nc.word(Role::ArcI).is_some() || nc.word(Role::ArcJ).is_some();
                match here {
                    Known::On(_) if nc.ops().any(is_of_frame) => refuse(FRAME),
                    Known::Mixed if moves || arc => refuse(MIXED),
                    Known::On(_) if moves || arc => {
                        let distance = state.op(Group::Distance);
                        if distance == Some(Op::Incremental) {
                            findings.push((Code::Conditional, MOVED, span));
                        }
                        let placed = matches!(before, Known::On(true)) || nc.has(Op::CycleHere);
                        let turned = Turned {
                            centre: centre.clone(),
                            cosine: REGISTERS[0],
                            sine: REGISTERS[1],
                            last: words.filter(|_| placed),
                        };
                        match turn(stmt, &turned, distance, vacant, &mut temps, &mut out) {
                            Ok(()) => {}
                            Err((stmt, what)) => {
                                findings.push((Code::NoEquivalent, what, span));
                                out.push(stmt);
                            }
                        }
                        continue;
                    }
                    _ => {}
                }
                out.push(stmt);
            }
            block.stmts = out;
            let span = block.term.site.span;
            let mut reads = false;
            block.term.kind.exprs(&mut |e| reads |= reads_position(e));
            if here != Known::Off && reads {
                findings.push((Code::NoEquivalent, POSITION, span));
            }
            match &block.term.kind {
                TermKind::Return { .. } if here != Known::Off && !callees.contains(&index) => {
                    findings.push((Code::NoEquivalent, RETURNS, span));
                }
                TermKind::End { .. } | TermKind::Stray if here != Known::Off => {
                    findings.push((Code::Conditional, ENDS, span))
                }
                _ => {}
            }
        }
        for (code, what, span) in findings {
            context.add_once(index, what, Diagnostic::new(code, span, what));
        }
    }
}

/// The centre of all rotations of a library, where that is one place in numbers.
fn one_centre(module: &Module) -> Option<[f64; 2]> {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let mut found = None;
    for nc in stmts.filter_map(|stmt| stmt.kind.nc()).filter(|nc| nc.has(Op::RotateOn)) {
        let word = |role| nc.word(role).and_then(Expr::constant);
        let here = [word(Role::X)?, word(Role::Y)?];
        if *found.get_or_insert(here) != here {
            return None;
        }
    }
    found
}

/// Takes the codes of a rotation out of a block, and keeps what it says in registers.
fn set(
    stmt: Stmt,
    vacant: &Vacant,
    (ccw, registers): (bool, &[Var]),
    out: &mut Stmts,
) -> Result<(), &'static str> {
    let Stmt { kind: StmtKind::Nc(mut nc), site } = stmt else { return Ok(()) };
    let on = nc.has(Op::RotateOn);
    nc.items.retain(|item| !matches!(item, NcItem::Op(Op::RotateOn | Op::RotateOff)));
    let mut values = Vec::new();
    if on {
        let (Some(angle), Some(x), Some(y)) = (nc.word(Role::Angle), nc.word(Role::X), nc.word(Role::Y))
        else {
            return Err(BARE);
        };
        if vacant.contains(&true) {
            return Err(BARE);
        }
        let sine = Expr::Call(Func::Sin, [angle.clone()].into());
        let sine = if ccw { sine } else { Expr::Negate(Box::new(sine)) };
        values = vec![Expr::Call(Func::Cos, [angle.clone()].into()), sine, x.clone(), y.clone()];
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Angle | Role::X | Role::Y, _)));
    }
    let aside = || SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
    for (var, value) in registers.iter().zip(values) {
        out.push(Stmt { kind: StmtKind::Assign { target: Place::Var(*var), value }, site: aside() });
    }
    let kind = if nc.items.is_empty() { StmtKind::Comment } else { StmtKind::Nc(nc) };
    out.push(Stmt { kind, site });
    Ok(())
}

/// True for what chooses another frame of coordinates, or goes where words do not say.
pub(super) fn is_of_frame(op: Op) -> bool {
    let group = op.group();
    matches!(group, Group::Plane | Group::WorkOffset | Group::Scaling | Group::Mirror) && op != Op::PlaneXy
        || matches!(
            op,
            Op::LocalShift | Op::SetPosition | Op::WriteWork | Op::MachineOnce | Op::ReferenceFrom
        )
        || matches!(op, Op::Probe | Op::ProbeOther | Op::Thread | Op::Pole | Op::PolarOn | Op::ArcTangent)
}

/// True for an expression that reads where the tool is in the coordinates of the program.
pub(super) fn reads_position(e: &Expr) -> bool {
    use Sys::{AxisPosition, EndPosition, SkipPosition, WorkPosition};
    let mut reads = false;
    e.walk(&mut |part| {
        reads |= matches!(part, Expr::System(EndPosition | WorkPosition | SkipPosition | AxisPosition, _));
    });
    reads
}

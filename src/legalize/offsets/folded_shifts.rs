//! Local shifts that are counted into the coordinates, on a target that has none.
//!
//! Law: under a local shift an absolute place of the program is so much further along in the work offset, so the shift is added to each
//! absolute word, to the planes of drilling cycles and to the centre of a rotation, and its blocks go. Increments, centres of arcs from their
//! start and machine coordinates do not know of it. Side conditions: the shift is a number wherever a word counts with it; its block does
//! nothing else, and no cycle, compensation or turned frame is in force there; nothing under it is called, sets a frame or a table, or
//! reads a position; no run goes back with it to its caller, and the end of a run clears it. Counter-example: `G52 X10.`, `#1=#5041`.

mod follow;
mod obstacles;

use super::left_shifts::{AXES, is_none};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::Vacancy;
use crate::ir::analysis::over_calls::{OverCalls, called};
use crate::ir::{BinOp, Block, BlockId, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::features::Features;
use crate::legalize::moves::increments::parts_of_unit;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use follow::{Shifted, Shifts, size};
use obstacles::*;
use std::collections::{BTreeMap, BTreeSet};

const CLEARS: Question = Question::EndClearsLocal;

const FOLDED: &str =
    "the target has no local shift: this one is counted into the coordinates up to where it ends";

/// True if the library shifts so, and the target cannot.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    super::no_shifts::concerns(features, context)
}

/// Counts shifts into coordinates, and says why where it cannot; true if one went.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let shifts = |program: &Program| Features::of_program(program).op(Op::LocalShift);
    let known = OverCalls::of(module, &Shifts);
    let facts = context.modal_facts(module);
    let summaries = context.summaries(module);
    let given = context.called(module).given(module);
    let features = Features::of(&module.programs);
    let library = Library {
        drills: features.any_op(Op::is_cycle),
        compensates: features.op(Op::RadiusLeft) || features.op(Op::RadiusRight),
        shapes: features.any_op(is_shape),
        units: features.op(Op::Inch) && features.op(Op::Metric),
        clears: context.source.is(CLEARS),
        touches: reads(&module.programs, &has_touch),
        external: reads(&module.programs, &|e| has_external(e, context.source))
            || sets(&module.programs, &|kind| sets_external(kind, context.source)),
    };
    let called = called(module);
    let (mut changed, none) = (false, BTreeSet::new());
    for (index, program) in module.programs.iter_mut().enumerate().filter(|(_, program)| shifts(program)) {
        let vacancy = Vacancy::of(program, &summaries, given.get(&index).unwrap_or(&none));
        let counts = |_: &Nc, role: Role| AXES.contains(&role) || role == Role::CycleR;
        let own = Features::of_program(program);
        let is_flat = !library.shapes || !called[index] && !own.any_op(is_shape);
        let look = Look {
            program,
            library: &library,
            source: context.source,
            is_flat,
            absent: vacancy.absent(&counts),
        };
        let made = look.over(&|id| known.at(index, id).cloned(), &|id| facts.at(index, id));
        let Made { first: Some(first), edits, ends, obstacle } = made else { continue };
        if let Some((why, help)) = obstacle {
            let what = format!(
                "the target has no local shift, and this one cannot be counted into the coordinates: {why}"
            );
            for span in first {
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what.clone()).with_help(help));
            }
            continue;
        }
        changed = true;
        ends.iter().for_each(|span| context.rests_on_source(index, *span, CLEARS));
        if let Some(span) = first.first() {
            context.add_once(index, FOLDED, Diagnostic::new(Code::ShiftCounted, *span, FOLDED));
        }
        for ((id, at), edit) in edits {
            let Some(stmt) = program.blocks.get_mut(id.index()).and_then(|block| block.stmts.get_mut(at))
            else {
                continue;
            };
            stmt.kind = edit.map_or(StmtKind::Comment, StmtKind::Nc);
        }
    }
    changed
}

/// True for a code that turns, scales or mirrors coordinates.
fn is_shape(op: Op) -> bool {
    matches!(op, Op::RotateOn | Op::ScaleOn | Op::MirrorOn)
}

/// True where programs read what is asked.
fn reads(programs: &[Program], is_asked: &dyn Fn(&Expr) -> bool) -> bool {
    let mut blocks = programs.iter().flat_map(|program| &program.blocks);
    blocks.any(|block| {
        let mut found = false;
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut |e| found |= is_asked(e)));
        block.term.kind.exprs(&mut |e| found |= is_asked(e));
        found
    })
}

/// True where a statement of programs is so.
fn sets(programs: &[Program], is_so: &dyn Fn(&StmtKind) -> bool) -> bool {
    let blocks = programs.iter().flat_map(|program| &program.blocks);
    blocks.flat_map(|block| &block.stmts).any(|stmt| is_so(&stmt.kind))
}

/// What is asked of the whole library.
struct Library {
    drills: bool,
    compensates: bool,
    /// True if it turns, scales or mirrors coordinates.
    shapes: bool,
    /// True if it reads where the probe touched.
    touches: bool,
    /// True if it reads or sets the shift of all work offsets, which some controls keep in one register with local ones.
    external: bool,
    /// True if it has codes of both units.
    units: bool,
    /// True if the source's end of a run clears the shift.
    clears: bool,
}

/// A program that is looked at.
struct Look<'p> {
    program: &'p Program,
    library: &'p Library,
    source: &'p Control,
    /// True if no block of it, and no caller, turns coordinates.
    is_flat: bool,
    /// The blocks with a word that may not be there.
    absent: BTreeSet<(BlockId, usize)>,
}

/// What becomes of a program.
#[derive(Default)]
struct Made {
    /// Where its shifts begin; none if no shift but 0 is set.
    first: Option<Vec<Span>>,
    /// The blocks that are written otherwise; none for one that goes.
    edits: BTreeMap<(BlockId, usize), Option<Nc>>,
    /// The ends of a run that clear a shift.
    ends: Vec<Span>,
    obstacle: Option<Obstacle>,
}

impl Look<'_> {
    /// Looks at all blocks that a run comes to.
    fn over(&self, known: &dyn Fn(BlockId) -> Option<Shifted>, facts: &dyn Fn(BlockId) -> Modal) -> Made {
        let mut made = Made::default();
        if known(BlockId(0)).is_some_and(|shifted| !shifted.is_none()) {
            made.obstacle = Some(CALLED);
        }
        for (id, block) in self.program.ids().zip(&self.program.blocks) {
            let Some(mut shifted) = known(id) else { continue };
            let mut state = facts(id);
            for (at, stmt) in block.stmts.iter().enumerate() {
                let before = state.clone();
                state.step(stmt);
                if let Err(obstacle) = self.stmt((id, at), stmt, (&before, &state), &shifted, &mut made) {
                    made.obstacle.get_or_insert(obstacle);
                }
                shifted.step(stmt);
            }
            if let Err(obstacle) = self.end(block, &shifted, &mut made) {
                made.obstacle.get_or_insert(obstacle);
            }
        }
        made
    }

    fn stmt(
        &self,
        place: (BlockId, usize),
        stmt: &Stmt,
        (before, state): (&Modal, &Modal),
        shifted: &Shifted,
        made: &mut Made,
    ) -> Result<(), Obstacle> {
        let mut reads = false;
        stmt.kind.exprs(&mut |e| reads |= has_place(e));
        if reads && !shifted.is_none() {
            return Err(READS);
        }
        let nc = match &stmt.kind {
            StmtKind::ModalCall(_) if !shifted.is_none() => return Err(CALLED),
            StmtKind::Nc(nc) => nc,
            _ => return Ok(()),
        };
        if nc.has(Op::LocalShift) {
            let zero = nc.items.iter().all(|item| !matches!(item, NcItem::Word(_, value) if !is_none(value)));
            if !zero {
                made.first.get_or_insert_default().push(stmt.site.span);
            }
            if zero && shifted.is_none() {
                return Ok(());
            }
            self.sets(stmt, nc, before)?;
            made.edits.insert(place, None);
            return Ok(());
        }
        if shifted.is_none() {
            return Ok(());
        }
        if self.library.touches && nc.has(Op::Probe) {
            return Err(READS);
        }
        if let Some(edited) = counted(nc, state, shifted)? {
            if self.absent.contains(&place) {
                return Err(VACANT);
            }
            made.edits.insert(place, Some(edited));
        }
        Ok(())
    }

    /// True for a size in whole increments, so that the word and what it is added to are rounded alike.
    fn is_whole(&self, value: &Expr, before: &Modal) -> bool {
        // Three decimals are whole in either unit.
        let parts = parts_of_unit(before, self.source).unwrap_or(1e3);
        size(value).is_some_and(|size| (size * parts - (size * parts).round()).abs() < 1e-6)
    }

    /// What must hold where a shift is set.
    fn sets(&self, stmt: &Stmt, nc: &Nc, before: &Modal) -> Result<(), Obstacle> {
        for item in &nc.items {
            match item {
                NcItem::Op(Op::LocalShift) => {}
                NcItem::Word(Role::X | Role::Y | Role::Z, value) if self.is_whole(value, before) => {}
                NcItem::Word(Role::X | Role::Y | Role::Z, _) => return Err(COMPUTED),
                NcItem::Word(role, value) if AXES.contains(role) && is_none(value) => {}
                NcItem::Word(role, _) if AXES.contains(role) => return Err(ROTARY),
                _ => return Err(BESIDE),
            }
        }
        if stmt.site.skip.is_some() {
            return Err(SKIPPED);
        }
        if self.library.units {
            return Err(UNITS);
        }
        if self.library.external {
            return Err(EXTERNAL);
        }
        let off = |group, off| before.op(group) == Some(off);
        if self.library.drills && !off(Group::Cycle, Op::CycleOff)
            || self.library.compensates && !off(Group::RadiusComp, Op::RadiusOff)
        {
            return Err(IN_FORCE);
        }
        let flat = [
            (Group::Rotation, Op::RotateOff),
            (Group::Scaling, Op::ScaleOff),
            (Group::Mirror, Op::MirrorOff),
        ];
        match self.is_flat || flat.into_iter().all(|(group, none)| off(group, none)) {
            true => Ok(()),
            false => Err(FRAME),
        }
    }

    /// What must hold where a block ends under a shift.
    fn end(&self, block: &Block, shifted: &Shifted, made: &mut Made) -> Result<(), Obstacle> {
        if shifted.is_none() {
            return Ok(());
        }
        let mut reads = false;
        block.term.kind.exprs(&mut |e| reads |= has_place(e));
        match &block.term.kind {
            _ if reads => Err(READS),
            TermKind::Call { .. } | TermKind::Chain(_) => Err(CALLED),
            TermKind::Return { .. } | TermKind::Stray => Err(RETURNS),
            TermKind::End { .. } if self.library.clears => {
                made.ends.push(block.term.site.span);
                Ok(())
            }
            TermKind::End { .. } => Err(STAYS),
            _ => Ok(()),
        }
    }
}

/// A block with the shift in its words; none if it stays as it is.
fn counted(nc: &Nc, state: &Modal, shifted: &Shifted) -> Result<Option<Nc>, Obstacle> {
    if let Some(obstacle) = nc.items.iter().find_map(|item| stands_in_way(item, state)) {
        return Err(obstacle);
    }
    if nc.has(Op::MachineOnce) {
        return Ok(None);
    }
    if state.may_call() && nc.moves() {
        return Err(CALLED);
    }
    let drills = state.op(Group::Cycle).is_some_and(Op::is_cycle);
    let (mut edited, mut any) = (nc.clone(), false);
    for item in &mut edited.items {
        let NcItem::Word(role, value) = item else { continue };
        let axis = match role {
            Role::X => 0,
            Role::Y => 1,
            Role::Z | Role::CycleR => 2,
            _ => continue,
        };
        let by = shifted.along(axis).ok_or(SEVERAL)?;
        if by == 0.0 {
            continue;
        }
        match state.op(Group::Distance) {
            Some(Op::Absolute) => {}
            Some(Op::Incremental) if !nc.has(Op::RotateOn) => continue,
            Some(_) => return Err(FRAME),
            None => return Err(DISTANCE),
        }
        if drills && state.op(Group::Plane) != Some(Op::PlaneXy) || *role == Role::CycleR && !drills {
            return Err(PLANE);
        }
        *value = further(value, by)?;
        any = true;
    }
    Ok(any.then_some(edited))
}

/// A place that is so much further along.
fn further(value: &Expr, by: f64) -> Result<Expr, Obstacle> {
    if matches!(value, Expr::Increments(_)) {
        return Err(POINT);
    }
    // Sums of decimals are decimals: what binary arithmetic adds to them is not meant.
    let clean = |number: f64| (number * 1e6).round() / 1e6 + 0.0;
    Ok(match value.constant() {
        Some(number) => Expr::Number(clean(number + by)),
        None if by < 0.0 => Expr::binary(BinOp::Sub, value.clone(), Expr::Number(clean(-by))),
        None => Expr::binary(BinOp::Add, value.clone(), Expr::Number(clean(by))),
    })
}

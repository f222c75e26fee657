//! What becomes of a program whose coordinates are shifted, and what is in the way.

use super::super::left_shifts::{AXES, is_none};
use super::follow::{By, Shifted, size};
use super::obstacles::*;
use super::{Library, REGISTERS};
use crate::canon::{Group, Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::reachable;
use crate::ir::{BinOp, Block, BlockId, Call, Callee, Expr, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::Modal;
use crate::legalize::moves::increments::parts_of_unit;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A program that is looked at.
pub(super) struct Look<'p> {
    pub program: &'p Program,
    pub library: &'p Library,
    pub source: &'p Control,
    /// The program that a name of the library means.
    pub named: &'p dyn Fn(&Callee) -> Option<usize>,
    /// True if another program of the library calls it.
    pub is_called: bool,
    /// True if no program that calls it, or is called by it, however far, turns coordinates.
    pub is_flat: bool,
    /// The blocks with a word that may not be there.
    pub absent: BTreeSet<(BlockId, usize)>,
}

/// What becomes of a program.
#[derive(Default)]
pub(super) struct Made {
    /// Where its shifts begin, if it sets one other than 0.
    pub first: Vec<Span>,
    /// The blocks that are written otherwise; none for one that goes.
    pub edits: BTreeMap<(BlockId, usize), Option<Nc>>,
    /// What blocks set along X, Y and Z.
    pub sets: BTreeMap<(BlockId, usize), [Option<Expr>; 3]>,
    /// True for X, Y and Z where a word counts with what the register of the shift holds.
    pub counts: [bool; 3],
    /// True if its start can set registers.
    pub is_start: bool,
    /// True for those of them that starts of programs must set.
    pub starts: [bool; 3],
    /// The programs that are called under a shift, or return with one.
    pub under: BTreeSet<usize>,
    /// The ends of a run that clear a shift.
    pub ends: Vec<Span>,
    pub obstacle: Option<Obstacle>,
}

impl Look<'_> {
    /// Looks at all blocks that a run comes to.
    pub fn over(&self, known: &dyn Fn(BlockId) -> Option<Shifted>, facts: &dyn Fn(BlockId) -> Modal) -> Made {
        let mut made = Made::default();
        let main = reachable(self.program, BlockId(0));
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
            // A part that only calls enter returns to where this analysis goes on.
            let returns = !self.library.indirect && (self.is_called || !main.contains(&id));
            if let Err(obstacle) = self.end(block, &shifted, (known, returns), &mut made) {
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
            if stmt.site.skip.is_none() {
                let set = [Role::X, Role::Y, Role::Z].map(|role| Some(Expr::Number(size(nc.word(role)?)?)));
                made.sets.insert(place, set);
            }
            let zero = nc.items.iter().all(|item| !matches!(item, NcItem::Word(_, value) if !is_none(value)));
            if !zero {
                made.first.push(stmt.site.span);
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
        if let Some(edited) = counted(nc, state, shifted, made)? {
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

    /// What must hold where a block ends under a shift, or a call comes back with one.
    fn end(
        &self,
        block: &Block,
        shifted: &Shifted,
        (known, returns): (&dyn Fn(BlockId) -> Option<Shifted>, bool),
        made: &mut Made,
    ) -> Result<(), Obstacle> {
        if let TermKind::Call { call, next } = &block.term.kind {
            self.call(call, shifted, known(*next), made)?;
        }
        if shifted.is_none() {
            return Ok(());
        }
        let mut reads = false;
        block.term.kind.exprs(&mut |e| reads |= has_place(e));
        match &block.term.kind {
            _ if reads => Err(READS),
            TermKind::Chain(_) => Err(CALLED),
            TermKind::Return { to: None } if returns => Ok(()),
            TermKind::Return { .. } | TermKind::Stray => Err(RETURNS),
            TermKind::End { .. } if self.library.clears => {
                made.ends.push(block.term.site.span);
                Ok(())
            }
            TermKind::End { .. } => Err(STAYS),
            _ => Ok(()),
        }
    }

    /// What must hold where a block calls: it is known what runs, and that it runs.
    fn call(
        &self,
        call: &Call,
        shifted: &Shifted,
        after: Option<Shifted>,
        made: &mut Made,
    ) -> Result<(), Obstacle> {
        let callee = (self.named)(&call.callee);
        let is_shifted = !shifted.is_none();
        if is_shifted || after.as_ref().is_some_and(|after| !after.is_none()) {
            made.under.extend(callee);
        }
        let is_known = callee.is_some() || matches!(call.callee, Callee::Block(_));
        if is_shifted && (self.library.indirect || !is_known) {
            return Err(CALLED);
        }
        // What runs no times leaves the shift as it was.
        let runs = call.count.as_ref().is_none_or(|count| count.constant().is_some_and(|count| count >= 1.0));
        let is_left = || match after {
            None => !is_shifted,
            Some(mut after) => !after.join(shifted),
        };
        if runs || is_left() { Ok(()) } else { Err(CALLED) }
    }
}

/// A block with the shift in its words; none if it stays as it is.
fn counted(nc: &Nc, state: &Modal, shifted: &Shifted, made: &mut Made) -> Result<Option<Nc>, Obstacle> {
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
        let by = shifted.by(axis).ok_or(SEVERAL)?;
        if by == By::Number(0.0) {
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
        *value = further(value, by, axis)?;
        made.counts[axis] |= matches!(by, By::Register(_));
        made.starts[axis] |= by == By::Register(true);
        any = true;
    }
    Ok(any.then_some(edited))
}

/// A place that is so much further along.
fn further(value: &Expr, by: By, axis: usize) -> Result<Expr, Obstacle> {
    if matches!(value, Expr::Increments(_)) {
        return Err(POINT);
    }
    // Sums of decimals are decimals: what binary arithmetic adds to them is not meant.
    let clean = |number: f64| (number * 1e6).round() / 1e6 + 0.0;
    let sum = |a: Expr, b: f64| match b {
        0.0 => a,
        b if b < 0.0 => Expr::binary(BinOp::Sub, a, Expr::Number(-b)),
        b => Expr::binary(BinOp::Add, a, Expr::Number(b)),
    };
    Ok(match (value.constant(), by) {
        (Some(number), By::Number(by)) => Expr::Number(clean(number + by)),
        (None, By::Number(by)) => sum(value.clone(), clean(by)),
        (Some(number), By::Register(_)) => sum(Expr::Var(REGISTERS[axis]), number),
        (None, By::Register(_)) => Expr::binary(BinOp::Add, value.clone(), Expr::Var(REGISTERS[axis])),
    })
}

//! Where the holes of a lathe end: at the level where the cycle began, or at the retract plane, by G98 and G99 on some controls alone.
//!
//! Law: a cycle that begins at its retract plane ends there. So where the target always goes back to where the cycle began, the tool goes to
//! the place and to the plane before the cycle, in rapid, as the cycle does it; a hole of such a cycle that ends where the cycle began goes
//! back by a move of its own, which ends the cycle. Where the next hole ends elsewhere, the cycle is told again, with all its words.
//! Where the source always goes back, the target is told so.
//! Side conditions: which of the two is in force is known; what is told again are numbers that count as they did; rapid or G1 is in force before
//! it. Counter-example: `G99 G83 ..`, and `G98` before a hole to which a jump leads.

use super::hole_words::{Told, lasting};
use super::holes::drills;
use super::straight::entered_straight;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine};
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use std::collections::BTreeMap;

/// True where only one of the controls has codes for it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let (source, target) = (chooses(context.source), chooses(context.target));
    let told = features.op(Op::ReturnInitial) || features.op(Op::ReturnR);
    let holes = features.any_op(Op::is_hole);
    context.target.machine() == Machine::Lathe && source != target && (holes || told && !target)
}

/// True of a control with codes for where a hole ends.
fn chooses(control: &Control) -> bool {
    control.code_for(Op::ReturnInitial, &BTreeMap::new()).is_some()
}

/// Says where holes end, or makes them end there.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let told = chooses(context.target);
    let facts = context.modal_facts(module);
    let (mut found, mut ends) = (Vec::new(), Vec::new());
    for (index, program) in module.programs.iter_mut().enumerate() {
        let straight = entered_straight(program);
        let mut walk = Walk::default();
        for ((id, block), straight) in program.ids().zip(&mut program.blocks).zip(straight) {
            let mut state = facts.at(index, id);
            if !straight {
                walk = Walk::default();
            }
            let mut out = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::take(&mut block.stmts) {
                let before = state.clone();
                state.step(&stmt);
                let StmtKind::Nc(nc) = &mut stmt.kind else {
                    out.push(stmt);
                    continue;
                };
                if told {
                    tell(nc);
                    out.push(stmt);
                    continue;
                }
                nc.items.retain(|item| !matches!(item, NcItem::Op(Op::ReturnInitial | Op::ReturnR)));
                let Some(op) = drills(nc, &state) else {
                    if nc.items.is_empty() {
                        stmt.kind = StmtKind::Comment;
                    }
                    out.push(stmt);
                    continue;
                };
                let hole = Hole { nc, op, before: &before, state: &state, skipped: stmt.site.skip.is_some() };
                let open = hole.goes_on() && walk.cycle == Target::Unknown;
                ends.push((index, state.op(Group::ReturnPlane), open, stmt.site.span));
                match walk.hole(&hole) {
                    Ok(None) => out.push(stmt),
                    Ok(Some(blocks)) => {
                        let aside = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
                        let sites = std::iter::once(stmt.site).chain(std::iter::repeat(aside));
                        let new = |(nc, site)| Stmt { kind: StmtKind::Nc(nc), site };
                        out.extend(blocks.into_iter().zip(sites).map(new));
                    }
                    Err(what) => {
                        found.push((index, stmt.site.span, what));
                        out.push(stmt);
                    }
                }
            }
            block.stmts = out;
        }
    }
    // A hole that goes on from a cycle that other ways lead to too: all holes must end alike.
    let alike = ends.iter().all(|(_, plane, ..)| Some(*plane) == ends.first().map(|first| first.1));
    let goes_on = ends.iter().find(|(_, _, open, _)| *open);
    if let Some((index, .., span)) = goes_on.filter(|_| !alike) {
        found.push((*index, *span, MIXED));
    }
    for (index, span, what) in found {
        context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what).with_help(HELP));
    }
    true
}

/// Writes the code before that of a cycle.
fn tell(nc: &mut Nc) {
    let cycle = nc.items.iter().position(|item| matches!(item, NcItem::Op(op) if op.is_hole()));
    if let Some(at) = cycle.filter(|_| !nc.has(Op::ReturnInitial)) {
        nc.items.insert(at, NcItem::Op(Op::ReturnInitial));
    }
}

/// A block that drills, without the codes that say where it ends.
struct Hole<'h> {
    nc: &'h Nc,
    op: Op,
    before: &'h Modal,
    state: &'h Modal,
    skipped: bool,
}

/// What is in force on the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Target {
    /// What the ways that lead here left.
    #[default]
    Unknown,
    /// A cycle that began where that of the source did.
    Level,
    /// A cycle that began at its retract plane.
    Plane,
    /// No cycle: a move ended it.
    Ended,
}

/// What is known of the cycle in force.
#[derive(Clone, Debug, Default)]
struct Walk {
    told: Told,
    cycle: Target,
}

impl Walk {
    /// The blocks in the place of a hole; nothing if it stays as it is.
    fn hole(&mut self, hole: &Hole<'_>) -> Result<Option<Vec<Nc>>, &'static str> {
        let ends = match hole.state.op(Group::ReturnPlane) {
            Some(Op::ReturnR) => Target::Plane,
            Some(_) => Target::Level,
            None => return Err(UNKNOWN),
        };
        let goes_on = hole.goes_on();
        if !goes_on {
            *self = Self::default();
        }
        let plane = self.told.plane();
        self.told.take(hole.nc, hole.op, hole.state);
        if hole.skipped {
            // Some runs do not come by what it says.
            self.told.op = None;
        }
        let old = std::mem::replace(&mut self.cycle, ends);
        let tells_plane = hole.nc.word(Role::CycleRStep).is_some();
        let moves_plane = tells_plane && (plane.is_none() || plane != self.told.plane());
        match (old, ends) {
            (Target::Unknown, Target::Plane) if goes_on && tells_plane => Err(PLANE),
            (Target::Plane, Target::Plane) if moves_plane => {
                self.at_plane(hole, plane.ok_or(PLANE)?).map(Some)
            }
            // What the block before it left to other ways is looked at for the whole library.
            (Target::Unknown, _) if goes_on => {
                self.cycle = old;
                Ok(None)
            }
            (Target::Unknown | Target::Level, Target::Level) => Ok(None),
            (Target::Plane, Target::Plane) => Ok(tells_plane.then(|| vec![at_its_plane(hole.nc.clone())])),
            (Target::Plane, _) if moves_plane => Err(MIXED),
            (Target::Plane, _) => {
                self.cycle = Target::Ended;
                self.back(hole).map(Some)
            }
            (_, Target::Plane) => self.at_plane(hole, 0.0).map(Some),
            (_, _) => self.again(hole).map(|nc| Some(vec![nc])),
        }
    }

    /// A hole of a cycle that began at its plane, and the way back to where the source's cycle began.
    fn back(&self, hole: &Hole<'_>) -> Result<Vec<Nc>, &'static str> {
        let plane = self.told.plane().ok_or(MIXED)?;
        if hole.nc.word(Role::Repeat).is_some() {
            return Err(EMULATION);
        }
        let mut blocks = vec![at_its_plane(hole.nc.clone())];
        if plane != 0.0 {
            blocks.push(hole.along(-plane));
            blocks.extend(hole.motion()?);
        }
        Ok(blocks)
    }

    /// The way to the place and to the plane, from so far toward it, and the cycle from there.
    fn at_plane(&self, hole: &Hole<'_>, from: f64) -> Result<Vec<Nc>, &'static str> {
        let plane = self.told.plane().ok_or(PLANE)?;
        let motion = hole.motion()?;
        let times = match hole.nc.word(Role::Repeat).map(|times| times.constant()) {
            None => 1.0,
            Some(times) => times.filter(|times| *times >= 1.0 && times.fract() == 0.0).ok_or(EMULATION)?,
        };
        let (places, rest) = hole.parts();
        if times > 1.0 && places.is_empty() {
            return Err(EMULATION);
        }
        let mut blocks = Vec::new();
        if !places.is_empty() {
            blocks.push(Nc { items: std::iter::once(NcItem::Op(Op::Rapid)).chain(places.clone()).collect() });
        }
        if plane != from {
            blocks.push(hole.along(plane - from));
        }
        if !blocks.is_empty() {
            blocks.extend(motion);
        }
        blocks.push(at_its_plane(Nc { items: self.words(hole, rest)? }));
        if times > 1.0 {
            let peck = hole.nc.word(Role::CycleQ).map(|peck| NcItem::Word(Role::CycleQ, peck.clone()));
            let more = (times > 2.0).then(|| NcItem::Word(Role::Repeat, Expr::Number(times - 1.0)));
            blocks.push(Nc { items: places.into_iter().chain(peck).chain(more).collect() });
        }
        Ok(blocks)
    }

    /// The hole, with the code of its cycle and all that the cycle was told.
    fn again(&self, hole: &Hole<'_>) -> Result<Nc, &'static str> {
        let (places, rest) = hole.parts();
        let repeat = hole.nc.word(Role::Repeat).map(|times| NcItem::Word(Role::Repeat, times.clone()));
        let items = self.words(hole, rest)?.into_iter();
        let (codes, words): (Vec<_>, Vec<_>) = items.partition(|item| matches!(item, NcItem::Op(_)));
        Ok(Nc { items: codes.into_iter().chain(places).chain(words).chain(repeat).collect() })
    }

    /// The code of the cycle and its words, in a block that has these beside its place.
    fn words(&self, hole: &Hole<'_>, rest: Vec<NcItem>) -> Result<Vec<NcItem>, &'static str> {
        if !hole.goes_on() {
            return Ok(rest);
        }
        if hole.skipped || !self.told.is_whole(hole.state) {
            return Err(MIXED);
        }
        let lasting = lasting(hole.op);
        let told = self.told.words().map(|(role, value)| NcItem::Word(*role, value.clone()));
        let own = |item: &NcItem| match item {
            NcItem::Op(op) => !op.is_hole(),
            NcItem::Word(role, _) => !lasting.contains(role),
            NcItem::Code(..) => true,
        };
        Ok(self.told.op.map(NcItem::Op).into_iter().chain(told).chain(rest.into_iter().filter(own)).collect())
    }
}

/// A cycle that begins at its retract plane.
fn at_its_plane(mut nc: Nc) -> Nc {
    for item in &mut nc.items {
        if let NcItem::Word(Role::CycleRStep, value) = item {
            *value = Expr::Number(0.0);
        }
    }
    nc
}

impl Hole<'_> {
    /// True where a cycle is in force before it, or may be.
    fn goes_on(&self) -> bool {
        self.before.op(Group::Cycle) != Some(Op::CycleOff)
    }

    /// The words of its place, and what else it has, without repeats.
    fn parts(&self) -> (Vec<NcItem>, Vec<NcItem>) {
        let depth = &lasting(self.op)[2..];
        let is_place =
            |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis() && !depth.contains(role));
        let repeats = |item: &&NcItem| !matches!(item, NcItem::Word(Role::Repeat, _));
        self.nc.items.iter().filter(repeats).cloned().partition(is_place)
    }

    /// A rapid along the hole, by a radius where it goes along X.
    fn along(&self, by: f64) -> Nc {
        let (role, by) = if self.op.is_side_hole() { (Role::StepX, 2.0 * by) } else { (Role::StepZ, by) };
        Nc { items: vec![NcItem::Op(Op::Rapid), NcItem::Word(role, Expr::Number(by))] }
    }

    /// What goes after a rapid, so that the block after the cycle moves as it did.
    fn motion(&self) -> Result<Option<Nc>, &'static str> {
        match self.before.op(Group::Motion) {
            _ if self.skipped => Err(EMULATION),
            Some(Op::Rapid) => Ok(None),
            Some(Op::Linear) => Ok(Some(Nc { items: vec![NcItem::Op(Op::Linear)] })),
            _ => Err(EMULATION),
        }
    }
}

const UNKNOWN: &str = "whether holes end at the level where the cycle began (G98) or at the retract plane (G99) is not known here";
const MIXED: &str =
    "holes of one drilling cycle end at two levels: the target always goes back to where the cycle began";
const PLANE: &str = "the retract plane of a hole that ends there (G99) is computed, or changes in the cycle: the target always goes back to where it began";
const EMULATION: &str = "a hole that ends at its retract plane (G99) has computed repeats or a block skip, or what moves before it is neither G0 nor \
                         G1, or not known: the target always goes back to where the cycle began";
const HELP: &str = "write G98 before the cycle, or G0 and a move to the retract plane, and R as 0 in the cycle; or say in the source's profile how a \
                    program begins: [start] codes";

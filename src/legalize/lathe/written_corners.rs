//! Corners of a lathe, and lines by their angle, written out as moves.
//!
//! Law: a line that a corner cuts short ends where the corner begins; a chamfer is a straight feed move, a round an arc by its radius, by the
//! turn of the lines; a line by its angle ends at the place that is worked out. Places are rounded to the target's least increment. Side conditions:
//! all coordinates are numbers, it is known where the first line begins, and the run goes straight through the blocks. Counter-example:
//! `Z-20. ,R3.` before `X#500`.
//!
//! It is done where the target has no words for them, where nobody confirms what its word for an angle means, and where its profile says so;
//! elsewhere the words stay.

use super::contour_starts::{At, Contours};
use super::drawn_lines::{self, Fault, Line, Words, fault, is_open, read, waits};
use super::place::Place;
use super::settings::takes;
use super::straight::{entered_straight, goes_on_to};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question, Units};
use crate::ir::{BlockId, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::BTreeMap;

/// True for corners and angles of a lathe for a lathe.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let roles = [Role::LineAngle, Role::CornerChamfer, Role::CornerRadius];
    let lathes = [context.source, context.target].iter().all(|control| control.machine() == Machine::Lathe);
    lathes && roles.iter().any(|role| features.role(*role))
}

/// What becomes of words on the target.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    /// They stay.
    Kept,
    /// They are written out if that can be done.
    Asked,
    /// They must be written out.
    Lacking,
}

/// Of corners, and of angles.
fn fates(source: &Control, target: &Control) -> [Fate; 2] {
    if target.behaviour(Question::Corners).is_some_and(|row| row.value == "moves") {
        return [Fate::Lacking; 2];
    }
    let clash = |role: Role| target.clash(|_| false, |found| (found == role).then_some(None)).is_some();
    let corners =
        if clash(Role::CornerChamfer) || clash(Role::CornerRadius) { Fate::Lacking } else { Fate::Kept };
    let known =
        target.behaviour(Question::LineAngle).filter(|row| row.origin.is_settled() && row.value != "unknown");
    let angles = match (takes(target, Op::Linear, Role::LineAngle), known) {
        (false, _) => Fate::Lacking,
        (true, Some(_)) => Fate::Kept,
        // Whatever it means, it means the same there.
        (true, None) if source.name() == target.name() => Fate::Kept,
        (true, None) => Fate::Asked,
    };
    [corners, angles]
}

/// Writes them out; true where anything changed.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let fates = fates(context.source, context.target);
    let facts = context.modal_facts(module);
    let steps = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let has_steps = steps.into_iter().any(|stmt| stmt.kind.has_op(Op::Incremental));
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let numbers = context.target.numbers();
        let mut walk = Walk {
            program,
            straight: entered_straight(program),
            contours: Contours::of(program),
            fates,
            foreign: context.source.name() != context.target.name(),
            has_steps,
            increments: [numbers.increment_mm, numbers.increment_inch],
            inch: context.target.units() == Some(Units::Inch),
            made: BTreeMap::new(),
            ends: BTreeMap::new(),
            said: Vec::new(),
        };
        walk.all(|at| facts.at(index, BlockId(at as u32)));
        let Walk { made, said, .. } = walk;
        changed |= !made.is_empty();
        for (at, stmts) in made.into_iter().rev() {
            let block = program.blocks.get_mut(at.0);
            if let Some(block) = block.filter(|block| at.1 < block.stmts.len()) {
                let mut all: Vec<Stmt> = std::mem::take(&mut block.stmts).into_iter().collect();
                all.splice(at.1..=at.1, stmts);
                block.stmts = all.into_iter().collect::<Stmts>();
            }
        }
        for said in said {
            match said {
                Said::Angle(span, kept) => {
                    context.rests_on_source(index, span, Question::LineAngle);
                    if kept {
                        context.rests_on_target(index, span, Question::LineAngle);
                    }
                }
                // A parameter may say that a comma is an alarm.
                Said::Comma(span) if context.target.corner_setting().is_some() => {
                    context.rests_on_target(index, span, Question::CornerLetters);
                }
                Said::Comma(_) => {}
                Said::Refused(span, what) => {
                    let found = Diagnostic::new(Code::NoEquivalent, span, what);
                    context.add(
                        index,
                        found.with_help("write the corner as moves, and X and Z of the end of each line"),
                    );
                }
            }
        }
    }
    changed
}

/// What there is to say.
enum Said {
    /// The angle of a line stands there; true where the target has its word.
    Angle(Span, bool),
    /// A corner keeps its comma.
    Comma(Span),
    /// It cannot be done.
    Refused(Span, String),
}

/// What stands in the place of each of some lines, and where the last one ends, if that is known.
type Written = (Vec<Vec<Stmt>>, Option<[f64; 2]>);

/// A way through a program.
struct Walk<'p> {
    program: &'p Program,
    straight: Vec<bool>,
    contours: Contours,
    fates: [Fate; 2],
    /// True where the target is another control.
    foreign: bool,
    /// True where a mode of the library tells increments.
    has_steps: bool,
    /// The target's least increments: millimetres, inches.
    increments: [f64; 2],
    /// True where a program that names no unit counts inches.
    inch: bool,
    /// What stands in a statement's place.
    made: BTreeMap<At, Vec<Stmt>>,
    /// Where lines end that are written out: X, a diameter, and Z.
    ends: BTreeMap<At, [f64; 2]>,
    said: Vec<Said>,
}

impl<'p> Walk<'p> {
    fn all(&mut self, facts: impl Fn(usize) -> Modal) {
        let (mut place, mut done) = (Place::default(), (0, 0));
        for (at, block) in self.program.blocks.iter().enumerate() {
            let mut state = facts(at);
            if !self.straight.get(at).is_some_and(|straight| *straight) {
                place = Place::default();
            }
            for (count, stmt) in block.stmts.iter().enumerate() {
                let inside = place.in_contour();
                place.enter(stmt);
                let start = stmt.site.sequence.get().and_then(|number| self.contours.starts.get(&number));
                match start {
                    Some([x, z]) if !inside && place.in_contour() => place.knows(*x, *z),
                    // The run comes to it by itself, too.
                    Some([x, z]) => place.agrees(*x, *z),
                    None => {}
                }
                let here = (at, count);
                let drawn = |nc: &Nc| {
                    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_drawn()))
                };
                if here >= done && stmt.kind.nc().is_some_and(drawn) {
                    done = self.chain(here, &state, &place);
                }
                state.step(stmt);
                let inside = place.in_contour();
                match self.made.get(&here) {
                    Some(stmts) => stmts.iter().for_each(|stmt| place.step(stmt)),
                    None => place.step(stmt),
                }
                // The next line begins where this one ends, and not where its words are rounded to.
                if let Some([x, z]) = self.ends.get(&here).filter(|_| place.in_contour() == inside) {
                    place.lies_at(*x, *z);
                }
            }
        }
    }

    fn stmt(&self, at: At) -> Option<&'p Stmt> {
        self.program.blocks.get(at.0)?.stmts.get(at.1)
    }

    /// The next statement that is more than a comment, where the run always comes to it from here.
    fn next(&self, at: At) -> Option<At> {
        let (mut block, mut count) = (at.0, at.1 + 1);
        loop {
            let here = self.program.blocks.get(block)?;
            let rest = here.stmts.get(count..)?;
            if let Some(found) = rest.iter().position(|stmt| !matches!(stmt.kind, StmtKind::Comment)) {
                return Some((block, count + found));
            }
            let straight = self.straight.get(block + 1).is_some_and(|straight| *straight);
            if !straight || !goes_on_to(&here.term.kind, block + 1) {
                return None;
            }
            (block, count) = (block + 1, 0);
        }
    }

    /// The lines from one on that belong together, and what is wrong with them.
    fn lines(&self, first: At) -> (Vec<At>, Result<(), Fault>) {
        let mut all = vec![first];
        let mut before = None;
        loop {
            let at = *all.last().unwrap_or(&first);
            let Some(nc) = self.stmt(at).and_then(|stmt| stmt.kind.nc()) else {
                return (all, Err(NO_MOVE.into()));
            };
            if let Some(what) = fault(nc, before) {
                return (all, Err(what.into()));
            }
            if !waits(nc) {
                return (all, Ok(()));
            }
            match self.next(at) {
                Some(next) if !self.contours.together(at, next) => return (all, Err(CONTOUR.into())),
                Some(next) => all.push(next),
                None => return (all, Err(NO_MOVE.into())),
            }
            before = Some(nc);
        }
    }

    /// Looks at the lines from one on; the place after them.
    fn chain(&mut self, first: At, state: &Modal, place: &Place) -> At {
        let (all, well) = self.lines(first);
        let blocks: Vec<&Stmt> = all.iter().filter_map(|at| self.stmt(*at)).collect();
        let ncs: Vec<&Nc> = blocks.iter().filter_map(|stmt| stmt.kind.nc()).collect();
        let last = all.last().copied().unwrap_or(first);
        let (span, after) =
            (blocks.first().map_or_else(Span::default, |stmt| stmt.site.span), (last.0, last.1 + 1));
        let has = |role: Role| ncs.iter().any(|nc| nc.word(role).is_some());
        // What a corner with a sign is that could not do without it was said.
        let signed =
            [Role::ChamferX, Role::ChamferZ, Role::ChamferNext, Role::RoundNext].into_iter().any(has);
        let angles = has(Role::LineAngle);
        let corners = has(Role::CornerChamfer) || has(Role::CornerRadius);
        let fate = match (corners && self.fates[0] == Fate::Lacking, angles, self.fates[1]) {
            (true, ..) | (_, true, Fate::Lacking) => Fate::Lacking,
            (_, true, Fate::Asked) => Fate::Asked,
            // Of a contour a note of the maker forbids it (docs/lathe.md R9).
            (_, true, Fate::Kept) if self.foreign && self.contours.inside(first) => Fate::Asked,
            _ => Fate::Kept,
        };
        if signed {
            return after;
        }
        let made = well.and_then(|()| self.write(&blocks, state, place));
        let kept = match made {
            Err(Fault::Source(_)) => false,
            Err(Fault::Unknown(_)) => fate != Fate::Lacking,
            Ok(_) => fate == Fate::Kept,
        };
        if angles {
            self.said.push(Said::Angle(span, kept));
        }
        if corners && kept {
            self.said.push(Said::Comma(span));
        }
        match made {
            Ok((made, end)) if !kept => {
                self.made.extend(all.into_iter().zip(made));
                self.ends.extend(end.map(|end| (last, end)));
                return after;
            }
            Err(Fault::Source(what) | Fault::Unknown(what)) if !kept => {
                self.said.push(Said::Refused(span, what))
            }
            _ => {}
        }
        // The letter of an angle means that beside the code alone.
        for (at, stmt) in all.into_iter().zip(&blocks) {
            if let StmtKind::Nc(nc) = &stmt.kind
                && nc.word(Role::LineAngle).is_some()
                && !nc.has(Op::Linear)
            {
                let items = std::iter::once(NcItem::Op(Op::Linear)).chain(nc.items.iter().cloned());
                let kind = StmtKind::Nc(Nc { items: items.collect() });
                self.made.insert(at, vec![Stmt { kind, site: stmt.site.clone() }]);
            }
        }
        after
    }

    /// What stands in the place of each of the lines.
    fn write(&self, blocks: &[&Stmt], state: &Modal, place: &Place) -> Result<Written, Fault> {
        let ncs: Vec<&Nc> = blocks.iter().filter_map(|stmt| stmt.kind.nc()).collect();
        if blocks.iter().any(|stmt| stmt.site.skip.is_some()) {
            return Err(
                "a block that may be skipped stands beside this corner, or is the one after it".into()
            );
        }
        let begins = |stmt: &&&Stmt| {
            stmt.site.sequence.get().is_some_and(|number| self.contours.starts.contains_key(&number))
        };
        let angled = |stmt: &&Stmt| stmt.kind.nc().is_some_and(|nc| nc.word(Role::LineAngle).is_some());
        if blocks.iter().filter(begins).any(angled) {
            return Err(Fault::Unknown(FIRST.into()));
        }
        if state.may_call() {
            return Err(Fault::Unknown("a modal call is in force, which would run after each move".into()));
        }
        let own = ncs.first().is_some_and(|nc| nc.has(Op::Linear));
        match state.op(Group::Motion).filter(|_| !own) {
            None if !own => {
                return Err(Fault::Unknown("which code of motion is in force is not known here".into()));
            }
            Some(op) if op != Op::Linear => return Err(NOT_STRAIGHT.into()),
            _ => {}
        }
        if !matches!(state.op(Group::Plane), None | Some(Op::PlaneZx)) {
            return Err(Fault::Unknown("whether the plane of Z and X is in force is not known here".into()));
        }
        let own = ncs.first().and_then(|nc| nc.ops().filter(|op| op.group() == Group::Distance).last());
        let steps = match own.or(state.op(Group::Distance)) {
            None if self.has_steps => {
                return Err(Fault::Unknown(
                    "whether X and Z are increments here (G90, G91) is not known".into(),
                ));
            }
            mode => mode == Some(Op::Incremental),
        };
        let line = |(at, nc): (usize, &&Nc)| read(nc, steps, (at == 0, at + 1 == ncs.len()));
        let lines = ncs.iter().enumerate().map(line).collect::<Result<Vec<Line>, Fault>>()?;
        let start = if steps { [None; 2] } else { [place.x().map(|x| x / 2.0), place.z()] };
        let relative = drawn_lines::relative(&lines, start)?;
        let drawn = drawn_lines::solve(&lines, start.map(Option::unwrap_or_default))?;
        let inch = state.op(Group::Units).map_or(self.inch, |op| op == Op::Inch);
        let words = Words { steps, relative, increment: self.increments[usize::from(inch)] };
        let mut after_arc = false;
        let mut out = Vec::with_capacity(blocks.len());
        for ((stmt, line), nc) in blocks.iter().zip(&drawn).zip(&ncs) {
            let ends = lines.get(out.len()).is_some_and(|line| line.corner.is_none() && line.angle.is_none());
            let mut nc = words.line(nc, line, ends && !is_open(nc));
            if after_arc && !nc.has(Op::Linear) {
                nc.items.insert(0, NcItem::Op(Op::Linear));
            }
            let mut all = vec![Stmt { kind: StmtKind::Nc(nc), site: stmt.site.clone() }];
            after_arc = false;
            if let Some(corner) = line.corner {
                let mut items = Vec::new();
                if let Some(arc) = corner.arc {
                    items.push(NcItem::Op(if arc.ccw { Op::ArcCcw } else { Op::ArcCw }));
                    after_arc = true;
                }
                items.extend(words.ways(line.to, corner.to, [false; 2]));
                items.extend(corner.arc.iter().flat_map(|arc| words.arc(line.to, arc)));
                let site = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
                all.push(Stmt { kind: StmtKind::Nc(Nc { items }), site });
            }
            out.push(all);
        }
        let known = !steps && relative == [false; 2];
        let end = drawn.last().filter(|_| known).map(|line| [2.0 * line.to[0], line.to[1]]);
        Ok((out, end))
    }
}

const NOT_STRAIGHT: &str = "a corner or an angle in a block that is no straight feed move";
const FIRST: &str = "the first block of a contour has an angle: by X and Z in its place the cycle would take it for a contour of another kind";
const NO_MOVE: &str = "the block after this corner, or after this line by its angle alone, must be a straight feed move that the run \
                       always comes to: otherwise the source stops at an alarm";
const CONTOUR: &str =
    "a contour begins or ends between this corner and the next block: the source stops at an alarm";

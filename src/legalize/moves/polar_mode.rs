//! Polar coordinates that a code switches on, by rectangular ones, on a target that has none.
//!
//! Law: while they are in force, X is the distance d from the zero of the coordinates, and Y the angle a from the X axis,
//! counter-clockwise, in degrees: the point is `d*COS[a]`, `d*SIN[a]`. A word that is left out is what it was last, and an angle
//! under G91 adds to it; a count of such a block is a block for each place. What was last said is a number if it is the same on
//! every way, or else it is kept in a register. Source: page 147 of the manual that the row of the code names.
//!
//! Side conditions, each refused by name: the plane is XY; whether polar coordinates are in force is known at each move; what a
//! block leaves out was said before; the distance is absolute. Counter-example: `G91 X10.`, whose distance counts from where the
//! tool is.

mod ends;
mod known;

use super::increments::parts_of_unit;
use super::rotations::reads_position;
use super::short_arcs::{other_planes, vacant};
use crate::canon::{Func, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::ModalFacts;
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{
    BinOp, BlockId, Class, Expr, Module, Nc, NcItem, Place, SourceInfo, Stmt, StmtKind, Stmts, TermKind, Var,
    statics_of,
};
use crate::legalize::Context;
use crate::legalize::layout::blanks::is_empty;
use known::{Kept, Polar, Rules, count};
use std::collections::{BTreeMap, BTreeSet};

/// True if the target has no code for them.
pub fn concerns(target: &Control) -> bool {
    target.code_for(Op::PolarOn, &BTreeMap::new()).is_none()
}

/// The registers of the last distance and of the last angle.
const LENGTH: Var = Var { class: Class::Static, number: statics_of::POLAR };
const ANGLE: Var = Var { class: Class::Static, number: statics_of::POLAR + 1 };

const PLANE: &str =
    "polar coordinates in another plane than XY, or under an unknown one: write G17 before them";
const MIXED: &str = "polar coordinates are in force on some of the ways to this block, and the target has none: end them on every way";
const INCREMENTS: &str = "a polar distance under G91 counts from where the tool is, which is not followed: write the distance from the zero \
     under G90";
const UNKNOWN: &str =
    "it is not known whether G90 or G91 is in force at this polar move: write one before it";
const BESIDE: &str = "X and Y beside this code are not polar ones, or choose what they count from: end the polar coordinates before it";
const CENTRE: &str = "an arc in polar coordinates by its centre: write its radius R";
const OTHERS: &str = "other words stand beside an angle in increments: give them a block of their own";
const CALLS: &str =
    "an angle in increments, and a macro is called after each move: write the angle under G90";
const COUNT: &str = "the count of this block is not a whole number from 1 to 1000";
const BARE: &str = "the angle has no decimal point, and no source says which increments it counts: write one";
const VACANT: &str = "a word of this polar move may be vacant: give it a value in every run";
const POSITION: &str = "this reads the position under polar coordinates, and no source says whether it is a distance and an angle then";
const RETURNS: &str = "this returns with polar coordinates in force to callers that are not in the library, and the target has none: end \
     them before";
const ENDS: &str =
    "polar coordinates are in force at the end of this program: the next one is taken not to go on in them";

/// Writes polar coordinates as rectangular ones.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if ends::never_begin(module) {
        return ends::leave_out(module, context);
    }
    let facts = context.modal_facts(module);
    let summaries = context.summaries(module);
    let called = context.called(module);
    let (given, none) = (called.given(module), BTreeSet::new());
    let callees: BTreeSet<usize> = called.pairs(module).into_iter().map(|(_, callee)| callee).collect();
    let planes = other_planes(module, context);
    module.programs.iter_mut().for_each(plain_words);
    let known = OverCalls::of(module, &Rules { facts: &facts });
    let kept = registers(module, &facts, &known);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let vacant = vacant(program, &summaries, given.get(&index).unwrap_or(&none));
        let mut findings: Vec<(Code, &'static str, crate::text::Span)> = Vec::new();
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let Some(mut here) = known.at(index, id).copied() else { continue };
            let mut state = facts.at(index, id);
            let mut out = Stmts::with_capacity(block.stmts.len());
            for (stmt, vacant) in std::mem::take(&mut block.stmts).into_iter().zip(&vacant[at]) {
                let before = here;
                state.step(&stmt);
                here.step(&stmt, &state);
                let span = stmt.site.span;
                let mut reads = false;
                stmt.kind.exprs(&mut |e| reads |= reads_position(e));
                if before != Polar::Off && reads {
                    findings.push((Code::NoEquivalent, POSITION, span));
                }
                let rules = Move {
                    before,
                    after: here,
                    distance: state.op(Group::Distance),
                    flat: state.op(Group::Plane).map_or(!planes[index], |op| op == Op::PlaneXy),
                    vacant: vacant.contains(&true),
                    kept,
                    // A finer grid where the unit is not known.
                    parts: parts_of_unit(&state, context.source).unwrap_or(1e6),
                    calls: state.may_call(),
                };
                if let Err(why) = rules.write(stmt, &mut out) {
                    findings.push((Code::NoEquivalent, why, span));
                }
            }
            block.stmts = out;
            let end = match &block.term.kind {
                _ if here == Polar::Off => None,
                TermKind::Return { .. } if !callees.contains(&index) => Some((Code::NoEquivalent, RETURNS)),
                TermKind::End { .. } | TermKind::Stray => Some((Code::Conditional, ENDS)),
                _ => None,
            };
            findings.extend(end.map(|(code, what)| (code, what, block.term.site.span)));
        }
        for (code, what, span) in findings {
            context.add_once(index, what, Diagnostic::new(code, span, what));
        }
    }
}

/// Gives the words beside the code itself the letters that they have in the blocks after it.
fn plain_words(program: &mut crate::ir::Program) {
    let stmts = program.blocks.iter_mut().flat_map(|block| &mut block.stmts);
    let blocks = stmts.filter_map(|stmt| match &mut stmt.kind {
        StmtKind::Nc(nc) if nc.has(Op::PolarOn) => Some(nc),
        _ => None,
    });
    for item in blocks.flat_map(|nc| &mut nc.items) {
        if let NcItem::Word(role, _) = item {
            match role {
                Role::PolarDistance => *role = Role::X,
                Role::PolarAngle => *role = Role::Y,
                _ => {}
            }
        }
    }
}

/// Of distance and angle, whether a block of the library needs its register.
fn registers(module: &Module, facts: &ModalFacts, known: &OverCalls<Polar>) -> [bool; 2] {
    let mut kept = [false; 2];
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let Some(mut here) = known.at(index, id).copied() else { continue };
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                state.step(stmt);
                here.step(stmt, &state);
                let (StmtKind::Nc(nc), Polar::On { length, angle }) = (&stmt.kind, here) else { continue };
                let words = [Role::X, Role::Y].map(|role| nc.word(role).is_some());
                let adds = state.op(Group::Distance) == Some(Op::Incremental);
                kept[0] |= words[1] && !words[0] && length == Kept::Held;
                kept[1] |= (words[0] && !words[1] || words[1] && adds) && angle == Kept::Held;
            }
        }
    }
    kept
}

/// A block, and what is in force there.
struct Move {
    before: Polar,
    after: Polar,
    distance: Option<Op>,
    flat: bool,
    vacant: bool,
    /// True where a macro is called after each move.
    calls: bool,
    kept: [bool; 2],
    parts: f64,
}

impl Move {
    /// Writes the block; it stays as it was where it cannot be written.
    fn write(&self, mut stmt: Stmt, out: &mut Stmts) -> Result<(), &'static str> {
        let StmtKind::Nc(nc) = &mut stmt.kind else {
            out.push(stmt);
            return Ok(());
        };
        let switches = nc.has(Op::PolarOn) || nc.has(Op::PolarOff);
        let moves = nc.word(Role::X).is_some() || nc.word(Role::Y).is_some();
        let fault = match self.after {
            Polar::Off => None,
            _ if nc.ops().any(|op| op.group() == Group::Plane && op != Op::PlaneXy) => Some(PLANE),
            _ if !moves => None,
            Polar::Mixed => Some(MIXED),
            Polar::On { .. } => self.fault(nc),
        };
        nc.items.retain(|item| !matches!(item, NcItem::Op(Op::PolarOn | Op::PolarOff)));
        if switches && nc.items.is_empty() {
            stmt.kind = StmtKind::Comment;
            // The code was all of it.
            if is_empty(&stmt) {
                return Ok(());
            }
        }
        match (fault, self.after, &stmt.kind) {
            (None, Polar::On { length, angle }, StmtKind::Nc(_)) if moves => {
                self.rectangular(stmt, [length, angle], out)
            }
            (fault, ..) => {
                out.push(stmt);
                fault.map_or(Ok(()), Err)
            }
        }
    }

    fn fault(&self, nc: &Nc) -> Option<&'static str> {
        let arc = [Role::ArcI, Role::ArcJ].iter().any(|role| nc.word(*role).is_some());
        let adds = self.distance == Some(Op::Incremental);
        let own = |item: &NcItem| {
            matches!(item, NcItem::Word(Role::Y | Role::Repeat | Role::Feed, _))
                || matches!(item, NcItem::Op(Op::Incremental | Op::Rapid | Op::Linear))
        };
        match () {
            () if !self.flat => Some(PLANE),
            () if self.vacant => Some(VACANT),
            () if nc.word(Role::Y).is_some_and(is_bare) => Some(BARE),
            () if nc.ops().any(takes_axes) => Some(BESIDE),
            () if arc => Some(CENTRE),
            () if self.distance.is_none() => Some(UNKNOWN),
            () if adds && nc.word(Role::X).is_some() => Some(INCREMENTS),
            () if adds && self.calls => Some(CALLS),
            () if adds && !nc.items.iter().all(own) => Some(OTHERS),
            () if adds && count(nc).is_none() => Some(COUNT),
            () => None,
        }
    }

    /// Puts the place in the place of distance and angle.
    fn rectangular(&self, stmt: Stmt, after: [Kept; 2], out: &mut Stmts) -> Result<(), &'static str> {
        let Stmt { kind: StmtKind::Nc(mut nc), site } = stmt else { return Ok(()) };
        let aside = || SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
        let keep = |var, value| {
            let kind = StmtKind::Assign { target: Place::Var(var), value };
            Stmt { kind, site: aside() }
        };
        let [length, angle] = [Role::X, Role::Y].map(|role| nc.word(role).cloned());
        let said = match &length {
            Some(word) => Ok(word.clone()),
            None => after[0].value(LENGTH),
        };
        let said = said.and_then(|length| match (&angle, self.adds()) {
            (Some(word), false) => Ok((length, word.clone())),
            _ => after[1].value(ANGLE).map(|angle| (length, angle)),
        });
        let (far, turned) = match said {
            Ok(said) => said,
            Err(why) => {
                out.push(Stmt { kind: StmtKind::Nc(nc), site });
                return Err(why);
            }
        };
        if let (true, Some(word)) = (self.kept[0], &length) {
            out.push(keep(LENGTH, word.clone()));
        }
        let (Some(step), true) = (&angle, self.adds()) else {
            if let (true, Some(word)) = (self.kept[1], &angle) {
                out.push(keep(ANGLE, word.clone()));
            }
            place(&mut nc, self.point(&far, &turned));
            out.push(Stmt { kind: StmtKind::Nc(nc), site });
            return Ok(());
        };
        let times = count(&nc).unwrap_or(1.0);
        let from = match self.before {
            Polar::On { angle: Kept::Number(from), .. } if matches!(turned, Expr::Number(_)) => Some(from),
            _ => None,
        };
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Repeat, _) | NcItem::Op(Op::Incremental)));
        nc.items.insert(0, NcItem::Op(Op::Absolute));
        let mut site = site.clone();
        for at in 1..=times as u32 {
            let turned = match (from, step.constant()) {
                (Some(from), Some(step)) => Expr::Number(step.mul_add(f64::from(at), from)),
                _ => turned.clone(),
            };
            if self.kept[1] {
                let value = match from {
                    Some(_) => turned.clone(),
                    None => Expr::binary(BinOp::Add, Expr::Var(ANGLE), step.clone()),
                };
                out.push(keep(ANGLE, value));
            }
            place(&mut nc, self.point(&far, &turned));
            let own = nc.clone();
            // Words that are in force need not be said again.
            nc.items.retain(|item| matches!(item, NcItem::Word(Role::X | Role::Y, _)));
            let rest = SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
            out.push(Stmt { kind: StmtKind::Nc(own), site: std::mem::replace(&mut site, rest) });
        }
        let back = Nc { items: [NcItem::Op(Op::Incremental)].into_iter().collect() };
        out.push(Stmt { kind: StmtKind::Nc(back), site });
        Ok(())
    }

    fn adds(&self) -> bool {
        self.distance == Some(Op::Incremental)
    }

    /// The point of a distance and an angle; of numbers, to the least increment.
    fn point(&self, far: &Expr, turned: &Expr) -> [Expr; 2] {
        if let (Some(far), Some(turned)) = (far.constant(), turned.constant()) {
            let (sin, cos) = turned.to_radians().sin_cos();
            // No minus before 0.
            let counted = |place: f64| Expr::Number((place * self.parts).round() / self.parts + 0.0);
            return [counted(far * cos), counted(far * sin)];
        }
        [Func::Cos, Func::Sin].map(|function| {
            let part = Expr::Call(function, [turned.clone()].into());
            Expr::binary(BinOp::Mul, far.clone(), part)
        })
    }
}

/// True for a code whose X and Y are no place to go to in polar coordinates.
fn takes_axes(op: Op) -> bool {
    use Op::{ArcTangent, Home, Probe, ProbeOther, Reference2, ReferenceCheck, ReferenceReturn, Thread};
    use Op::{LocalShift, MachineOnce, Pole, ReferenceFrom, RotateOn, SetPosition, StrokeCheckOn, WriteWork};
    matches!(op.group(), Group::Scaling | Group::Mirror)
        || matches!(op, LocalShift | SetPosition | WriteWork | MachineOnce | RotateOn | Pole | StrokeCheckOn)
        || matches!(op, ReferenceReturn | ReferenceFrom | Reference2 | ReferenceCheck | Home)
        || matches!(op, Probe | ProbeOther | Thread | ArcTangent)
}

/// True for a number that counts increments.
fn is_bare(word: &Expr) -> bool {
    let mut bare = false;
    word.walk(&mut |part| bare |= matches!(part, Expr::Increments(_)));
    bare
}

/// Puts X and Y where the first of them stands.
fn place(nc: &mut Nc, [x, y]: [Expr; 2]) {
    let is_own = |item: &NcItem| matches!(item, NcItem::Word(Role::X | Role::Y, _));
    let at = nc.items.iter().position(is_own).unwrap_or(nc.items.len());
    nc.items.retain(|item| !is_own(item));
    nc.items.splice(at..at, [NcItem::Word(Role::X, x), NcItem::Word(Role::Y, y)]);
}

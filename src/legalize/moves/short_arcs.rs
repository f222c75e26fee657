//! Arcs, on a control that takes their radius and is not known to take their centre.
//!
//! Law: an arc of at most 180 degrees is the one of its radius between its ends, so a centre becomes the distance to it, and
//! an arc of more is a row of shorter ones about the same centre. Pieces are a third of a turn at the most; their ends are
//! rounded to 0.00001 of the unit, less than the control resolves, and lie on the arc within that. Where all words are one
//! variable, its opposite and zero, the arc's shape is known though its size is not, and where only the words of one axis stand
//! there the arc is a half turn. A radius from a variable is written with its opposite, as the target's shorter arc has a minus.
//!
//! Where the centre or the ends are variables otherwise, the run finds the sweep and cuts the arc ([`turn`]); where it begins is
//! kept from the move before ([`starts`]).
//!
//! Side conditions: the plane is XY and nothing moves along Z; absolute arcs of a centre begin where the text says; the radius
//! from a variable is not negative on the run, which the verifier tries. Counter-example: `G2 X#1 Y#2 I#3 J#4`
//! after a call that moves.

mod plan;
mod shape;
mod starts;
mod turn;

use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::Modal;
use crate::ir::{
    BlockId, Callee, Class, Expr, Module, Nc, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Var,
};
use crate::legalize::calls::standing;
use crate::legalize::{Context, calls_of};
use crate::text::Span;
use plan::{Library, Plan};
use shape::{Arc, Size};
pub(super) use starts::{Vacant, vacant};
pub(in crate::legalize) use starts::{keeps, stands};
use std::collections::BTreeSet;
use turn::Turn;

/// True if the target takes a radius, and no source says from where a centre counts there, or the shorter arc has a minus: its
/// arcs are then written by their radius, whatever its profile says of centres.
pub fn concerns(target: &Control) -> bool {
    let is = |question, value| target.behaviour(question).is_some_and(|row| row.value == value);
    let unknown = target.behaviour(Question::ArcCentre).is_none_or(|row| row.value == "unknown");
    let opposite = is(Question::ArcRadiusNegative, "short");
    (unknown || opposite) && target.letter(Role::ArcRadius, None).is_some()
}

const PLANE: &str = "an arc in another plane than XY: no source says what the target's planes do";
const HELIX: &str =
    "an arc that moves along Z too: no source says whether the target takes it. Write it as straight moves";
const START: &str = "where this arc begins is not known, and the target takes no centre: write X and Y in absolute numbers in the move before";
const LONG: &str = "an arc of more than 180 degrees by its radius: where it begins is not known, so it cannot be cut. Write X and Y in \
     absolute numbers in the move before";
const COMPUTED: &str = "an arc by a centre from variables may be of more than 180 degrees, and the target takes a radius: it is cut only \
     where its block has no other words, codes or compensation than F. Put them into a block before it";
const VACANT: &str = "a word of this arc may be vacant, and the target takes a radius, which is worked out from the words: give each of \
     them a value in every run";
const DISTANCE: &str = "it is not known whether G90 or G91 is in force at this arc: write one before it";
const OFF: &str = "the end of this arc does not lie on it: its distance from the centre is another one than that of the start";
const BEGINS: &str = "absolute coordinates are taken to be in force where this program begins: it names neither G90 nor G91 before this \
     block";
const ENDS: &str = "the end of this arc is taken to lie on it: the target takes a radius, which is worked out from I and J, and no end that \
     is off the arc";
const POSITIVE: &str = "the radius of this arc is taken to be positive, an arc of at most 180 degrees: the target has the sign the other way \
     round, and no source says what a positive one means there";

/// What becomes of a statement.
enum Made {
    Kept,
    Pieces(Vec<Stmt>),
    Turn(Turn),
}

/// Writes arcs by their radius.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let (open, facts) = (context.modal_facts(module), context.facts_from_absolute(module));
    let summaries = context.summaries(module);
    let planes = other_planes(module, context);
    let still = starts::still(module);
    let (given, none) = (context.called(module).given(module), BTreeSet::new());
    for (index, program) in module.programs.iter_mut().enumerate() {
        let modal = |id| facts.at(index, id);
        let given = given.get(&index).unwrap_or(&none);
        let library = Library { summaries: &summaries, still: &still, given, other_planes: planes[index] };
        let begins = begins(program, &|id| open.at(index, id), &modal);
        let mut plan = Plan::of(program, &library, &modal, &|span| context.is_faulty(index, span));
        for (what, span) in &plan.refused {
            context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, *span, *what));
        }
        for (text, spans, predicate) in [
            (
                POSITIVE,
                std::mem::take(&mut plan.positive),
                Predicate::ShortArcs as fn(Vec<Span>) -> Predicate,
            ),
            (ENDS, std::mem::take(&mut plan.turned), Predicate::ArcEnds),
        ] {
            if let Some(first) = spans.first().copied() {
                let finding = Diagnostic::new(Code::Conditional, first, text);
                context.add(index, finding.assuming(predicate(spans)));
            }
        }
        if let Some(span) = begins.filter(|_| plan.rests) {
            context.add_once(index, BEGINS, Diagnostic::new(Code::Conditional, span, BEGINS));
        }
        if plan.changes {
            plan.lay(program);
        }
    }
}

/// The first move of a program that is absolute only if the program begins so.
fn begins(
    program: &Program,
    open: &dyn Fn(BlockId) -> Modal,
    from_absolute: &dyn Fn(BlockId) -> Modal,
) -> Option<Span> {
    for (id, block) in program.ids().zip(&program.blocks) {
        let (mut open, mut absolute) = (open(id), from_absolute(id));
        for stmt in &block.stmts {
            open.step(stmt);
            absolute.step(stmt);
            let moves = stmt.kind.nc().is_some_and(Nc::moves);
            if moves && open.op(Group::Distance).is_none() && absolute.op(Group::Distance).is_some() {
                return Some(stmt.site.span);
            }
        }
    }
    None
}

/// The programs that name another plane than XY, or that call or are called by one that may be in another. One that stands
/// in the machine may leave any.
pub(super) fn other_planes(module: &Module, context: &Context<'_>) -> Vec<bool> {
    let names = |nc: &Nc| nc.ops().any(|op| op.group() == Group::Plane && op != Op::PlaneXy);
    let stmts = |program: &Program| {
        program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc()).any(names)
    };
    let mut others: Vec<bool> = module.programs.iter().map(stmts).collect();
    standing::callers(module, context).keys().for_each(|caller| others[*caller] = true);
    let place = |callee: &Callee| {
        module
            .programs
            .iter()
            .position(|p| matches!(callee, Callee::Program(name) if p.name.as_ref() == Some(name)))
    };
    let calls = |program: &Program| -> Vec<Option<usize>> {
        program.blocks.iter().flat_map(calls_of).map(|call| place(&call.callee)).collect()
    };
    let calls: Vec<Vec<Option<usize>>> = module.programs.iter().map(calls).collect();
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (index, callees) in calls.iter().enumerate() {
            for callee in callees.iter().flatten().copied() {
                let either = others[index] || others[callee];
                changed |= either && !(others[index] && others[callee]);
                (others[index], others[callee]) = (either, either);
            }
        }
    }
    others
}

/// From the start of an arc to its centre, by its radius and the way to its end; none if there is no such arc.
pub(super) fn centre(way: [f64; 2], radius: f64, ccw: bool) -> Option<[f64; 2]> {
    Arc::by_radius(way, radius, ccw).map(|arc| arc.centre().map(round))
}

/// True for a block with words of an arc's centre or radius.
fn has_shape(nc: &Nc) -> bool {
    [Role::ArcI, Role::ArcJ, Role::ArcK, Role::ArcRadius].iter().any(|role| nc.word(*role).is_some())
}

/// True for a block that moves along an arc.
pub(super) fn is_arc(nc: &Nc, state: &Modal) -> bool {
    let arc = matches!(state.op(Group::Motion), Some(Op::ArcCw | Op::ArcCcw));
    let drills = state.op(Group::Cycle).is_some_and(Op::is_cycle);
    arc && has_shape(nc) && !drills && !nc.ops().any(Op::takes_axes)
}

struct Maker<'m> {
    temps: &'m mut u32,
    /// True if a radius is taken to be positive.
    positive: bool,
}

/// Digits that words keep.
fn round(number: f64) -> f64 {
    (number * 1e5).round() / 1e5 + 0.0
}

impl Maker<'_> {
    /// What stands for an arc.
    fn arc(
        &mut self,
        stmt: &Stmt,
        state: &Modal,
        start: Option<[Expr; 2]>,
        planes: bool,
    ) -> Result<Vec<Stmt>, &'static str> {
        let StmtKind::Nc(nc) = &stmt.kind else { return Ok(Vec::new()) };
        let in_xy = matches!(state.op(Group::Plane), Some(Op::PlaneXy))
            || state.op(Group::Plane).is_none() && !planes;
        if !in_xy || nc.word(Role::ArcK).is_some() {
            return Err(PLANE);
        }
        if nc.word(Role::Z).is_some() {
            return Err(HELIX);
        }
        let distance = state.op(Group::Distance);
        let incremental = distance == Some(Op::Incremental);
        let ccw = state.op(Group::Motion) == Some(Op::ArcCcw);
        let ends = [Role::X, Role::Y].map(|role| nc.word(role));
        let closed = ends.iter().all(Option::is_none);
        let centre = [Role::ArcI, Role::ArcJ].map(|role| nc.word(role));
        let start = start.map(|start| start.map(|word| word.constant()));
        let start = match start {
            Some([Some(x), Some(y)]) => Some([x, y]),
            _ => None,
        };
        // The way from the start to the end, where it is a number.
        let way = || -> Option<[f64; 2]> {
            let mut way = [0.0; 2];
            for (axis, end) in ends.iter().enumerate() {
                let Some(end) = end else { continue };
                way[axis] = end.constant()? - if incremental { 0.0 } else { start?[axis] };
            }
            Some(way)
        };
        if let Some(radius) = nc.word(Role::ArcRadius) {
            return match radius.constant() {
                // Beside words of variables the number goes to one too.
                Some(number)
                    if number >= 0.0 && ends.iter().flatten().any(|end| end.constant().is_none()) =>
                {
                    let radius = radius.clone();
                    Ok(self.by_variable(stmt, nc, radius))
                }
                // About half a turn: digits that the end has lost would move the centre far along.
                Some(radius) if radius >= 0.0 => {
                    let way = distance.and_then(|_| way());
                    let half = way.and_then(|way| Arc::by_radius(way, radius, ccw));
                    match half.filter(|arc| arc.pieces() > 1) {
                        Some(arc) => Ok(self.pieces(stmt, &arc, &Size::One, (incremental, start))),
                        None => Ok(vec![stmt.clone()]),
                    }
                }
                Some(radius) => {
                    distance.ok_or(DISTANCE)?;
                    let way = way().ok_or(LONG)?;
                    let arc = Arc::by_radius(way, radius, ccw).ok_or(OFF)?;
                    Ok(self.pieces(stmt, &arc, &Size::One, (incremental, start)))
                }
                None => {
                    self.positive = true;
                    let radius = radius.clone();
                    Ok(self.by_variable(stmt, nc, radius))
                }
            };
        }
        if distance.is_none() && !closed {
            return Err(DISTANCE);
        }
        if centre.iter().flatten().all(|word| word.constant().is_some()) {
            let centre = centre.map(|word| word.and_then(Expr::constant).unwrap_or(0.0));
            let way = way().ok_or(if incremental { COMPUTED } else { START })?;
            let arc = Arc::about(way, centre, ccw);
            if arc.off() > 0.005 {
                return Err(OFF);
            }
            return Ok(self.pieces(stmt, &arc, &Size::One, (incremental, start)));
        }
        if !incremental && !closed {
            return Err(COMPUTED);
        }
        let (arc, size) = shape::of(ends, centre, ccw).ok_or(COMPUTED)?;
        Ok(self.pieces(stmt, &arc, &size, (true, None)).into_iter().collect::<Vec<_>>()).map(|mut made| {
            if !incremental {
                switch(&mut made);
            }
            made
        })
    }

    fn temp(&mut self) -> Var {
        *self.temps += 1;
        Var { class: Class::Temp, number: *self.temps }
    }

    /// The same block with a radius from a variable, as the target writes it.
    fn by_variable(&mut self, stmt: &Stmt, nc: &Nc, radius: Expr) -> Vec<Stmt> {
        if matches!(&radius, Expr::Negate(inner) if matches!(**inner, Expr::Var(_)) && !inner.may_be_vacant())
        {
            return vec![stmt.clone()];
        }
        let temp = self.temp();
        let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
        let value = Expr::Negate(Box::new(radius));
        let first = Stmt { kind: StmtKind::Assign { target: Place::Var(temp), value }, site };
        let mut nc = nc.clone();
        for item in &mut nc.items {
            if let NcItem::Word(Role::ArcRadius, value) = item {
                *value = Expr::Negate(Box::new(Expr::Var(temp)));
            }
        }
        vec![first, Stmt { kind: StmtKind::Nc(nc), site: stmt.site.clone() }]
    }

    /// The arc in as many pieces as it needs.
    fn pieces(
        &mut self,
        stmt: &Stmt,
        arc: &Arc,
        size: &Size,
        (incremental, start): (bool, Option<[f64; 2]>),
    ) -> Vec<Stmt> {
        let StmtKind::Nc(nc) = &stmt.kind else { return Vec::new() };
        let aside = || SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
        let mut out = Vec::new();
        let radius = match size {
            Size::One => Expr::Number(clean(arc.radius())),
            Size::Of(unit) => {
                let temp = self.temp();
                let value = Expr::Negate(Box::new(size.radius(unit, arc.radius())));
                out.push(Stmt { kind: StmtKind::Assign { target: Place::Var(temp), value }, site: aside() });
                Expr::Negate(Box::new(Expr::Var(temp)))
            }
        };
        let count = arc.pieces();
        let role = |item: &NcItem| match item {
            NcItem::Word(role, _) => Some(*role),
            _ => None,
        };
        let shape = |item: &NcItem| matches!(role(item), Some(Role::ArcI | Role::ArcJ | Role::ArcRadius));
        let ends = |item: &NcItem| matches!(role(item), Some(Role::X | Role::Y));
        if count == 1 {
            let mut items: Vec<NcItem> = nc.items.iter().filter(|item| !shape(item)).cloned().collect();
            items.push(NcItem::Word(Role::ArcRadius, radius));
            out.push(Stmt { kind: StmtKind::Nc(Nc { items }), site: stmt.site.clone() });
            return out;
        }
        // A whole turn needs no words, so its pieces are incremental where its start is not known.
        let switched = !incremental && start.is_none();
        let relative = incremental || switched;
        let mut before = [0.0; 2];
        let mut made = Vec::new();
        for piece in 1..=count {
            let at = arc.place(piece, count);
            let last = piece == count;
            let mut words = Vec::new();
            for (axis, role) in [Role::X, Role::Y].into_iter().enumerate() {
                let given = nc.word(role).filter(|_| last).cloned();
                let value = match (size, given, relative) {
                    (_, Some(given), false) => given,
                    (_, None, false) => Expr::Number(round(start.unwrap_or_default()[axis] + at[axis])),
                    (Size::One, _, true) => Expr::Number(round(round(at[axis]) - round(before[axis]))),
                    (Size::Of(unit), given, true) => size.word(unit, given, at[axis], before[axis]),
                };
                words.push(NcItem::Word(role, value));
            }
            words.push(NcItem::Word(Role::ArcRadius, radius.clone()));
            before = at;
            let rest = nc.items.iter().filter(|item| piece == 1 && !shape(item) && !ends(item));
            let items = rest.cloned().chain(words).collect();
            let site = if piece == 1 { stmt.site.clone() } else { aside() };
            made.push(Stmt { kind: StmtKind::Nc(Nc { items }), site });
        }
        if switched {
            switch(&mut made);
        }
        out.extend(made);
        out
    }
}

/// Puts incremental coordinates in force for these blocks.
fn switch(made: &mut Vec<Stmt>) {
    let Some(site) = made.last().map(|stmt| SourceInfo {
        span: stmt.site.span,
        skip: stmt.site.skip,
        ..SourceInfo::default()
    }) else {
        return;
    };
    if let Some(nc) = made.iter_mut().find_map(|stmt| match &mut stmt.kind {
        StmtKind::Nc(nc) => Some(nc),
        _ => None,
    }) {
        nc.items.retain(|item| *item != NcItem::Op(Op::Absolute));
        nc.items.insert(0, NcItem::Op(Op::Incremental));
    }
    made.push(Stmt { kind: StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Absolute)] }), site });
}

/// Without what binary arithmetic adds to decimal digits.
fn clean(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

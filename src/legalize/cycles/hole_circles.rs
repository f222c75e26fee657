//! Holes on a circle, an arc or a line that one block names.
//!
//! Law: such a block runs the drilling cycle in force at places round the place where the tool stands, or from there on along a line; so
//! do blocks with these places, written in absolute numbers and rounded to the least increment. Side conditions: all words are numbers, the tool's
//! place is known from absolute words before, the same on every way, or the block names the centre of a circle or the first hole of a line, the plane is that of X and Y (or no block that may come before names another),
//! coordinates are absolute, and the block has nothing else. Counter-example: `G70 I5. J15. L12` after `G28 X0 Y0`, which is refused.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::behind::in_other_planes;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, solve};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::features::Features;
use crate::legalize::moves::increments::parts_of_unit;
use crate::legalize::moves::short_arcs::stands;
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// More holes than this are a slip.
const MOST: f64 = 1000.0;

/// True where the library has such blocks.
pub fn concerns(features: &Features) -> bool {
    features.any_op(is_pattern)
}

fn is_pattern(op: Op) -> bool {
    matches!(op, Op::HolesCircle | Op::HolesArc | Op::HolesLine)
}

/// Writes the places out, and refuses what cannot be; true where any were written.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    context.count(module);
    let turned = in_other_planes(module);
    let comes_back = context.summaries(module).come_back();
    let mut changed = false;
    for index in 0..module.programs.len() {
        if !context.may_concern(index, concerns) {
            continue;
        }
        let program = &mut module.programs[index];
        let rules = Rules { index, facts: &facts, comes_back, source: context.source, turned: &turned };
        let places = solve(&rules, program, &Cfg::of(program));
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let mut state = facts.at(index, id);
            let mut place = places.at(id).copied().unwrap_or_default();
            place.enter(block, comes_back);
            let mut out = Stmts::with_capacity(block.stmts.len());
            for stmt in std::mem::take(&mut block.stmts) {
                state.step(&stmt);
                if !stmt.kind.nc().is_some_and(|nc| nc.ops().any(is_pattern)) {
                    place.step(&stmt, &state);
                    out.push(stmt);
                    continue;
                }
                changed = true;
                match holes(&stmt, &state, place, &rules) {
                    Ok(holes) => {
                        if stmt.kind.nc().is_some_and(|nc| nc.names_axis() && has_centre(nc)) {
                            let told = Diagnostic::new(Code::Conditional, stmt.site.span, CENTRE);
                            context.add_once(index, CENTRE, told);
                        }
                        place = place.after(&holes);
                        out.extend(written(&stmt, &holes));
                    }
                    Err(why) => {
                        let what = format!("holes in a pattern cannot be written out: {why}");
                        let help = match why {
                            super::pockets::NO_UNIT => super::pockets::UNIT_HELP,
                            _ => "write the places of the holes into blocks of their own",
                        };
                        let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what);
                        context.add(index, finding.with_help(help));
                        place = Place::default();
                        let kind = StmtKind::not_converted(Code::NoEquivalent.number());
                        out.push(Stmt { kind, site: stmt.site });
                    }
                }
            }
            block.stmts = out;
        }
    }
    changed
}

/// Where the tool stands along X and Y, in the numbers of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Place([Option<f64>; 2]);

impl Lattice for Place {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        self.0.iter_mut().zip(other.0).for_each(|(own, other)| *own = own.filter(|own| Some(*own) == other));
        *self != before
    }
}

/// What blocks of a program do to it.
struct Rules<'r> {
    index: usize,
    facts: &'r ModalFacts,
    /// True where a call may come back at any label.
    comes_back: bool,
    source: &'r Control,
    /// The places that may come in another plane than that of X and Y.
    turned: &'r BTreeSet<(usize, Span)>,
}

impl Analysis for Rules<'_> {
    type State = Place;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Place)> {
        cfg.roots().iter().map(|root| (*root, Place::default())).collect()
    }

    fn block(&self, id: BlockId, block: &Block, place: &mut Place) {
        place.enter(block, self.comes_back);
        let mut state = self.facts.at(self.index, id);
        for stmt in &block.stmts {
            state.step(stmt);
            if stmt.kind.nc().is_some_and(|nc| nc.ops().any(is_pattern)) {
                *place = holes(stmt, &state, *place, self)
                    .map_or_else(|_| Place::default(), |holes| place.after(&holes));
            } else {
                place.step(stmt, &state);
            }
        }
        if matches!(block.term.kind, TermKind::Call { .. }) {
            *place = Place::default();
        }
    }
}

impl Place {
    /// Comes to the start of a block, where a call may come back too.
    fn enter(&mut self, block: &Block, comes_back: bool) {
        if comes_back && !block.labels.is_empty() {
            *self = Self::default();
        }
    }

    /// Where the last of these holes leaves the tool.
    fn after(self, holes: &[[f64; 2]]) -> Self {
        Self(holes.last().map_or(self.0, |last| last.map(Some)))
    }

    /// Takes a statement's effect; `after` is what is in force after it.
    fn step(&mut self, stmt: &Stmt, after: &Modal) {
        // A shift may be written there.
        if !matches!(stmt.kind.target(), None | Some(crate::ir::Place::Var(_))) {
            *self = Self::default();
        }
        let Some(nc) = stmt.kind.nc() else { return };
        let counts_anew = |op: Op| matches!(op.group(), Group::WorkOffset | Group::Units | Group::Plane);
        let rest: Vec<NcItem> = nc
            .items
            .iter()
            .filter(|item| !matches!(item, NcItem::Op(op) if counts_anew(*op)))
            .cloned()
            .collect();
        let anew = rest.len() < nc.items.len();
        let is_known = stands(&Nc { items: rest.into_iter().collect() }) && !after.may_call();
        let before = *self;
        for (axis, role) in [Role::X, Role::Y].into_iter().enumerate() {
            let absolute = after.op(Group::Distance) == Some(Op::Absolute);
            self.0[axis] = match nc.word(role) {
                _ if !is_known => None,
                Some(word) => word.constant().filter(|_| absolute),
                None if anew => None,
                None => before.0[axis],
            };
        }
        if stmt.site.skip.is_some() && self.0 != before.0 {
            *self = Self::default();
        }
    }
}

/// The places of the holes; why not, where they cannot be told.
fn holes(stmt: &Stmt, state: &Modal, place: Place, rules: &Rules<'_>) -> Result<Vec<[f64; 2]>, &'static str> {
    let StmtKind::Nc(nc) = &stmt.kind else { return Ok(Vec::new()) };
    let line = rules.source.code_for(Op::HolesLine, &BTreeMap::new());
    let names_first = line.is_some_and(|row| row.takes(Role::X) && row.takes(Role::Y));
    let own = |item: &NcItem| match item {
        NcItem::Op(op) => is_pattern(*op),
        NcItem::Word(role, _) => {
            use Role::*;
            matches!(role, HolesRadius | HolesApart | HolesStart | HolesStep | HolesCount)
                || matches!(role, X | Y) && (has_centre(nc) || names_first)
        }
        NcItem::Code(..) => false,
    };
    if !nc.items.iter().all(own) || stmt.site.skip.is_some() {
        return Err("give the code a block of its own, without a block skip");
    }
    let word = |role| match nc.word(role) {
        Some(word) => word.constant().map(Some).ok_or("its words are computed"),
        None => Ok(None),
    };
    let is = |pattern| nc.ops().any(|op| op == pattern);
    let line = is(Op::HolesLine);
    let length = if line { Role::HolesApart } else { Role::HolesRadius };
    let (length, count) = (word(length)?, word(Role::HolesCount)?);
    let (start, step) = (word(Role::HolesStart)?.unwrap_or(0.0), word(Role::HolesStep)?);
    let (Some(length), Some(count)) = (length, count) else {
        return Err("it has no radius or distance, or no number of holes");
    };
    if !(1.0..=MOST).contains(&count) || count.fract() != 0.0 {
        return Err("the number of holes is not a whole number from 1 to 1000");
    }
    let step = match step {
        _ if is(Op::HolesCircle) => 360.0 / count,
        _ if line => 0.0,
        Some(step) => step,
        None => return Err("it has no angle between the holes"),
    };
    match state.op(Group::Cycle) {
        Some(op) if op.is_cycle() => {}
        Some(_) => return Err("no drilling cycle is in force"),
        None => return Err("it is not known here which drilling cycle is in force"),
    }
    let flat = !rules.turned.contains(&(rules.index, stmt.site.span));
    let plane = state.op(Group::Plane).or(flat.then_some(Op::PlaneXy));
    if plane != Some(Op::PlaneXy) || state.op(Group::Distance) != Some(Op::Absolute) {
        return Err("it is not known here that G17 and G90 are in force");
    }
    if state.may_call() {
        return Err("a macro is called after each move");
    }
    // Words of the block name the centre.
    let (x, y) = (word(Role::X)?.or(place.0[0]), word(Role::Y)?.or(place.0[1]));
    let (Some(x), Some(y)) = (x, y) else {
        return Err("it is not known here where the tool stands: write X and Y as numbers before it");
    };
    let parts = parts_of_unit(state, rules.source);
    let parts = parts.ok_or(super::pockets::NO_UNIT)?;
    // No minus before 0.
    let counted = |place: f64| (place * parts).round() / parts + 0.0;
    let hole = |at: u32| {
        let angle = step.mul_add(f64::from(at), start).to_radians();
        let away = if line { length * f64::from(at) } else { length };
        [counted(away.mul_add(angle.cos(), x)), counted(away.mul_add(angle.sin(), y))]
    };
    Ok((0..count as u32).map(hole).collect())
}

/// True for holes round a centre, which the block may name; on a line it may name the first hole where its code has the words for it.
fn has_centre(nc: &Nc) -> bool {
    nc.ops().any(|op| matches!(op, Op::HolesCircle | Op::HolesArc))
}

const CENTRE: &str = "no source says whether the tool goes to the centre of these holes first: on the target it goes straight to the first hole";

/// A block for each hole; the first is where the block with them stood.
fn written(stmt: &Stmt, holes: &[[f64; 2]]) -> Vec<Stmt> {
    let block = |(at, [x, y]): (usize, &[f64; 2])| {
        let words = [(Role::X, *x), (Role::Y, *y)];
        let items = words.map(|(role, value)| NcItem::Word(role, Expr::Number(value)));
        let site = if at == 0 {
            stmt.site.clone()
        } else {
            SourceInfo { span: stmt.site.span, ..SourceInfo::default() }
        };
        Stmt { kind: StmtKind::Nc(Nc { items: items.into_iter().collect() }), site }
    };
    holes.iter().enumerate().map(block).collect()
}

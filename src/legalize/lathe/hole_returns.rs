//! Where the holes of a lathe end: at the level where the cycle began, or at the retract plane, by G98 and G99 on some controls alone.
//!
//! Law: a cycle that begins at its retract plane ends there. So where the target always goes back to where the cycle began, the tool goes to
//! the place and to the plane before the cycle, in rapid, as the cycle does it; the last hole of such a cycle may go back by a move of its own.
//! Where the source always goes back, the target is told so.
//! Side conditions: which of the two is in force is known, and the same for all holes of a cycle; rapid is in force before it; no repeats.
//! Counter-example: `G99 G83 ..` and `G98` before a hole that is not its last one.

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
    let mut found = Vec::new();
    for (index, program) in module.programs.iter_mut().enumerate() {
        let straight = entered_straight(program);
        // Whether the cycle in force began at its plane on the target.
        let mut lowered = None;
        // The way from the plane of such a cycle back to where it began, if that is known.
        let mut back: Option<Option<Nc>> = None;
        let mut returns = Vec::new();
        for ((id, block), straight) in program.ids().zip(&mut program.blocks).zip(straight) {
            let mut state = facts.at(index, id);
            lowered = lowered.filter(|_| straight);
            let mut out = Stmts::with_capacity(block.stmts.len());
            let mut rest = std::mem::take(&mut block.stmts).into_iter();
            while let Some(mut stmt) = rest.next() {
                let before = (state.op(Group::Cycle), state.op(Group::Motion));
                state.step(&stmt);
                let StmtKind::Nc(nc) = &mut stmt.kind else {
                    out.push(stmt);
                    continue;
                };
                if told {
                    tell(nc);
                } else {
                    nc.items.retain(|item| !matches!(item, NcItem::Op(Op::ReturnInitial | Op::ReturnR)));
                    if drills(nc, &state).is_some() {
                        let goes_on = before.0 != Some(Op::CycleOff);
                        let hole = Hole { before, lowered, skipped: stmt.site.skip.is_some() };
                        if goes_on
                            && let Some(back) = back.clone().filter(|_| hole.rises(nc, &state))
                            && is_last(rest.as_slice(), &state)
                        {
                            let site = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
                            out.push(stmt);
                            out.extend(back.map(|back| Stmt { kind: StmtKind::Nc(back), site }));
                            continue;
                        }
                        if !goes_on {
                            back = way_back(nc);
                        }
                        match hole.end(nc, &state) {
                            Ok((stmts, now)) => {
                                let site = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
                                let new = |nc| Stmt { kind: StmtKind::Nc(nc), site: site.clone() };
                                out.extend(stmts.into_iter().map(new));
                                let open = goes_on && lowered.is_none();
                                lowered = now;
                                returns.push((state.op(Group::ReturnPlane), open, stmt.site.span));
                            }
                            Err(what) => found.push((index, stmt.site.span, what)),
                        }
                    }
                }
                if nc_is_empty(&stmt.kind) {
                    stmt.kind = StmtKind::Comment;
                }
                out.push(stmt);
            }
            block.stmts = out;
        }
        // A hole that goes on from a cycle that other ways lead to too: all holes must end alike.
        let alike = returns.iter().all(|(plane, ..)| Some(*plane) == returns.first().map(|first| first.0));
        let goes_on = returns.iter().find(|(_, open, _)| *open);
        if let Some((.., span)) = goes_on.filter(|_| !alike) {
            found.push((index, *span, MIXED));
        }
    }
    for (index, span, what) in found {
        context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what).with_help(HELP));
    }
    true
}

fn nc_is_empty(kind: &StmtKind) -> bool {
    kind.nc().is_some_and(|nc| nc.items.is_empty())
}

/// Writes the code before that of a cycle.
fn tell(nc: &mut Nc) {
    let cycle = nc.items.iter().position(|item| matches!(item, NcItem::Op(op) if op.is_hole()));
    if let Some(at) = cycle.filter(|_| !nc.has(Op::ReturnInitial)) {
        nc.items.insert(at, NcItem::Op(Op::ReturnInitial));
    }
}

/// A block that drills.
struct Hole {
    /// The cycle and the interpolation in force before it.
    before: (Option<Op>, Option<Op>),
    lowered: Option<bool>,
    skipped: bool,
}

/// What goes before a hole, and whether its cycle begins at the plane on the target.
type End = (Vec<Nc>, Option<bool>);

impl Hole {
    /// True of a hole that ends where its cycle began on the source, and at the plane on the target, as the holes before it.
    fn rises(&self, nc: &Nc, state: &Modal) -> bool {
        let plain = nc.word(Role::CycleRStep).or(nc.word(Role::Repeat)).is_none() && !self.skipped;
        let back = state.op(Group::ReturnPlane) == Some(Op::ReturnInitial);
        self.lowered == Some(true) && back && plain && state.op(Group::Motion) == Some(Op::Rapid)
    }

    fn end(&self, nc: &mut Nc, state: &Modal) -> Result<End, &'static str> {
        let at_plane = match state.op(Group::ReturnPlane) {
            Some(Op::ReturnR) => true,
            Some(_) => false,
            None => return Err(UNKNOWN),
        };
        let plane = nc.word(Role::CycleRStep).cloned();
        let goes_on = self.before.0 != Some(Op::CycleOff);
        if !at_plane && !goes_on {
            return Ok((Vec::new(), Some(false)));
        }
        if goes_on {
            // What the block before it left to other ways is looked at for the whole program.
            return match (self.lowered, plane) {
                (Some(lowered), _) if lowered != at_plane => Err(MIXED),
                (_, Some(_)) if at_plane => Err(PLANE),
                _ => Ok((Vec::new(), self.lowered)),
            };
        }
        let r = plane.as_ref().map_or(Some(0.0), Expr::constant).ok_or(PLANE)?;
        if self.before.1 != Some(Op::Rapid) || self.skipped || nc.word(Role::Repeat).is_some() {
            return Err(EMULATION);
        }
        let side = nc.ops().any(Op::is_side_hole);
        Ok((lead(nc, side, r), Some(true)))
    }
}

/// True where the cycle in force drills nothing more: it ends in these statements before another hole.
fn is_last(rest: &[Stmt], state: &Modal) -> bool {
    let mut state = state.clone();
    for stmt in rest {
        state.step(stmt);
        match &stmt.kind {
            StmtKind::Nc(nc) if drills(nc, &state).is_some() => return false,
            StmtKind::Nc(_) if state.op(Group::Cycle) == Some(Op::CycleOff) => return true,
            StmtKind::Nc(_) | StmtKind::Comment | StmtKind::Assign { .. } => {}
            _ => return false,
        }
    }
    false
}

/// The move from the plane of a cycle to where it began: an empty one if both are one place. Nothing, if that is not known.
fn way_back(nc: &Nc) -> Option<Option<Nc>> {
    if nc.word(Role::CycleR).is_some() {
        return None;
    }
    let r = nc.word(Role::CycleRStep).map_or(Some(0.0), Expr::constant)?;
    let side = nc.ops().any(Op::is_side_hole);
    let (role, by) = if side { (Role::StepX, -2.0 * r) } else { (Role::StepZ, -r) };
    let items = || vec![NcItem::Op(Op::Rapid), NcItem::Word(role, Expr::Number(by))];
    Some((by != 0.0).then(|| Nc { items: items() }))
}

/// The moves to the place of a hole, and to its plane; the cycle then begins there.
fn lead(nc: &mut Nc, side: bool, r: f64) -> Vec<Nc> {
    let along = |role: Role| match side {
        true => matches!(role, Role::X | Role::StepX),
        false => matches!(role, Role::Z | Role::StepZ),
    };
    let place = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis() && !along(*role));
    let (places, rest): (Vec<_>, Vec<_>) = std::mem::take(&mut nc.items).into_iter().partition(place);
    nc.items = rest;
    for item in &mut nc.items {
        if let NcItem::Word(Role::CycleRStep, value) = item {
            *value = Expr::Number(0.0);
        }
    }
    let rapid =
        |items: Vec<NcItem>| Nc { items: std::iter::once(NcItem::Op(Op::Rapid)).chain(items).collect() };
    let mut out = Vec::new();
    if !places.is_empty() {
        out.push(rapid(places));
    }
    if r != 0.0 {
        let (role, by) = if side { (Role::StepX, 2.0 * r) } else { (Role::StepZ, r) };
        out.push(rapid(vec![NcItem::Word(role, Expr::Number(by))]));
    }
    out
}

const UNKNOWN: &str = "whether holes end at the level where the cycle began (G98) or at the retract plane (G99) is not known here";
const MIXED: &str =
    "holes of one drilling cycle end at two levels: the target always goes back to where the cycle began";
const PLANE: &str = "the retract plane of a hole that ends there (G99) is computed, or changes in the cycle: the target always goes back to where it began";
const EMULATION: &str = "a hole that ends at its retract plane (G99) in a block with repeats or a block skip, or without rapid traverse in force \
                         before it: the target always goes back to where the cycle began";
const HELP: &str = "write G98 before the cycle, or G0 and a move to the retract plane, and R as 0 in the cycle; or say in the source's profile how a \
                    program begins: [start] codes";

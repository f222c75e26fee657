//! Holes of a lathe for which a code of their block clamps the C axis, on a target whose cycles do nothing of the kind.
//!
//! Law: the tool goes to the place, the axis is clamped, the tool goes to the retract plane, drills and comes back to it, the axis is let go,
//! and the tool goes back to where the cycle began. Each of these is a block of its own, and what the cycle was told before is told again
//! with each hole. Side conditions: the profile of the source names both codes (parameter 5110); rapid is in force, the words that are told
//! again are numbers and count as they did, nothing else leads into the cycle, holes end at the level where it began, and none has
//! repeats or a block skip. Counter-example: `C90. M89` after a label that is jumped to, where the depth is not known.

use super::hole_words::{Told, lasting};
use super::holes::drills;
use super::straight::{entered_straight, returns_into};
use crate::canon::{Act, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use std::collections::BTreeMap;

/// True where holes may be held on the source, and the target is another control.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let known = matches!(context.source.hole_clamp(), [Some(_), Some(_)]);
    known
        && context.source.name() != context.target.name()
        && features.op(Op::Act)
        && features.any_op(Op::is_hole)
}

/// Writes them out.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let [Some(clamps), Some(frees)] = context.source.hole_clamp() else { return false };
    let chooses = context.source.code_for(Op::ReturnInitial, &BTreeMap::new()).is_some();
    // Nothing of the library changes what the machine begins in.
    let begins = context.source.start().iter().any(|mode| mode.op == Op::ReturnInitial);
    let stays = begins && !context.features.op(Op::ReturnR);
    let facts = context.modal_facts(module);
    let numbers_are_entered = returns_into(module);
    let (mut written, mut lost, mut open) = (Vec::new(), Vec::new(), Vec::new());
    for (index, program) in module.programs.iter_mut().enumerate() {
        let straight = entered_straight(program);
        let mut cycle = Cycle::default();
        for ((id, block), straight) in program.ids().zip(&mut program.blocks).zip(straight) {
            let mut state = facts.at(index, id);
            if !straight || numbers_are_entered {
                cycle = Cycle::default();
            }
            let mut out = Stmts::with_capacity(block.stmts.len());
            for stmt in std::mem::take(&mut block.stmts) {
                let before = state.clone();
                state.step(&stmt);
                let hole = stmt.kind.nc().and_then(|nc| Some((nc, drills(nc, &state)?)));
                let Some((nc, op)) = hole else {
                    if state.op(Group::Cycle) == Some(Op::CycleOff) {
                        cycle = Cycle::default();
                    }
                    out.push(stmt);
                    continue;
                };
                let held = is_held(nc, clamps);
                cycle.told.take(nc, op, &state);
                if !held && !cycle.is_ended {
                    if cycle.told.op.is_none() {
                        open.push((index, stmt.site.span));
                    }
                    out.push(stmt);
                    continue;
                }
                let acts = held.then_some([clamps, frees]);
                // A control without codes for it always goes back to where the cycle began.
                let returns = state.op(Group::ReturnPlane);
                let goes_back = !chooses || returns == Some(Op::ReturnInitial) || returns.is_none() && stays;
                match cycle
                    .written(nc, (acts, goes_back), (&before, &state))
                    .filter(|_| stmt.site.skip.is_none())
                {
                    Some(blocks) => {
                        cycle.is_ended = true;
                        written.push((index, stmt.site.span));
                        let aside = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
                        let sites = std::iter::once(stmt.site).chain(std::iter::repeat(aside));
                        out.extend(
                            blocks
                                .into_iter()
                                .zip(sites)
                                .map(|(nc, site)| Stmt { kind: StmtKind::Nc(nc), site }),
                        );
                    }
                    None => {
                        lost.push((index, stmt.site.span));
                        out.push(stmt);
                    }
                }
            }
            block.stmts = out;
        }
    }
    // The cycle may have ended on the target.
    lost.extend(open.into_iter().filter(|_| !written.is_empty()));
    for (index, span) in lost {
        let found = Diagnostic::new(Code::NoEquivalent, span, LOST).with_help(LOST_HELP);
        context.add_once(index, LOST, found);
    }
    for (index, span) in &written {
        context.rests_on_source(*index, *span, Question::HoleClamp);
    }
    !written.is_empty()
}

const LOST: &str = "a hole of a cycle whose holes are clamped: its plane or depth is computed, or not known here, or it has repeats or a block \
                    skip, or ends at its plane, or G0 is not known to be in force; the target needs a block for each step of it";
const LOST_HELP: &str =
    "write the code of the cycle with all its words into the block, and G0 into a block before it that moves";

/// True of a block whose one code of a builder is the clamp.
fn is_held(nc: &Nc, clamps: Act) -> bool {
    let mut acts = nc.items.iter().filter_map(|item| match item {
        NcItem::Word(Role::Act, number) => Some(number.constant()),
        _ => None,
    });
    acts.next() == Some(Some(clamps.number())) && acts.next().is_none()
}

/// What is known of the cycle in force, and whether the target has none any more.
#[derive(Clone, Debug, Default)]
struct Cycle {
    told: Told,
    is_ended: bool,
}

impl Cycle {
    /// The blocks of a hole. No blocks, if something of it is not known.
    fn written(
        &self,
        nc: &Nc,
        (acts, goes_back): (Option<[Act; 2]>, bool),
        (before, state): (&Modal, &Modal),
    ) -> Option<Vec<Nc>> {
        let op = self.told.op?;
        let plane = self.told.plane()?;
        let rapid = before.op(Group::Motion) == Some(Op::Rapid);
        // The depth would count otherwise, or the next plane from another level.
        if !self.told.is_whole(state) || !rapid || !goes_back || nc.word(Role::Repeat).is_some() {
            return None;
        }
        let aside = |item: &NcItem| match item {
            NcItem::Word(role, _) => *role == Role::Act || lasting(op).contains(role),
            NcItem::Op(own) => *own == Op::Act || own.is_hole(),
            NcItem::Code(..) => false,
        };
        let depth = |role: &Role| lasting(op)[2..].contains(role);
        let is_place = |item: &NcItem| matches!(item, NcItem::Word(role, _) if (role.is_axis() || role.is_step()) && !depth(role));
        let (places, rest): (Vec<_>, Vec<_>) =
            nc.items.iter().filter(|item| !aside(item)).cloned().partition(is_place);
        let lasting = self.told.words().map(|(role, value)| NcItem::Word(*role, value.clone()));
        let Some(acts) = acts else {
            let items = std::iter::once(NcItem::Op(op)).chain(places).chain(lasting).chain(rest);
            return Some(vec![Nc { items: items.collect() }]);
        };
        // The cycle begins at its plane, and so ends there.
        let at_plane = lasting.map(|item| match item {
            NcItem::Word(Role::CycleRStep, _) => NcItem::Word(Role::CycleRStep, Expr::Number(0.0)),
            item => item,
        });
        let cycle = std::iter::once(NcItem::Op(op)).chain(at_plane).chain(rest).collect();
        let act = |act: Act| Nc {
            items: vec![NcItem::Op(Op::Act), NcItem::Word(Role::Act, Expr::Number(act.number()))],
        };
        let way = |by: f64| {
            let (role, by) = if op.is_side_hole() { (Role::StepX, 2.0 * by) } else { (Role::StepZ, by) };
            Nc { items: vec![NcItem::Op(Op::Rapid), NcItem::Word(role, Expr::Number(by))] }
        };
        let mut blocks = Vec::new();
        if !places.is_empty() {
            blocks.push(Nc { items: std::iter::once(NcItem::Op(Op::Rapid)).chain(places).collect() });
        }
        blocks.push(act(acts[0]));
        if plane != 0.0 {
            blocks.push(way(plane));
        }
        blocks.push(Nc { items: cycle });
        blocks.push(act(acts[1]));
        if plane != 0.0 {
            blocks.push(way(-plane));
        }
        Some(blocks)
    }
}

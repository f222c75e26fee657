//! Round pockets that one block mills, where the target has no code for them.
//!
//! Law: such a block feeds down at the centre, goes out to the first circle along a half circle, mills it whole, goes on to the
//! next, and back to the centre along a half circle; so do blocks with these moves, in increments from where the tool stands. The
//! cutter radius is read from its offset, with its wear where the target keeps that apart, and taken off. Side conditions: the words are
//! numbers, the block names an offset, the
//! plane is that of X and Y, coordinates are neither scaled nor mirrored, where they are turned the tool stands at a place in them
//! ([`turned`]), neither compensation nor a drilling cycle is in force, and what is in force comes back after it. That
//! the source goes so is `machine:pocket.path`, which a figure of its maker alone shows. Counter-example: `G13 I.5 D1` under `G41`.

mod path;
mod turned;

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::analysis::behind::{behind_or_entered, in_other_planes};
use crate::ir::{Block, BlockId, Module, Nc, NcItem, Place, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::moves::increments::parts_of_unit;
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use crate::legalize::{Context, Modal};
use crate::text::Span;
use path::{Pocket, write};
use std::collections::BTreeSet;

/// More circles than this, repeats counted, are too long to write out.
const MOST: usize = 100;

const FACT: &str = "machine:pocket.path";

/// What a reviewer must look at.
const TAKEN: &str = "a round pocket (G12, G13) is written out as arcs. Taken: Z feeds straight down at the centre; a half circle goes out to \
     radius I; each circle is milled whole; half circles go on to the next (Q more each time, K last); a half circle goes back to the \
     centre, and the tool stays at its depth. The tool's radius is read from offset D of the target. Make sure that the source goes so \
     too, as its graphics page shows, and that offset D of the target holds this tool, its wear counted";

const GOES_ON: &str = "after this pocket the program moves along X or Y before it raises Z, and the target's tool is at the depth of the pocket then: \
     make sure that the source's is too, and does not come back up by itself";

/// Why what counts in a unit cannot be written out.
pub(super) const NO_UNIT: &str = "it is not known here whether lengths are inches or millimetres";

/// What to do then.
pub(super) const UNIT_HELP: &str = "write G20 or G21 before it; or, if programs that name no unit are in that of the machine, units = \"inch\" or \"metric\" into the \
     source's profile";

/// True where the library has such blocks.
pub fn concerns(features: &Features) -> bool {
    features.any_op(Op::is_pocket)
}

/// Writes the arcs out, and refuses what cannot be; true where a block was found.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let turned = in_other_planes(module);
    let [drills, turns, shapes, compensates] = IN_THE_WAY.map(|(on, off)| after_one_of(module, on, off));
    let kept = |state| context.target.system_runs(state).next().is_some();
    let wears = [Sys::RadiusWear, Sys::DiameterWear, Sys::DiameterOrRadiusWear].into_iter().any(kept);
    for index in 0..module.programs.len() {
        let program = &mut module.programs[index];
        let mut found = Vec::new();
        for (at, block) in program.blocks.iter().enumerate() {
            // The tools that were found small enough, and for which radius.
            let mut fit: Vec<(f64, f64)> = Vec::new();
            let mut state = facts.at(index, BlockId(at as u32));
            for (place, stmt) in block.stmts.iter().enumerate() {
                let before = state.clone();
                state.step(stmt);
                let is_after = |some: &BTreeSet<(usize, Span)>| some.contains(&(index, stmt.site.span));
                let never = Never {
                    turned: !is_after(&turned),
                    drills: !is_after(&drills),
                    turns: !is_after(&turns),
                    shapes: !is_after(&shapes),
                    compensates: !is_after(&compensates),
                };
                if !is_pocket(stmt) {
                    fit.retain(|_| !may_write_offsets(stmt));
                    continue;
                }
                let mut pocket = read(
                    stmt,
                    (&before, &state),
                    (needs_motion(block, place), turned::is_known(block, place, &before)),
                    (context.source, never),
                );
                if let Ok(pocket) = &mut pocket {
                    let first = pocket.circles.first().copied().unwrap_or_default();
                    pocket.fits =
                        fit.iter().any(|(offset, least)| *offset == pocket.offset && *least <= first);
                    fit.push((pocket.offset, first));
                    pocket.goes_on = goes_on(block, place);
                    pocket.wears = wears;
                }
                tell(&pocket, index, stmt, context);
                found.push(pocket.ok());
            }
        }
        if found.is_empty() {
            continue;
        }
        let (mut found, mut temp) = (found.into_iter(), highest_temp(program));
        rebuild(program, &mut |builder, part| match part {
            Part::Stmt(stmt) if is_pocket(&stmt) => match found.next().flatten() {
                Some(pocket) => write(builder, &pocket, &mut temp, stmt.site),
                None => {
                    builder.push(StmtKind::not_converted(Code::NoEquivalent.number()), stmt.site);
                }
            },
            other => other.keep(builder),
        });
    }
}

fn is_pocket(stmt: &Stmt) -> bool {
    stmt.kind.nc().is_some_and(|nc| nc.ops().any(Op::is_pocket))
}

/// True for a statement that may write a cutter radius.
fn may_write_offsets(stmt: &Stmt) -> bool {
    let plain = |op: Op| !matches!(op, Op::WriteRadius | Op::WriteRadiusWear | Op::WriteOffset | Op::Builder);
    match &stmt.kind {
        StmtKind::Comment => false,
        StmtKind::Nc(nc) => {
            !nc.ops().all(plain) || nc.items.iter().any(|item| matches!(item, NcItem::Code(..)))
        }
        StmtKind::Assign { target: Place::Var(_), .. } => false,
        _ => true,
    }
}

/// Says what a pocket rests on, or why it is refused.
fn tell(pocket: &Result<Pocket, &'static str>, index: usize, stmt: &Stmt, context: &mut Context<'_>) {
    let known = context.source.behaviour(Question::PocketEnds).is_some_and(|row| row.origin.is_settled());
    match pocket {
        Ok(pocket) => {
            if pocket.depth.is_some() {
                context.rests_on_source(index, stmt.site.span, Question::PocketEnds);
            }
            if pocket.depth.is_some() && pocket.goes_on && !known {
                context.add(index, Diagnostic::new(Code::Conditional, stmt.site.span, GOES_ON));
            }
            if pocket.is_turned {
                let told = Diagnostic::new(Code::Conditional, stmt.site.span, turned::TOLD).asked_once();
                context.add_once(index, turned::TOLD, told);
            }
            if !context.source.has_tried(FACT) {
                // More than a fact of the machine: whoever runs the program looks at its path first.
                let told = Diagnostic::new(Code::Conditional, stmt.site.span, TAKEN).with_fact(FACT);
                let help = context.source.to_settle(FACT, Side::Source);
                context.add_once(index, FACT, told.with_help(help));
            }
        }
        Err(why) => {
            let what = format!("a round pocket (G12, G13) cannot be written out as arcs: {why}");
            let help = if *why == NO_UNIT { UNIT_HELP } else { "write its arcs into the program by hand" };
            context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help));
        }
    }
}

/// Which operations are meant.
type Which = fn(Op) -> bool;

/// What may not be in force at a round pocket: the codes that begin it, and those that end it.
const IN_THE_WAY: [(Which, Which); 4] = [
    (Op::is_cycle, |op| op == Op::CycleOff),
    (|op| op == Op::RotateOn, |op| op == Op::RotateOff),
    (
        |op| matches!(op, Op::ScaleOn | Op::MirrorOn),
        // What ends one of the two may leave another.
        |_| false,
    ),
    (|op| matches!(op, Op::RadiusLeft | Op::RadiusRight), |op| op == Op::RadiusOff),
];

/// The pockets, by program and place, that may come after such a code and before its end. Of a computed code it is told where it stands.
fn after_one_of(module: &Module, on: Which, off: Which) -> BTreeSet<(usize, Span)> {
    let begins = |stmt: &Stmt| stmt.kind.nc().is_some_and(|nc| nc.ops().any(on));
    let ends = |stmt: &Stmt| {
        // One that is skipped ends nothing.
        stmt.site.skip.is_none() && stmt.kind.nc().is_some_and(|nc| nc.ops().any(off))
    };
    let mut found = BTreeSet::new();
    behind_or_entered(module, begins, ends, |index, stmt| {
        if is_pocket(stmt) {
            found.insert((index, stmt.site.span));
        }
    });
    found
}

/// What no block that may come before puts in force.
#[derive(Clone, Copy)]
struct Never {
    turned: bool,
    drills: bool,
    turns: bool,
    shapes: bool,
    compensates: bool,
}

/// True where the next block that may move does not say how.
fn needs_motion(block: &Block, place: usize) -> bool {
    let after =
        block.stmts.iter().skip(place + 1).filter(|stmt| !is_pocket(stmt) || stmt.site.skip.is_some());
    for nc in after.filter_map(|stmt| stmt.kind.nc()) {
        if nc.ops().any(|op| op.group() == Group::Motion) {
            return false;
        }
        if nc.names_axis() || nc.moves() {
            return true;
        }
    }
    true
}

/// True unless the next block that moves goes along Z alone.
fn goes_on(block: &Block, place: usize) -> bool {
    let mut after = block.stmts.iter().skip(place + 1).filter_map(|stmt| stmt.kind.nc());
    let next = after.find(|nc| nc.names_axis() || nc.moves());
    let across = |nc: &Nc| {
        nc.items
            .iter()
            .any(|item| matches!(item, NcItem::Word(role, _) if role.is_axis() && *role != Role::Z))
    };
    next.is_none_or(|nc| nc.word(Role::Z).is_none() || across(nc))
}

/// What a block mills; why it cannot be told.
fn read(
    stmt: &Stmt,
    (before, state): (&Modal, &Modal),
    (needs_motion, in_turned): (bool, bool),
    (source, never): (&Control, Never),
) -> Result<Pocket, &'static str> {
    let StmtKind::Nc(nc) = &stmt.kind else { return Err("it is no block of words") };
    if stmt.site.skip.is_some() {
        return Err("it has a block skip");
    }
    let mut lead = Vec::new();
    for item in &nc.items {
        match item {
            NcItem::Op(op) if op.is_pocket() => {}
            NcItem::Op(op) if matches!(op.group(), Group::ReturnPlane | Group::Distance) => {
                lead.push(item.clone())
            }
            NcItem::Word(role, _) if own(*role) => {}
            _ => return Err("other codes, or words of X and Y, stand beside it"),
        }
    }
    let plane = state.op(Group::Plane).or(never.turned.then_some(Op::PlaneXy));
    let off = |group, off, never: bool| state.op(group) == Some(off) || never;
    if plane != Some(Op::PlaneXy) {
        return Err("it is not known here that G17 is in force");
    }
    if !off(Group::Cycle, Op::CycleOff, never.drills)
        || !off(Group::RadiusComp, Op::RadiusOff, never.compensates)
    {
        return Err("it is not known here that G80 and G40 are in force");
    }
    let flat = [(Group::Scaling, Op::ScaleOff), (Group::Mirror, Op::MirrorOff)];
    if !flat.into_iter().all(|(group, none)| off(group, none, never.shapes)) {
        return Err("it is not known here that coordinates are neither scaled nor mirrored");
    }
    let is_turned = !off(Group::Rotation, Op::RotateOff, never.turns);
    if is_turned && !in_turned {
        return Err(
            "coordinates may be turned here, and it is not known by which block, or no block goes to a place in them before it",
        );
    }
    if state.may_call() || state.op(Group::FeedMode) == Some(Op::FeedInverse) {
        return Err("a macro is called after each move, or feeds are of inverse time");
    }
    let motion = match before.op(Group::Motion) {
        _ if !needs_motion => None,
        Some(op @ (Op::Rapid | Op::Linear)) => Some(op),
        _ => {
            return Err(
                "it is not known here that G0 or G1 is in force: write the code into the next block that moves",
            );
        }
    };
    let absolute = match state.op(Group::Distance) {
        Some(op) => op == Op::Absolute,
        None => return Err("it is not known here whether G90 or G91 is in force"),
    };
    let number = |role| match nc.word(role) {
        Some(word) => word.constant().map(Some).ok_or("its words I, K, Q, L and D must be numbers"),
        None => Ok(None),
    };
    let Some(offset) = number(Role::RadiusOffset)?.filter(|offset| *offset >= 0.0 && offset.fract() == 0.0)
    else {
        return Err("it has no D");
    };
    let count = number(Role::PocketCount)?.unwrap_or(1.0);
    if count < 1.0 || count.fract() != 0.0 || count > MOST as f64 || count > 1.0 && absolute {
        return Err("L is not a whole number from 1 to 100, or repeats the same depth under G90");
    }
    let parts = parts_of_unit(state, source);
    let parts = parts.ok_or(NO_UNIT)?;
    let words = [number(Role::PocketFirst)?, number(Role::PocketLast)?, number(Role::PocketStep)?];
    let circles = circles(words, parts)?;
    if circles.len() * count as usize > MOST {
        return Err("it has more than 100 circles");
    }
    let word = |role| nc.word(role).cloned();
    Ok(Pocket {
        lead,
        clockwise: nc.has(Op::PocketCw),
        circles,
        offset,
        count: count as usize,
        depth: word(Role::Z),
        feed: word(Role::Feed),
        absolute,
        motion,
        parts,
        fits: false,
        goes_on: false,
        wears: true,
        is_turned,
    })
}

/// True for a word of the code, or one that it may have beside it.
fn own(role: Role) -> bool {
    use Role::{Feed, PocketCount, PocketFirst, PocketLast, PocketStep, RadiusOffset, Z};
    matches!(role, PocketFirst | PocketLast | PocketStep | PocketCount | RadiusOffset | Feed | Z)
}

/// The radii of the circles that are to be milled; `parts` are the least increments in a unit.
fn circles([first, last, step]: [Option<f64>; 3], parts: f64) -> Result<Vec<f64>, &'static str> {
    let Some(first) = first.filter(|first| *first > 0.0) else {
        return Err("it has no radius I above 0");
    };
    let (last, step) = match (last, step) {
        (None, None) => return Ok(vec![first]),
        (Some(last), Some(step)) if last > first && step * parts >= 1.0 => (last, step),
        _ => return Err("K and Q must stand together, and K must be larger than I"),
    };
    let circles = ((last - first) / step - 1e-6).ceil();
    if circles > MOST as f64 {
        return Err("it has more than 100 circles");
    }
    let radius = |at: usize| ((step.mul_add(at as f64, first)) * parts).round() / parts;
    Ok((0..circles as usize).map(radius).chain([last]).collect())
}

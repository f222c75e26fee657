//! Increments by letters of their own (U, W), where the target has a mode for them (G91), and the other way round.
//!
//! Law: a word moves its axis by what it moved it by. Side conditions: where a mode becomes letters, it is known at each block that moves; where
//! letters become a mode, a block has words of one kind only, or where the tool stands is known as numbers. Counter-example: `G1 X50. W-2.`
//! after a call, which no mode can say.

use super::contour_modes::{Modes, reached};
use super::contour_starts::Contours;
use super::place::{self, Place};
use super::restarts::restarts;
use super::straight::entered_straight;
use super::zeros::{adds, sets_zero};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, STEP_LETTERS};
use crate::ir::analysis::calls_of;
use crate::ir::analysis::over_calls::called;
use crate::ir::{Call, Callee, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, TermKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, ModalFacts};
use crate::text::Span;
use std::collections::BTreeMap;

/// True where the target has letters for increments, and no mode; a program that names no mode begins in one all the same.
pub fn mode_to_letters(features: &Features, context: &Context<'_>) -> bool {
    let modes = features.op(Op::Incremental)
        || features.op(Op::Absolute)
        || has_mode(context.source) && moves_any(features);
    let letters = has_letters(context.target) && !has_mode(context.target);
    modes && letters || loses_letters(features, context)
}

/// True where the source has modes and letters, and the target has modes alone: all become letters first.
fn loses_letters(features: &Features, context: &Context<'_>) -> bool {
    let (source, target) = (context.source, context.target);
    let both = has_mode(source) && has_letters(source);
    let stepped = Role::STEPS.iter().any(|(_, step)| features.role(*step));
    both && stepped && has_mode(target) && !has_letters(target)
}

fn moves_any(features: &Features) -> bool {
    Role::STEPS.iter().any(|(whole, step)| features.role(*whole) || features.role(*step))
}

/// True where the target has a mode for increments, and the source none; a program without increments must say so there too. A target
/// that has letters as well gets them only where a mode for the whole block cannot say it.
pub fn letters_to_mode(features: &Features, context: &Context<'_>) -> bool {
    let lost = loses_letters(features, context);
    moves_any(features) && has_mode(context.target) && (!has_mode(context.source) || lost)
}

/// True of a control that has letters for increments.
pub(in crate::legalize) fn has_letters(control: &Control) -> bool {
    control.dialect().words.iter().any(|row| row.role == Role::StepX)
}

fn has_mode(control: &Control) -> bool {
    control.dialect().codes.iter().any(|row| row.preferred && row.op == Op::Incremental)
}

/// Puts increments into letters of their own, and takes the modes away.
pub fn to_letters(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let mut found = contours_elsewhere(module, &facts);
    let ends_in_mode = has_mode(context.target);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let modes = Modes::of(program, index, &facts);
        for at in 0..program.blocks.len() {
            let mut modal = modes.at(at);
            let Some(block) = program.blocks.get_mut(at) else { continue };
            for stmt in &mut block.stmts {
                modal.step(stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                match modal.op(Group::Distance) {
                    _ if !moves(nc) && !sets_zero(nc) => {}
                    Some(Op::Incremental) if adds(nc) => found.push((index, span, TABLE)),
                    Some(Op::Incremental) if nc.has(Op::MachineOnce) => found.push((index, span, MACHINE)),
                    Some(Op::Incremental) => swap(nc, |(whole, step)| (whole, step)),
                    Some(_) => {}
                    // Letters count alike in both.
                    None if has_steps(nc) && !both_kinds(nc) => {}
                    None => found.push((index, span, UNKNOWN)),
                }
                nc.items.retain(|item| !matches!(item, NcItem::Op(Op::Absolute | Op::Incremental)));
            }
            block.stmts.retain_mut(is_left);
            // What it leaves in force is said again there.
            if ends_in_mode && matches!(block.term.kind, TermKind::End { .. } | TermKind::Return { .. }) {
                block.stmts.extend(modal.op(Group::Distance).map(mode_alone));
            }
        }
    }
    for (index, span, what) in found {
        let help = if what == TABLE { TABLE_HELP } else { HELP };
        context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
    }
    true
}

/// A block that only says how places count.
fn mode_alone(op: Op) -> Stmt {
    let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(op)] });
    Stmt { kind, site: SourceInfo::default() }
}

/// True where something of a statement is left: of an emptied one its comments, and a number that may be gone to.
fn is_left(stmt: &mut Stmt) -> bool {
    if stmt.kind.nc().is_none_or(|nc| !nc.items.is_empty()) {
        return true;
    }
    stmt.kind = StmtKind::Comment;
    stmt.site.sequence.get().is_some() || !stmt.site.comments.is_empty()
}

/// Cycles that read a contour in another mode than the one it stands in.
fn contours_elsewhere(module: &Module, facts: &ModalFacts) -> Vec<(usize, Span, &'static str)> {
    let mut found = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        let (mut begun, mut read) = (BTreeMap::new(), Vec::new());
        let modes = Modes::of(program, index, facts);
        for (at, block) in program.blocks.iter().enumerate() {
            let mut modal = modes.at(at);
            for stmt in &block.stmts {
                let before = modal.op(Group::Distance);
                modal.step(stmt);
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                // A first block that says its mode is read alike from everywhere.
                let says = nc.ops().any(|op| op.group() == Group::Distance);
                if let Some(number) = stmt.site.sequence.get().filter(|_| !says) {
                    begun.insert(number, before);
                }
                if nc.ops().any(Op::reads_contour) {
                    let first = nc.word(Role::ContourFirst).and_then(|first| first.constant());
                    read.push((first, modal.op(Group::Distance), stmt.site.span));
                }
            }
        }
        let elsewhere = read.into_iter().filter(|(first, mode, _)| {
            let stands = first.and_then(|first| begun.get(&(first as u32)));
            stands.is_some_and(|stands| stands != mode)
        });
        found.extend(elsewhere.map(|(_, _, span)| (index, span, CONTOUR)));
    }
    found
}

const CONTOUR: &str =
    "this cycle reads its contour under another of G90 and G91 than the one it stands under";
const MACHINE: &str = "G53 while G91 is in force: no source says what its words count";
const TABLE: &str = "a table is written by an increment (G91), and no word of the target adds to it";
const TABLE_HELP: &str = "write the whole value under G90";
const UNKNOWN: &str = "whether G90 or G91 is in force here is not known";
const HELP: &str =
    "write G90 or G91 before it, or say in the source's profile how a program begins: [start] codes";

/// Writes the mode that each block's words need.
pub fn to_mode(module: &mut Module, context: &mut Context<'_>) -> bool {
    let (mut found, mut changed) = (Vec::new(), Vec::new());
    let letters = has_letters(context.target);
    let is_modal = |stmt: &Stmt| matches!(stmt.kind, StmtKind::ModalCall(_));
    let mut stmts = module.programs.iter().flat_map(|p| &p.blocks).flat_map(|block| &block.stmts);
    let any_modal = stmts.any(is_modal);
    let called = called(module);
    let by_name = |call: &Call| !matches!(call.callee, Callee::Computed(_) | Callee::Cycle(_));
    let named = module.programs.iter().flat_map(|p| &p.blocks).all(|block| calls_of(block).all(by_name));
    for (index, program) in module.programs.iter_mut().enumerate() {
        // One that calls nothing, and that nothing calls, has no modal call in force.
        let calls_none = program.blocks.iter().flat_map(calls_of).next().is_none();
        let alone = calls_none && named && called.get(index) == Some(&false);
        let calls_after_moves = any_modal && !alone;
        let (straight, reached, fresh) = (entered_straight(program), reached(program), restarts(program));
        // What a macro after each move does to where cycles begin is not known.
        let contours = if calls_after_moves { Contours::default() } else { Contours::of(program) };
        let (mut mode, mut place) = (None, Place::keeping_level());
        for (count, (block, straight)) in program.blocks.iter_mut().zip(straight).enumerate() {
            if !straight {
                mode = None;
                place.forget();
            }
            let read = !reached.get(count).copied().unwrap_or(true)
                && block.stmts.first().is_some_and(|stmt| contours.starts_at(stmt).is_some());
            if read {
                // Cycles alone come to it, which read places.
                mode = Some(Op::Absolute);
            }
            let mut ahead = Vec::new();
            for (at, stmt) in block.stmts.iter_mut().enumerate() {
                // A macro that runs after each move may leave the tool elsewhere.
                if calls_after_moves {
                    place.forget();
                }
                enter(&mut place, stmt, contours.starts_at(stmt), read && at == 0);
                let before = place;
                let inside = before.in_contour() || contours.inside((count, at));
                // The letters need no mode, so an operator may begin there after a reset; in a contour nobody does.
                if !inside && fresh.get(count).and_then(|fresh| fresh.get(at)).copied().unwrap_or(true) {
                    mode = None;
                }
                place.step(stmt);
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if let [NcItem::Op(op @ (Op::Absolute | Op::Incremental))] = nc.items[..] {
                    if mode.replace(op) == Some(op) {
                        nc.items.clear();
                    }
                    continue;
                }
                if nc.ops().any(Op::reads_contour) {
                    nc.items.retain(|item| !is_no_step(item));
                }
                // The reader has refused a place and an increment of one axis.
                if Role::STEPS
                    .iter()
                    .any(|(whole, step)| nc.word(*whole).is_some() && nc.word(*step).is_some())
                {
                    continue;
                }
                // The radius of a cylinder is no increment, and its block takes no other code.
                if nc.has(Op::Cylinder) && mode != Some(Op::Absolute) {
                    ahead.push((
                        at,
                        SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() },
                    ));
                    mode = Some(Op::Absolute).filter(|_| stmt.site.skip.is_none());
                    continue;
                }
                // Under G91 they would shift or add.
                let table = sets_zero(nc) && !nc.has(Op::SetPosition);
                // The depth of a hole counts from its plane, not from where the tool stands.
                if !place.drills() && !table && (both_kinds(nc) || inside) {
                    place::to_places(nc, before);
                    if !inside && !letters && both_kinds(nc) {
                        place::to_steps(nc, before);
                    }
                }
                // The blocks of a contour are places: the cycle must not read them under G91.
                if !moves(nc) && !sets_zero(nc) && !nc.ops().any(Op::reads_contour) {
                    continue;
                }
                if table {
                    if has_places(nc) && mode != Some(Op::Absolute) {
                        nc.items.insert(0, NcItem::Op(Op::Absolute));
                        let alone = stmt.site.skip.is_none() && !calls_after_moves;
                        mode = Some(Op::Absolute).filter(|_| alone);
                    }
                    continue;
                }
                // What no mode can say for the whole block the letters say, where the target has them.
                let stays = letters && (both_kinds(nc) || inside && has_steps(nc));
                if both_kinds(nc) && !stays {
                    found.push((
                        index,
                        stmt.site.span,
                        (BOTH, "write both as places, or both as increments"),
                    ));
                    continue;
                }
                if inside && has_steps(nc) && !stays {
                    found.push((index, stmt.site.span, (IN_CONTOUR, IN_CONTOUR_HELP)));
                    swap(nc, |(whole, step)| (step, whole));
                    continue;
                }
                let needed = if has_steps(nc) && !stays { Op::Incremental } else { Op::Absolute };
                if place.drills() && !nc.ops().any(Op::is_hole) && mode != Some(needed) {
                    changed.push((index, stmt.site.span));
                }
                if !stays {
                    swap(nc, |(whole, step)| (step, whole));
                }
                let written = mode != Some(needed);
                if written {
                    nc.items.insert(0, NcItem::Op(needed));
                    mode = Some(needed);
                }
                // A switch that skips the block leaves the mode as it was, and a macro that runs after it changes it.
                if written && stmt.site.skip.is_some() || calls_after_moves {
                    mode = None;
                }
            }
            for (at, site) in ahead.into_iter().rev() {
                block.stmts.insert(at, Stmt { site, ..mode_alone(Op::Absolute) });
            }
            block.stmts.retain_mut(is_left);
        }
    }
    for (index, span) in changed {
        context.rests_on_target(index, span, Question::CyclePlanesFrozen);
    }
    // A target that is not said to have the letters may have them.
    let open = context.target.leaves_open(STEP_LETTERS);
    for (index, span, (what, help)) in found {
        let finding = Diagnostic::new(Code::NoEquivalent, span, what);
        let finding = match open {
            true => finding.with_help(format!("{help}{LETTERS_HELP}")).lacking_there(STEP_LETTERS),
            false => finding.with_help(help),
        };
        context.add(index, finding);
    }
    true
}

const LETTERS_HELP: &str = "; or, if the target takes U, W and H as increments in its own system too, write step_letters = \"yes\" under \
                            [settings] in its profile";
const BOTH: &str = "a place and an increment in one block, and where the tool stands is not known here: the target has one mode for both axes";
const IN_CONTOUR: &str = "increments in a contour become places for the target, and where the cycle that reads it begins is not known as numbers";
const IN_CONTOUR_HELP: &str = "write G0 with X and Z as numbers right before each cycle that reads this contour, the same for all of them; or write the \
                               contour as places";

/// True of an increment of 0.
fn is_no_step(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(role, by) if role.is_step() && by.constant() == Some(0.0))
}

/// Comes to a statement: a contour begins where the cycles begin that read it.
fn enter(place: &mut Place, stmt: &Stmt, start: Option<[Option<f64>; 2]>, read: bool) {
    let inside = place.in_contour();
    place.enter(stmt);
    match start {
        Some([x, z]) if read || !inside && place.in_contour() => place.knows(x, z),
        // The run comes to it by itself, too.
        Some([x, z]) => place.agrees(x, z),
        None => {}
    }
}

fn has_steps(nc: &Nc) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_step()))
}

fn has_places(nc: &Nc) -> bool {
    let whole = |item: &NcItem| matches!(item, NcItem::Word(role, _) if Role::STEPS.iter().any(|(whole, _)| whole == role));
    nc.items.iter().any(whole)
}

/// True of a block with places and increments.
fn both_kinds(nc: &Nc) -> bool {
    has_steps(nc) && has_places(nc)
}

/// True for a block whose axis words say where something goes.
fn moves(nc: &Nc) -> bool {
    let words = nc.items.iter().any(|item| {
        matches!(item, NcItem::Word(role, _) if Role::STEPS.iter().any(|(whole, step)| whole == role || step == role))
    });
    words && !nc.ops().any(Op::takes_axes) && !nc.has(Op::Dwell)
}

fn swap(nc: &mut Nc, pair: impl Fn((Role, Role)) -> (Role, Role)) {
    for item in &mut nc.items {
        if let NcItem::Word(role, _) = item
            && let Some((_, to)) = Role::STEPS.into_iter().map(&pair).find(|(from, _)| from == role)
        {
            *role = to;
        }
    }
}

//! Codes of the tool length without a word of its axis, where they move nothing on the source, and that axis on the target.
//!
//! Law: a length that moves nothing acts first in the next block that places something along its axis, so its code may
//! stand in that block. Side conditions: both blocks are in one stretch without jumps and calls; what stands between
//! leaves that axis, the lengths and what coordinates count from alone, and reads no state; the block is a straight move to
//! an absolute place. An M code of the machine's builder does the same whichever length is in force. Where the block names a
//! length itself, the earlier code did nothing. Counter-example: `G43 H1`, `G91 Z-5.`, which goes down by 5 from where the
//! tool stands, and by the length too where its code stands beside it.

use crate::canon::{Act, Group, Op, Role};
use crate::ir::{Bank, Block, Expr, Module, Nc, NcItem, Place, Stmt, StmtKind};
use crate::legalize::assumptions::shop::{moves_by_code, moves_on_one, names_length};
use crate::legalize::features::Features;
use crate::legalize::moves::mains::facts_from_reset;
use crate::legalize::{Context, Modal};

/// True if the library names tool lengths, and their codes move the axis on the target alone.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    moves_on_one(features, context, [context.target, context.source])
}

/// Puts the codes beside the moves.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = facts_from_reset(module, context);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let found = moved(block, facts.at(index, id), context);
            changed |= !found.is_empty();
            put(block, &found);
        }
    }
    changed
}

/// The statements whose codes go, and those that they go to, where these do not name a length themselves.
fn moved(block: &Block, mut state: Modal, context: &Context<'_>) -> Vec<(usize, Option<usize>)> {
    let mut found = Vec::new();
    let mut waits: Option<usize> = None;
    let mut off: Option<usize> = None;
    // A number that is computed is the same as long as nothing is assigned.
    let mut computed = false;
    for (at, stmt) in block.stmts.iter().enumerate() {
        let before = state.clone();
        state.step(stmt);
        let names = stmt.kind.nc().filter(|nc| names_length(nc));
        // In the machine's coordinates no length counts: its end may stand there.
        if let Some(from) = off.take() {
            match stmt.kind.nc() {
                Some(nc) if takes_end(nc, &state, context) && stmt.site.skip.is_none() => {
                    found.push((from, Some(at)));
                    waits = waits.filter(|waits| *waits != from);
                }
                _ if is_quiet(stmt, &state, context) => off = Some(from),
                _ => {}
            }
        }
        let takes = stmt.kind.nc().filter(|nc| takes(nc, &state, context) && stmt.site.skip.is_none());
        if let (Some(from), Some(nc)) = (waits, takes) {
            match names {
                None => found.push((from, Some(at))),
                Some(_) if says_all(nc) => found.push((from, None)),
                Some(_) => {}
            }
            waits = None;
        } else if let Some(nc) = names {
            let begins = stmt.site.skip.is_none() && moves_by_code(nc, &before) && goes(nc, &state, context);
            computed = nc.word(Role::LengthOffset).is_some_and(|row| row.constant().is_none());
            // What is named anew before it counts was never used.
            found.extend(waits.filter(|_| begins && says_all(nc)).map(|from| (from, None)));
            waits = begins.then_some(at);
            let ends = nc.has(Op::LengthOff) && nc.word(Role::Z).is_none() && stmt.site.skip.is_none();
            off = (ends && goes(nc, &state, context)).then_some(at);
        } else if !is_quiet(stmt, &state, context) || computed && matches!(stmt.kind, StmtKind::Assign { .. })
        {
            waits = None;
        }
    }
    found
}

/// True where a block says both what is done with a length and which.
fn says_all(nc: &Nc) -> bool {
    nc.has(Op::LengthOff)
        || (nc.has(Op::LengthPlus) || nc.has(Op::LengthMinus)) && nc.word(Role::LengthOffset).is_some()
}

fn is_of_length(item: &NcItem) -> bool {
    match item {
        NcItem::Op(op) => op.group() == Group::LengthComp,
        NcItem::Word(role, _) => *role == Role::LengthOffset,
        NcItem::Code(..) => false,
    }
}

/// True for a block whose code of the length may go to a later one.
pub(super) fn goes(nc: &Nc, after: &Modal, context: &Context<'_>) -> bool {
    nc.word(Role::LengthOffset).is_none_or(|row| !reads_state(row))
        && is_plain(nc.items.iter().filter(|item| !is_of_length(item)), after, context)
}

/// True for a straight move to an absolute place along the axis of the length.
fn takes(nc: &Nc, after: &Modal, context: &Context<'_>) -> bool {
    let depth = |item: &&NcItem| matches!(item, NcItem::Word(Role::Z, _));
    let place = nc.word(Role::Z).filter(|value| !value.may_be_vacant() && !reads_state(value));
    let straight = matches!(after.op(Group::Motion), Some(Op::Rapid | Op::Linear));
    let row = nc.word(Role::LengthOffset).map(Expr::constant);
    place.is_some()
        && row != Some(None)
        && stands(after)
        && straight
        && after.op(Group::Distance) == Some(Op::Absolute)
        && is_plain(nc.items.iter().filter(|item| !is_of_length(item) && !depth(item)), after, context)
}

/// True for a move in the machine's coordinates along the axis of the length, which may have the end of a length beside it.
fn takes_end(nc: &Nc, after: &Modal, context: &Context<'_>) -> bool {
    let own = |item: &&NcItem| matches!(item, NcItem::Op(Op::MachineOnce) | NcItem::Word(Role::Z, _));
    nc.has(Op::MachineOnce)
        && nc.word(Role::Z).is_some_and(|value| value.constant().is_some())
        && !names_length(nc)
        && stands(after)
        && after.op(Group::Distance) == Some(Op::Absolute)
        && is_plain(nc.items.iter().filter(|item| !own(item)), after, context)
}

/// True for a statement that is the same whichever length is in force.
pub(super) fn is_quiet(stmt: &Stmt, after: &Modal, context: &Context<'_>) -> bool {
    match &stmt.kind {
        StmtKind::Comment => true,
        StmtKind::Nc(nc) => is_plain(nc.items.iter(), after, context),
        StmtKind::Assign { target: Place::Var(_), value } => !reads_state(value),
        _ => false,
    }
}

/// True where words and codes move no axis of the length and leave alone what coordinates count from.
fn is_plain<'n>(mut items: impl Iterator<Item = &'n NcItem>, after: &Modal, context: &Context<'_>) -> bool {
    use Role::{A, ArcI, ArcJ, ArcRadius, B, C, Feed, RadiusOffset, Speed, Tool, WorkOffset, X, Y};
    let stands = stands(after);
    items.all(|item| match item {
        NcItem::Op(op) => keeps(*op),
        NcItem::Word(Role::Act, act) => act.constant().is_some_and(|act| is_still(act, context)),
        NcItem::Word(role, value) => {
            let plain = matches!(role, Feed | RadiusOffset | Speed | Tool | WorkOffset) || role.is_act_word();
            let across = matches!(role, A | ArcI | ArcJ | ArcRadius | B | C | X | Y);
            (plain || across && stands) && !reads_state(value)
        }
        NcItem::Code(..) => false,
    })
}

/// True where words of axes are moves, each along its own axis.
pub(super) fn stands(after: &Modal) -> bool {
    let off = |group, op| after.op(group).is_none_or(|there| there == op);
    !after.may_call()
        && after.op(Group::Cycle) == Some(Op::CycleOff)
        && off(Group::Rotation, Op::RotateOff)
        && off(Group::Scaling, Op::ScaleOff)
        && off(Group::Mirror, Op::MirrorOff)
}

/// True for a builder's code that is an M code on the source, and on the target where that has it: no place in it counts the
/// tool length.
fn is_still(act: f64, context: &Context<'_>) -> bool {
    let Some(act) = Act::of(act) else { return false };
    let is_m = |code: &str| code.starts_with('M');
    context.source.site_of(act).is_some_and(|site| is_m(&site.code))
        && context.target.code_of(act).is_none_or(|row| is_m(&row.code))
}

fn keeps(op: Op) -> bool {
    use Group::{Coolant, Distance, FeedMode, PathMode, Plane, RadiusComp, ReturnPlane, SpeedMode, Spindle};
    let here =
        matches!(op, Op::Rapid | Op::Linear | Op::ExactStopOnce | Op::SelectWork | Op::CycleOff | Op::Act);
    let group = op.group();
    here || matches!(
        group,
        Coolant | Distance | FeedMode | PathMode | Plane | RadiusComp | ReturnPlane | SpeedMode | Spindle
    )
}

/// True where the machine's state is read, as a position: it may hold the length.
pub(super) fn reads_state(value: &Expr) -> bool {
    let mut found = false;
    value.walk(&mut |e| {
        found |= matches!(e, Expr::System(..) | Expr::Indirect(Bank::Numbered, _));
    });
    found
}

/// Takes the codes out of their blocks and puts them where they go.
fn put(block: &mut Block, found: &[(usize, Option<usize>)]) {
    let mut gone = Vec::new();
    for (from, to) in found {
        let StmtKind::Nc(nc) = &mut block.stmts[*from].kind else { continue };
        let (codes, rest): (Vec<NcItem>, Vec<NcItem>) =
            std::mem::take(&mut nc.items).into_iter().partition(is_of_length);
        if rest.is_empty() {
            gone.push(*from);
        }
        nc.items = rest;
        if let Some(StmtKind::Nc(nc)) = to.and_then(|to| block.stmts.get_mut(to)).map(|stmt| &mut stmt.kind) {
            let words = nc.items.iter().position(|item| !matches!(item, NcItem::Op(_)));
            let at = words.unwrap_or(nc.items.len());
            nc.items.splice(at..at, codes);
        }
    }
    for at in gone.into_iter().rev() {
        match block.stmts[at].site.comments.is_empty() {
            true => drop(block.stmts.remove(at)),
            false => block.stmts[at].kind = StmtKind::Comment,
        }
    }
}

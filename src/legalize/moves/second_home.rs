//! The return to the second reference position, where the target has no code for it.
//!
//! Law: a return is a rapid move to its point, if that is not where the tool stands, and one in machine coordinates to the place that the target's
//! profile gives for it: `second_home_x`, `second_home_y` and `second_home_z` under `[settings]`. Which place of the target stands for a position
//! that somebody set on the source no program says. Side conditions: the return is one of X, Y and Z, none of its words may be vacant, and it goes
//! to the second position; on a mill neither a cycle nor cutter compensation is in force. Counter-example: `G30 P3 U0`.

use super::home::{VACANT, unsure};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, SECOND_HOME, Units};
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::{Context, Modal, replace_statements};
use std::collections::BTreeMap;

/// True of a target that has machine coordinates and no such return, and whose profile may give the place.
pub fn concerns(target: &Control) -> bool {
    let has = |op| target.code_for(op, &BTreeMap::new()).is_some();
    let asked = target.dialect().settings.iter().any(|row| SECOND_HOME.contains(&row.name.as_str()));
    asked && !has(Op::Reference2) && has(Op::MachineOnce)
}

/// The setting of a profile that gives the place along an axis.
fn setting(role: Role) -> Option<&'static str> {
    let [x, y, z] = SECOND_HOME;
    match role {
        Role::X | Role::StepX => Some(x),
        Role::Y => Some(y),
        Role::Z | Role::StepZ => Some(z),
        _ => None,
    }
}

/// The place that a profile gives, if it is a number.
fn stated(name: &str, target: &Control) -> Option<f64> {
    target.setting(name)?.parse().ok().filter(|place: &f64| place.is_finite())
}

/// Why a return stays, and the settings that are missing.
struct Stays(&'static str, &'static str, Vec<&'static str>);

/// Writes returns as moves.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let unsure = unsure(module, context, Op::Reference2);
    let mill = context.target.machine() == Machine::Mill;
    replace_statements(module, &facts, |index, state, stmt, out| {
        let before = state.clone();
        state.step(&stmt);
        let (span, skip) = (stmt.site.span, stmt.site.skip);
        let made = match &stmt.kind {
            // What no setting can give is asked as a code that the target does not have.
            StmtKind::Nc(nc) if mill && nc.has(Op::Reference2) && !is_second(nc) => return out.push(stmt),
            StmtKind::Nc(nc) if nc.has(Op::Reference2) => {
                if unsure.contains(&(index, span)) {
                    Err(Stays(VACANT, VACANT_HELP, Vec::new()))
                } else if mill && is_under_another(&before) {
                    Err(Stays(UNDER, UNDER_HELP, Vec::new()))
                } else {
                    moves(nc, &before, context.source, context.target)
                }
            }
            _ => return out.push(stmt),
        };
        let blocks = match made {
            Ok(blocks) => blocks,
            Err(Stays(what, help, missing)) => {
                let refused = || Diagnostic::new(Code::NoEquivalent, span, what).with_help(help);
                match missing.as_slice() {
                    [] => context.add(index, refused()),
                    missing => {
                        missing.iter().for_each(|name| context.add(index, refused().lacking_there(*name)))
                    }
                }
                return out.push(stmt);
            }
        };
        let mut site = Some(stmt.site);
        for items in blocks {
            let site = site.take().unwrap_or_else(|| SourceInfo { span, skip, ..SourceInfo::default() });
            out.push(Stmt { kind: StmtKind::Nc(Nc { items }), site });
        }
    });
}

/// True for a return to the second position of axes that have a place for it.
fn is_second(nc: &Nc) -> bool {
    let axes = || nc.items.iter().filter_map(axis);
    nc.word(Role::ReferencePoint).is_none_or(|which| which.constant() == Some(2.0))
        && axes().next().is_some()
        && axes().all(|(role, _)| setting(role).is_some())
}

/// True where a cycle or the compensation of the cutter is in force, or a macro is called after each move: what a return does there
/// is more than a move.
fn is_under_another(state: &Modal) -> bool {
    let compensates = matches!(state.op(Group::RadiusComp), Some(Op::RadiusLeft | Op::RadiusRight));
    state.op(Group::Cycle).is_some_and(Op::is_cycle) || compensates || state.may_call()
}

/// The blocks that stand for a return.
fn moves(nc: &Nc, before: &Modal, source: &Control, target: &Control) -> Result<Vec<Vec<NcItem>>, Stays> {
    let axes: Vec<(Role, Expr)> = nc.items.iter().filter_map(axis).collect();
    let by_mode = source.code_for(Op::Incremental, &BTreeMap::new()).is_some();
    let whole = axes.iter().any(|(role, _)| !role.is_step());
    let mut now = before.clone();
    now.step_words(nc);
    let under = now.op(Group::Distance).filter(|_| whole && by_mode);
    let no_way = axes.iter().all(|(_, value)| value.constant() == Some(0.0));
    // Under G91 a way of 0 is none, as U0 and W0 are.
    let in_steps = under == Some(Op::Incremental) && no_way;
    if !is_second(nc) || whole && by_mode && under != Some(Op::Absolute) && !in_steps {
        return Err(Stays(OTHER, OTHER_HELP, Vec::new()));
    }
    let missing: Vec<&'static str> = axes
        .iter()
        .filter_map(|(role, _)| setting(*role))
        .filter(|name| stated(name, target).is_none())
        .collect();
    if !missing.is_empty() {
        return Err(Stays(MISSING, MISSING_HELP, missing));
    }
    let unit = |units: Units| if units == Units::Inch { Op::Inch } else { Op::Metric };
    if before.op(Group::Units).is_some_and(|op| target.units().map(unit) != Some(op)) {
        return Err(Stays(UNIT, UNIT_HELP, Vec::new()));
    }
    let stays = in_steps || no_way && axes.iter().all(|(role, _)| role.is_step());
    let mut home: Vec<NcItem> = nc.items.iter().filter(|item| axis(item).is_none()).cloned().collect();
    home.retain(|item| !matches!(item, NcItem::Word(Role::ReferencePoint, _)));
    let mut out = Vec::new();
    if !stays {
        // A mode beside the code counts for the place on the way.
        let is_mode = |item: &NcItem| matches!(item, NcItem::Op(Op::Absolute | Op::Incremental));
        let (mut way, rest): (Vec<NcItem>, Vec<NcItem>) = home.into_iter().partition(is_mode);
        home = rest;
        way.push(NcItem::Op(Op::Rapid));
        way.extend(axes.iter().map(|(role, value)| NcItem::Word(*role, value.clone())));
        out.push(way);
    }
    for item in &mut home {
        if *item == NcItem::Op(Op::Reference2) {
            *item = NcItem::Op(Op::MachineOnce);
        }
    }
    for (role, _) in &axes {
        let whole = match role {
            Role::X | Role::StepX => Role::X,
            Role::Y => Role::Y,
            _ => Role::Z,
        };
        let place = setting(*role).and_then(|name| stated(name, target));
        home.extend(place.map(|place| NcItem::Word(whole, Expr::Number(place))));
    }
    if in_steps {
        home.retain(|item| *item != NcItem::Op(Op::Incremental));
        home.insert(0, NcItem::Op(Op::Absolute));
        out.push(home);
        out.push(vec![NcItem::Op(Op::Incremental)]);
    } else {
        out.push(home);
    }
    let again = before.op(Group::Motion).filter(|op| !stays && *op != Op::Rapid);
    out.extend(again.map(|op| vec![NcItem::Op(op)]));
    Ok(out)
}

fn axis(item: &NcItem) -> Option<(Role, Expr)> {
    match item {
        NcItem::Word(role, value) if role.is_axis() => Some((*role, value.clone())),
        _ => None,
    }
}

const OTHER: &str = "a return to another reference position than the second, of other axes than X, Y and Z, or by way of a place that is not known to be \
     absolute: the target has no code for it";
const OTHER_HELP: &str = "write the place as a move in machine coordinates (G53)";
const MISSING: &str = "the target has no code for the second reference position, and its profile gives no number for the place that stands for it";
const MISSING_HELP: &str = "write the place in machine coordinates into the target's profile, under [settings]: second_home_x, second_home_y and \
     second_home_z. If something else shall happen there, say so in the source's profile: [codes] and the code, with target, or do = \"omit\" or \
     \"stop\"";
const VACANT_HELP: &str = "give the variable a value in each run, or test it before the return";
const UNDER: &str = "a return to the second reference position under a drilling cycle, cutter compensation or a modal call: the target has no code for it";
const UNDER_HELP: &str = "end the cycle (G80), the compensation (G40) or the call (G67) before it";
const UNIT: &str =
    "the second home position is in the unit of the target's profile, and the program is in the other one";
const UNIT_HELP: &str = "write the program in the unit that the profile of the machine gives";

//! The return to the second reference position, where the target has no code for it.
//!
//! Law: a return is a rapid move to its point, if that is not where the tool stands, and one in machine coordinates to the place that the target's
//! profile gives for it: `second_home_x` and `second_home_z` under `[settings]`. Which place of the target stands for a position that somebody
//! set on the source no program says. Side conditions: the return is one of X and Z, and goes to the second position. Counter-example: `G30 P3 U0`.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, SECOND_HOME, Units};
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::{Context, Modal, replace_statements};
use std::collections::BTreeMap;

/// True of a lathe that has machine coordinates, and no such return.
pub fn concerns(target: &Control) -> bool {
    let has = |op| target.code_for(op, &BTreeMap::new()).is_some();
    target.machine() == Machine::Lathe && !has(Op::Reference2) && has(Op::MachineOnce)
}

/// The setting of a profile that gives the place along an axis.
fn setting(role: Role) -> Option<&'static str> {
    let [x, z] = SECOND_HOME;
    match role {
        Role::X | Role::StepX => Some(x),
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
    replace_statements(module, &facts, |index, state, stmt, out| {
        let before = state.clone();
        state.step(&stmt);
        let made = match &stmt.kind {
            StmtKind::Nc(nc) if nc.has(Op::Reference2) => moves(nc, &before, context.source, context.target),
            _ => return out.push(stmt),
        };
        let (span, skip) = (stmt.site.span, stmt.site.skip);
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

/// The blocks that stand for a return.
fn moves(nc: &Nc, before: &Modal, source: &Control, target: &Control) -> Result<Vec<Vec<NcItem>>, Stays> {
    let second = nc.word(Role::ReferencePoint).is_none_or(|which| which.constant() == Some(2.0));
    let axes: Vec<(Role, Expr)> = nc.items.iter().filter_map(axis).collect();
    let known = axes.iter().all(|(role, _)| setting(*role).is_some());
    let by_mode = source.code_for(Op::Incremental, &BTreeMap::new()).is_some();
    let whole = axes.iter().any(|(role, _)| !role.is_step());
    let mut now = before.clone();
    now.step_words(nc);
    let under = now.op(Group::Distance).filter(|_| whole && by_mode);
    let no_way = axes.iter().all(|(_, value)| value.constant() == Some(0.0));
    // Under G91 a way of 0 is none, as U0 and W0 are.
    let in_steps = under == Some(Op::Incremental) && no_way;
    if !second || !known || axes.is_empty() || whole && by_mode && under != Some(Op::Absolute) && !in_steps {
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
    let mut out = Vec::new();
    if !stays {
        let words = axes.iter().map(|(role, value)| NcItem::Word(*role, value.clone()));
        out.push(std::iter::once(NcItem::Op(Op::Rapid)).chain(words).collect());
    }
    let mut home: Vec<NcItem> = nc.items.iter().filter(|item| axis(item).is_none()).cloned().collect();
    home.retain(|item| !matches!(item, NcItem::Word(Role::ReferencePoint, _)));
    for item in &mut home {
        if *item == NcItem::Op(Op::Reference2) {
            *item = NcItem::Op(Op::MachineOnce);
        }
    }
    for (role, _) in &axes {
        let whole = if matches!(role, Role::X | Role::StepX) { Role::X } else { Role::Z };
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

const OTHER: &str = "a return to another reference position than the second, of other axes than X and Z, or by increments under G91: the target has no code for it";
const OTHER_HELP: &str = "write the place as a move in machine coordinates (G53)";
const MISSING: &str = "the target has no code for the second reference position, and its profile gives no number for the place that stands for it";
const MISSING_HELP: &str = "write the place in machine coordinates into the target's profile, under [settings]: second_home_x and second_home_z";
const UNIT: &str =
    "the second home position is in the unit of the target's profile, and the program is in the other one";
const UNIT_HELP: &str = "write the program in the unit that the profile of the machine gives";

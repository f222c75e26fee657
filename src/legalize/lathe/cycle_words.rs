//! Cycles of a lathe whose depth, way back and form stand in a block before them, in their own block, or in settings.
//!
//! Law: a cycle does the same if each of these values is the same, wherever it is taken from. Side conditions: the block that sets them
//! stands before the cycle with no jump between; a value that the target takes from a setting is a constant, and the target's profile
//! says that the setting is so. Counter-example: a setting that another program needs otherwise.

use super::settings::{Kind, row, setting, takes};
use super::spring_passes::{Place, passes};
use super::thread_form;
use crate::assume::Predicate;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Expr, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a cycle takes besides its own words.
type Values = Vec<(Role, Expr)>;

/// True if there are such cycles, and the target does not take the values from where the source does.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let rough = features.role(Role::RoughX) || features.role(Role::RoughZ);
    let differs = |kind: &Kind| {
        features.op(kind.cycle)
            && kind.roles.iter().any(|role| {
                takes(context.source, kind.setup, *role) != takes(context.target, kind.setup, *role)
                    || takes(context.source, kind.cycle, *role) != takes(context.target, kind.cycle, *role)
            })
    };
    rough || super::settings::KINDS.iter().any(differs)
}

/// Gives each cycle its values in the target's form.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let mut found = Vec::new();
    let mut changed = false;
    for block in &mut program.blocks {
        if block.stmts.iter().any(|stmt| cycle_of(stmt).is_some()) {
            changed = true;
            let old = std::mem::take(&mut block.stmts);
            let ends = matches!(block.term.kind, TermKind::End { .. });
            block.stmts = in_block(old, ends, (context.source, context.target), &mut found).into();
        }
    }
    refuse_two_values(&mut found);
    for (span, what, help, needs) in found {
        let code = if needs.is_some() { Code::Conditional } else { Code::NoEquivalent };
        let finding = Diagnostic::new(code, span, what.as_str());
        let finding = if help.is_empty() { finding } else { finding.with_help(help) };
        match needs {
            Some(predicate) => context.add_once(index, &what, finding.assuming(predicate)),
            None => context.add(index, finding),
        }
    }
    changed
}

/// A setting cannot change while a program runs: what needs another value than a cycle before is refused.
fn refuse_two_values(found: &mut Found) {
    let mut values: BTreeMap<Arc<str>, f64> = BTreeMap::new();
    for (_, what, help, needs) in found {
        let Some(Predicate::Setting(name, value)) = needs else { continue };
        let first = *values.entry(name.clone()).or_insert(*value);
        if first.to_bits() != value.to_bits() {
            let number = name.trim_start_matches("setting.");
            *what = format!(
                "setting {number} must be {value} here, and {first} for a cycle before: a program cannot change it"
            );
            *help = "give both cycles the same value, or make two programs of them".into();
            *needs = None;
        }
    }
}

fn nc_of(stmt: &Stmt) -> Option<&Nc> {
    match &stmt.kind {
        StmtKind::Nc(nc) => Some(nc),
        _ => None,
    }
}

fn cycle_of(stmt: &Stmt) -> Option<&'static Kind> {
    nc_of(stmt)?.ops().find_map(Kind::of_cycle)
}

fn setup_of(stmt: &Stmt) -> Option<&'static Kind> {
    nc_of(stmt)?.ops().find_map(Kind::of_setup)
}

/// What is found: where, what, what to do, and what the conversion supposes; of a refusal nothing.
type Found = Vec<(Span, String, String, Option<Predicate>)>;

fn in_block(
    old: impl IntoIterator<Item = Stmt>,
    ends: bool,
    (source, target): (&Control, &Control),
    found: &mut Found,
) -> Vec<Stmt> {
    let mut new: Vec<Stmt> = Vec::new();
    let mut set: Vec<(Op, Values)> = Vec::new();
    let mut place = Place::default();
    let mut old: std::collections::VecDeque<Stmt> = old.into_iter().collect();
    while let Some(mut stmt) = old.pop_front() {
        if let Some(kind) = setup_of(&stmt) {
            let values = nc_of(&stmt).map(|nc| values_of(nc, kind)).unwrap_or_default();
            let slot = set.iter().position(|(op, _)| *op == kind.setup);
            let slot = slot.unwrap_or_else(|| {
                set.push((kind.setup, Values::new()));
                set.len() - 1
            });
            replace(&mut set[slot].1, values);
            if stmt.site.skip.is_some() {
                found.push((stmt.site.span, SKIPPED.into(), String::new(), None));
            }
            // The comments stay; the block is written anew where the target has one.
            stmt.kind = StmtKind::Comment;
            if !stmt.site.comments.is_empty() {
                new.push(stmt);
            }
            continue;
        }
        place.step(&stmt);
        let Some(kind) = cycle_of(&stmt) else {
            new.push(stmt);
            continue;
        };
        let before = set.iter().find(|(op, _)| *op == kind.setup).map(|(_, values)| values.clone());
        match resolve(&stmt, kind, before, source, target) {
            Ok(Given { words, setup, finishes, angle, needs }) => {
                let span = stmt.site.span;
                found.extend(needs.into_iter().map(|(what, help, needs)| (span, what, help, Some(needs))));
                if finishes > 0 {
                    match passes(&stmt, (angle, finishes), place, (old.make_contiguous(), ends)) {
                        Some(all) => all.into_iter().rev().for_each(|pass| old.push_front(pass)),
                        None => found.push((stmt.site.span, FINISHES.into(), FINISHES_HELP.into(), None)),
                    }
                }
                if !setup.is_empty() {
                    let nc = with(kind.setup, setup);
                    let site = crate::ir::SourceInfo { span: stmt.site.span, ..Default::default() };
                    new.push(Stmt { kind: StmtKind::Nc(nc), site });
                }
                if let StmtKind::Nc(nc) = &mut stmt.kind {
                    drop_rough(nc, target);
                    nc.items
                        .retain(|item| !matches!(item, NcItem::Word(role, _) if kind.roles.contains(role)));
                    nc.items.extend(words.into_iter().map(|(role, value)| NcItem::Word(role, value)));
                }
            }
            Err((what, help)) => found.push((stmt.site.span, what, help, None)),
        }
        new.push(stmt);
    }
    new
}

/// A control that always ends roughing with a pass along the contour needs no words for what that pass takes: `roughing` says
/// that the passes differ.
fn drop_rough(nc: &mut Nc, target: &Control) {
    let along = target.behaviour(Question::RoughingEnds).is_some_and(|row| row.value == "along");
    let Some(op) = nc.ops().find(|op| matches!(op, Op::RoughTurning | Op::RoughFacing)) else { return };
    let rough = |role: Role| matches!(role, Role::RoughX | Role::RoughZ) && !takes(target, op, role);
    if along {
        nc.items.retain(|item| !matches!(item, NcItem::Word(role, _) if rough(*role)));
    }
}

/// What a cycle is given on the target.
#[derive(Default)]
struct Given {
    /// By words of its own block.
    words: Values,
    /// By words of the block before it.
    setup: Values,
    /// Finishing passes of a thread beyond those of the cycle.
    finishes: usize,
    /// The thread's angle, degrees.
    angle: f64,
    /// Settings that the target must have.
    needs: Vec<Need>,
}

/// A setting that the target must have: what, what to do, and as a value.
type Need = (String, String, Predicate);

const FINISHES: &str = "the target finishes a thread in one pass, if something is left for it, and this one has more: they are not written out, as \
                        where the cycle begins, or a number of it, is not known here";
const FINISHES_HELP: &str = "write X and Z of the start as numbers right before the thread, and a G code in the next block that moves; or give the \
                             thread one finishing pass and an allowance for it";

const SKIPPED: &str =
    "a block skip before the block that sets what the next cycle takes: whether it counts is not known here";

fn with(op: Op, values: Values) -> Nc {
    let words = values.into_iter().map(|(role, value)| NcItem::Word(role, value));
    Nc { items: std::iter::once(NcItem::Op(op)).chain(words).collect() }
}

fn values_of(nc: &Nc, kind: &Kind) -> Values {
    let words = nc.items.iter().filter_map(|item| match item {
        NcItem::Word(role, value) if kind.roles.contains(role) => Some((*role, value.clone())),
        _ => None,
    });
    words.collect()
}

fn replace(values: &mut Values, new: Values) {
    values.retain(|(role, _)| new.iter().all(|(other, _)| other != role));
    values.extend(new);
}

/// The words of the cycle's own block, and of the block before it.
fn resolve(
    stmt: &Stmt,
    kind: &'static Kind,
    before: Option<Values>,
    source: &Control,
    target: &Control,
) -> Result<Given, (String, String)> {
    let mut values = given(stmt, kind, before, source)?;
    if !thread_form::apart(&mut values) {
        let what = "finishing passes, run-out and angle of a thread are in a number that is computed, or has not six digits";
        return Err((what.into(), "write the number as it is: P021060".into()));
    }
    usual(&mut values);
    let finishes = if takes(target, kind.setup, Role::ThreadForm) { 0 } else { more_finishes(&mut values) };
    let angle = constant(&values, Role::ThreadAngle).unwrap_or(0.0);
    if takes(target, kind.setup, Role::ThreadForm) && !thread_form::together(&mut values) {
        let what = "the run-out or the angle of this thread has more digits than the target takes";
        return Err((what.into(), "the target takes tenths of a lead, and whole degrees".into()));
    }
    let (words, setup, needs) = place(values, kind, target)?;
    Ok(Given { words, setup, finishes, angle, needs })
}

/// Finishing passes beyond the one that takes off what was left; they are no word of the cycle any more.
fn more_finishes(values: &mut Values) -> usize {
    let Some(all) = constant(values, Role::ThreadFinishes).filter(|all| *all >= 1.0) else { return 0 };
    let left = constant(values, Role::ThreadAllowance).is_some_and(|left| left > 0.0);
    values.retain(|(role, _)| *role != Role::ThreadFinishes);
    if left {
        values.push((Role::ThreadFinishes, Expr::Number(1.0)));
    }
    all as usize - usize::from(left)
}

fn constant(values: &Values, wanted: Role) -> Option<f64> {
    values.iter().find(|(role, _)| *role == wanted).and_then(|(_, value)| value.constant())
}

/// All values of a cycle: of its own words, of the block before it, and of the source's settings.
fn given(
    stmt: &Stmt,
    kind: &'static Kind,
    before: Option<Values>,
    source: &Control,
) -> Result<Values, (String, String)> {
    let mut values = before.unwrap_or_default();
    let own = nc_of(stmt).map(|nc| values_of(nc, kind)).unwrap_or_default();
    replace(&mut values, own);
    for role in kind.roles {
        if values.iter().any(|(found, _)| found == role) {
            continue;
        }
        match setting(source, kind.cycle, *role) {
            Some((_, Some(value))) => values.push((*role, Expr::Number(value))),
            Some((name, None)) => return Err(of_setting(source, name, *role)),
            None => {}
        }
    }
    if values.is_empty() && row(source, kind.setup).is_some() {
        let code = row(source, kind.setup).map_or("", |row| row.code.as_str());
        let what = format!("no {code} block before this one sets {}", meaning(kind.roles[0]));
        return Err((what, format!("write the {code} block right before this one")));
    }
    Ok(values)
}

fn of_setting(control: &Control, name: &str, role: Role) -> (String, String) {
    let number = name.trim_start_matches("setting.");
    let title = &control.dialect().title;
    let what =
        format!("setting {number} of the {title} says {}, and its profile does not give it", meaning(role));
    (
        what,
        format!("look it up on the machine, and write in its profile, under [settings]: {number} = \"...\""),
    )
}

fn meaning(role: Role) -> String {
    let meaning = role.meaning().trim().trim_end_matches('.');
    let mut chars = meaning.chars();
    chars.next().map_or(String::new(), |first| first.to_lowercase().chain(chars).collect())
}

/// A control without a letter for them has one finishing pass, if there is something left for it, and goes in along one flank.
fn usual(values: &mut Values) {
    values.retain(|(role, value)| *role != Role::ThreadInfeed || value.constant() != Some(1.0));
    let left = constant(values, Role::ThreadAllowance);
    if left.is_some_and(|left| left > 0.0) && values.iter().all(|(role, _)| *role != Role::ThreadFinishes) {
        values.push((Role::ThreadFinishes, Expr::Number(1.0)));
    }
}

/// Puts each value where the target takes it from: its words, the block before it, or settings that it needs. A setting that is
/// not as the program needs it is worse than a block before.
fn place(
    values: Values,
    kind: &'static Kind,
    target: &Control,
) -> Result<(Values, Values, Vec<Need>), (String, String)> {
    let (words, others): (Values, Values) =
        values.iter().cloned().partition(|(role, _)| takes(target, kind.cycle, *role));
    let needs: Result<Vec<Option<Need>>, _> =
        others.iter().map(|(role, value)| in_setting(*role, value, kind, target)).collect();
    if let Ok(needs) = &needs
        && needs.iter().all(Option::is_none)
    {
        return Ok((words, Values::new(), Vec::new()));
    }
    let (before, rest): (Values, Values) =
        values.iter().cloned().partition(|(role, _)| takes(target, kind.setup, *role));
    if !before.is_empty() && rest.iter().all(|(role, _)| takes(target, kind.cycle, *role)) {
        return Ok((rest, before, Vec::new()));
    }
    Ok((words, Values::new(), needs?.into_iter().flatten().collect()))
}

/// What the target must be set to for a value that no word of it says; nothing where it is so.
fn in_setting(
    role: Role,
    value: &Expr,
    kind: &Kind,
    target: &Control,
) -> Result<Option<Need>, (String, String)> {
    if role == Role::ThreadFinishes {
        let what = "the number of finishing passes of this thread is computed, or none";
        return match value.constant() {
            Some(1.0) => Ok(None),
            _ => Err((what.into(), "write it as a number".into())),
        };
    }
    let Some((name, stated)) = setting(target, kind.cycle, role) else {
        return Err((format!("the target has no word for {} here", meaning(role)), String::new()));
    };
    let number = name.trim_start_matches("setting.");
    let Some(value) = value.constant() else {
        let what = format!("{} is computed, and the target takes it from setting {number}", meaning(role));
        return Err((what, "write it as a number".into()));
    };
    if stated.is_some_and(|stated| (value - stated).abs() < 1e-9) {
        return Ok(None);
    }
    let now =
        stated.map_or("its profile does not give it".into(), |stated| format!("its profile says {stated}"));
    let title = &target.dialect().title;
    let what = format!(
        "setting {number} of the {title} must be {value} while this program runs ({}); {now}",
        meaning(role)
    );
    let help = format!(
        "set it so before the program is run; if the machine is always set so, write in its profile, under [settings]: {number} = \"{value}\""
    );
    Ok(Some((what, help, Predicate::Setting(name.into(), value))))
}

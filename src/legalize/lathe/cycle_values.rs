//! What a cycle of a lathe takes besides its own words: where the source gives each value, and where the target takes it from.

use super::left_settings::{Left, leaves_allowance, left_of, runs_out_otherwise};
use super::settings::{Kind, row, row_for, setting, stand_in, takes};
use super::thread_form;
use crate::assume::Predicate;
use crate::canon::{CycleSetting, Role};
use crate::dialect::{Control, Setting};
use crate::ir::{Expr, Module, Nc, NcItem, Stmt};
use std::sync::Arc;

/// What a cycle takes besides its own words.
pub(super) type Values = Vec<(Role, Expr)>;

/// What a cycle is given on the target.
#[derive(Default)]
pub(super) struct Given {
    /// By words of its own block.
    pub words: Values,
    /// By words of the block before it.
    pub setup: Values,
    /// Finishing passes of a thread beyond those of the cycle.
    pub finishes: usize,
    /// The thread's angle, degrees.
    pub angle: f64,
    /// Settings that the target must have.
    pub needs: Vec<Need>,
    /// What settings of the target say, whatever that is.
    pub left: Vec<Left>,
}

/// What of a cycle a setting of the target says.
enum Taken {
    Need(Need),
    Left(Left),
    /// That it is there at all, and how much it is.
    Both(Need, Left),
}

/// A setting that the target must have: what, what to do, and as a value.
pub(super) type Need = (String, String, Predicate);

/// Why a cycle is not told whole: what, what to do, and the setting that the source's profile does not state.
pub(super) struct Untold(pub String, pub String, pub Option<Arc<str>>);

impl From<(String, String)> for Untold {
    fn from((what, help): (String, String)) -> Self {
        Self(what, help, None)
    }
}

/// What the blocks of a library set, each for a kind: a value that a setting stands in for may be one of these.
pub(super) struct Written(Vec<(&'static Kind, Role, Expr)>);

impl Written {
    /// That of all programs, where the source has such settings.
    pub(super) fn of(module: &Module, source: &Control) -> Self {
        if source.dialect().settings.iter().all(|row| row.otherwise.is_none()) {
            return Self(Vec::new());
        }
        let blocks = module.programs.iter().flat_map(|program| &program.blocks);
        let stmts = blocks.flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
        let setups = stmts.filter_map(|nc| Some((nc, nc.ops().find_map(Kind::of_setup)?)));
        let values = setups.flat_map(|(nc, kind)| {
            values_of(nc, kind).into_iter().map(move |(role, value)| (kind, role, value))
        });
        Self(values.collect())
    }

    /// True where a block sets the role for a kind to anything else.
    fn others(&self, source: &Control, kind: &'static Kind, role: Role, value: f64) -> bool {
        let part = thread_form::PARTS.contains(&role);
        let Some(row) = row_for(source, kind.cycle, role) else { return false };
        self.0.iter().any(|(by, found, set)| {
            row.cycles.contains(&by.cycle)
                && match found {
                    Role::ThreadForm => part,
                    found => *found == role && set.constant() != Some(value),
                }
        })
    }
}

/// The values that a block's own words give.
pub(super) fn values_of(nc: &Nc, kind: &Kind) -> Values {
    let words = nc.items.iter().filter_map(|item| match item {
        NcItem::Word(role, value) if kind.roles.contains(role) => Some((*role, value.clone())),
        _ => None,
    });
    words.collect()
}

/// Puts new values in the place of old ones.
pub(super) fn replace(values: &mut Values, new: Values) {
    values.retain(|(role, _)| new.iter().all(|(other, _)| other != role));
    values.extend(new);
}

/// All that a cycle takes besides its own words, and whether some of it is what a setting stands in for; if something of it is not told: what,
/// and what to do.
pub(super) fn told(
    stmt: &Stmt,
    kind: &'static Kind,
    before: Option<Values>,
    (source, written): (&Control, &Written),
) -> Result<(Values, bool), Untold> {
    let (mut values, stood_in) = given(stmt, kind, before, (source, written))?;
    if !thread_form::apart(&mut values) {
        let what = "finishing passes, run-out and angle of a thread are in a number that is computed, or has not six digits";
        return Err((what.to_owned(), "write the number as it is: P021060".to_owned()).into());
    }
    for (role, value) in &mut values {
        // P1: none is one.
        if *role == Role::ThreadFinishes && value.constant() == Some(0.0) {
            *value = Expr::Number(1.0);
        }
    }
    usual(&mut values);
    Ok((values, stood_in))
}

/// The words of the cycle's own block, and of the block before it.
pub(super) fn resolve(
    mut values: Values,
    kind: &'static Kind,
    target: &Control,
) -> Result<Given, (String, String)> {
    let counts_finishes = takes(target, kind.setup, Role::ThreadForm)
        || setting(target, kind.cycle, Role::ThreadFinishes).is_some();
    let finishes = if counts_finishes { 0 } else { more_finishes(&mut values, target) };
    let angle = constant(&values, Role::ThreadAngle).unwrap_or(0.0);
    if takes(target, kind.cycle, Role::ThreadInfeed)
        && values.iter().all(|(role, _)| *role != Role::ThreadInfeed)
    {
        // Written, because the letter's last value of another code might count.
        values.push((Role::ThreadInfeed, Expr::Number(1.0)));
    }
    if takes(target, kind.setup, Role::ThreadForm) && !thread_form::together(&mut values) {
        let what = "the run-out or the angle of this thread has more digits than the target takes";
        return Err((what.into(), "the target takes tenths of a lead, and whole degrees".into()));
    }
    let (words, setup, taken) = place(values, kind, target)?;
    let (mut needs, mut left) = (Vec::new(), Vec::new());
    for taken in taken {
        match taken {
            Taken::Need(need) => needs.push(need),
            Taken::Left(one) => left.push(one),
            Taken::Both(need, one) => {
                needs.push(need);
                left.push(one);
            }
        }
    }
    Ok(Given { words, setup, finishes, angle, needs, left })
}

/// Finishing passes beyond the one that takes off what was left; they are no word of the cycle any more.
fn more_finishes(values: &mut Values, target: &Control) -> usize {
    let Some(all) = constant(values, Role::ThreadFinishes).filter(|all| *all >= 1.0) else { return 0 };
    let left = constant(values, Role::ThreadAllowance);
    let left = left.is_some_and(|left| left > 0.0) || leaves_allowance(left, target);
    values.retain(|(role, _)| *role != Role::ThreadFinishes);
    if left {
        values.push((Role::ThreadFinishes, Expr::Number(1.0)));
    }
    all as usize - usize::from(left)
}

/// The number that a value is.
pub(super) fn constant(values: &Values, wanted: Role) -> Option<f64> {
    values.iter().find(|(role, _)| *role == wanted).and_then(|(_, value)| value.constant())
}

/// All values of a cycle: of its own words, of the block before it, and of the source's settings.
fn given(
    stmt: &Stmt,
    kind: &'static Kind,
    before: Option<Values>,
    (source, written): (&Control, &Written),
) -> Result<(Values, bool), Untold> {
    let mut values = before.unwrap_or_default();
    let own = stmt.kind.nc().map(|nc| values_of(nc, kind)).unwrap_or_default();
    replace(&mut values, own);
    let mut stood_in = false;
    for role in kind.roles {
        let form = |found: &Role| *found == Role::ThreadForm && thread_form::PARTS.contains(role);
        if values.iter().any(|(found, _)| found == role || form(found)) {
            continue;
        }
        match setting(source, kind.cycle, *role) {
            Some((_, Some(value))) => values.push((*role, Expr::Number(value))),
            Some((name, None)) => return Err(of_setting(source, name, *role)),
            None => match stand_in(source, kind.cycle, *role) {
                Some((name, Some(value))) if written.others(source, kind, *role, value) => {
                    return Err(changed(source, kind, *role, name).into());
                }
                Some((_, Some(value))) => {
                    values.push((*role, Expr::Number(value)));
                    stood_in = true;
                }
                Some((name, None)) => return Err(of_setting(source, name, *role)),
                None => {}
            },
        }
    }
    let has = |role: &Role| values.iter().any(|(found, _)| found == role);
    // Settings may stand in for all parts of a thread's form.
    let is_told =
        |role: &Role| has(role) || (*role == Role::ThreadForm && thread_form::PARTS.iter().all(has));
    match kind.roles.iter().find(|role| needs(source, kind, **role) && !is_told(role)) {
        Some(role) => Err(not_set(source, kind, *role).into()),
        None => Ok((values, stood_in)),
    }
}

/// True of a value that must be told: what the control takes otherwise stands in a parameter, or is the last cycle's.
fn needs(source: &Control, kind: &Kind, role: Role) -> bool {
    match role {
        Role::ThreadForm => takes(source, kind.setup, role),
        Role::ThreadFinishes | Role::ThreadRunOut | Role::ThreadAngle | Role::ThreadInfeed => false,
        _ => true,
    }
}

fn not_set(source: &Control, kind: &Kind, role: Role) -> (String, String) {
    let before = row(source, kind.setup).filter(|_| !takes(source, kind.cycle, role));
    match before {
        Some(row) => (
            format!("no {} block before this one sets {}", row.code, meaning(role)),
            format!("write the {} block right before this one, with all its words", row.code),
        ),
        None => (format!("the block does not say {}", meaning(role)), "write the word for it".into()),
    }
}

/// What is said where a setting stands in for a word, and blocks of the library set it to something else.
fn changed(source: &Control, kind: &'static Kind, role: Role, name: &str) -> (String, String) {
    let (what, help) = not_set(source, kind, role);
    let (of, number) = setting_named(name);
    (format!("{what}, and other blocks of the library change {of} {number}, which counts then"), help)
}

fn of_setting(control: &Control, name: &str, role: Role) -> Untold {
    let (kind, number) = setting_named(name);
    let title = &control.dialect().title;
    let meaning = of_row(control, name, role);
    let what = format!("{kind} {number} of the {title} says {meaning}, and its profile does not give it");
    let help =
        format!("look it up on the machine, and write in its profile, under [{kind}s]: {number} = \"...\"");
    Untold(what, help, Some(name.into()))
}

/// A setting as people name it, `setting` or `parameter`, and its number.
pub(super) fn setting_named(name: &str) -> (&str, &str) {
    name.split_once('.').unwrap_or(("setting", name))
}

fn meaning(role: Role) -> String {
    in_a_sentence(role.meaning())
}

/// What a setting says, in words of its own where it counts parts of what the word does: tenths of a lead.
fn of_row(control: &Control, name: &str, role: Role) -> String {
    let counts = control.setting_row(name).filter(|row| row.parts.is_some());
    counts.map_or_else(|| meaning(role), |row| in_a_sentence(&row.meaning))
}

fn in_a_sentence(meaning: &str) -> String {
    let meaning = meaning.trim().trim_end_matches('.');
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
) -> Result<(Values, Values, Vec<Taken>), (String, String)> {
    let (words, others): (Values, Values) =
        values.iter().cloned().partition(|(role, _)| takes(target, kind.cycle, *role));
    let needs: Result<Vec<Option<Taken>>, _> =
        others.iter().map(|(role, value)| in_setting(*role, value, kind, target)).collect();
    if let Ok(needs) = &needs
        && needs.iter().all(Option::is_none)
    {
        return Ok((words, Values::new(), Vec::new()));
    }
    // Nobody knows a control to be the newer one whose profile lists no options; both take the values from settings.
    let has = row(target, kind.setup).is_some_and(|row| {
        row.option.as_deref().is_none_or(|option| target.has_option(option) == Some(true))
    });
    let (before, rest): (Values, Values) =
        values.iter().cloned().partition(|(role, _)| has && takes(target, kind.setup, *role));
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
) -> Result<Option<Taken>, (String, String)> {
    let by = setting(target, kind.cycle, role);
    if role == Role::ThreadFinishes && by.is_none() {
        let none = "this thread has 0 finishing passes by the first two digits of its P, and no source says what that is: 1 to 99 are read";
        let computed = "the number of finishing passes of this thread is computed";
        return match value.constant() {
            Some(1.0) => Ok(None),
            Some(_) => Err((none.into(), "write how many passes there are: P011060 for one".into())),
            None => Err((computed.into(), "write it as a number".into())),
        };
    }
    let Some((name, stated)) = by else {
        return Err((format!("the target has no word for {} here", meaning(role)), String::new()));
    };
    let whole = target.setting_row(name).map_or(1.0, Setting::whole);
    // As the machine has it: 10 tenths for a length of one lead.
    let as_set = |value: f64| (value * whole * 1e6).round() / 1e6;
    let is = (kind.cycle, role);
    let left = left_of(is, value.constant(), stated, target);
    let (kind, number) = setting_named(name);
    let value = match (value.constant(), left) {
        (Some(value), _) if stated.is_some_and(|stated| (value - stated).abs() < 1e-9) => return Ok(None),
        (value, Some(what)) => {
            let value = value.map(as_set);
            return Ok(Some(Taken::Left(Left { what, name: Some(name.into()), value, unit: None })));
        }
        (value, None) => value,
    };
    let Some(value) = value else {
        let what = format!("{} is computed, and the target takes it from {kind} {number}", meaning(role));
        return Err((what, "write it as a number".into()));
    };
    let (value, stated) = (as_set(value), stated.map(as_set));
    let now =
        stated.map_or("its profile does not give it".into(), |stated| format!("its profile says {stated}"));
    let title = &target.dialect().title;
    let what = format!(
        "{kind} {number} of the {title} must be {value} while this program runs ({}); {now}",
        of_row(target, name, role)
    );
    let help = format!(
        "set it so before the program is run; if the machine is always set so, write in its profile, under [{kind}s]: {number} = \"{value}\""
    );
    let need = (what, help, Predicate::Setting(name.into(), value));
    if stated.is_some() && runs_out_otherwise(is, value, target) {
        let what = CycleSetting::ThreadRunOut;
        let left = Left { what, name: Some(name.into()), value: Some(value), unit: None };
        return Ok(Some(Taken::Both(need, left)));
    }
    Ok(Some(Taken::Need(need)))
}

//! Cycles of a lathe whose depth, way back and form stand in a block before them, in their own block, or in settings.
//!
//! Law: a cycle does the same if each of these values is the same, wherever it is taken from. Side conditions: the block that sets them
//! stands before the cycle with no jump between, and nothing that changes what it is computed from; a value that the target takes from
//! a setting is a constant, and the target's profile says that the setting is so. Counter-example: a setting that another program needs
//! otherwise.

use super::cycle_values::{Given, Values, replace, resolve, values_of};
use super::place::Place;
use super::settings::{Kind, setting, takes};
use super::spring_passes::passes;
use super::straight::entered_straight;
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Units};
use crate::ir::{Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::text::Span;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

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
    let straight = entered_straight(program);
    let other_unit = names_other_unit(program, context.source) || names_other_unit(program, context.target);
    let modal = context.features.has(Feature::Modal);
    let (mut set, mut found) = (Vec::new(), Vec::new());
    let mut changed = false;
    for (block, straight) in program.blocks.iter_mut().zip(straight) {
        if !straight {
            set.clear();
        }
        if block.stmts.iter().any(|stmt| cycle_of(stmt).is_some() || setup_of(stmt).is_some()) {
            changed = true;
            let old = std::mem::take(&mut block.stmts);
            let mut run =
                Run { source: context.source, target: context.target, other_unit, modal, set, found };
            block.stmts = run.block(old, matches!(block.term.kind, TermKind::End { .. })).into();
            (set, found) = (run.set, run.found);
        } else if block.stmts.iter().any(|stmt| !matches!(stmt.kind, StmtKind::Comment)) {
            set.iter_mut().for_each(Set::pass);
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

fn cycle_of(stmt: &Stmt) -> Option<&'static Kind> {
    stmt.kind.nc()?.ops().find_map(Kind::of_cycle)
}

fn setup_of(stmt: &Stmt) -> Option<&'static Kind> {
    stmt.kind.nc()?.ops().find_map(Kind::of_setup)
}

/// What is found: where, what, what to do, and what the conversion supposes; of a refusal nothing.
type Found = Vec<(Span, String, String, Option<Predicate>)>;

/// What a block before has set for the cycles of a kind.
struct Set {
    setup: Op,
    values: Values,
    /// True once something ran that may change what a computed value is.
    passed: bool,
}

impl Set {
    fn pass(&mut self) {
        self.passed = true;
    }

    /// True where a value may not be any more what it was when it was set.
    fn is_stale(&self) -> bool {
        self.passed && self.values.iter().any(|(_, value)| value.constant().is_none())
    }
}

/// The walk through the blocks of a program.
struct Run<'c> {
    source: &'c Control,
    target: &'c Control,
    /// True where the program may run in another unit than the one that the settings are in.
    other_unit: bool,
    /// True where a macro may run after each move, and leave the tool elsewhere.
    modal: bool,
    set: Vec<Set>,
    found: Found,
}

impl Run<'_> {
    fn block(&mut self, old: impl IntoIterator<Item = Stmt>, ends: bool) -> Vec<Stmt> {
        let mut new: Vec<Stmt> = Vec::new();
        let mut old: VecDeque<Stmt> = old.into_iter().collect();
        let mut place = Place::default();
        while let Some(stmt) = old.pop_front() {
            if let Some(kind) = setup_of(&stmt) {
                new.extend(self.setup(kind, stmt));
                continue;
            }
            place.enter(&stmt);
            place.step(&stmt);
            if self.modal {
                place = Place::default();
            }
            if let Some(kind) = cycle_of(&stmt) {
                let (made, more) = self.cycle(kind, stmt, place, (old.make_contiguous(), ends));
                new.extend(made);
                more.into_iter().rev().for_each(|pass| old.push_front(pass));
            } else {
                let comment = matches!(stmt.kind, StmtKind::Comment);
                new.push(stmt);
                if comment {
                    continue;
                }
            }
            self.set.iter_mut().for_each(Set::pass);
        }
        new
    }

    /// Takes the values of a block that sets them; what else it does stays. It is written anew where the target has such a block.
    fn setup(&mut self, kind: &Kind, mut stmt: Stmt) -> Option<Stmt> {
        let nc = stmt.kind.nc()?;
        let values = values_of(nc, kind);
        let own = |item: &NcItem| match item {
            NcItem::Op(op) => *op == kind.setup,
            NcItem::Word(role, _) => kind.roles.contains(role),
            NcItem::Code(..) => false,
        };
        let rest: Vec<NcItem> = nc.items.iter().filter(|item| !own(item)).cloned().collect();
        let moves = |item: &NcItem| match item {
            NcItem::Op(op) => matches!(op.group(), Group::Motion),
            NcItem::Word(role, _) => role.is_axis(),
            NcItem::Code(..) => true,
        };
        if stmt.site.skip.is_some() {
            self.found.push((stmt.site.span, SKIPPED.into(), String::new(), None));
        }
        if rest.iter().any(moves) {
            self.found.push((stmt.site.span, MOVES.into(), "give the move a block of its own".into(), None));
        }
        match self.set.iter_mut().find(|set| set.setup == kind.setup) {
            Some(set) => {
                // What it computed before may be old, and what this block leaves out stays.
                let stale = set.is_stale();
                replace(&mut set.values, values);
                set.passed = stale;
            }
            None => self.set.push(Set { setup: kind.setup, values, passed: false }),
        }
        stmt.kind = if rest.is_empty() { StmtKind::Comment } else { StmtKind::Nc(Nc { items: rest }) };
        let empty = matches!(stmt.kind, StmtKind::Comment) && stmt.site.comments.is_empty();
        (!empty).then_some(stmt)
    }

    /// True where a length of the cycle comes from a setting, or is to be in one.
    fn rests_on_length(&self, kind: &Kind, setup: &Values) -> bool {
        let written = |role: &Role| setup.iter().any(|(found, _)| found == role);
        kind.roles.iter().any(|role| {
            let there = setting(self.source, kind.cycle, *role).is_some();
            let here = setting(self.target, kind.cycle, *role).is_some() && !written(role);
            role.is_length() && (there || here)
        })
    }

    /// The cycle with its words, after the block that sets the rest, if the target has one; and the passes that the target's
    /// cycle does not make.
    fn cycle(
        &mut self,
        kind: &'static Kind,
        mut stmt: Stmt,
        place: Place,
        next: (&[Stmt], bool),
    ) -> (Vec<Stmt>, Vec<Stmt>) {
        let span = stmt.site.span;
        let set = self.set.iter().find(|set| set.setup == kind.setup);
        if set.is_some_and(Set::is_stale) {
            self.refuse(span, STALE, "write the block that sets it right before this one");
            return (vec![stmt], Vec::new());
        }
        let before = set.map(|set| set.values.clone());
        let Given { words, setup, finishes, angle, needs } =
            match resolve(&stmt, kind, before, self.source, self.target) {
                Ok(given) => given,
                Err((what, help)) => {
                    self.refuse(span, &what, &help);
                    return (vec![stmt], Vec::new());
                }
            };
        if self.other_unit && self.rests_on_length(kind, &setup) {
            self.refuse(
                span,
                OTHER_UNIT,
                "write the program in the unit that the profile of the machine gives",
            );
        }
        self.found.extend(needs.into_iter().map(|(what, help, needs)| (span, what, help, Some(needs))));
        let more =
            if finishes > 0 { passes(&stmt, (angle, finishes), place, next) } else { Some(Vec::new()) };
        if more.is_none() {
            self.refuse(span, FINISHES, FINISHES_HELP);
        }
        if let StmtKind::Nc(nc) = &mut stmt.kind {
            drop_rough(nc, self.source, self.target);
            nc.items.retain(|item| !matches!(item, NcItem::Word(role, _) if kind.roles.contains(role)));
            nc.items.extend(words.into_iter().map(|(role, value)| NcItem::Word(role, value)));
        }
        let site = crate::ir::SourceInfo { span, ..Default::default() };
        let setup = (!setup.is_empty()).then(|| Stmt { kind: StmtKind::Nc(with(kind, setup)), site });
        (setup.into_iter().chain([stmt]).collect(), more.unwrap_or_default())
    }

    fn refuse(&mut self, span: Span, what: &str, help: &str) {
        self.found.push((span, what.into(), help.into(), None));
    }
}

/// True of a program that names another unit than the machine's profile gives, in which lengths of settings are.
fn names_other_unit(program: &Program, control: &Control) -> bool {
    let other = match control.units() {
        Some(Units::Metric) => Op::Inch,
        Some(Units::Inch) => Op::Metric,
        None => return false,
    };
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| stmt.kind.nc().is_some_and(|nc| nc.has(other)))
}

/// A control that always ends roughing with a pass along the contour needs no words for what that pass takes: `roughing` says
/// that the passes differ.
fn drop_rough(nc: &mut Nc, source: &Control, target: &Control) {
    let is_along =
        |control: &Control| control.behaviour(Question::RoughingEnds).is_some_and(|row| row.value == "along");
    let along = is_along(target) && !is_along(source);
    let Some(op) = nc.ops().find(|op| matches!(op, Op::RoughTurning | Op::RoughFacing)) else { return };
    let rough = |role: Role| matches!(role, Role::RoughX | Role::RoughZ) && !takes(target, op, role);
    if along {
        nc.items.retain(|item| !matches!(item, NcItem::Word(role, _) if rough(*role)));
    }
}

const FINISHES: &str = "the target finishes a thread in one pass, if something is left for it, and this one has more: they are not written out, as \
                        where the cycle begins, or a number of it, is not known here";
const FINISHES_HELP: &str = "write X and Z of the start as numbers right before the thread, and a G code in the next block that moves; or give the \
                             thread one finishing pass and an allowance for it";
const OTHER_UNIT: &str = "a length of this cycle is in a setting, in the unit of the control, and the program names the other unit";
const STALE: &str = "a value that this cycle takes from a block before it is computed, and what it is computed from may have changed since";
const MOVES: &str =
    "a move in the block that sets what the next cycle takes: no source says what the control does with it";
const SKIPPED: &str =
    "a block skip before the block that sets what the next cycle takes: whether it counts is not known here";

/// The block that sets the values, in the order that people write them in.
fn with(kind: &Kind, mut values: Values) -> Nc {
    values.sort_by_key(|(role, _)| kind.roles.iter().position(|found| found == role));
    let words = values.into_iter().map(|(role, value)| NcItem::Word(role, value));
    Nc { items: std::iter::once(NcItem::Op(kind.setup)).chain(words).collect() }
}

//! Cycles of a lathe whose depth, way back and form stand in a block before them, in their own block, or in settings.
//!
//! Law: a cycle does the same if each of these values is the same, wherever it is taken from. Side conditions: the block that sets them
//! stands before the cycle with no jump between, and nothing that changes what it is computed from; a value that the target takes from
//! a setting is a constant, and the target's profile says that the setting is so. Counter-example: a setting that another program needs
//! otherwise.

use super::cycle_values::{Values, nc_of, replace, resolve, values_of};
use super::settings::{Kind, setting, takes};
use super::straight::entered_straight;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Units};
use crate::ir::{Nc, NcItem, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;

/// True if there are such cycles, and the target does not take the values from where the source does.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let differs = |kind: &Kind| {
        features.op(kind.cycle)
            && kind.roles.iter().any(|role| {
                takes(context.source, kind.setup, *role) != takes(context.target, kind.setup, *role)
                    || takes(context.source, kind.cycle, *role) != takes(context.target, kind.cycle, *role)
            })
    };
    super::settings::KINDS.iter().any(differs)
}

/// Gives each cycle its values in the target's form.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let straight = entered_straight(program);
    let other_unit = names_other_unit(program, context.source) || names_other_unit(program, context.target);
    let (mut set, mut found) = (Vec::new(), Vec::new());
    let mut changed = false;
    for (block, straight) in program.blocks.iter_mut().zip(straight) {
        if !straight {
            set.clear();
        }
        if block.stmts.iter().any(|stmt| cycle_of(stmt).is_some() || setup_of(stmt).is_some()) {
            changed = true;
            let old = std::mem::take(&mut block.stmts);
            let mut run = Run { source: context.source, target: context.target, other_unit, set, found };
            block.stmts = run.block(old).into();
            (set, found) = (run.set, run.found);
        } else if block.stmts.iter().any(|stmt| !matches!(stmt.kind, StmtKind::Comment)) {
            set.iter_mut().for_each(Set::pass);
        }
    }
    for (span, what, help) in found {
        let finding = Diagnostic::new(Code::NoEquivalent, span, what);
        context.add(index, if help.is_empty() { finding } else { finding.with_help(help) });
    }
    changed
}

fn cycle_of(stmt: &Stmt) -> Option<&'static Kind> {
    nc_of(stmt)?.ops().find_map(Kind::of_cycle)
}

fn setup_of(stmt: &Stmt) -> Option<&'static Kind> {
    nc_of(stmt)?.ops().find_map(Kind::of_setup)
}

/// What is found: where, what, and what to do.
type Found = Vec<(Span, String, String)>;

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
    set: Vec<Set>,
    found: Found,
}

impl Run<'_> {
    fn block(&mut self, old: impl IntoIterator<Item = Stmt>) -> Vec<Stmt> {
        let mut new: Vec<Stmt> = Vec::new();
        for stmt in old {
            if let Some(kind) = setup_of(&stmt) {
                new.extend(self.setup(kind, stmt));
                continue;
            }
            if let Some(kind) = cycle_of(&stmt) {
                new.extend(self.cycle(kind, stmt));
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
        let nc = nc_of(&stmt)?;
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
            self.found.push((stmt.site.span, SKIPPED.into(), String::new()));
        }
        if rest.iter().any(moves) {
            self.found.push((stmt.site.span, MOVES.into(), "give the move a block of its own".into()));
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

    /// The cycle with its words, after the block that sets the rest, if the target has one.
    fn cycle(&mut self, kind: &'static Kind, mut stmt: Stmt) -> Vec<Stmt> {
        let set = self.set.iter().find(|set| set.setup == kind.setup);
        if set.is_some_and(Set::is_stale) {
            self.found.push((
                stmt.site.span,
                STALE.into(),
                "write the block that sets it right before this one".into(),
            ));
            return vec![stmt];
        }
        let before = set.map(|set| set.values.clone());
        let (words, setup) = match resolve(&stmt, kind, before, self.source, self.target) {
            Ok((words, setup)) if self.other_unit && self.rests_on_length(kind, &setup) => {
                let help = "write the program in the unit that the profile of the machine gives";
                self.found.push((stmt.site.span, OTHER_UNIT.into(), help.into()));
                (words, setup)
            }
            Ok(made) => made,
            Err((what, help)) => {
                self.found.push((stmt.site.span, what, help));
                return vec![stmt];
            }
        };
        if let StmtKind::Nc(nc) = &mut stmt.kind {
            nc.items.retain(|item| !matches!(item, NcItem::Word(role, _) if kind.roles.contains(role)));
            nc.items.extend(words.into_iter().map(|(role, value)| NcItem::Word(role, value)));
        }
        let site = crate::ir::SourceInfo { span: stmt.site.span, ..Default::default() };
        let setup = (!setup.is_empty()).then(|| Stmt { kind: StmtKind::Nc(with(kind, setup)), site });
        setup.into_iter().chain([stmt]).collect()
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
    stmts.any(|stmt| nc_of(stmt).is_some_and(|nc| nc.has(other)))
}

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

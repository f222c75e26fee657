//! Cycles of a lathe whose depth, way back and form stand in a block before them, in their own block, or in settings.
//!
//! Law: a cycle does the same if each of these values is the same, wherever it is taken from. Side conditions: the block that sets them
//! stands before the cycle with no jump between, and nothing that changes what it is computed from; a value that the target takes from
//! a setting is a constant, and the target's profile says that the setting is so. Counter-example: a setting that another program needs
//! otherwise.

mod forms;
mod kept;
mod starts;
mod written;

use super::contours::facts_uncompensated;
use super::cycle_values::{Given, Untold, Values, Written, replace, resolve, told, values_of};
use super::left_settings::leaves;
use super::place::Place;
use super::roughing::{ALLOWANCES, ALLOWANCES_HELP, drop_rough};
use super::setting_values::{Found, Instead, So, tell};
use super::settings::{KINDS, Kind, block_before, setting, share, stands_in, takes};
use super::straight::entered_straight;
use super::thread_loops::{self, Made};
use super::thread_passes::says_how;
use super::threads::{beyond, flanks_are_open};
use crate::canon::{Group, Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::analysis::Summaries;
use crate::ir::{Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::codes::pauses::related;
use crate::legalize::features::{Feature, Features};
use crate::legalize::moves::turned_units::{Turned, may_be_other};
use crate::legalize::{Context, Modal};
use crate::text::Span;
use starts::{Starts, vacant};

/// True if there are such cycles, and the target takes the values from elsewhere than the source, or from a setting that is another.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let rough = features.role(Role::RoughX) || features.role(Role::RoughZ);
    let apart = |kind: &Kind, role: Role| {
        let of = |control| setting(control, kind.cycle, role);
        match (of(context.source), of(context.target)) {
            (Some((ours, Some(here))), Some((theirs, Some(there)))) => here != there || ours != theirs,
            // Of one setting nobody knows that it is another; of two nobody knows that they agree.
            (Some((ours, _)), Some((theirs, _))) => ours != theirs,
            _ => false,
        }
    };
    let differs = |kind: &Kind| {
        features.op(kind.cycle)
            && kind.roles.iter().any(|role| {
                takes(context.source, kind.setup, *role) != takes(context.target, kind.setup, *role)
                    || takes(context.source, kind.cycle, *role) != takes(context.target, kind.cycle, *role)
                    || apart(kind, *role)
                    || stands_in(context.source, features, kind.cycle, *role)
            })
    };
    // What settings hold once the unit is turned is not what the profiles say.
    let is_turned = context.target.is(Question::UnitsAgree)
        && Turned::of(context.target).is_some_and(|turned| features.op(turned.op));
    let cuts = || KINDS.iter().any(|kind| features.op(kind.cycle));
    rough || KINDS.iter().any(differs) || is_turned && cuts()
}

/// Gives each cycle its values in the target's form, and writes out the threads and grooves for which it has none; gives the
/// programs that this changed.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> Vec<usize> {
    let runs = |stmt: &Stmt| cycle_of(stmt).is_some() || setup_of(stmt).is_some();
    let has = |program: &Program| program.blocks.iter().any(|block| block.stmts.iter().any(runs));
    let with: Vec<usize> = (0..module.programs.len()).filter(|at| has(&module.programs[*at])).collect();
    let (called, main) = (context.modal_facts(module), facts_uncompensated(module, context));
    let sides = [Op::RadiusLeft, Op::RadiusRight];
    let compensates = related(module, context, |features| sides.iter().any(|op| features.op(*op)));
    let written = Written::of(module, context.source);
    let summaries = context.summaries(module);
    let calls = if with.is_empty() { Vec::new() } else { context.called(module).pairs(module) };
    let others = [context.source, context.target].map(|control| may_be_other(module, &calls, control));
    let is_turned = others[1].contains(&true) && context.target.is(Question::UnitsAgree);
    let turned = is_turned.then(|| context.target.in_other_unit());
    let mut all = Vec::new();
    for index in &with {
        let [source, target] = &others;
        let there = turned.as_ref().filter(|_| target[*index]);
        let units = ([source[*index], target[*index] && there.is_none()], there);
        let program = &mut module.programs[*index];
        // Who calls one that returns, the library may not know; others begin after a reset or an end (docs/lathe.md Q1).
        let facts = if returns(program) { &called } else { &main };
        let states = program.ids().map(|id| facts.at(*index, id)).collect();
        let found =
            each(program, states, (*index, &written, &summaries, compensates[*index]), units, context);
        all.push((*index, found));
    }
    tell(all, &calls, module, context);
    with
}

fn each(
    program: &mut Program,
    states: Vec<Modal>,
    (index, written, summaries, compensates): (usize, &Written, &Summaries, bool),
    (other_unit, turned): ([bool; 2], Option<&Control>),
    context: &mut Context<'_>,
) -> Found {
    let mut found = Found::new();
    forms::settle(program, summaries, &mut found);
    let straight = entered_straight(program);
    let loops = [Op::Threading, Op::Groove, Op::FaceGroove].iter().any(|op| context.features.op(*op));
    let vacant = if loops { vacant(program, summaries) } else { Vec::new() };
    let mut run = Run {
        source: context.source,
        target: turned.unwrap_or(context.target),
        profile: context.target,
        features: &context.features,
        written,
        other_unit,
        turned: turned.and_then(Turned::of),
        modal: context.features.has(Feature::Modal),
        in_steps: context.features.op(Op::Incremental),
        compensates,
        set: Vec::new(),
        place: Place::default(),
        starts: Starts::default(),
        in_pass: true,
        vacant: false,
        set_vacant: false,
        found,
        loops: Vec::new(),
        flanks: None,
    };
    let mut vacant = vacant.into_iter();
    for (index, ((block, state), straight)) in program.blocks.iter_mut().zip(states).zip(straight).enumerate()
    {
        let vacant = vacant.next().unwrap_or_default();
        if !straight {
            run.set.clear();
            run.place.forget();
        }
        let old = std::mem::take(&mut block.stmts);
        let ends = matches!(block.term.kind, TermKind::End { .. });
        block.stmts = run.block((index, old.into_iter().collect(), vacant), state, ends).into();
    }
    let Run { found, flanks, loops, .. } = run;
    thread_loops::write(program, loops);
    if let Some(span) = flanks {
        flanks_are_open(index, span, context);
    }
    found
}

fn returns(program: &Program) -> bool {
    program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Return { .. }))
}

fn cycle_of(stmt: &Stmt) -> Option<&'static Kind> {
    stmt.kind.nc()?.ops().find_map(Kind::of_cycle)
}

fn setup_of(stmt: &Stmt) -> Option<&'static Kind> {
    stmt.kind.nc()?.ops().find_map(Kind::of_setup)
}

/// What blocks before have set for the cycles of a kind, and of those that share what is set.
struct Set {
    kind: &'static Kind,
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
        let computed = |value: &Expr| value.constant().is_none() && !matches!(value, Expr::Increments(_));
        self.passed && self.values.iter().any(|(_, value)| computed(value))
    }
}

/// The walk through the blocks of a program.
struct Run<'c> {
    source: &'c Control,
    target: &'c Control,
    features: &'c Features,
    /// What the blocks of the library set.
    written: &'c Written,
    /// The target as its profile has it; `target` is as it is while the program runs.
    profile: &'c Control,
    /// True where the program may run in another unit than the one that the settings of the source, and of the target, are in.
    other_unit: [bool; 2],
    /// Where the target's operator sets it to that unit: both.
    turned: Option<Turned>,
    /// True where a macro may run after each move, and leave the tool elsewhere.
    modal: bool,
    /// True where words of a place may be increments, by a mode.
    in_steps: bool,
    /// True where the program, or one that calls it or that it calls, compensates the nose radius.
    compensates: bool,
    set: Vec<Set>,
    place: Place,
    starts: Starts,
    /// True where a single pass may be in force, which a block without an axis may make once more.
    in_pass: bool,
    /// True where a word of the block at hand may have no value.
    vacant: bool,
    /// True where a word of a block that sets what cycles take may have none.
    set_vacant: bool,
    found: Found,
    /// Loops in the place of cycles, each with the block and the place in it where the cycle stands.
    loops: Vec<((usize, usize), Made)>,
    /// The first thread that is written out and cut on both flanks.
    flanks: Option<Span>,
}

impl Run<'_> {
    fn block(
        &mut self,
        (index, old, vacant): (usize, Vec<Stmt>, Vec<bool>),
        mut state: Modal,
        ends: bool,
    ) -> Vec<Stmt> {
        let mut new: Vec<Stmt> = Vec::with_capacity(old.len());
        let (mut old, mut vacant) = (old.into_iter(), vacant.into_iter());
        while let Some(stmt) = old.next() {
            let rapid = [(Group::Motion, Op::Rapid), (Group::Cycle, Op::CycleOff)];
            let rapid = rapid.iter().all(|(group, op)| state.op(*group) == Some(*op));
            self.in_pass = state.op(Group::Motion).is_none_or(Op::is_pass);
            state.step(&stmt);
            self.vacant = vacant.next().unwrap_or(false);
            self.starts.step(&stmt, self.vacant, &mut self.place);
            if let Some(kind) = setup_of(&stmt) {
                new.extend(self.setup(kind, stmt));
                continue;
            }
            self.place.enter(&stmt);
            self.place.step(&stmt);
            if self.modal {
                self.place.forget();
            }
            match cycle_of(&stmt) {
                Some(kind) => {
                    let bare = !self.compensates || state.op(Group::RadiusComp) == Some(Op::RadiusOff);
                    let may = match rapid || says_how(old.as_slice(), ends) {
                        _ if !bare => Err("the nose radius may be compensated"),
                        true => Ok(()),
                        false => Err("the next block moves by the code of before"),
                    };
                    new.extend(self.cycle(kind, (stmt, (index, new.len())), may));
                }
                None if matches!(stmt.kind, StmtKind::Comment) => {
                    new.push(stmt);
                    continue;
                }
                None => new.push(stmt),
            }
            self.set.iter_mut().for_each(Set::pass);
        }
        new
    }

    /// Takes the values of a block that sets them; what else it does stays. It is written anew where the target has such a block.
    fn setup(&mut self, kind: &'static Kind, mut stmt: Stmt) -> Option<Stmt> {
        let nc = stmt.kind.nc()?;
        self.set_vacant |= self.vacant;
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
            self.refuse(stmt.site.span, SKIPPED, "");
        }
        if rest.iter().any(moves) {
            let (what, help) = forms::beside(kind, &rest, self.source);
            self.refuse(stmt.site.span, &what, help);
        }
        match self.set.iter_mut().find(|set| share(self.source, set.kind, kind)) {
            Some(set) => {
                // What it computed before may be old, and what this block leaves out stays.
                let stale = set.is_stale();
                replace(&mut set.values, values);
                set.passed = stale;
            }
            None => self.set.push(Set { kind, values, passed: false }),
        }
        stmt.kind = if rest.is_empty() { StmtKind::Comment } else { StmtKind::Nc(Nc { items: rest }) };
        let empty = matches!(stmt.kind, StmtKind::Comment) && stmt.site.comments.is_empty();
        (!empty).then_some(stmt)
    }

    /// The cycle with its words, after the block that sets the rest, if the target has one, and before the passes that the target's cycle
    /// does not make; or all passes of a thread that the target has no cycle for.
    fn cycle(
        &mut self,
        kind: &'static Kind,
        (mut stmt, at): (Stmt, (usize, usize)),
        may: Result<(), &'static str>,
    ) -> Vec<Stmt> {
        let span = stmt.site.span;
        let set = self.set.iter().find(|set| share(self.source, set.kind, kind));
        if set.is_some_and(Set::is_stale) {
            self.refuse(span, STALE, "write the block that sets it right before this one");
            return vec![stmt];
        }
        let before = set.map(|set| set.values.clone());
        let (mut all, stood_in) = match told(&stmt, kind, before, (self.source, self.written)) {
            Ok(told) => told,
            Err(Untold(what, help, lacks)) => {
                self.found.push((span, what, help, lacks.map_or(So::Refused, So::Lacks)));
                return vec![stmt];
            }
        };
        let threads = stmt.kind.nc().filter(|_| kind.cycle == Op::Threading);
        if let Some((what, help)) = threads.and_then(|nc| forms::no_pass(nc, &all, self.source)) {
            self.refuse(span, &what, &help);
            return vec![stmt];
        }
        if threads.is_some() {
            self.finish_once(span, &mut all);
        }
        let mut given = match threads.and_then(|nc| beyond(nc, &all, self.target)) {
            Some((what, help)) => Err((what.into(), help.into())),
            None => resolve(all.clone(), kind, self.target),
        };
        let straight = given.as_mut().is_ok_and(|given| self.ends_straight(&mut given.needs));
        let writes = matches!(kind.cycle, Op::Threading | Op::Groove | Op::FaceGroove);
        let needs = given.as_ref().ok().filter(|_| writes).map(|given| given.needs.as_slice());
        let needs = needs.unwrap_or_default();
        let elsewhere: Vec<Instead> = needs.iter().filter_map(|need| self.set_otherwise(need)).collect();
        let mut why = String::new();
        let may_write = if stood_in && self.other_unit.contains(&true) { Err(OTHER_UNIT) } else { may };
        let finishing = given.as_ref().ok().map(|given| self.finishing(&stmt, given, &all, may));
        // A thread whose finishing passes cannot follow its cycle may be a loop of all its passes.
        let leaves = leaves(self.target);
        let beyond =
            finishing.as_ref().map_or(writes, |passes| passes.is_none() && may_write.is_ok() && !leaves);
        if beyond || !elsewhere.is_empty() {
            match may_write.and_then(|()| self.written_out((&stmt, at), &all, kind)) {
                Ok(passes) => {
                    let notes = elsewhere.into_iter().map(|(what, help)| (span, what, help, So::Noted));
                    self.found.extend(notes);
                    return passes;
                }
                Err(because) => why = format!("; its moves are not written out: {because}"),
            }
        }
        let Given { words, setup, needs, left, .. } = match given {
            Ok(given) => given,
            Err((what, help)) => {
                self.refuse(span, &format!("{what}{why}"), &help);
                return vec![stmt];
            }
        };
        if self.other_unit.contains(&true) && stood_in || self.rests_on_length(kind, &setup) {
            self.refuse(
                span,
                OTHER_UNIT,
                "write the program in the unit that the profile of the machine gives",
            );
        }
        for need in needs {
            let (what, help, so) = self.supposed(need, &why);
            self.found.push((span, what, help, so));
        }
        self.leave(&stmt, kind, left);
        let passes = finishing.flatten();
        if passes.is_none() {
            self.no_finishes(span, &all);
        }
        if let StmtKind::Nc(nc) = &mut stmt.kind {
            let same = drop_rough(nc, self.target);
            nc.items.retain(|item| !matches!(item, NcItem::Word(role, _) if kind.roles.contains(role)));
            nc.items.extend(words.into_iter().map(|(role, value)| NcItem::Word(role, value)));
            if !same {
                self.refuse(span, ALLOWANCES, ALLOWANCES_HELP);
            }
        }
        let site = crate::ir::SourceInfo { span, ..Default::default() };
        let setup = (!setup.is_empty()).then(|| Stmt { kind: StmtKind::Nc(block_before(kind, setup)), site });
        let cycle = if straight { kept::straight(stmt) } else { vec![stmt] };
        setup.into_iter().chain(cycle).chain(passes.unwrap_or_default()).collect()
    }

    fn refuse(&mut self, span: Span, what: &str, help: &str) {
        self.found.push((span, what.into(), help.into(), So::Refused));
    }
}

const OTHER_UNIT: &str = "a length of this cycle is in a setting, in the unit of the control, and the program names the other unit";
const STALE: &str = "a value that this cycle takes from a block before it is computed, and what it is computed from may have changed since";
const SKIPPED: &str =
    "a block skip before the block that sets what the next cycle takes: whether it counts is not known here";

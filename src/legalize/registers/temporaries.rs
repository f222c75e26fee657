//! Colours temporaries: two that are never alive together share a register.
//!
//! Temporaries are numbered anew, library-wide: a colour is a number, and a program uses the lowest it can. One that is
//! alive over a call shares none with what the call may run; those programs are coloured first. One that is alive at a
//! move where a modal call may be open, or over a call of what is not known, gets a number that no other has.
//!
//! Law: no two share a register of which one is written while the other is alive. Side condition: a program that its own
//! call comes back to has one set of temporaries for both levels, so none may be alive over that call. Counter-example:
//! a macro that calls itself between the two halves of a long expression.

use super::needs::{APART, first_colours, has_locals};
use super::statics::{Statics, lowest};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{CallGraph, Cfg, Temps, Transfer, live_after};
use crate::ir::{Block, Callee, Class, Expr, Module, Place, Program, StmtKind, TermKind, Var};
use crate::legalize::Context;
use crate::syntax::ProgramName;
use crate::text::Span;
use foldhash::HashMap;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Colours of a call's programs that are told apart; no control has so many registers.
const MOST_COLOURS: usize = 2000;

/// Gives temporaries, and statics if there are any, their colours.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let modal = stmts().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
    // Only for a target without locals are there any.
    let prefixes = context.source.prefixes();
    let statics = if has_locals(context.target) { None } else { Statics::of(module, &prefixes) };
    let target = context.target;
    let planned = module.programs.par_iter_mut().enumerate().map(|(at, program)| {
        let first = first_colours(program, target);
        let mut plan = Plan { first, ..Plan::of(at, program, modal, statics.as_ref()) };
        if statics.is_none() && plan.over.is_empty() {
            // Nothing in other programs matters to it: what it needs is not kept for the whole library.
            plan.colour(&BTreeSet::new());
            (plan.apart, plan.copies) = Default::default();
        }
        plan
    });
    let mut plans: Vec<Plan> = planned.collect();
    if statics.is_some() || plans.iter().any(|plan| !plan.over.is_empty()) {
        over_calls(module, &mut plans, statics.as_ref(), context);
    } else {
        plans.iter_mut().for_each(|plan| plan.colour(&BTreeSet::new()));
    }
    // The highest colour of each class.
    let mut highest: BTreeMap<u32, u32> = BTreeMap::new();
    let given = plans.iter().flat_map(|plan| plan.colours.values().copied());
    for colour in given.chain(statics.iter().map(Statics::highest)) {
        let highest = highest.entry(colour / APART).or_default();
        *highest = colour.max(*highest);
    }
    for plan in &mut plans {
        for temp in std::mem::take(&mut plan.alone) {
            let first = plan.first_of(temp);
            let lone = highest.entry(first / APART).or_insert(first);
            *lone += 1;
            plan.colours.insert(temp, *lone);
        }
        let class = class_of(statics.as_ref());
        let over = plan.over.keys().filter_map(|temp| plan.colours.get(temp));
        context.over_calls.extend(over.map(|colour| Var { class, number: *colour }));
    }
    let named = module.programs.par_iter_mut().zip(&plans);
    named.for_each(|(program, plan)| rename(program, plan, statics.as_ref()));
    let over = statics.iter().flat_map(Statics::over_calls);
    context.over_calls.extend(over.map(|colour| Var { class: Class::Static, number: colour }));
}

/// With statics, temporaries are statics too: both have the same registers.
fn class_of(statics: Option<&Statics>) -> Class {
    if statics.is_some() { Class::Static } else { Class::Temp }
}

/// Colours callees before their callers, so that what is alive over a call keeps off all that the call may run.
fn over_calls(module: &Module, plans: &mut [Plan], statics: Option<&Statics>, context: &mut Context<'_>) {
    let calls = Calls::of(module);
    let graph = CallGraph::new(calls.callees);
    let component = graph.components();
    // By component: the colours of all that a call of it may run; none if they are too many to be told.
    let mut used: Vec<Option<Temps>> = vec![Some(Temps::default()); plans.len()];
    for index in graph.callees_first() {
        let plan = &mut plans[index];
        let mut alone = BTreeSet::new();
        for (temp, Over { callees, anything, place }) in &plan.over {
            let known: Vec<usize> =
                callees.iter().filter_map(|name| calls.names.get(name).copied()).collect();
            let again = known.iter().any(|callee| component[*callee] == component[index]);
            if again {
                refuse(index, *place, context);
            }
            let colours: Option<Vec<&Temps>> =
                known.iter().map(|callee| used[component[*callee]].as_ref()).collect();
            let colours = colours.filter(|_| !anything && !again && known.len() == callees.len());
            match colours {
                Some(colours) => plan.kept_off.entry(*temp).or_default().join_all(&colours),
                None => drop(alone.insert(*temp)),
            }
        }
        if let Some(statics) = statics {
            let through = statics.through(index);
            let temps: Vec<u32> = plan.apart.keys().copied().collect();
            temps.iter().for_each(|temp| plan.kept_off.entry(*temp).or_default().join_all(&[&through]));
        }
        plan.colour(&alone);
        plan.alone = alone;
        let mut mine = used[component[index]].take();
        if let Some(all) = &mut mine {
            plan.colours.values().for_each(|colour| all.insert(*colour));
            let written = statics.map(|statics| statics.written(index));
            written.iter().for_each(|colours| all.join_all(&[colours]));
        }
        let others =
            graph.callees(index).map(|callee| component[callee]).filter(|other| *other != component[index]);
        for other in others {
            mine = mine.zip(used[other].as_ref()).map(|(mut all, more)| {
                all.join_all(&[more]);
                all
            });
        }
        used[component[index]] = mine.filter(|all| all.iter().count() <= MOST_COLOURS);
    }
}

fn refuse(index: usize, place: Span, context: &mut Context<'_>) {
    let what = "this calls the program again before it has ended, while a value in between must outlive the call: the registers for such values are the same at every level";
    let help = "compute the value before the call, and keep it in a local variable";
    context.add_once(index, what, Diagnostic::new(Code::OutOfRegisters, place, what).with_help(help));
}

/// Who calls whom.
struct Calls {
    names: HashMap<ProgramName, usize>,
    callees: Vec<BTreeSet<(usize, bool)>>,
}

impl Calls {
    fn of(module: &Module) -> Self {
        let names: HashMap<ProgramName, usize> =
            module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at))).collect();
        let called = |block: &Block| match &block.term.kind {
            TermKind::Call { call, .. } => match &call.callee {
                Callee::Program(name) => names.get(name).copied(),
                _ => None,
            },
            TermKind::Chain(name) => names.get(name).copied(),
            _ => None,
        };
        let callees =
            |program: &Program| program.blocks.iter().filter_map(called).map(|to| (to, false)).collect();
        let callees = module.programs.iter().map(callees).collect();
        Self { names, callees }
    }
}

/// The calls that a temporary is alive over.
#[derive(Debug, Default)]
struct Over {
    callees: BTreeSet<ProgramName>,
    /// True if one of them may run what is not known, or what stands in the program itself.
    anything: bool,
    place: Span,
}

/// What a program's temporaries need.
#[derive(Default)]
struct Plan {
    /// By temporary: those that are alive where it is written, or are written where it is alive.
    apart: HashMap<u32, Temps>,
    /// By temporary: colours of others that it must not have.
    kept_off: HashMap<u32, Temps>,
    /// By temporary: what its colours come after, if they are of a class of their own.
    first: HashMap<u32, u32>,
    /// Those alive over calls.
    over: BTreeMap<u32, Over>,
    /// Temporaries that are copied to one another.
    copies: Vec<(u32, u32)>,
    /// The colours, from 1.
    colours: HashMap<u32, u32>,
    /// Those that get a colour that nothing else has.
    alone: BTreeSet<u32>,
    /// By block: true where it names any.
    naming: Vec<bool>,
}

impl Plan {
    /// Of a program; in a library with modal calls every move may be a call.
    fn of(index: usize, program: &Program, modal: bool, statics: Option<&Statics>) -> Self {
        let mut plan = Self::default();
        if program.temporaries().next().is_none() {
            return plan;
        }
        let (live, naming) = live_out(program);
        let statics = statics.map(|statics| (statics, statics.live_after(index, program)));
        for (id, ((block, mut now), names)) in program.blocks.iter().zip(live).zip(&naming).enumerate() {
            if now.is_empty() && !names {
                continue;
            }
            if let TermKind::Call { call, .. } = &block.term.kind {
                for temp in now.iter() {
                    let over = plan.over.entry(temp).or_default();
                    over.place = block.term.site.span;
                    match &call.callee {
                        Callee::Program(name) => drop(over.callees.insert(name.clone())),
                        _ => over.anything = true,
                    }
                }
            }
            let others = statics.as_ref().map(|(statics, after)| (*statics, &after[id]));
            plan.block(block, &mut now, modal, others);
        }
        Self { naming, ..plan }
    }

    fn block(
        &mut self,
        block: &Block,
        now: &mut Temps,
        modal: bool,
        statics: Option<(&Statics, &Vec<Temps>)>,
    ) {
        backward(block, now, &mut |at, step, now| match step {
            Step::Move if modal => {
                now.iter().for_each(|temp| self.over.entry(temp).or_default().anything = true);
            }
            Step::Write { temp, sure } => {
                let from = copied(block, at).filter(|from| *from != temp && sure);
                self.copies.extend(from.map(|from| (temp, from)));
                // A copy holds the same as what it copies, until one of them is written.
                for other in now.iter().filter(|other| Some(*other) != from) {
                    self.apart.entry(other).or_default().insert(temp);
                    self.apart.entry(temp).or_default().insert(other);
                }
                let apart = self.apart.entry(temp).or_default();
                apart.remove(temp);
                if let Some(after) = statics.and_then(|(_, after)| after.get(at)) {
                    self.kept_off.entry(temp).or_default().join_all(&[after]);
                }
            }
            Step::Static(var) => {
                let colour = statics.and_then(|(statics, _)| statics.colour(var));
                for (temp, colour) in now.iter().zip(std::iter::repeat(colour)) {
                    colour
                        .into_iter()
                        .for_each(|colour| self.kept_off.entry(temp).or_default().insert(colour));
                }
            }
            Step::Move | Step::Read => {}
        });
    }

    /// Colours of a temporary come after this one.
    fn first_of(&self, temp: u32) -> u32 {
        self.first.get(&temp).copied().unwrap_or(0)
    }

    /// Gives each the lowest colour that is free, or that of what it is copied to or from; not to those that get one
    /// alone.
    fn colour(&mut self, alone: &BTreeSet<u32>) {
        let mut temps: Vec<u32> = self.apart.keys().copied().filter(|temp| !alone.contains(temp)).collect();
        temps.sort_unstable();
        for temp in temps {
            let mut taken = self.kept_off.remove(&temp).unwrap_or_default();
            let others = self.apart[&temp].iter().filter_map(|other| self.colours.get(&other));
            others.for_each(|colour| taken.insert(*colour));
            let partners = self.copies.iter().filter_map(|(a, b)| match temp {
                _ if temp == *a => self.colours.get(b),
                _ if temp == *b => self.colours.get(a),
                _ => None,
            });
            let first = self.first_of(temp);
            let alike = |colour: &u32| !taken.has(*colour) && colour / APART == first / APART;
            let shared = partners.copied().find(alike);
            self.colours.insert(temp, shared.unwrap_or_else(|| lowest(&taken, first)));
        }
    }
}

/// The temporary that a statement copies.
fn copied(block: &Block, at: usize) -> Option<u32> {
    match &block.stmts.get(at)?.kind {
        StmtKind::Assign { value: Expr::Var(Var { class: Class::Temp, number }), .. } => Some(*number),
        _ => None,
    }
}

/// The temporaries alive at the end of each block, and whether it names any.
fn live_out(program: &Program) -> (Vec<Temps>, Vec<bool>) {
    let mut naming = vec![false; program.blocks.len()];
    let transfer = |(block, names): (&Block, &mut bool)| {
        let mut transfer = Transfer::default();
        backward(block, &mut transfer.reads, &mut |_, step, _| {
            *names |= !matches!(step, Step::Move | Step::Static(_));
            if let Step::Write { temp, sure: true } = step {
                transfer.writes.insert(temp);
            }
        });
        transfer
    };
    let transfers: Vec<Transfer> = program.blocks.iter().zip(&mut naming).map(transfer).collect();
    let live = live_after(program, || Cfg::of(program), &transfers);
    let out = program.ids().map(|id| live.at(id).cloned().unwrap_or_default()).collect();
    (out, naming)
}

/// What matters of a block.
enum Step {
    /// A temporary is read.
    Read,
    /// This one is written; not for sure under block skip.
    Write { temp: u32, sure: bool },
    /// An axis is moved.
    Move,
    /// This static is written.
    Static(Var),
}

/// Walks a block from its end; `each` is told the statement's place, each step and what is alive after it.
fn backward(block: &Block, live: &mut Temps, each: &mut dyn FnMut(usize, Step, &Temps)) {
    block.term.kind.exprs(&mut |e| read(block.stmts.len(), e, live, each));
    for (at, stmt) in block.stmts.iter().enumerate().rev() {
        if matches!(&stmt.kind, StmtKind::Nc(nc) if nc.names_axis()) {
            each(at, Step::Move, live);
        }
        if let Some(Place::Var(var @ Var { class: Class::Static, .. })) = stmt.kind.target() {
            each(at, Step::Static(*var), live);
        }
        if let Some(Place::Var(Var { class: Class::Temp, number })) = stmt.kind.target() {
            let sure = stmt.site.skip.is_none();
            each(at, Step::Write { temp: *number, sure }, live);
            // Under block skip the old value may survive.
            if sure {
                live.remove(*number);
            }
        }
        stmt.kind.exprs(&mut |e| read(at, e, live, each));
    }
}

fn read(at: usize, e: &Expr, live: &mut Temps, each: &mut dyn FnMut(usize, Step, &Temps)) {
    e.variables(&mut |var| {
        if var.class == Class::Temp {
            each(at, Step::Read, live);
            live.insert(var.number);
        }
    });
}

/// Puts the colours in.
fn rename(program: &mut Program, Plan { colours, naming, .. }: &Plan, statics: Option<&Statics>) {
    let class = class_of(statics);
    let change = |var: &mut Var| {
        let colour = match var.class {
            Class::Temp => colours.get(&var.number).copied(),
            Class::Static => statics.and_then(|statics| statics.colour(*var)),
            _ => None,
        };
        if let Some(number) = colour {
            *var = Var { class, number };
        }
    };
    let mut each = |e: &mut Expr| {
        e.walk_mut(&mut |e| {
            if let Expr::Var(var) = e {
                change(var);
            }
        });
    };
    program.held.iter_mut().for_each(|(var, _)| change(var));
    for (at, block) in program.blocks.iter_mut().enumerate() {
        if statics.is_none() && !naming.get(at).is_some_and(|naming| *naming) {
            continue;
        }
        for stmt in &mut block.stmts {
            stmt.kind.exprs_mut(&mut each);
            if let StmtKind::Assign { target: Place::Var(var), .. }
            | StmtKind::Input { target: Place::Var(var), .. } = &mut stmt.kind
            {
                change(var);
            }
        }
        block.term.kind.exprs_mut(&mut each);
        // Copies between two that share a register do nothing.
        block.stmts.retain_mut(|stmt| {
            let idle = matches!(&stmt.kind, StmtKind::Assign { target: Place::Var(to), value: Expr::Var(from) }
                if to == from && matches!(to.class, Class::Temp | Class::Static));
            if idle {
                stmt.kind = StmtKind::Comment;
            }
            !idle || stmt.site.sequence.is_some() || !stmt.site.comments.is_empty()
        });
    }
}

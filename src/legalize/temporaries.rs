//! Colours temporaries: two that are never alive together share a register.
//!
//! Temporaries are numbered anew, library-wide: a colour is a number, and a program uses the lowest it
//! can. A temporary that is alive across a call, or a move where a modal call may be open, must not share with any of the callee's, so each such one
//! gets a number that no other has.

use crate::ir::analysis::Temps;
use crate::ir::{Block, Class, Expr, Module, Place, Program, StmtKind, TermKind, Var};
use smallvec::SmallVec;
use std::collections::{BTreeMap, BTreeSet};

/// Gives temporaries their colours.
pub fn run(module: &mut Module) {
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let modal = stmts().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
    let plans: Vec<Plan> = module.programs.iter().map(|program| Plan::of(program, modal)).collect();
    let shared = plans.iter().flat_map(|plan| plan.colours.values()).max().copied().unwrap_or(0);
    let mut lone = shared;
    for (program, mut plan) in module.programs.iter_mut().zip(plans) {
        for temp in plan.across {
            lone += 1;
            plan.colours.insert(temp, lone);
        }
        if !plan.colours.is_empty() {
            rename(program, &plan.colours, &plan.naming);
        }
    }
}

/// What a program's temporaries need.
struct Plan {
    /// Colours of those that may share, from 1.
    colours: BTreeMap<u32, u32>,
    /// Those alive across a call.
    across: BTreeSet<u32>,
    /// By block: true where it names any.
    naming: Vec<bool>,
}

impl Plan {
    /// Of a program; in a library with modal calls every move may be a call.
    fn of(program: &Program, modal: bool) -> Self {
        let mut plan = Self { colours: BTreeMap::new(), across: BTreeSet::new(), naming: Vec::new() };
        if program.temporaries().next().is_none() {
            return plan;
        }
        let (live, naming) = live_out(program);
        let mut apart: BTreeMap<u32, Temps> = BTreeMap::new();
        for ((block, mut now), names) in program.blocks.iter().zip(live).zip(&naming) {
            if now.is_empty() && !names {
                continue;
            }
            if matches!(block.term.kind, TermKind::Call { .. }) {
                plan.across.extend(now.iter());
            }
            backward(block, &mut now, &mut |step, now| match step {
                Step::Move if modal => plan.across.extend(now.iter()),
                Step::Write(temp) => {
                    now.iter().for_each(|other| apart.entry(other).or_default().insert(temp));
                    apart.entry(temp).or_default().join(now);
                }
                Step::Move | Step::Read => {}
            });
        }
        for (&temp, neighbours) in apart.iter().filter(|(temp, _)| !plan.across.contains(temp)) {
            let others = neighbours.iter().filter(|other| *other != temp);
            let taken: BTreeSet<u32> = others.filter_map(|n| plan.colours.get(&n).copied()).collect();
            let colour = (1..).find(|colour| !taken.contains(colour)).unwrap_or(1);
            plan.colours.insert(temp, colour);
        }
        Self { naming, ..plan }
    }
}

/// The temporaries alive at the end of each block, and whether it names any.
fn live_out(program: &Program) -> (Vec<Temps>, Vec<bool>) {
    let count = program.blocks.len();
    let mut live_in = vec![Temps::default(); count];
    let mut live_out = live_in.clone();
    let mut naming = vec![true; count];
    let mut predecessors = vec![SmallVec::<[usize; 2]>::new(); count];
    for (at, block) in program.blocks.iter().enumerate() {
        for to in block.term.kind.successors() {
            if let Some(list) = predecessors.get_mut(to.index()) {
                list.push(at);
            }
        }
    }
    let mut work: Vec<usize> = (0..count).collect();
    let mut waiting = vec![true; count];
    while let Some(at) = work.pop() {
        waiting[at] = false;
        let block = &program.blocks[at];
        let mut out = Temps::default();
        for live in block.term.kind.successors().iter().filter_map(|to| live_in.get(to.index())) {
            out.join(live);
        }
        let mut now = out.clone();
        if naming[at] {
            let mut names = false;
            backward(block, &mut now, &mut |step, _| names |= !matches!(step, Step::Move));
            naming[at] = names;
        }
        live_out[at] = out;
        if now != live_in[at] {
            live_in[at] = now;
            work.extend(predecessors[at].iter().filter(|at| !std::mem::replace(&mut waiting[**at], true)));
        }
    }
    (live_out, naming)
}

/// What matters of a block.
enum Step {
    /// A temporary is read.
    Read,
    /// This one is written.
    Write(u32),
    /// An axis is moved.
    Move,
}

/// Walks a block from its end; `each` is told each step and what is alive behind it.
fn backward(block: &Block, live: &mut Temps, each: &mut dyn FnMut(Step, &Temps)) {
    block.term.kind.exprs(&mut |e| read(e, live, each));
    for stmt in block.stmts.iter().rev() {
        if matches!(&stmt.kind, StmtKind::Nc(nc) if nc.names_axis()) {
            each(Step::Move, live);
        }
        if let Some(Place::Var(Var { class: Class::Temp, number })) = stmt.kind.target() {
            each(Step::Write(*number), live);
            // Under block skip the old value may survive.
            if stmt.site.skip.is_none() {
                live.remove(*number);
            }
        }
        stmt.kind.exprs(&mut |e| read(e, live, each));
    }
}

fn read(e: &Expr, live: &mut Temps, each: &mut dyn FnMut(Step, &Temps)) {
    e.variables(&mut |var| {
        if var.class == Class::Temp {
            each(Step::Read, live);
            live.insert(var.number);
        }
    });
}

fn rename(program: &mut Program, names: &BTreeMap<u32, u32>, naming: &[bool]) {
    let change = |var: &mut Var| {
        if let (Class::Temp, Some(&number)) = (var.class, names.get(&var.number)) {
            var.number = number;
        }
    };
    let mut each = |e: &mut Expr| {
        e.walk_mut(&mut |e| {
            if let Expr::Var(var) = e {
                change(var);
            }
        });
    };
    for (block, _) in program.blocks.iter_mut().zip(naming).filter(|(_, naming)| **naming) {
        for stmt in &mut block.stmts {
            stmt.kind.exprs_mut(&mut each);
            if let StmtKind::Assign { target: Place::Var(var), .. }
            | StmtKind::Input { target: Place::Var(var), .. } = &mut stmt.kind
            {
                change(var);
            }
        }
        block.term.kind.exprs_mut(&mut each);
    }
}

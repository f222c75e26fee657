//! Colours temporaries: two that are never alive together share a register.
//!
//! Temporaries are numbered anew, library-wide: a colour is a number, and a program uses the lowest it
//! can. A temporary that is alive across a call, or a move where a modal call may be open, must not share with any of the callee's, so each such one
//! gets a number that no other has.

use crate::ir::analysis::{Cfg, Temps, Transfer, live_after};
use crate::ir::{Block, Class, Expr, Module, Place, Program, StmtKind, TermKind, Var};
use crate::legalize::Context;
use foldhash::{HashMap, HashMapExt};
use std::collections::BTreeSet;

/// Gives temporaries their colours.
pub fn run(module: &mut Module, _: &mut Context<'_>) {
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let modal = stmts().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
    let mut shared = 0;
    let mut waiting: Vec<(&mut Program, Plan)> = Vec::new();
    for program in &mut module.programs {
        let plan = Plan::of(program, modal);
        shared = plan.colours.values().copied().max().unwrap_or(0).max(shared);
        if plan.across.is_empty() {
            rename(program, &plan);
        } else {
            waiting.push((program, plan));
        }
    }
    let mut lone = shared;
    for (program, mut plan) in waiting {
        for temp in std::mem::take(&mut plan.across) {
            lone += 1;
            plan.colours.insert(temp, lone);
        }
        rename(program, &plan);
    }
}

/// What a program's temporaries need.
struct Plan {
    /// Colours of those that may share, from 1.
    colours: HashMap<u32, u32>,
    /// Those alive across a call.
    across: BTreeSet<u32>,
    /// By block: true where it names any.
    naming: Vec<bool>,
}

impl Plan {
    /// Of a program; in a library with modal calls every move may be a call.
    fn of(program: &Program, modal: bool) -> Self {
        let mut plan = Self { colours: HashMap::new(), across: BTreeSet::new(), naming: Vec::new() };
        if program.temporaries().next().is_none() {
            return plan;
        }
        let (live, naming) = live_out(program);
        let mut apart: HashMap<u32, Temps> = HashMap::new();
        for ((block, mut now), names) in program.blocks.iter().zip(live).zip(&naming) {
            if now.is_empty() && !names {
                continue;
            }
            if matches!(block.term.kind, TermKind::Call { .. }) {
                plan.across.extend(now.iter());
            }
            backward(block, &mut now, &mut |step, now| match step {
                Step::Move if modal => plan.across.extend(now.iter()),
                Step::Write { temp, .. } => {
                    now.iter().for_each(|other| apart.entry(other).or_default().insert(temp));
                    apart.entry(temp).or_default().join(now);
                }
                Step::Move | Step::Read => {}
            });
        }
        let mut temps: Vec<u32> = apart.keys().copied().filter(|temp| !plan.across.contains(temp)).collect();
        temps.sort_unstable();
        let mut taken: Vec<u32> = Vec::new();
        for temp in temps {
            let others = apart[&temp].iter().filter(|other| *other != temp);
            taken.clear();
            taken.extend(others.filter_map(|other| plan.colours.get(&other).copied()));
            taken.sort_unstable();
            taken.dedup();
            // The first that is not where it would be leaves its place free.
            let free = (1..).zip(&taken).find(|(colour, taken)| colour != *taken);
            plan.colours.insert(temp, free.map_or(taken.len() as u32 + 1, |(colour, _)| colour));
        }
        Self { naming, ..plan }
    }
}

/// The temporaries alive at the end of each block, and whether it names any.
fn live_out(program: &Program) -> (Vec<Temps>, Vec<bool>) {
    let cfg = Cfg::of(program);
    let mut naming = vec![false; program.blocks.len()];
    let transfer = |(block, names): (&Block, &mut bool)| {
        let mut transfer = Transfer::default();
        backward(block, &mut transfer.reads, &mut |step, _| {
            *names |= !matches!(step, Step::Move);
            if let Step::Write { temp, sure: true } = step {
                transfer.writes.insert(temp);
            }
        });
        transfer
    };
    let transfers: Vec<Transfer> = program.blocks.iter().zip(&mut naming).map(transfer).collect();
    let live = live_after(program, &cfg, &transfers);
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
}

/// Walks a block from its end; `each` is told each step and what is alive after it.
fn backward(block: &Block, live: &mut Temps, each: &mut dyn FnMut(Step, &Temps)) {
    block.term.kind.exprs(&mut |e| read(e, live, each));
    for stmt in block.stmts.iter().rev() {
        if matches!(&stmt.kind, StmtKind::Nc(nc) if nc.names_axis()) {
            each(Step::Move, live);
        }
        if let Some(Place::Var(Var { class: Class::Temp, number })) = stmt.kind.target() {
            let sure = stmt.site.skip.is_none();
            each(Step::Write { temp: *number, sure }, live);
            // Under block skip the old value may survive.
            if sure {
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

fn rename(program: &mut Program, Plan { colours, naming, .. }: &Plan) {
    let change = |var: &mut Var| {
        if let (Class::Temp, Some(&number)) = (var.class, colours.get(&var.number)) {
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

//! Colours temporaries: two that are never alive together share a register.
//!
//! Temporaries are numbered anew, library-wide: a colour is a number, and a program uses the lowest it
//! can. A temporary that is alive across a call, or a move where a modal call may be open, must not share with any of the callee's, so each such one
//! gets a number that no other has.

use super::rewrite::highest_temp;
use crate::ir::{Block, Class, Expr, Module, Place, Program, StmtKind, TermKind, Var};
use std::collections::{BTreeMap, BTreeSet};

type Live = BTreeSet<u32>;

/// Gives temporaries their colours.
pub fn run(module: &mut Module) {
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let modal = stmts().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
    let plans: Vec<Plan> = module.programs.iter().map(|program| Plan::of(program, modal)).collect();
    let shared = plans.iter().flat_map(|plan| plan.colours.values()).max().copied().unwrap_or(0);
    let mut lone = shared;
    for (program, plan) in module.programs.iter_mut().zip(&plans) {
        let mut names = plan.colours.clone();
        for &temp in &plan.across {
            lone += 1;
            names.insert(temp, lone);
        }
        if !names.is_empty() {
            rename(program, &names);
        }
    }
}

/// What a program's temporaries need.
struct Plan {
    /// Colours of those that may share, from 1.
    colours: BTreeMap<u32, u32>,
    /// Those alive across a call.
    across: BTreeSet<u32>,
}

impl Plan {
    /// Of a program; in a library with modal calls every move may be a call.
    fn of(program: &Program, modal: bool) -> Self {
        if highest_temp(program) == 0 {
            return Self { colours: BTreeMap::new(), across: BTreeSet::new() };
        }
        let live = live_out(program);
        let mut apart: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        let mut across = BTreeSet::new();
        for (block, out) in program.blocks.iter().zip(&live) {
            let mut now = out.clone();
            if matches!(block.term.kind, TermKind::Call { .. }) {
                across.extend(now.iter().copied());
            }
            let mut moved = |now: &Live| across.extend(now.iter().copied().filter(|_| modal));
            backward(block, &mut now, &mut moved, &mut |defined, now| {
                let row = apart.entry(defined).or_default();
                row.extend(now.iter().filter(|other| **other != defined));
                let others: Vec<u32> = now.iter().copied().filter(|other| *other != defined).collect();
                others.into_iter().for_each(|other| {
                    apart.entry(other).or_default().insert(defined);
                });
            });
        }
        let mut colours: BTreeMap<u32, u32> = BTreeMap::new();
        for (&temp, neighbours) in apart.iter().filter(|(temp, _)| !across.contains(temp)) {
            let taken: BTreeSet<u32> = neighbours.iter().filter_map(|n| colours.get(n).copied()).collect();
            let colour = (1..).find(|colour| !taken.contains(colour)).unwrap_or(1);
            colours.insert(temp, colour);
        }
        Self { colours, across }
    }
}

/// The temporaries alive at the end of each block.
fn live_out(program: &Program) -> Vec<Live> {
    let count = program.blocks.len();
    let mut live_in = vec![Live::new(); count];
    let mut live_out = vec![Live::new(); count];
    let mut predecessors = vec![Vec::new(); count];
    for (at, block) in program.blocks.iter().enumerate() {
        for to in block.term.kind.successors() {
            if let Some(list) = predecessors.get_mut(to.index()) {
                list.push(at);
            }
        }
    }
    let mut work: BTreeSet<usize> = (0..count).collect();
    while let Some(at) = work.pop_last() {
        let block = &program.blocks[at];
        let out: Live = block
            .term
            .kind
            .successors()
            .iter()
            .filter_map(|to| live_in.get(to.index()))
            .flatten()
            .copied()
            .collect();
        let mut now = out.clone();
        backward(block, &mut now, &mut |_| {}, &mut |_, _| {});
        live_out[at] = out;
        if now != live_in[at] {
            live_in[at] = now;
            work.extend(&predecessors[at]);
        }
    }
    live_out
}

/// Walks a block from its end; `define` is told each definition and what is alive behind it, `moved` what is alive
/// behind each move.
fn backward(
    block: &Block,
    live: &mut Live,
    moved: &mut dyn FnMut(&Live),
    define: &mut dyn FnMut(u32, &Live),
) {
    block.term.kind.exprs(&mut |e| read(e, live));
    for stmt in block.stmts.iter().rev() {
        if matches!(&stmt.kind, StmtKind::Nc(nc) if nc.names_axis()) {
            moved(live);
        }
        if let StmtKind::Assign { target, .. } | StmtKind::Input { target, .. } = &stmt.kind
            && let Place::Var(Var { class: Class::Temp, number }) = target
        {
            define(*number, live);
            // Under block skip the old value may survive.
            if stmt.site.skip.is_none() {
                live.remove(number);
            }
        }
        stmt.kind.exprs(&mut |e| read(e, live));
    }
}

fn read(e: &Expr, live: &mut Live) {
    e.walk(&mut |e| {
        if let Expr::Var(Var { class: Class::Temp, number }) = e {
            live.insert(*number);
        }
    });
}

fn rename(program: &mut Program, names: &BTreeMap<u32, u32>) {
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
    for block in &mut program.blocks {
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

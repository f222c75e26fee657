//! The cutter radius that the target's word of the tool length would replace.
//!
//! Law: where a length picks the radius of its row on the target alone, the number of the radius is named again: in the
//! block of a length under compensation, and where compensation starts without one after a length. Side condition: the last
//! number that the program named is known; what none has named stays so. Counter-example: `G41 D2 X5.`, `H3 Z4.`, after
//! which the radius of row 3 counts.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, reached, solve};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

const FACT: Question = Question::LengthWordPicksRadius;

/// True if only the target's lengths pick radii, and the library compensates.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let compensates = features.op(Op::RadiusLeft) || features.op(Op::RadiusRight);
    let own = context.source.is(FACT) || context.source.is(Question::RadiusOffsetActiveTool);
    compensates && context.target.is(FACT) && !own
}

/// Names radii again that a length took the place of.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    // Programs start without compensation: only what one begins may be in force.
    let mut entry = context.entry.clone();
    entry.start_in(Op::RadiusOff);
    let facts = context.modal_facts_from(module, &entry);
    let names = |program: &Program| {
        let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        stmts.filter_map(|stmt| stmt.kind.nc()).any(|nc| nc.word(Role::RadiusOffset).is_some() || picks(nc))
    };
    let naming: Vec<bool> = module.programs.iter().map(names).collect();
    let calls: BTreeSet<(usize, usize)> = context.called(module).pairs(module).into_iter().collect();
    // Whether any program names one that this comes to by calls, or that comes to it.
    let related = |from: usize, down: bool| {
        let near = |at: usize, go: &mut dyn FnMut(usize)| {
            let ways = calls
                .iter()
                .map(|(caller, callee)| if down { (*caller, *callee) } else { (*callee, *caller) });
            ways.filter(|(one, _)| *one == at).for_each(|(_, other)| go(other));
        };
        let mut first = BTreeSet::new();
        near(from, &mut |other| {
            first.insert(other);
        });
        let all: BTreeSet<usize> = reached(first, |at, go| near(at, go));
        all.into_iter().any(|other| naming[other])
    };
    for (index, program) in module.programs.iter_mut().enumerate() {
        let (elsewhere, before) = (related(index, true), related(index, false));
        let begins = if before { Named::Unknown } else { Named::Never };
        let rules = Follows { elsewhere, begins: Radius { named: begins, lost: false } };
        let starts = solve(&rules, program, &Cfg::of(program));
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let mut modal = facts.at(index, id);
            let mut radius = starts.at(id).copied().unwrap_or(rules.begins);
            for stmt in &mut block.stmts {
                let on = modal.op(Group::RadiusComp) != Some(Op::RadiusOff);
                modal.step(stmt);
                let span = stmt.site.span;
                let before = radius;
                radius.step(stmt);
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if nc.word(Role::RadiusOffset).is_some() {
                    continue;
                }
                let starts = compensates(nc) && before.lost;
                if !(starts || picks(nc) && on && !nc.has(Op::RadiusOff)) {
                    continue;
                }
                match before.named {
                    Named::Never => {}
                    Named::Known(number) => {
                        nc.items.push(NcItem::Word(Role::RadiusOffset, Expr::Number(number)));
                        radius.lost = false;
                        context.rests_on_target(index, span, FACT);
                    }
                    Named::Unknown => {
                        let what = "a tool length picks a radius too on the target, and the number of the radius that is in \
                                    force is not known here: write D in this block";
                        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
                    }
                }
            }
        }
    }
}

/// True for a block that picks a radius by a length, or ends it.
fn picks(nc: &Nc) -> bool {
    nc.word(Role::LengthOffset).is_some() || nc.has(Op::LengthOff)
}

fn compensates(nc: &Nc) -> bool {
    nc.has(Op::RadiusLeft) || nc.has(Op::RadiusRight)
}

/// The radius that the source has in force.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Radius {
    named: Named,
    /// True where a length took its place on the target.
    lost: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Named {
    Never,
    Known(f64),
    Unknown,
}

impl Radius {
    fn step(&mut self, stmt: &Stmt) {
        let Some(nc) = stmt.kind.nc() else { return };
        let skipped = stmt.site.skip.is_some();
        match nc.word(Role::RadiusOffset) {
            Some(value) => {
                let now = value.constant().map_or(Named::Unknown, Named::Known);
                self.named = if skipped && self.named != now { Named::Unknown } else { now };
                self.lost &= skipped;
            }
            None => self.lost |= picks(nc),
        }
    }
}

impl Lattice for Radius {
    fn join(&mut self, other: &Self) -> bool {
        let named = if self.named == other.named { self.named } else { Named::Unknown };
        let joined = Self { named, lost: self.lost || other.lost };
        std::mem::replace(self, joined) != joined
    }
}

struct Follows {
    /// True if programs that it calls name radii or lengths.
    elsewhere: bool,
    begins: Radius,
}

impl Analysis for Follows {
    type State = Radius;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Radius)> {
        cfg.roots().iter().map(|root| (*root, self.begins)).collect()
    }

    fn block(&self, _: BlockId, block: &Block, radius: &mut Radius) {
        block.stmts.iter().for_each(|stmt| radius.step(stmt));
        if self.elsewhere && matches!(block.term.kind, TermKind::Call { .. }) {
            *radius = Radius { named: Named::Unknown, lost: true };
        }
    }
}

//! Peck cycles that are told no depth of their pecks, where the target stops at them.
//!
//! Law: pecks without a depth drill in one go, as the drilling cycle does; the cycle with a wait where the block has one. Side
//! conditions: the block begins the cycle, cycles are off before it, and no block of the library tells a cycle in force its pecks.
//! That the source drills in one go is `machine:cycle.peck.missing`. Counter-example: `G83 X6.` in a cycle that an earlier block
//! told its Q.

use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side, matters};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::{Expr, Module, Nc, NcItem, Stmt, StmtKind};
use crate::legalize::each_step::each_step;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::BTreeMap;

const FACT: &str = "machine:cycle.peck.missing";

const COMPUTED: &str = "the depth of the pecks is computed, and the target stops with an alarm where it is 0 or vacant: make sure that it is neither";

/// True if such cycles may stand in the library, and the target stops at them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(pecks)
        && context.target.is(Question::CyclePeckNeeded)
        && !context.source.is(Question::CyclePeckNeeded)
}

fn pecks(op: Op) -> bool {
    matches!(op, Op::CyclePeck | Op::CycleChipBreak)
}

/// Whether cycles were told their pecks since they were off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Told {
    #[default]
    No,
    Yes,
    Maybe,
}

impl Lattice for Told {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        if *self != *other {
            *self = Self::Maybe;
        }
        *self != before
    }
}

/// What a block is to the pecks of the cycle.
#[derive(Clone, Copy, PartialEq)]
enum Does {
    Nothing,
    /// It begins a peck cycle without their depth: true where cycles were off before it.
    Begins(bool),
    /// It tells a cycle in force.
    Tells,
}

/// Takes a block: what is told after it, and what it does.
fn step(stmt: &Stmt, state: &mut Modal, told: &mut Told) -> Does {
    let before = state.op(Group::Cycle);
    state.step(stmt);
    let after = state.op(Group::Cycle);
    let Some(nc) = stmt.kind.nc() else { return Does::Nothing };
    if after == Some(Op::CycleOff) {
        *told = Told::No;
        return Does::Nothing;
    }
    let old = if before == Some(Op::CycleOff) { Told::No } else { *told };
    let tells = tells(nc);
    *told = if tells { Told::Yes } else { old };
    if stmt.site.skip.is_some() {
        told.join(&old);
    }
    match nc.ops().find(|op| op.is_cycle()) {
        Some(op) if pecks(op) && !tells && old != Told::Yes => Does::Begins(before == Some(Op::CycleOff)),
        None if tells => Does::Tells,
        _ => Does::Nothing,
    }
}

fn tells(nc: &Nc) -> bool {
    [Role::CycleQ, Role::PeckFirst]
        .iter()
        .any(|role| nc.word(*role).is_some_and(|word| word.constant() != Some(0.0)))
}

/// Makes them drilling cycles; true where one became one.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    computed(module, context);
    let mut later = false;
    let mut found: BTreeMap<(usize, u32), bool> = BTreeMap::new();
    each_step(module, &facts, step, |index, stmt, (_, does)| match does {
        Does::Begins(off) => *found.entry((index, stmt.site.span.start)).or_insert(true) &= off,
        Does::Tells => later = true,
        Does::Nothing => {}
    });
    for ((index, start), off) in found {
        let blocks = module.programs[index].blocks.iter_mut().flat_map(|block| &mut block.stmts);
        for stmt in blocks.filter(|stmt| stmt.site.span.start == start) {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            if !nc.ops().any(pecks) {
                continue;
            }
            let span = stmt.site.span;
            if later || !off {
                let what = "this peck cycle has no Q, and the target stops with an alarm where none was told before: it is not known \
                            here whether one was";
                let help = "write Q into this block";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
                continue;
            }
            drills(nc);
            if !context.source.has_tried(FACT) {
                let what = matters::meaning(FACT).unwrap_or_default();
                let what = format!("{what}: it becomes a drilling cycle without pecks");
                context.unconfirmed(index, Side::Source, span, FACT, what);
            }
        }
    }
}

/// Tells once of cycles whose pecks are computed.
fn computed(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let told = |nc: &Nc| {
            let mut words = [Role::CycleQ, Role::PeckFirst].into_iter().filter_map(|role| nc.word(role));
            nc.ops().any(pecks) && words.any(|word| word.constant().is_none())
        };
        let all: Vec<Span> =
            stmts.filter(|stmt| stmt.kind.nc().is_some_and(told)).map(|stmt| stmt.site.span).collect();
        if let Some(first) = all.first() {
            let found = Diagnostic::new(Code::Conditional, *first, COMPUTED).assuming(Predicate::Pecks(all));
            context.add_once(index, COMPUTED, found.asked_once());
        }
    }
}

/// Makes a peck cycle without pecks a drilling cycle.
fn drills(nc: &mut Nc) {
    let waits = nc.word(Role::CycleDwell).is_some_and(|word: &Expr| word.constant() != Some(0.0));
    let drill = if waits { Op::CycleDrillDwell } else { Op::CycleDrill };
    let told = |item: &NcItem| {
        matches!(item, NcItem::Word(Role::CycleQ | Role::PeckFirst | Role::PeckLess | Role::PeckLeast, _))
    };
    nc.items.retain(|item| !told(item));
    for item in &mut nc.items {
        if matches!(item, NcItem::Op(op) if pecks(*op)) {
            *item = NcItem::Op(drill);
        }
    }
}

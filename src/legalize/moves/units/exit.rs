//! Which unit a program may leave in force, with all that it runs.
//!
//! Over-approximates: what a program runs is what its calls and computed calls may come to, and the macro of any modal
//! call of the library. A computed code counts where one of the numbers that it may be selects a unit.

use crate::canon::{Group, Op};
use crate::dialect::Units;
use crate::ir::analysis::{Assigned, CallGraph};
use crate::ir::{Module, NcItem, StmtKind};
use crate::legalize::codes::by_number::numbers;
use crate::legalize::{Context, calls_of};
use std::cell::LazyCell;
use std::collections::BTreeSet;

/// What a program may leave in force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExitUnit {
    /// It names inches.
    inch: bool,
    /// It names millimetres.
    metric: bool,
    /// A computed code may name either.
    pub computed: bool,
    /// It runs what is not in the library.
    pub outside: bool,
}

impl ExitUnit {
    /// By program of a library.
    pub fn of(module: &Module, context: &Context<'_>) -> Vec<Self> {
        let mut left = own(module, context);
        let called = context.called(module);
        let (mut macros, mut unknown) = (Vec::<usize>::new(), Self::default());
        for (index, program) in module.programs.iter().enumerate() {
            for (id, block) in program.ids().zip(&program.blocks) {
                for call in calls_of(block) {
                    left[index].outside |= called.may_leave((index, id), call);
                }
                for stmt in &block.stmts {
                    let StmtKind::ModalCall(call) = &stmt.kind else { continue };
                    unknown.outside |= called.may_leave((index, id), call);
                    macros.extend(called.by((index, id), call));
                }
            }
        }
        let mut callees = vec![BTreeSet::new(); module.programs.len()];
        for (caller, callee) in called.pairs(module) {
            callees[caller].insert((callee, false));
        }
        CallGraph::new(callees).bottom_up(&mut left, |mine, callee, _| {
            let all = mine.join(*callee);
            std::mem::replace(mine, all) != all
        });
        // Whatever moves may run them.
        let macros = macros.into_iter().fold(unknown, |all, at| all.join(left[at]));
        left.iter_mut().for_each(|one| *one = one.join(macros));
        left
    }

    /// All programs of a library together.
    pub fn of_library(module: &Module, context: &Context<'_>) -> Self {
        Self::of(module, context).into_iter().fold(Self::default(), Self::join)
    }

    /// What either does.
    #[must_use]
    pub fn join(self, other: Self) -> Self {
        Self {
            inch: self.inch || other.inch,
            metric: self.metric || other.metric,
            computed: self.computed || other.computed,
            outside: self.outside || other.outside,
        }
    }

    /// False where it may leave another unit than this one, as far as the library tells.
    pub fn keeps(self, units: Units) -> bool {
        let other = if units == Units::Inch { self.metric } else { self.inch };
        !other && !self.computed
    }

    /// True where it leaves one unit, or none: nothing that it calls or computes leaves another.
    pub fn is_one(self) -> bool {
        !(self.inch && self.metric || self.computed || self.outside)
    }

    /// True where it names one.
    pub fn names_any(self) -> bool {
        self.inch || self.metric
    }

    /// The one unit that it names.
    pub fn named(self) -> Option<Units> {
        match (self.inch, self.metric) {
            (true, false) => Some(Units::Inch),
            (false, true) => Some(Units::Metric),
            _ => None,
        }
    }

    fn name(&mut self, op: Op) {
        self.inch |= op == Op::Inch;
        self.metric |= op == Op::Metric;
    }
}

/// What the codes of each program name.
fn own(module: &Module, context: &Context<'_>) -> Vec<ExitUnit> {
    let source = context.source;
    let summaries = LazyCell::new(|| context.summaries(module));
    let is_unit = |number: f64| {
        let row = |number| source.code('G', number, &[]);
        [number, number.round()].into_iter().filter_map(row).any(|row| row.op.group() == Group::Units)
    };
    let mut left = vec![ExitUnit::default(); module.programs.len()];
    for (index, program) in module.programs.iter().enumerate() {
        let assigned = LazyCell::new(|| Assigned::new(program, &summaries));
        for (id, block) in program.ids().zip(&program.blocks) {
            for (at, stmt) in block.stmts.iter().enumerate() {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                for item in &nc.items {
                    match item {
                        NcItem::Op(op) => left[index].name(*op),
                        // One that may be any is enough.
                        NcItem::Code('G', value) if !left[index].computed => {
                            left[index].computed = numbers(value, &assigned, id, at, source)
                                .is_none_or(|all| all.iter().any(|n| is_unit(n.number)));
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    left
}

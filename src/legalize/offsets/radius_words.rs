//! Numbers of cutter radii, on a control that takes them beside the code that compensates alone.
//!
//! Law: a number that is named before compensation begins counts where it begins. So it goes to the code that begins it,
//! and stands nowhere else. What a program is called with is followed through its callers. Side conditions: the number that
//! counts at that code is a constant and known on every way; while compensation is in force no other number is named.
//! Counter-example: `D1`, then `G41 X1.` in a part that is called with compensation in force.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use std::collections::BTreeMap;

/// True if the target takes the number beside the code that compensates, and there alone.
pub fn concerns(source: &Control, target: &Control) -> bool {
    let left = target.code_for(Op::RadiusLeft, &BTreeMap::new());
    let beside = left.is_some_and(|row| row.takes(Role::RadiusOffset));
    beside
        && target.letter(Role::RadiusOffset, None).is_none()
        && !source.is(Question::RadiusOffsetActiveTool)
}

/// The number in force.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Radius {
    /// What the program began with.
    Outside,
    Is(f64),
    Unknown,
}

impl Lattice for Radius {
    fn join(&mut self, other: &Self) -> bool {
        let joined = if self == other { *self } else { Self::Unknown };
        std::mem::replace(self, joined) != joined
    }
}

struct Numbers;

impl Radius {
    fn step(&mut self, nc: &Nc, skipped: bool) {
        let before = *self;
        if let Some(word) = nc.word(Role::RadiusOffset) {
            *self = word.constant().map_or(Self::Unknown, Self::Is);
        }
        if skipped {
            self.join(&before);
        }
    }
}

impl Follow for Numbers {
    type Known = Radius;

    fn outside(&self, _: usize) -> Radius {
        Radius::Outside
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, radius: &mut Radius) {
        for stmt in &block.stmts {
            stmt.kind.nc().into_iter().for_each(|nc| radius.step(nc, stmt.site.skip.is_some()));
        }
    }

    fn lose(&self, radius: &mut Radius) {
        *radius = Radius::Unknown;
    }
}

const UNKNOWN: &str = "which radius this compensates by is not known: write its number into this block";
const UNDER: &str = "another radius is named while cutter compensation may be in force: name it before, or end compensation first";

/// Moves the numbers to the codes that compensate.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let known = OverCalls::of(module, &Numbers);
    let compensates = |nc: &Nc| nc.has(Op::RadiusLeft) || nc.has(Op::RadiusRight);
    let any = module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    let any = any.filter_map(|stmt| stmt.kind.nc()).any(compensates);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let ids: Vec<_> = program.ids().collect();
        for (id, block) in ids.into_iter().zip(&mut program.blocks) {
            let Some(mut radius) = known.at(index, id).copied() else { continue };
            let mut state = facts.at(index, id);
            for stmt in &mut block.stmts {
                let (before, side) = (radius, state.op(Group::RadiusComp));
                state.step(stmt);
                let (span, skipped) = (stmt.site.span, stmt.site.skip.is_some());
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                radius.step(nc, skipped);
                if compensates(nc) {
                    if nc.word(Role::RadiusOffset).is_none() {
                        match radius {
                            Radius::Is(number) if number > 0.0 => {
                                nc.items.push(NcItem::Word(Role::RadiusOffset, Expr::Number(number)));
                            }
                            _ => context.add(index, Diagnostic::new(Code::NoEquivalent, span, UNKNOWN)),
                        }
                    }
                    continue;
                }
                if nc.word(Role::RadiusOffset).is_none() {
                    continue;
                }
                let off = side == Some(Op::RadiusOff) || nc.has(Op::RadiusOff) || !any;
                if !off && (before != radius || radius == Radius::Unknown) && side.is_some() {
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, UNDER));
                    continue;
                }
                nc.items.retain(|item| !matches!(item, NcItem::Word(Role::RadiusOffset, _)));
                if nc.items.is_empty() {
                    stmt.kind = StmtKind::Comment;
                }
            }
        }
    }
}

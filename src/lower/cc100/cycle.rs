//! Drilling cycles that go on over G0 and G1.
//!
//! Elsewhere a code of the motion group ends a drilling cycle. Here G80 alone
//! does: the manual drills with `G0 X=V23 Y=V22` under G81. Law: under a cycle a
//! code of rapid or feed says nothing, and is in force after G80. Side
//! condition: every way to the block agrees on whether a cycle is in force.

use super::graph::Graph;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::{Block, Nc, NcItem, Program, Stmt, StmtKind};
use crate::lower::common::Findings;

/// Whether a cycle is in force, and what it keeps waiting.
#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Off,
    /// In force, with the motion that was programmed under it.
    On(Option<Op>),
    /// In force, with different motions on different ways.
    OnMixed,
    Unknown,
}

impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let joined = match (*self, *other) {
            (a, b) if a == b => a,
            (State::On(_) | State::OnMixed, State::On(_) | State::OnMixed) => State::OnMixed,
            _ => State::Unknown,
        };
        std::mem::replace(self, joined) != joined
    }
}

impl State {
    fn is_on(self) -> bool {
        matches!(self, State::On(_) | State::OnMixed)
    }

    fn step(self, nc: &Nc) -> Self {
        nc.ops().filter(|op| matches!(op.group(), Group::Motion | Group::Cycle)).fold(self, |state, op| {
            match op {
                Op::CycleOff => State::Off,
                // A cycle told anew keeps what waits for the end of cycles.
                op if op.is_cycle() && state.is_on() => state,
                op if op.is_cycle() => State::On(None),
                op if state.is_on() => State::On(Some(op)),
                _ => state,
            }
        })
    }
}

fn through(block: &Block, state: State) -> State {
    block.stmts.iter().fold(state, |state, stmt| match &stmt.kind {
        StmtKind::Nc(nc) => state.step(nc),
        _ => state,
    })
}

/// Takes the motion codes under a drilling cycle out, and puts them after its end.
pub fn resolve(program: &mut Program, findings: &mut Findings<'_>) {
    let is_cycle = |stmt: &Stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if nc.ops().any(Op::is_cycle));
    if !program.blocks.iter().flat_map(|block| &block.stmts).any(is_cycle) {
        return;
    }
    let starts = Graph::of(program).forward(program, &State::Off, through);
    for (block, mut state) in program.blocks.iter_mut().zip(starts) {
        let mut stmts = Vec::with_capacity(block.stmts.len());
        for mut stmt in std::mem::take(&mut block.stmts) {
            let before = state;
            let mut ended = None;
            if let StmtKind::Nc(nc) = &mut stmt.kind {
                state = state.step(nc);
                check(before, nc, stmt.site.span, findings);
                if before.is_on() && state.is_on() {
                    nc.items.retain(|item| !matches!(item, NcItem::Op(Op::Rapid | Op::Linear)));
                }
                if let (State::On(Some(op)), State::Off) = (before, state) {
                    ended = Some(Nc { items: vec![NcItem::Op(op)] });
                }
            }
            let site = stmt.site.clone();
            if stmt.kind != StmtKind::Nc(Nc::default()) || !site.comments.is_empty() {
                stmts.push(stmt);
            }
            stmts.extend(ended.map(|nc| Stmt { kind: StmtKind::Nc(nc), site }));
        }
        block.stmts = stmts;
    }
}

fn check(before: State, nc: &Nc, span: crate::text::Span, findings: &mut Findings<'_>) {
    let motion = nc.ops().find(|op| op.group() == Group::Motion && !op.is_cycle() && *op != Op::CycleOff);
    match before {
        State::Unknown if motion.is_some() || nc.moves() => {
            let message = "a drilling cycle is in force on some paths to this block and not on others";
            findings.add(Diagnostic::new(Code::ModalConflict, span, message));
        }
        State::On(_) | State::OnMixed if motion.is_some() => {
            let goes_on = findings.behaviour(Question::CycleEndsByMotion, span) == Some("false");
            if !goes_on || !matches!(motion, Some(Op::Rapid | Op::Linear)) {
                findings.not_understood(span, "no source says what this motion does under a drilling cycle");
            }
        }
        _ => {}
    }
}

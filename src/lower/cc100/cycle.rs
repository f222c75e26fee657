//! Drilling cycles that go on over G0 and G1.
//!
//! Elsewhere a code of the motion group ends a drilling cycle. Here G80 alone
//! does: the manual drills with `G0 X=V23 Y=V22` under G81. Law: under a cycle a
//! code of rapid or feed says nothing, and is in force after G80. Side
//! condition: every way to the block agrees on whether a cycle is in force, and
//! every way to a move on which of those codes G80 left. Counter-example: `G1`,
//! `G81`, on some ways `G0`, then `G80` and `X=V1`: rapid after some, feed after others.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, OneOf, solve_everywhere};
use crate::ir::{Block, BlockId, Nc, NcItem, Program, Stmt, StmtKind, Stmts};
use crate::lower::common::Findings;
use crate::text::Span;

/// Whether a cycle is in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Cycle {
    Off(Motion),
    On(Motion),
}

/// Whether what is written has the motion code that the control has, or will have after the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Motion {
    Written,
    /// This one was programmed under the cycle, and is written after it.
    Waits(Op),
    /// It was programmed under a cycle, but on other ways to the end of that another one was.
    LeftOut,
}

/// What may be in force on the ways to a place.
type State = OneOf<Cycle>;

const NONE: Cycle = Cycle::Off(Motion::Written);

impl Cycle {
    /// Takes an operation of the two groups; `alone`: on all ways this was in force.
    fn step(self, op: Op, alone: bool) -> Self {
        match (self, op) {
            (Cycle::On(Motion::Waits(_)), Op::CycleOff) if alone => NONE,
            (Cycle::On(Motion::Waits(_)), Op::CycleOff) => Cycle::Off(Motion::LeftOut),
            (Cycle::On(motion) | Cycle::Off(motion), Op::CycleOff) => Cycle::Off(motion),
            (Cycle::Off(motion), op) if op.is_cycle() => Cycle::On(motion),
            // A cycle told anew keeps what waits for the end of cycles.
            (Cycle::On(_), op) if op.is_cycle() => self,
            (Cycle::On(_), op) => Cycle::On(Motion::Waits(op)),
            (Cycle::Off(_), _) => NONE,
        }
    }
}

fn step(state: &State, nc: &Nc) -> State {
    let ops = nc.ops().filter(|op| matches!(op.group(), Group::Motion | Group::Cycle));
    ops.fold(state.clone(), |state, op| {
        let alone = state.only().is_some();
        let mut after = state.map(|cycle| cycle.step(op, alone));
        if op == Op::CycleOff {
            // So it may be where only one of these was in force: more ways to a place never say less.
            after.join(&State::one(NONE));
        }
        after
    })
}

/// True where a cycle is in force on every way.
fn is_on(state: &State) -> bool {
    !state.list().is_empty() && state.list().iter().all(|cycle| matches!(cycle, Cycle::On(_)))
}

/// True where no way has a cycle in force.
fn is_off(state: &State) -> bool {
    !state.is_any() && state.list().iter().all(|cycle| matches!(cycle, Cycle::Off(_)))
}

/// What blocks do to it.
struct Cycles;

impl Analysis for Cycles {
    type State = State;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, State)> {
        vec![(BlockId(0), State::one(NONE))]
    }

    fn block(&self, _: BlockId, block: &Block, state: &mut State) {
        for stmt in &block.stmts {
            if let StmtKind::Nc(nc) = &stmt.kind {
                *state = step(state, nc);
            }
        }
    }
}

/// Takes the motion codes under a drilling cycle out, and puts them after its end.
pub fn resolve(program: &mut Program, findings: &mut Findings<'_>) {
    let is_cycle = |stmt: &Stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if nc.ops().any(Op::is_cycle));
    if !program.blocks.iter().flat_map(|block| &block.stmts).any(is_cycle) {
        return;
    }
    let starts = solve_everywhere(&Cycles, program, &Cfg::parts(program), &State::one(NONE));
    for (at, block) in (0..).zip(&mut program.blocks) {
        let mut state = starts.at(BlockId(at)).cloned().unwrap_or_default();
        let mut stmts = Stmts::with_capacity(block.stmts.len());
        for mut stmt in std::mem::take(&mut block.stmts) {
            let mut ended = None;
            if let StmtKind::Nc(nc) = &mut stmt.kind {
                let before = state;
                state = step(&before, nc);
                check((&before, &state), nc, stmt.site.span, findings);
                if is_on(&before) && is_on(&state) {
                    nc.items.retain(|item| !matches!(item, NcItem::Op(Op::Rapid | Op::Linear)));
                }
                if let Some(Cycle::On(Motion::Waits(op))) = before.only()
                    && is_off(&state)
                    && motion(nc).is_none()
                {
                    if nc.moves() {
                        nc.items.push(NcItem::Op(*op));
                    } else {
                        ended = Some(Nc { items: vec![NcItem::Op(*op)] });
                    }
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

/// The motion code of a block.
fn motion(nc: &Nc) -> Option<Op> {
    nc.ops().find(|op| op.group() == Group::Motion && !op.is_cycle() && *op != Op::CycleOff)
}

/// Reports a block before and after which these may be in force.
fn check((before, after): (&State, &State), nc: &Nc, span: Span, findings: &mut Findings<'_>) {
    let motion = motion(nc);
    let mut conflict = |message: &str| findings.add(Diagnostic::new(Code::ModalConflict, span, message));
    if !is_on(before) && !is_off(before) && (motion.is_some() || nc.moves()) {
        conflict("a drilling cycle is in force on some paths to this block and not on others");
    } else if after.list().contains(&Cycle::Off(Motion::LeftOut)) && nc.moves() {
        conflict(
            "the motion code in force here was programmed under a drilling cycle, and not on every path",
        );
    } else if is_on(before) && motion.is_some() {
        let goes_on = findings.behaviour(Question::CycleEndsByMotion, span) == Some("false");
        if !goes_on || !matches!(motion, Some(Op::Rapid | Op::Linear)) {
            findings.not_understood(span, "no source says what this motion does under a drilling cycle");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::analysis::dataflow::solve_everywhere_by;
    use crate::ir::text::parse;

    fn draw(seed: &mut u64, limit: u64) -> u64 {
        *seed ^= *seed << 13;
        *seed ^= *seed >> 7;
        *seed ^= *seed << 17;
        *seed % limit
    }

    /// A program whose blocks begin and end cycles, and lead anywhere.
    fn program(seed: &mut u64) -> Program {
        const WORDS: [&str; 5] = ["cycle.drill", "cycle.off", "motion.rapid", "motion.linear", "axis.x=1"];
        let count = 2 + draw(seed, 6);
        let mut text = String::from("program O1 {\n");
        for id in 0..count {
            text.push_str(&format!("block{id}:\n"));
            for _ in 0..draw(seed, 3) {
                text.push_str(&format!(" nc {}\n", WORDS[draw(seed, 5) as usize]));
            }
            let [a, b] = [draw(seed, count), draw(seed, count)];
            text.push_str(&match draw(seed, 7) {
                0 => " end\n".to_owned(),
                1 => " return\n".to_owned(),
                2 => format!(" call block{a} -> block{b}\n"),
                3 => format!(" jump block{a}\n"),
                _ => format!(" branch global.1 lt 3 ? block{a} : block{b}\n"),
            });
        }
        parse(&format!("{text}}}\n")).unwrap().programs.remove(0)
    }

    #[test]
    fn what_is_found_does_not_hang_on_the_order_of_visits() {
        for seed in 1..3000u64 {
            let mut random = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
            let program = program(&mut random);
            let (cfg, off) = (Cfg::parts(&program), State::one(NONE));
            let found = solve_everywhere(&Cycles, &program, &cfg, &off);
            for _ in 0..4 {
                let ranks = (0..cfg.len()).map(|_| draw(&mut random, 100) as u32).collect();
                let other = solve_everywhere_by(ranks, &Cycles, &program, &cfg, &off);
                assert_eq!(found, other, "seed {seed}");
            }
        }
    }
}

//! Where a program last sent the tool in X and Y, in words that still have the value they had then.
//!
//! A forward analysis of one program. After a call, at an entry and where paths disagree nothing
//! is known; nor after anything that may shift what coordinates mean. A rotation does not count
//! as that: the program's coordinates stay, the machine turns them.

use super::modal::Modal;
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, States, solve};
use crate::ir::analysis::{Cfg, Summaries, Vars};
use crate::ir::{Block, BlockId, Expr, Program, Stmt, StmtKind, TermKind};

/// The last position in X and Y that the program named, absolute: the words that still name it.
#[derive(Clone, Debug, PartialEq)]
pub struct Programmed([Option<Expr>; 2]);

const NOWHERE: Programmed = Programmed([None, None]);

impl Lattice for Programmed {
    fn join(&mut self, other: &Self) -> bool {
        let mut changed = false;
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            if mine.is_some() && mine != theirs {
                *mine = None;
                changed = true;
            }
        }
        changed
    }
}

/// What blocks do to it; `modal` says what is in force at the start of each.
struct Rules<'r> {
    summaries: &'r Summaries,
    modal: &'r dyn Fn(BlockId) -> Modal,
}

impl Analysis for Rules<'_> {
    type State = Programmed;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Programmed)> {
        cfg.roots().iter().map(|root| (*root, NOWHERE)).collect()
    }

    fn block(&self, id: BlockId, block: &Block, here: &mut Programmed) {
        let mut state = (self.modal)(id);
        for stmt in &block.stmts {
            state.step(stmt);
            here.step(stmt, &state, self.summaries);
        }
        if matches!(block.term.kind, TermKind::Call { .. }) {
            *here = NOWHERE;
        }
    }
}

impl Programmed {
    /// The position at the start of every block of a program. `modal` says what is in force there.
    pub fn of(program: &Program, summaries: &Summaries, modal: &dyn Fn(BlockId) -> Modal) -> States<Self> {
        solve(&Rules { summaries, modal }, program, &Cfg::of(program))
    }

    /// Both words, where both are known.
    pub fn words(&self) -> Option<[Expr; 2]> {
        match &self.0 {
            [Some(x), Some(y)] => Some([x.clone(), y.clone()]),
            _ => None,
        }
    }

    /// The words of X and Y, each where it is known.
    pub fn axes(&self) -> [Option<Expr>; 2] {
        self.0.clone()
    }

    /// Takes a statement's effect; `modal` is what is in force after it.
    pub fn step(&mut self, stmt: &Stmt, modal: &Modal, summaries: &Summaries) {
        let before = stmt.site.skip.map(|_| self.clone());
        let mut written = Vars::default();
        stmt.kind.target().iter().for_each(|place| written.write(place));
        match &stmt.kind {
            StmtKind::ClearAll(class) => written.classes.insert(*class),
            StmtKind::Nc(nc) => {
                written.join(summaries.by_nc(nc));
                // A rotation takes the tool along only where it runs the cycle in force.
                let cycle = modal.op(Group::Cycle).is_some_and(|op| op != Op::CycleOff);
                let turned = nc.has(Op::RotateOff) || (nc.has(Op::RotateOn) && !cycle);
                let moves = nc.ops().all(|op| keeps_coordinates(op) || changes_coordinates(op));
                let placed = nc.word(Role::X).is_some() || nc.word(Role::Y).is_some();
                let stays_off = nc.has(Op::RadiusOff) && !placed;
                if turned || modal.may_call() || !moves || stays_off {
                    *self = NOWHERE;
                } else if !nc.ops().all(keeps_coordinates) {
                    // An offset or a unit that the block names changes what it was, not what the block's own words say.
                    *self = NOWHERE;
                    self.moved([nc.word(Role::X), nc.word(Role::Y)], modal.op(Group::Distance));
                } else if !nc.has(Op::RotateOn) {
                    self.moved([nc.word(Role::X), nc.word(Role::Y)], modal.op(Group::Distance));
                }
            }
            _ => {}
        }
        for (word, step) in self.0.iter_mut().zip([Role::StepX, Role::StepY]) {
            let steps = stmt.kind.nc().is_some_and(|nc| nc.word(step).is_some());
            *word = word.take().filter(|word| !steps && !reads(word, &written));
        }
        if let Some(before) = before {
            self.join(&before);
        }
    }

    fn moved(&mut self, to: [Option<&Expr>; 2], distance: Option<Op>) {
        for (word, to) in self.0.iter_mut().zip(to) {
            if let Some(to) = to {
                let stays = distance == Some(Op::Absolute) && is_plain(to);
                *word = stays.then(|| to.clone());
            }
        }
    }
}

/// True for what changes the meaning of coordinates from its block on.
fn changes_coordinates(op: Op) -> bool {
    op == Op::SelectWork || op.group() == Group::Units
}

/// True for what leaves the meaning of coordinates alone. The end of compensation does, but without a move the tool stands beside
/// its words after it.
fn keeps_coordinates(op: Op) -> bool {
    use Group::*;
    let group = op.group();
    matches!(
        group,
        Motion
            | Cycle
            | Distance
            | FeedMode
            | RadiusComp
            | LengthComp
            | ReturnPlane
            | PathMode
            | SpeedMode
            | Rotation
            | Spindle
            | Coolant
    ) || matches!(
        op,
        Op::CheckInch
            | Op::CheckMetric
            | Op::PlaneXy
            | Op::PlaneZx
            | Op::PlaneYz
            | Op::CycleHere
            | Op::Dwell
            | Op::ExactStopOnce
            | Op::Stop
            | Op::OptionalStop
            | Op::RigidTaps
            | Op::TapReady
    )
}

/// True where only variables and numbers are read, and none that may be vacant: a vacant word is none.
fn is_plain(word: &Expr) -> bool {
    let mut plain = !word.may_be_vacant();
    word.walk(&mut |e| {
        plain &= !matches!(e, Expr::System(..)) && (e.place().is_none() || matches!(e, Expr::Var(_)))
    });
    plain
}

fn reads(word: &Expr, written: &Vars) -> bool {
    let mut found = false;
    word.walk(&mut |e| found |= matches!(e, Expr::Var(var) if written.contains(*var)));
    found
}

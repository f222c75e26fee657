//! Where arcs begin, kept in variables of the compiler's own: the X and Y of the last absolute move.
//!
//! Law: after a move of an axis in absolute numbers the word is where the tool stands on that axis, until another move of it,
//! or until what its coordinates count from changes. So the word is copied as the move is made, and the arc reads the copy.
//! Side condition: no way here goes by an incremental move of the axis, a word that may be vacant, a shift, a rotation, or a
//! call of anything that moves. Counter-example: `G91 X5.` before the arc.

use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, States, solve};
use crate::ir::analysis::{Cfg, Modal, Summaries, Vacancy};
use crate::ir::{
    Block, BlockId, Call, Callee, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind, Var,
};
use crate::syntax::ProgramName;
use std::collections::BTreeSet;

/// The axes of an arc.
const AXES: [Role; 2] = [Role::X, Role::Y];

/// The words of an arc, those of its end first, and the angle of a rotation.
const WORDS: [Role; 5] = [Role::X, Role::Y, Role::ArcI, Role::ArcJ, Role::Angle];

/// Of those words, which may be vacant.
pub type Vacant = [bool; 5];

/// Of X and Y, whether the copy of its last word says where the tool stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kept(pub [bool; 2]);

impl Lattice for Kept {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        (0..2).for_each(|axis| self.0[axis] &= other.0[axis]);
        *self != before
    }
}

/// What blocks do to it.
struct Rules<'r> {
    /// True where a call of the program may come back at any label of it.
    comes_back: bool,
    still: &'r BTreeSet<ProgramName>,
    modal: &'r dyn Fn(BlockId) -> Modal,
    vacant: &'r [Vec<Vacant>],
}

impl Analysis for Rules<'_> {
    type State = Kept;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Kept)> {
        cfg.roots().iter().map(|root| (*root, Kept([false; 2]))).collect()
    }

    fn block(&self, id: BlockId, block: &Block, kept: &mut Kept) {
        kept.enter(block, self.comes_back);
        let mut modal = (self.modal)(id);
        for (at, stmt) in block.stmts.iter().enumerate() {
            modal.step(stmt);
            kept.step(stmt, &modal, &self.vacant[id.index()][at]);
        }
        if let TermKind::Call { call, .. } = &block.term.kind
            && !stays(call, self.still)
        {
            *kept = Kept([false; 2]);
        }
    }
}

/// The axes whose word a block puts where the tool then stands, in absolute numbers.
pub(super) fn named(nc: &Nc, modal: &Modal, vacant: &Vacant) -> [bool; 2] {
    let absolute = modal.op(Group::Distance) == Some(Op::Absolute);
    [0, 1].map(|axis| absolute && !vacant[axis] && nc.word(AXES[axis]).is_some())
}

impl Kept {
    /// Comes to the start of a block, where a call may come back too.
    pub fn enter(&mut self, block: &Block, comes_back: bool) {
        if comes_back && !block.labels.is_empty() {
            *self = Self([false; 2]);
        }
    }

    /// Takes a statement's effect; `modal` is what is in force after it, and `vacant` the words that may be none.
    pub fn step(&mut self, stmt: &Stmt, modal: &Modal, vacant: &Vacant) {
        let StmtKind::Nc(nc) = &stmt.kind else { return };
        let before = *self;
        if !stands(nc) || modal.may_call() {
            *self = Self([false; 2]);
        } else {
            let named = named(nc, modal, vacant);
            for (axis, role) in AXES.into_iter().enumerate() {
                self.0[axis] = if nc.word(role).is_some() { named[axis] } else { self.0[axis] };
            }
        }
        if stmt.site.skip.is_some() {
            self.join(&before);
        }
    }
}

/// True for a block that leaves alone what coordinates count from.
pub fn stands(nc: &Nc) -> bool {
    nc.ops().all(keeps) && !nc.items.iter().any(|item| matches!(item, NcItem::Code(..)))
}

/// True for what leaves the meaning of coordinates alone, and the tool where words send it.
pub fn keeps(op: Op) -> bool {
    use Group::*;
    let probes = matches!(op, Op::Probe | Op::ProbeOther | Op::Thread | Op::CycleOther);
    !probes
        && matches!(
            op.group(),
            Motion
                | Cycle
                | Distance
                | FeedMode
                | RadiusComp
                | LengthComp
                | ReturnPlane
                | PathMode
                | Spindle
                | Coolant
        )
        || matches!(op, Op::ThroughSpindle | Op::ThroughSpindleOff)
}

/// True for a call that moves nothing.
fn stays(call: &Call, still: &BTreeSet<ProgramName>) -> bool {
    matches!(&call.callee, Callee::Program(name) if still.contains(name))
}

/// The programs that move nothing, what they call included.
pub(super) fn still(module: &Module) -> BTreeSet<ProgramName> {
    let moves = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Nc(nc) => nc.names_axis() || !stands(nc),
        StmtKind::ModalCall(_) | StmtKind::ModalCallOff => true,
        _ => false,
    };
    let quiet = |program: &&Program| !program.blocks.iter().flat_map(|block| &block.stmts).any(moves);
    let mut still: BTreeSet<ProgramName> =
        module.programs.iter().filter(quiet).filter_map(|program| program.name.clone()).collect();
    loop {
        let calls_on = |program: &Program| {
            program.blocks.iter().any(|block| match &block.term.kind {
                TermKind::Call { call, .. } => !stays(call, &still),
                TermKind::Chain(_) | TermKind::Return { to: Some(_) } => true,
                _ => false,
            })
        };
        let calls_on = module.programs.iter().filter(|program| calls_on(program));
        let loud: BTreeSet<ProgramName> = calls_on.filter_map(|program| program.name.clone()).collect();
        let before = still.len();
        still.retain(|name| !loud.contains(name));
        if still.len() == before {
            return still;
        }
    }
}

/// Of each statement, which words of an arc may be vacant; `given` are locals that every call sets.
pub fn vacant(program: &Program, summaries: &Summaries, given: &BTreeSet<Var>) -> Vec<Vec<Vacant>> {
    let vacancy = Vacancy::of(program, summaries, given);
    let of = |id, at, stmt: &Stmt| {
        WORDS.map(|role| match stmt.kind.nc().and_then(|nc| nc.word(role)) {
            // A vacant value has no opposite: it stays vacant.
            Some(Expr::Negate(word)) => vacancy.may_yield_vacant(id, at, word),
            Some(word) => word.may_be_vacant() && vacancy.may_yield_vacant(id, at, word),
            None => false,
        })
    };
    let block = |(id, block): (BlockId, &Block)| {
        block.stmts.iter().enumerate().map(|(at, stmt)| of(id, at, stmt)).collect()
    };
    program.ids().zip(&program.blocks).map(block).collect()
}

/// True where a call of this program may come back at any label of it: one of a program that may return to a number.
pub(super) fn comes_back(program: &Program, summaries: &Summaries, still: &BTreeSet<ProgramName>) -> bool {
    let leaves = |block: &Block| match &block.term.kind {
        TermKind::Call { call, .. } => !stays(call, still) && !matches!(call.callee, Callee::Block(_)),
        _ => false,
    };
    summaries.come_back() && program.blocks.iter().any(leaves)
}

/// What is kept where control comes to every block.
pub(super) fn of(
    program: &Program,
    (still, comes_back): (&BTreeSet<ProgramName>, bool),
    modal: &dyn Fn(BlockId) -> Modal,
    vacant: &[Vec<Vacant>],
) -> States<Kept> {
    solve(&Rules { comes_back, still, modal, vacant }, program, &Cfg::of(program))
}

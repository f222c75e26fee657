//! Whether anything can tell that a move left another interpolation in force than the source's does.
//!
//! Law: nothing can where on every way from the move a code of the interpolation comes before what goes by it, before the program reads
//! which one is in force, before it calls and before it returns; a run that ends there has none to leave. A code that a variable gives
//! is such a code where the variable holds the interpolation that the program read before the move: it is put back, whatever it was.
//! Counter-example: `#1=#4001` after the move, which reads the rapid on the target alone.

use crate::canon::{Group, Op, Sys};
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Every, Lattice, solve};
use crate::ir::{Block, BlockId, Expr, Nc, NcItem, Place, Program, Stmt, StmtKind, TermKind, Var};
use std::collections::BTreeSet;

/// A move: its block, and the number of its statement.
pub(super) type Move = (BlockId, usize);

/// The moves after which something may tell.
pub(super) fn told(program: &Program, moves: &[Move]) -> BTreeSet<Move> {
    let rules = Rules { moves };
    let states = solve(&rules, program, &Cfg::of(program));
    let mut told = BTreeSet::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        if let Some(state) = states.at(id) {
            let mut state = state.clone();
            rules.walk(id, block, &mut state, &mut |left| told.extend(left));
        }
    }
    told
}

/// What is known at a place.
#[derive(Clone, Debug)]
struct State {
    /// The moves since which no way here said the interpolation.
    left: BTreeSet<Move>,
    /// The variables that hold the interpolation that the program read, on every way.
    held: Every<Var>,
}

impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.left.len();
        self.left.extend(&other.left);
        self.held.join(&other.held) || self.left.len() != before
    }
}

struct Rules<'m> {
    moves: &'m [Move],
}

impl Rules<'_> {
    /// Follows a block; gives `tell` the moves that something tells of.
    fn walk(&self, id: BlockId, block: &Block, state: &mut State, tell: &mut impl FnMut(&BTreeSet<Move>)) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            let mut reads = false;
            stmt.kind.exprs(&mut |e| e.walk(&mut |e| reads |= reads_motion(e)));
            if reads || goes_by(stmt, state) {
                tell(&state.left);
            }
            step(stmt, state);
            if self.moves.contains(&(id, at)) {
                state.left.insert((id, at));
            }
        }
        let mut reads = false;
        block.term.kind.exprs(&mut |e| e.walk(&mut |e| reads |= reads_motion(e)));
        let stays = matches!(
            block.term.kind,
            TermKind::Jump(_) | TermKind::Branch { .. } | TermKind::Computed { .. } | TermKind::End { .. }
        );
        if reads || !stays {
            tell(&state.left);
        }
        // A callee may share what the caller holds.
        if matches!(block.term.kind, TermKind::Call { .. }) {
            state.held.0.clear();
        }
    }
}

impl Analysis for Rules<'_> {
    type State = State;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, State)> {
        let begins = State { left: BTreeSet::new(), held: Every(BTreeSet::new()) };
        cfg.roots().iter().map(|root| (*root, begins.clone())).collect()
    }

    fn block(&self, id: BlockId, block: &Block, state: &mut State) {
        self.walk(id, block, state, &mut |_| {});
    }
}

/// True for a read of the interpolation in force, or of one of which nobody knows the group.
fn reads_motion(e: &Expr) -> bool {
    let Expr::System(Sys::Modal, subscripts) = e else { return false };
    let number = subscripts.first().and_then(Expr::constant);
    number.is_none() || number == Group::Motion.number().map(f64::from)
}

/// True for a block that goes by the interpolation in force.
fn goes_by(stmt: &Stmt, state: &State) -> bool {
    let nc = match &stmt.kind {
        StmtKind::Nc(nc) => nc,
        StmtKind::ModalCall(_) | StmtKind::ModalCallOff => return true,
        _ => return false,
    };
    // These go rapidly whatever is in force, or not at all.
    let own =
        |op: Op| op.group() == Group::Motion || matches!(op, Op::MachineOnce | Op::Dwell) || op.is_return();
    !(nc.ops().any(own) || says(nc, state))
        && nc
            .items
            .iter()
            .any(|item| matches!(item, NcItem::Word(role, _) if role.is_length() || role.is_axis()))
}

/// True for a block that says the interpolation: by its code, or by a variable that holds it.
fn says(nc: &Nc, state: &State) -> bool {
    nc.items.iter().any(|item| match item {
        NcItem::Op(op) => op.group() == Group::Motion,
        NcItem::Code('G', Expr::Var(var)) => state.held.0.contains(var),
        _ => false,
    })
}

fn step(stmt: &Stmt, state: &mut State) {
    let sure = stmt.site.skip.is_none();
    match &stmt.kind {
        StmtKind::Nc(nc) if sure && says(nc, state) => state.left.clear(),
        StmtKind::Assign { target: Place::Var(var), value } => {
            let holds = matches!(value, Expr::System(..)) && reads_motion(value) && value_is_known(value);
            // What is read after the move is another one on the target.
            if sure && holds && state.left.is_empty() {
                state.held.0.insert(*var);
            } else {
                state.held.0.remove(var);
            }
        }
        StmtKind::Assign { target: Place::Indirect(..), .. }
        | StmtKind::Input { .. }
        | StmtKind::ClearAll(_) => {
            state.held.0.clear();
        }
        _ => {}
    }
}

/// True where the group that is read is a number of the text.
fn value_is_known(value: &Expr) -> bool {
    matches!(value, Expr::System(_, subscripts) if subscripts.iter().all(|one| one.constant().is_some()))
}

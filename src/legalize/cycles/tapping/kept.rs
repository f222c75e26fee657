//! The feed from before a tap: where the target's own tap feed stands in its place, and what brings it back.

use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::Control;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, States, solve};
use crate::ir::analysis::modal::Modal;
use crate::ir::{
    Block, BlockId, Class, Expr, Module, Place, Program, SourceInfo, Stmt, StmtKind, TermKind, Var,
};
use crate::legalize::ModalFacts;
use crate::legalize::rewrite::highest_temp;

/// F by the place of its letter.
const ADDRESS_F: u32 = 6;

/// The feed in force on the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feed {
    /// That of the source.
    Same,
    /// A register holds that of the source; in force is that of a tap, or the same.
    Held,
    /// That of a tap may be in force, and nothing holds that of the source.
    Lost,
}

/// What must be done at a statement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Does {
    Nothing,
    /// Before it the feed is read into the register.
    Reads,
    /// It says this feed again.
    Says(f64),
    /// It says the feed that the register holds.
    SaysHeld,
    /// It should say the feed, which is not known.
    Fails,
}

/// The feed at the start of every block of a library.
pub struct Kept {
    readable: bool,
    /// True where a program may call another or return in the middle of a tap.
    open: bool,
    entries: Vec<States<Feed>>,
    /// What holds the feed, in those programs that need it.
    registers: Vec<Option<Var>>,
}

impl Kept {
    /// Follows the feed through a library.
    pub fn of(module: &Module, facts: &ModalFacts, target: &Control) -> Self {
        let readable = target.system_address(Sys::Address, &[ADDRESS_F]).is_some();
        let mut kept = Self { readable, open: false, entries: Vec::new(), registers: Vec::new() };
        // Programs find and leave the feed as it was, unless one calls or returns in the middle of a tap.
        if kept.flow(module, facts, Feed::Same) {
            kept.open = true;
            kept.flow(module, facts, Feed::Lost);
        }
        for (index, program) in module.programs.iter().enumerate() {
            let asks = program.ids().any(|id| {
                let (mut modal, mut feed) = (facts.at(index, id), kept.at(index, id));
                let stmts = program.blocks.get(id.index()).into_iter().flat_map(|block| &block.stmts);
                stmts.into_iter().any(|stmt| kept.step(stmt, &mut modal, &mut feed) == Does::SaysHeld)
            });
            let register = Var { class: Class::Temp, number: highest_temp(program) + 1 };
            kept.registers.push(asks.then_some(register));
        }
        kept
    }

    /// Follows the feed where programs begin, and go on after calls, in this state. True where one calls or returns
    /// in another.
    fn flow(&mut self, module: &Module, facts: &ModalFacts, begins: Feed) -> bool {
        let mut open = false;
        let mut entries = Vec::with_capacity(module.programs.len());
        for (index, program) in module.programs.iter().enumerate() {
            let (rules, cfg) = (Follows { kept: &*self, facts, index, begins }, Cfg::of(program));
            let starts = solve(&rules, program, &cfg);
            open |= program.ids().any(|id| rules.is_open(program, &cfg, id, &starts));
            entries.push(starts);
        }
        self.entries = entries;
        open
    }

    /// The feed at the start of a block.
    pub fn at(&self, program: usize, id: BlockId) -> Feed {
        let entry = self.entries.get(program).and_then(|all| all.at(id));
        entry.copied().unwrap_or(Feed::Lost)
    }

    /// What holds the feed in a program.
    pub fn register(&self, program: usize) -> Option<Var> {
        self.registers.get(program).copied().flatten()
    }

    /// The statement that reads the feed into a register before another one.
    pub fn reading(register: Var, stmt: &Stmt) -> Stmt {
        let read = Expr::System(Sys::Address, [Expr::Number(f64::from(ADDRESS_F))].into());
        let kind = StmtKind::Assign { target: Place::Var(register), value: read };
        Stmt { kind, site: SourceInfo { span: stmt.site.span, ..SourceInfo::default() } }
    }

    /// Goes on after a statement, and says what must be done at it.
    pub fn step(&self, stmt: &Stmt, modal: &mut Modal, feed: &mut Feed) -> Does {
        let (was, known) = (modal.op(Group::Cycle), modal.feed());
        modal.step(stmt);
        let StmtKind::Nc(nc) = &stmt.kind else { return Does::Nothing };
        let skipped = stmt.site.skip.is_some();
        // What was read counts something else in another unit or feed mode.
        let other = nc.ops().any(|op| matches!(op.group(), Group::Units | Group::FeedMode));
        let mut does = Does::Nothing;
        if nc.ops().any(Op::is_tap) {
            if *feed == Feed::Same && nc.word(Role::Lead).is_some() {
                (*feed, does) =
                    if self.readable { (Feed::Held, Does::Reads) } else { (Feed::Lost, Does::Nothing) };
            }
        } else if nc.word(Role::Feed).is_some() {
            *feed = if skipped && *feed != Feed::Same { Feed::Lost } else { Feed::Same };
        } else if *feed != Feed::Same
            && was.is_none_or(Op::is_tap)
            && modal.op(Group::Cycle).is_some_and(|op| !op.is_tap())
        {
            does = match (known, *feed) {
                (Some(feed), _) => Does::Says(feed),
                (None, Feed::Held) if !other => Does::SaysHeld,
                _ => Does::Fails,
            };
            if does != Does::Fails && !skipped {
                *feed = Feed::Same;
            }
        }
        if (other && *feed == Feed::Held) || self.open && calls_by_moving(stmt, modal) {
            *feed = Feed::Lost;
        }
        does
    }
}

impl Lattice for Feed {
    fn join(&mut self, other: &Self) -> bool {
        let joined = if self == other { *self } else { Feed::Lost };
        std::mem::replace(self, joined) != joined
    }
}

/// What the blocks of a program do to the feed; it begins, and goes on after calls, as `begins` says.
struct Follows<'f> {
    kept: &'f Kept,
    facts: &'f ModalFacts,
    index: usize,
    begins: Feed,
}

impl Follows<'_> {
    /// True where a block calls or returns with another feed than that of the source.
    fn is_open(&self, program: &Program, cfg: &Cfg, id: BlockId, starts: &States<Feed>) -> bool {
        let (Some(block), Some(feed)) = (program.block(id), starts.at(id)) else { return false };
        let (mut feed, mut modal) = (*feed, self.facts.at(self.index, id));
        let in_block = block.stmts.iter().any(|stmt| {
            self.kept.step(stmt, &mut modal, &mut feed);
            feed != Feed::Same && calls_by_moving(stmt, &modal)
        });
        let goes = match &block.term.kind {
            TermKind::Call { .. } => true,
            TermKind::End { .. } => false,
            _ => cfg.succs(id).is_empty(),
        };
        in_block || feed != Feed::Same && goes
    }
}

impl Analysis for Follows<'_> {
    type State = Feed;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Feed)> {
        cfg.roots().iter().map(|root| (*root, self.begins)).collect()
    }

    fn block(&self, id: BlockId, block: &Block, feed: &mut Feed) {
        let mut modal = self.facts.at(self.index, id);
        for stmt in &block.stmts {
            self.kept.step(stmt, &mut modal, feed);
        }
        if self.begins == Feed::Lost && matches!(block.term.kind, TermKind::Call { .. }) {
            *feed = Feed::Lost;
        }
    }
}

/// True for a block that moves where a modal call may be open.
fn calls_by_moving(stmt: &Stmt, modal: &Modal) -> bool {
    modal.may_call() && matches!(&stmt.kind, StmtKind::Nc(nc) if nc.names_axis())
}

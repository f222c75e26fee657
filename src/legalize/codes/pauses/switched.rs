//! What a block skip alone started: it runs where the operator's switch is off, and stands where it is on.
//!
//! A run begins with spindle and coolant standing where no profile says otherwise, as for all that nothing of a library starts. A
//! block skip inside a block is a branch whose ways meet again: what each did is kept apart until then.

use super::{ends, starts};
use crate::canon::{Op, Running};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Callee, Cond, Module, NcItem, Program, Stmt, TermKind};
use crate::legalize::Modal;
use std::collections::BTreeMap;

/// What is known of one that runs or stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Known {
    /// No run comes here with the switch so.
    #[default]
    Never,
    Stands,
    Runs(Op),
    Unknown,
}

impl Known {
    fn join(self, other: Self) -> Self {
        match (self, other) {
            (Known::Never, known) | (known, Known::Never) => known,
            _ if self == other => self,
            _ => Known::Unknown,
        }
    }
}

/// What is known of one with a switch off and with it on, and the level of that switch, where they are not alike.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Under {
    level: Option<u8>,
    off: Known,
    on: Known,
}

impl Under {
    fn both(known: Known) -> Self {
        Self { level: None, off: known, on: known }
    }

    /// The same, told apart by the switch of a level.
    fn by(self, level: u8) -> Self {
        match self.level {
            Some(other) if other != level => {
                Self { level: Some(level), ..Self::both(self.off.join(self.on)) }
            }
            _ => Self { level: Some(level), ..self },
        }
    }

    /// After something that only runs with the switch of `skip` off, where it has one.
    fn set(&mut self, known: Known, skip: Option<u8>) {
        let never = |before: Known| if before == Known::Never { before } else { known };
        *self = match skip {
            Some(level) => {
                let told = self.by(level);
                Self { off: never(told.off), ..told }
            }
            None => Self { off: never(self.off), on: never(self.on), ..*self },
        };
    }

    fn join(self, other: Self) -> Self {
        let level = self.level.or(other.level);
        let (mine, theirs) = match level {
            Some(level) => (self.by(level), other.by(level)),
            None => (self, other),
        };
        Self { level, off: mine.off.join(theirs.off), on: mine.on.join(theirs.on) }
    }
}

/// For spindle and coolant, what is known with a switch off and on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Switched([Under; 2]);

impl Lattice for Switched {
    fn join(&mut self, other: &Self) -> bool {
        let joined =
            Self(Running::ALL.map(|running| self.0[running as usize].join(other.0[running as usize])));
        std::mem::replace(self, joined) != joined
    }
}

impl Switched {
    /// Where nothing is known.
    pub fn unknown() -> Self {
        Self([Under::both(Known::Unknown); 2])
    }

    /// Takes a statement.
    pub fn step(&mut self, stmt: &Stmt) {
        let Some(nc) = stmt.kind.nc() else { return };
        let computed = nc.items.iter().any(|item| matches!(item, NcItem::Code(..)));
        for running in Running::ALL {
            let under = &mut self.0[running as usize];
            let (group, _) = ends(running);
            let said = nc.ops().filter(|op| op.group() == group).last();
            let known = match said {
                _ if computed => Known::Unknown,
                Some(op) if starts(running).contains(&op) => Known::Runs(op),
                Some(_) => Known::Stands,
                // A tap may turn it, or leave it standing.
                None if running == Running::Spindle && nc.ops().any(Op::is_tap) => Known::Unknown,
                None => continue,
            };
            under.set(known, stmt.site.skip);
        }
    }

    /// The code that runs with the switch off, and the level of that switch, where nothing runs with it on.
    pub fn of(&self, running: Running) -> Option<(Op, u8)> {
        match self.0[running as usize] {
            Under { level: Some(level), off: Known::Runs(op), on: Known::Stands } => Some((op, level)),
            _ => None,
        }
    }
}

/// Follows a library.
pub(super) struct Switches {
    outside: Switched,
    /// By program, true where whoever calls it from outside the library may leave anything running.
    returns: Vec<bool>,
    /// By program, the blocks that a run comes to with a switch so, and no other way: its level, and true if it is on.
    ways: Vec<BTreeMap<BlockId, (u8, bool)>>,
}

impl Switches {
    /// What is known at every block; runs begin with `entry` in force.
    pub fn of(module: &Module, entry: &Modal) -> OverCalls<Switched> {
        let outside = Switched(Running::ALL.map(|running| {
            let op = entry.op(ends(running).0);
            Under::both(op.filter(|op| starts(running).contains(op)).map_or(Known::Stands, Known::Runs))
        }));
        let returns = module.programs.iter().map(Program::returns).collect();
        OverCalls::of(module, &Self { outside, returns, ways: module.programs.iter().map(ways).collect() })
    }
}

/// The blocks that a branch on a switch alone leads to.
fn ways(program: &Program) -> BTreeMap<BlockId, (u8, bool)> {
    let mut comes = vec![0_u32; program.blocks.len()];
    let mut found = BTreeMap::new();
    for block in &program.blocks {
        let kind = &block.term.kind;
        if let TermKind::Call { call, .. } = kind
            && let Callee::Block(entry) = call.callee
            && let Some(count) = comes.get_mut(entry.index())
        {
            *count += 1;
        }
        for id in kind.successors() {
            comes.get_mut(id.index()).into_iter().for_each(|count| *count += 1);
        }
        if let TermKind::Branch { cond, then, otherwise } = kind
            && let Cond::Switch(level) = **cond
        {
            found.extend([(*then, (level, true)), (*otherwise, (level, false))]);
        }
    }
    let alone = |id: &BlockId| {
        let labelled = program.block(*id).is_none_or(|block| !block.labels.is_empty());
        id.index() > 0 && !labelled && comes.get(id.index()) == Some(&1)
    };
    found.into_iter().filter(|(id, _)| alone(id)).collect()
}

impl Follow for Switches {
    type Known = Switched;

    fn outside(&self, program: usize) -> Switched {
        match self.returns.get(program) {
            Some(false) => self.outside,
            _ => Switched::unknown(),
        }
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, known: &mut Switched) {
        if let Some((level, on)) = self.ways.get(index).and_then(|ways| ways.get(&id)) {
            for under in &mut known.0 {
                let told = under.by(*level);
                *under = match on {
                    true => Under { off: Known::Never, ..told },
                    false => Under { on: Known::Never, ..told },
                };
            }
        }
        block.stmts.iter().for_each(|stmt| known.step(stmt));
    }

    fn lose(&self, known: &mut Switched) {
        *known = Switched::unknown();
    }
}

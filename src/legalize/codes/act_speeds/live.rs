//! The last S, and whether a live tool turns, at every block of a library.

use crate::canon::{Act, Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::{Block, BlockId, Expr, Nc, NcItem, Stmt, StmtKind};
use crate::legalize::cycles::tap_leads::Speed;

/// Whether a live tool turns whose code reads S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Live {
    No,
    On(Act),
    /// Something came since that may have stopped it.
    Doubted(Act),
    /// It turns on some of the ways here.
    Either(Act),
}

/// What is known at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Known {
    pub speed: Speed,
    /// True where the last S stands beside the code of a live tool, on some way here.
    pub beside: bool,
    pub live: Live,
}

impl Known {
    pub(super) const NOTHING: Self = Self { speed: Speed::Unknown, beside: false, live: Live::No };

    /// After a statement.
    pub(super) fn step(&mut self, stmt: &Stmt, source: &Control, target: &Control) {
        self.speed.step(stmt);
        let StmtKind::Nc(nc) = &stmt.kind else {
            if matches!(stmt.kind, StmtKind::ModalCall(_)) {
                self.doubt();
            }
            return;
        };
        let skipped = stmt.site.skip.is_some();
        self.beside &= nc.word(Role::Speed).is_none() || skipped;
        if nc.has(Op::SpindleCw) || nc.has(Op::SpindleCcw) {
            self.live = if skipped { self.live.either(Live::No) } else { Live::No };
        }
        let changes = [Op::SpindleStop, Op::ToolChange, Op::Builder, Op::MachineSpecific];
        let code = nc.items.iter().any(|item| matches!(item, NcItem::Code(..)));
        if code || nc.ops().any(|op| changes.contains(&op)) || names_tool(nc) {
            self.doubt();
        }
        for act in acts(nc) {
            let ours = source.speed_word(act);
            let Some(role) = ours.or(target.speed_word(act)) else {
                self.doubt();
                continue;
            };
            if let Some(value) = nc.word(role) {
                if ours.is_some() && self.speed != Speed::Surface {
                    let now = value.constant().map_or(Speed::Said, Speed::Known);
                    self.speed = if skipped { self.speed.either(now) } else { now };
                }
                self.beside |= ours != target.speed_word(act);
            }
            self.live = if skipped { self.live.either(Live::On(act)) } else { Live::On(act) };
        }
    }

    fn doubt(&mut self) {
        if let Live::On(act) | Live::Either(act) = self.live {
            self.live = Live::Doubted(act);
        }
    }
}

/// True for a block with a tool word.
pub(super) fn names_tool(nc: &Nc) -> bool {
    nc.word(Role::Tool).is_some() || nc.word(Role::Turret).is_some()
}

/// The codes of builders in a block.
pub(super) fn acts(nc: &Nc) -> impl Iterator<Item = Act> + '_ {
    nc.items.iter().filter_map(|item| match item {
        NcItem::Word(Role::Act, number) => Expr::constant(number).and_then(Act::of),
        _ => None,
    })
}

impl Live {
    fn either(self, other: Self) -> Self {
        match (self, other) {
            _ if self == other => self,
            (Self::On(act) | Self::Either(act), _) | (_, Self::On(act) | Self::Either(act)) => {
                Self::Either(act)
            }
            (Self::Doubted(act), _) | (_, Self::Doubted(act)) => Self::Doubted(act),
            (Self::No, Self::No) => Self::No,
        }
    }
}

impl Lattice for Known {
    fn join(&mut self, other: &Self) -> bool {
        let mut speed = self.speed;
        speed.join(&other.speed);
        let joined = Self { speed, beside: self.beside || other.beside, live: self.live.either(other.live) };
        std::mem::replace(self, joined) != joined
    }
}

/// Follows a library.
pub(super) struct Lives<'c> {
    pub source: &'c Control,
    pub target: &'c Control,
}

impl Follow for Lives<'_> {
    type Known = Known;

    fn outside(&self, _: usize) -> Known {
        Known::NOTHING
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Known) {
        block.stmts.iter().for_each(|stmt| known.step(stmt, self.source, self.target));
    }

    fn lose(&self, known: &mut Known) {
        known.speed.lose();
        known.doubt();
    }
}

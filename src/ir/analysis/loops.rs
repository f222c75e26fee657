//! Natural loops, nested.

use super::{Cfg, Dominators};
use crate::ir::BlockId;

/// A natural loop: all edges back to one header that dominates where they start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loop {
    /// Where it is entered, and the only place where it is.
    pub header: BlockId,
    /// The blocks that go back to the header.
    pub latches: Vec<BlockId>,
    /// Index of the loop around it.
    pub parent: Option<usize>,
}

/// The loops of a program. Inner loops come before those around them.
#[derive(Clone, Debug, Default)]
pub struct Loops {
    /// The loops.
    pub all: Vec<Loop>,
    /// Edges that go back in reverse postorder to a block that does not dominate their start:
    /// jumps into the middle of a loop.
    pub irreducible: Vec<(BlockId, BlockId)>,
    innermost: Vec<Option<usize>>,
    /// A loop around each loop, as far out as was found last: shortens the way to the outermost.
    around: Vec<usize>,
}

impl Loops {
    /// The loops of a graph.
    pub fn of(cfg: &Cfg, dominators: &Dominators) -> Self {
        let mut loops = Self { innermost: vec![None; cfg.len()], ..Self::default() };
        for header in cfg.order().iter().rev() {
            let (mut latches, mut irreducible) = (Vec::new(), Vec::new());
            for pred in cfg.preds(*header) {
                let Some(from) = cfg.place(*pred) else { continue };
                if dominators.dominates(*header, *pred) {
                    latches.push(*pred);
                } else if cfg.place(*header).is_some_and(|to| to <= from) {
                    irreducible.push((*pred, *header));
                }
            }
            loops.irreducible.extend(irreducible);
            if !latches.is_empty() {
                loops.collect(cfg, *header, latches);
            }
        }
        loops
    }

    /// Finds the blocks of one loop, stepping over the loops inside it as over single blocks.
    fn collect(&mut self, cfg: &Cfg, header: BlockId, latches: Vec<BlockId>) {
        let this = self.all.len();
        let mut work = latches.clone();
        self.all.push(Loop { header, latches, parent: None });
        self.around.push(this);
        while let Some(id) = work.pop() {
            if id == header {
                continue;
            }
            match self.innermost[id.index()] {
                None => {
                    self.innermost[id.index()] = Some(this);
                    work.extend(cfg.preds(id).iter().filter(|p| cfg.place(**p).is_some()));
                }
                Some(inner) => {
                    let outer = self.outermost(inner);
                    if outer != this {
                        self.all[outer].parent = Some(this);
                        self.around[outer] = this;
                        let head = self.all[outer].header;
                        work.extend(cfg.preds(head).iter().filter(|p| cfg.place(**p).is_some()));
                    }
                }
            }
        }
        self.innermost[header.index()] = self.innermost[header.index()].or(Some(this));
    }

    fn outermost(&mut self, mut at: usize) -> usize {
        while self.around[at] != at {
            self.around[at] = self.around[self.around[at]];
            at = self.around[at];
        }
        at
    }

    /// Index of the innermost loop that a block is in.
    pub fn innermost(&self, id: BlockId) -> Option<usize> {
        self.innermost.get(id.index()).copied().flatten()
    }

    /// True where the block is in the loop.
    pub fn contains(&self, which: usize, id: BlockId) -> bool {
        let mut at = self.innermost(id);
        while let Some(found) = at.filter(|found| *found != which) {
            at = self.all[found].parent;
        }
        at == Some(which)
    }

    /// The blocks of a loop, in the order of ids.
    pub fn body(&self, which: usize) -> Vec<BlockId> {
        (0..self.innermost.len() as u32).map(BlockId).filter(|id| self.contains(which, *id)).collect()
    }

    /// How many loops are around a block.
    pub fn depth(&self, id: BlockId) -> usize {
        std::iter::successors(self.innermost(id), |which| self.all[*which].parent).count()
    }
}

//! Builds a program's blocks from a run of statements with labels and jumps.

use super::{Block, BlockId, Callee, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind, Terminator};
use crate::syntax::{Label, ProgramName};
use thin_vec::ThinVec;

/// Builds a program block by block, in source order.
///
/// Ids are handed out before their blocks are filled, so that a jump can go
/// forward: [`Builder::fresh`], then [`Builder::start`] when the place is reached.
/// [`Builder::finish`] lays the blocks out in the order they were started in;
/// a block that was never started becomes an empty one that ends in
/// [`TermKind::Stray`], at the end.
#[derive(Debug)]
pub struct Builder {
    blocks: Vec<Option<Block>>,
    order: Vec<BlockId>,
    current: BlockId,
    open: bool,
}

impl Default for Builder {
    fn default() -> Self {
        Self::new()
    }
}

impl Builder {
    /// A builder at the start of the entry block.
    pub fn new() -> Self {
        let mut builder = Self { blocks: Vec::new(), order: Vec::new(), current: BlockId(0), open: false };
        let entry = builder.fresh();
        builder.start(entry);
        builder
    }

    /// A builder whose first `count` ids are handed out, for rebuilding a program of so many
    /// blocks; it is at the start of the first.
    pub fn over(count: usize) -> Self {
        let mut builder = Self::new();
        for _ in 1..count {
            builder.fresh();
        }
        builder
    }

    /// An id for a block that is started later.
    pub fn fresh(&mut self) -> BlockId {
        self.blocks.push(None);
        BlockId(self.blocks.len() as u32 - 1)
    }

    /// Goes on in the block `id`, once; the present one falls through to it unless it is ended.
    pub fn start(&mut self, id: BlockId) {
        if self.open {
            self.end(TermKind::Jump(id), SourceInfo::default());
        }
        self.current = id;
        self.open = true;
        let Some(slot @ None) = self.blocks.get_mut(id.index()) else { return };
        *slot = Some(Block {
            labels: ThinVec::new(),
            stmts: Stmts::new(),
            term: Terminator { kind: TermKind::Stray, site: SourceInfo::default() },
        });
        self.order.push(id);
    }

    /// Adds a label to the present block, which must be at its start to be found by it.
    pub fn label(&mut self, label: Label) {
        self.reopen();
        self.with_current(|block| {
            // Hardly any block has two: room for more would be a tenth of all memory.
            block.labels.reserve_exact(1);
            block.labels.push(label);
        });
    }

    /// Makes room for statements of the present block.
    pub fn reserve(&mut self, count: usize) {
        self.with_current(|block| block.stmts.reserve_exact(count));
    }

    /// Adds a statement; after an ended block it starts an unreachable one.
    #[inline]
    pub fn push(&mut self, kind: StmtKind, site: SourceInfo) {
        self.reopen();
        self.with_current(|block| block.stmts.push(Stmt { kind, site }));
    }

    /// True if the present block has a wait for the moves that nothing can skip, and nothing after it that may move.
    pub fn has_waited(&self) -> bool {
        let block = self.blocks.get(self.current.index()).and_then(Option::as_ref);
        let stmts = block.filter(|_| self.open).map_or(&[][..], |block| block.stmts.as_slice());
        let moves = |kind: &StmtKind| matches!(kind, StmtKind::Nc(_) | StmtKind::ModalCall(_));
        let last = stmts.iter().rev().find(|stmt| stmt.kind == StmtKind::Sync || moves(&stmt.kind));
        last.is_some_and(|stmt| stmt.kind == StmtKind::Sync && stmt.site.skip.is_none())
    }

    /// Ends the present block.
    pub fn end(&mut self, kind: TermKind, site: SourceInfo) {
        self.reopen();
        self.with_current(|block| {
            block.term = Terminator { kind, site };
            // Most blocks are short: room to spare would be most of a library.
            block.stmts.shrink_to_fit();
        });
        self.open = false;
    }

    /// Makes the present block, just started, what another is, its end included.
    pub fn keep(&mut self, block: Block) {
        self.with_current(|slot| *slot = block);
        self.open = false;
    }

    /// Ends the present block and goes on in a fresh one, which `kind` may name.
    pub fn end_then(&mut self, site: SourceInfo, kind: impl FnOnce(BlockId) -> TermKind) -> BlockId {
        let next = self.fresh();
        self.end(kind(next), site);
        self.start(next);
        next
    }

    /// The block that statements are added to.
    pub fn current(&self) -> BlockId {
        self.current
    }

    /// True when the present block has no terminator yet.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// True when the present block is open and has no statements yet.
    pub fn is_at_start(&self) -> bool {
        let block = self.blocks.get(self.current.index()).and_then(Option::as_ref);
        self.open && block.is_some_and(|block| block.stmts.is_empty())
    }

    fn reopen(&mut self) {
        if !self.open {
            let next = self.fresh();
            self.start(next);
        }
    }

    #[inline]
    fn with_current(&mut self, change: impl FnOnce(&mut Block)) {
        if let Some(Some(block)) = self.blocks.get_mut(self.current.index()) {
            change(block);
        }
    }

    /// The finished program. An open block ends in [`TermKind::Stray`].
    pub fn finish(mut self, name: Option<ProgramName>, file: usize, site: SourceInfo) -> Program {
        for index in 0..self.blocks.len() {
            if self.blocks[index].is_none() {
                self.open = false;
                self.start(BlockId(index as u32));
            }
        }
        let mut place = vec![BlockId(0); self.blocks.len()];
        self.order.iter().enumerate().for_each(|(at, id)| place[id.index()] = BlockId(at as u32));
        let mut blocks = Vec::with_capacity(self.order.len());
        for id in &self.order {
            let Some(mut block) = self.blocks[id.index()].take() else { continue };
            block.term.kind.for_each_target(&mut |target| *target = place[target.index()]);
            for stmt in &mut block.stmts {
                if let StmtKind::ModalCall(call) = &mut stmt.kind
                    && let Callee::Block(entry) = &mut call.callee
                {
                    *entry = place[entry.index()];
                }
            }
            blocks.push(block);
        }
        Program { name, file, site, held: Vec::new(), blocks }
    }
}

//! Which variables are live: may be read before they are written.

use super::effects::{Seen, Summaries, Vars};
use super::{Cfg, Row, Universe};
use crate::ir::{Block, BlockId, Callee, Class, Expr, Place, Program, Site, StmtKind, TermKind, Var};
use std::collections::VecDeque;

/// What counts as read when a program is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Nothing: what is live at the entry is what the program itself, and what it calls, reads.
    Nothing,
    /// All that other programs or the operator may see afterwards.
    Observable,
}

/// Liveness in one program. Variables that neither it nor its callees name are not spoken of.
#[derive(Clone, Debug)]
pub struct Liveness<'p> {
    program: &'p Program,
    summaries: &'p Summaries,
    universe: Universe,
    exit: Exit,
    /// Live at the start of each block, those two of [`Cfg::whole`] included.
    before: Vec<Row>,
    /// What each block reads before it writes it, and what passes it.
    transfers: Vec<(Row, Row)>,
    cfg: Cfg,
    /// True where a modal call runs a body of the program, whose return may go behind any NC block.
    modal_body: bool,
}

impl<'p> Liveness<'p> {
    /// Computes it.
    pub fn of(program: &'p Program, summaries: &'p Summaries, exit: Exit) -> Self {
        let cfg = Cfg::whole(program, summaries.come_back());
        let mut live = Self {
            program,
            summaries,
            universe: Universe::default(),
            exit,
            before: Vec::new(),
            transfers: Vec::new(),
            cfg,
            modal_body: has_modal_body(program),
        };
        live.gather();
        live.before = vec![live.universe.none(); live.cfg.len()];
        // Without variables there is nothing to find.
        if !live.universe.vars().is_empty() {
            let every = live.universe.classes(|_| true);
            live.transfers = program.blocks.iter().map(|block| live.transfer(block, &every)).collect();
            live.solve();
        }
        live
    }

    /// Collects the variables to speak of.
    fn gather(&mut self) {
        let mut all = Vars::default();
        for block in &self.program.blocks {
            for stmt in &block.stmts {
                stmt.kind.exprs(&mut |e| all.read(e));
                stmt.kind.target().iter().for_each(|place| all.write(place));
                if let StmtKind::Nc(nc) = &stmt.kind {
                    all.join(&self.summaries.of_nc(nc).reads);
                }
            }
            block.term.kind.exprs(&mut |e| all.read(e));
            if let Some(used) = self.used_by_term(&block.term.kind) {
                all.join(used);
            }
        }
        self.universe = Universe::new(&all.vars);
    }

    fn solve(&mut self) {
        let count = self.cfg.len();
        // Blocks that the entry does not reach are answered for too: they may be kept.
        let mut work: VecDeque<BlockId> = (0..count as u32).rev().map(BlockId).collect();
        let mut waiting = vec![true; count];
        while let Some(id) = work.pop_front() {
            waiting[id.index()] = false;
            let mut row = self.after(id);
            if let Some((reads, passes)) = self.transfers.get(id.index()) {
                row.intersect(passes);
                row.join(reads);
            }
            if self.before[id.index()].join(&row) {
                for pred in self.cfg.preds(id) {
                    if !std::mem::replace(&mut waiting[pred.index()], true) {
                        work.push_back(*pred);
                    }
                }
            }
        }
    }

    /// What a block makes of what is live behind it: of nothing, and of everything.
    fn transfer(&self, block: &Block, every: &Row) -> (Row, Row) {
        let through = |mut row: Row| {
            self.term(&block.term.kind, &mut row);
            block.stmts.iter().rev().for_each(|stmt| self.stmt(&stmt.kind, &stmt.site, &mut row));
            row
        };
        (through(self.universe.none()), through(every.clone()))
    }

    /// Live behind a block's terminator.
    fn after(&self, id: BlockId) -> Row {
        let mut row = match self.program.block(id).map(|block| &block.term.kind) {
            Some(TermKind::Return { .. }) if self.modal_body => self.universe.classes(|_| true),
            Some(TermKind::Return { .. }) if self.exit == Exit::Observable => {
                self.universe.classes(|class| class != Class::Temp)
            }
            Some(TermKind::End { .. } | TermKind::Stray | TermKind::Chain(_))
                if self.exit == Exit::Observable =>
            {
                self.universe.classes(Class::shared)
            }
            _ => self.universe.none(),
        };
        self.cfg.succs(id).iter().for_each(|to| {
            row.join(&self.before[to.index()]);
        });
        row
    }

    fn used_by_term(&self, kind: &TermKind) -> Option<Seen<'p>> {
        match kind {
            // The graph leads into a body in the same program.
            TermKind::Call { call, .. } if !matches!(call.callee, Callee::Block(_)) => {
                Some(self.summaries.reads(call))
            }
            TermKind::Chain(name) => Some((&self.summaries.of_program(name).reads).into()),
            _ => None,
        }
    }

    fn term(&self, kind: &TermKind, row: &mut Row) {
        self.used_by_term(kind).iter().for_each(|used| self.add(*used, row));
        kind.exprs(&mut |e| self.read(e, row));
    }

    fn stmt(&self, kind: &StmtKind, site: &Site, row: &mut Row) {
        // What the operator may switch off writes nothing for sure.
        if site.skip.is_none() {
            match kind {
                StmtKind::ClearAll(class) => row.subtract(&self.universe.classes(|c| c == *class)),
                kind => {
                    if let Some(Place::Var(var)) = kind.target()
                        && let Some(at) = self.universe.place(*var)
                    {
                        row.remove(at);
                    }
                }
            }
        }
        if let StmtKind::Nc(nc) = kind {
            self.add((&self.summaries.of_nc(nc).reads).into(), row);
        }
        kind.exprs(&mut |e| self.read(e, row));
    }

    fn read(&self, e: &Expr, row: &mut Row) {
        e.walk(&mut |part| match part {
            Expr::Var(var) => self.universe.place(*var).iter().for_each(|at| row.insert(*at)),
            Expr::Indirect(bank, _) => {
                row.join(&self.universe.classes(|class| Vars::bank(*bank).contains(&class)));
            }
            _ => {}
        });
    }

    fn add(&self, seen: Seen<'_>, row: &mut Row) {
        seen.vars().filter_map(|var| self.universe.place(var)).for_each(|at| row.insert(at));
        for whole in seen.classes() {
            row.join(&self.universe.classes(|class| class == whole));
        }
    }

    /// The variables live at the start of a block.
    pub fn before(&self, id: BlockId) -> impl Iterator<Item = Var> + '_ {
        self.before.get(id.index()).into_iter().flat_map(|row| self.universe.members(row))
    }

    /// True where a variable is live at the start of a block.
    pub fn is_live_before(&self, id: BlockId, var: Var) -> bool {
        let row = self.before.get(id.index());
        self.universe.place(var).is_some_and(|at| row.is_some_and(|row| row.has(at)))
    }

    /// Calls `f` on each statement of a block, last first, with what is live behind it.
    pub fn backward(&self, id: BlockId, f: &mut dyn FnMut(usize, super::Holds<'_, Var>)) {
        let Some(Block { stmts, term, .. }) = self.program.block(id) else { return };
        let mut row = self.after(id);
        self.term(&term.kind, &mut row);
        for (at, stmt) in stmts.iter().enumerate().rev() {
            f(at, &|var: &Var| self.universe.place(*var).is_some_and(|place| row.has(place)));
            self.stmt(&stmt.kind, &stmt.site, &mut row);
        }
    }
}

fn has_modal_body(program: &Program) -> bool {
    program.blocks.iter().flat_map(|block| &block.stmts).any(
        |stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if matches!(call.callee, Callee::Block(_))),
    )
}

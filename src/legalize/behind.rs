//! Which statements may come while something is in force that another statement began.
//!
//! Over-approximates: what a called program begins may be in force after the call, what is in force at a call may be in
//! force in all that is called, and only a statement of the same program ends it. So a program that is called again
//! finds what it began itself.

use super::calls_of;
use crate::ir::analysis::Cfg;
use crate::ir::{Block, BlockId, Call, Callee, Module, Program, Stmt, StmtKind, TermKind};
use crate::syntax::ProgramName;
use std::collections::BTreeMap;

/// Calls `found` with every statement, by program, that may come after one that `sets` and before one that `ends`.
pub fn behind(
    module: &Module,
    sets: impl Fn(&Stmt) -> bool,
    ends: impl Fn(&Stmt) -> bool,
    mut found: impl FnMut(usize, &Stmt),
) {
    let library = Library::of(module, &sets);
    if !library.any {
        return;
    }
    let step = |stmt: &Stmt, on: bool| {
        let modal = match &stmt.kind {
            StmtKind::ModalCall(call) => library.begins(call),
            _ => false,
        };
        sets(stmt) || modal || (on && !ends(stmt))
    };
    let entries = library.entries(module, &step);
    for (index, program) in module.programs.iter().enumerate() {
        let starts = library.starts(index, program, entries[index], &step);
        for (block, mut on) in program.blocks.iter().zip(starts) {
            for stmt in &block.stmts {
                if on {
                    found(index, stmt);
                }
                on = step(stmt, on);
            }
        }
    }
}

/// What the programs of a library begin, and which of them a call runs.
struct Library<'m> {
    /// True where some program begins it.
    any: bool,
    /// By program, whether it or what it calls begins it.
    within: Vec<bool>,
    /// Programs by name.
    named: BTreeMap<&'m ProgramName, Vec<usize>>,
}

impl<'m> Library<'m> {
    fn of(module: &'m Module, sets: &dyn Fn(&Stmt) -> bool) -> Self {
        let stmts = |program: &'m Program| program.blocks.iter().flat_map(|block| &block.stmts);
        let within: Vec<bool> = module.programs.iter().map(|program| stmts(program).any(sets)).collect();
        let mut named: BTreeMap<&ProgramName, Vec<usize>> = BTreeMap::new();
        for (index, program) in module.programs.iter().enumerate() {
            program.name.iter().for_each(|name| named.entry(name).or_default().push(index));
        }
        let any = within.contains(&true);
        let mut library = Self { any, within, named };
        if any {
            library.close(module);
        }
        library
    }

    /// Finds what programs begin through their calls.
    fn close(&mut self, module: &Module) {
        let mut callers: Vec<Vec<usize>> = vec![Vec::new(); module.programs.len()];
        let mut work: Vec<usize> = Vec::new();
        for (index, program) in module.programs.iter().enumerate() {
            for call in program.blocks.iter().flat_map(calls_of) {
                match self.callees(call) {
                    Callees::Own => {}
                    Callees::Any | Callees::Outside => self.within[index] = true,
                    Callees::These(callees) => callees.iter().for_each(|callee| callers[*callee].push(index)),
                }
            }
            for callee in program.blocks.iter().flat_map(|block| self.chained(block)) {
                callers[*callee].push(index);
            }
            work.extend(self.within[index].then_some(index));
        }
        while let Some(callee) = work.pop() {
            for caller in &callers[callee] {
                if !std::mem::replace(&mut self.within[*caller], true) {
                    work.push(*caller);
                }
            }
        }
    }

    /// The programs that a block goes on in for good.
    fn chained(&self, block: &Block) -> &[usize] {
        match &block.term.kind {
            TermKind::Chain(name) => self.named.get(name).map_or(&[], Vec::as_slice),
            _ => &[],
        }
    }

    fn callees(&self, call: &Call) -> Callees<'_> {
        match &call.callee {
            Callee::Block(_) => Callees::Own,
            // Any program may be meant.
            Callee::Computed(_) => Callees::Any,
            Callee::Cycle(_) => Callees::Outside,
            Callee::Program(name) => Callees::These(self.named.get(name).map_or(&[], Vec::as_slice)),
        }
    }

    /// True where something that a call runs may begin it. Of a subroutine of the same program its blocks tell.
    fn begins(&self, call: &Call) -> bool {
        match self.callees(call) {
            Callees::Own => false,
            Callees::Any | Callees::Outside => self.any,
            Callees::These(callees) => callees.iter().any(|callee| self.within[*callee]),
        }
    }

    /// By program, whether it may be in force where it is called.
    fn entries(&self, module: &Module, step: &dyn Fn(&Stmt, bool) -> bool) -> Vec<bool> {
        let mut entries = vec![false; module.programs.len()];
        // Each program comes twice at the most: as it is, and where it is entered so.
        let mut work: Vec<usize> = (0..module.programs.len()).collect();
        while let Some(index) = work.pop() {
            let Some(program) = module.programs.get(index) else { continue };
            let starts = self.starts(index, program, entries[index], step);
            let mut enter = |callee: usize| {
                if !std::mem::replace(&mut entries[callee], true) {
                    work.push(callee);
                }
            };
            for (block, start) in program.blocks.iter().zip(starts) {
                let on = block.stmts.iter().fold(start, |on, stmt| step(stmt, on));
                self.chained(block).iter().copied().filter(|_| on).for_each(&mut enter);
                for call in calls_of(block) {
                    let last =
                        matches!(&block.term.kind, TermKind::Call { call: last, .. } if **last == *call);
                    // A modal call runs at moves to come, and a repeat is entered from the one before it.
                    let again = !last || call.count.is_some() && self.begins(call);
                    if !(on || again && self.any) {
                        continue;
                    }
                    match self.callees(call) {
                        Callees::Own | Callees::Outside => {}
                        Callees::Any => (0..module.programs.len()).for_each(&mut enter),
                        Callees::These(callees) => callees.iter().copied().for_each(&mut enter),
                    }
                }
            }
        }
        entries
    }

    /// By block, whether it may be in force at its start; `before`: at the start of the program.
    fn starts(
        &self,
        index: usize,
        program: &Program,
        before: bool,
        step: &dyn Fn(&Stmt, bool) -> bool,
    ) -> Vec<bool> {
        let mut starts = vec![false; program.blocks.len()];
        let within = self.within[index];
        if !before && !within {
            return starts;
        }
        let cfg = Cfg::of(program);
        let called = |call: &Call| self.begins(call) || within && matches!(call.callee, Callee::Block(_));
        let end = |block: &Block, on: bool| {
            block.stmts.iter().fold(on, |on, stmt| step(stmt, on)) || calls_of(block).any(called)
        };
        // A subroutine is entered from wherever it is called.
        cfg.roots().iter().for_each(|root| starts[root.index()] = before || within && *root != BlockId(0));
        let mut changed = true;
        // Each round makes one more true, or is the last.
        while changed {
            changed = false;
            for (at, block) in program.blocks.iter().enumerate() {
                let end = end(block, starts[at]);
                for to in cfg.succs(BlockId(at as u32)) {
                    if let Some(start) = starts.get_mut(to.index()).filter(|start| end && !**start) {
                        *start = true;
                        changed = true;
                    }
                }
            }
        }
        starts
    }
}

/// What a call may run.
enum Callees<'a> {
    /// A subroutine of the program itself.
    Own,
    /// Any program.
    Any,
    /// What stands outside the library, which may begin anything.
    Outside,
    /// These programs.
    These(&'a [usize]),
}

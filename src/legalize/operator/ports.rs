//! Formatted output to a port that is not open.
//!
//! Law: where the source prints without it and the target does not, the port is opened before such output and
//! closed after it. A program that prints at several places, or in a loop, opens it at its head and closes it where it ends, so that all goes
//! into one file; where it is called, calls parts of its own, or runs with others that print, each run of output opens it. Side condition: nothing in the library opens the port; where something does, whether it is open
//! at another place is for a reviewer, and so is output of a source whose port must be open and is not. Whether it is open is told by the order of the text. Counter-example: a
//! subprogram that prints for a caller which has opened the port; closing it there would end the caller's output.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::{Cfg, calls_of};
use crate::ir::{Block, BlockId, Callee, Module, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::Context;
use crate::text::Span;
use std::collections::BTreeSet;

const NEEDS: Question = Question::OutputNeedsPort;

/// Opens the port where it must be open on the target only.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let needs = [context.source, context.target].map(|control| control.is(NEEDS));
    let opened =
        module.programs.iter().any(|program| statements(program).any(|s| s.kind == StmtKind::OpenPort));
    let alone = alone(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let Some(span) = shut(program) else { continue };
        context.rests_on_source(index, span, NEEDS);
        context.rests_on_target(index, span, NEEDS);
        match needs {
            [false, true] if opened => {
                let what = "the target prints only while the port is open: make sure that it is open here";
                context.add(index, Diagnostic::new(Code::Conditional, span, what));
            }
            [false, true] if alone == Some(index) && prints_again(program) => open_once(program, span),
            [false, true] => open(program),
            [true, false] => {
                let what = "the port is not open here as far as this program shows, and no source says what the old control does then: \
                            make sure that a caller opens it";
                context.add(index, Diagnostic::new(Code::Conditional, span, what));
            }
            [_, _] => {}
        }
    }
}

fn statements(program: &Program) -> impl Iterator<Item = &Stmt> {
    program.blocks.iter().flat_map(|block| &block.stmts)
}

/// The first output that stands where the program has not opened the port.
fn shut(program: &Program) -> Option<Span> {
    let mut open = false;
    for stmt in statements(program) {
        match stmt.kind {
            // A block that may be skipped opens nothing for certain.
            StmtKind::OpenPort => open |= stmt.site.skip.is_none(),
            StmtKind::ClosePort => open = false,
            StmtKind::Output(_) if !open => return Some(stmt.site.span),
            _ => {}
        }
    }
    None
}

/// The one program that prints, if it is one that nothing calls.
fn alone(module: &Module) -> Option<usize> {
    let prints = |program: &Program| statements(program).any(|stmt| matches!(stmt.kind, StmtKind::Output(_)));
    let mut printing = module.programs.iter().enumerate().filter(|(_, program)| prints(program));
    let (index, program) = printing.next().filter(|_| printing.next().is_none())?;
    let calls = |other: &Program, to: &dyn Fn(&Callee) -> bool| {
        other.blocks.iter().flat_map(calls_of).any(|call| to(&call.callee))
    };
    let called = module.programs.iter().any(|other| {
        calls(other, &|callee| match callee {
            Callee::Program(name) => Some(name) == program.name.as_ref(),
            Callee::Computed(_) => true,
            _ => false,
        })
    });
    let parts = calls(program, &|callee| matches!(callee, Callee::Block(_)));
    let rewound = !Cfg::of(program).preds(BlockId(0)).is_empty();
    (!called && !parts && !rewound).then_some(index)
}

/// True for a program that prints in more than one block, or in one that it may come to again.
fn prints_again(program: &Program) -> bool {
    let prints = |block: &Block| block.stmts.iter().any(|stmt| matches!(stmt.kind, StmtKind::Output(_)));
    let mut printing = program.ids().zip(&program.blocks).filter(|(_, block)| prints(block));
    let Some((id, block)) = printing.next() else { return false };
    let runs = block.stmts.split(|stmt| !matches!(stmt.kind, StmtKind::Output(_) | StmtKind::Comment));
    let several =
        runs.filter(|run| run.iter().any(|stmt| matches!(stmt.kind, StmtKind::Output(_)))).count() > 1;
    several || printing.next().is_some() || comes_back(program, id)
}

/// True if control may come to a block again after it.
fn comes_back(program: &Program, id: BlockId) -> bool {
    let mut seen = BTreeSet::new();
    let mut open = vec![id];
    while let Some(block) = open.pop().and_then(|at| program.blocks.get(at.index())) {
        for next in block.term.kind.successors() {
            if next == id {
                return true;
            }
            if seen.insert(next) {
                open.push(next);
            }
        }
    }
    false
}

/// Opens the port at the head of a program, and closes it where the program ends.
fn open_once(program: &mut Program, span: Span) {
    let port = |kind, span| Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } };
    if let Some(block) = program.blocks.first_mut() {
        let at = block.stmts.iter().position(|stmt| stmt.kind != StmtKind::Comment);
        block.stmts.insert(at.unwrap_or(block.stmts.len()), port(StmtKind::OpenPort, span));
    }
    for block in &mut program.blocks {
        if matches!(block.term.kind, TermKind::End { .. } | TermKind::Return { .. }) {
            block.stmts.push(port(StmtKind::ClosePort, block.term.site.span));
        }
    }
}

/// Opens the port before each run of output, and closes it after.
fn open(program: &mut Program) {
    for block in &mut program.blocks {
        let mut out = Stmts::with_capacity(block.stmts.len());
        let port = |kind, span| Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } };
        let mut open = None;
        for stmt in std::mem::take(&mut block.stmts) {
            match stmt.kind {
                StmtKind::Output(_) if open.is_none() => {
                    open = Some(stmt.site.span);
                    out.push(port(StmtKind::OpenPort, stmt.site.span));
                }
                // Comments do not end a run.
                StmtKind::Output(_) | StmtKind::Comment => {}
                _ => out.extend(open.take().map(|span| port(StmtKind::ClosePort, span))),
            }
            out.push(stmt);
        }
        out.extend(open.map(|span| port(StmtKind::ClosePort, span)));
        block.stmts = out;
    }
}

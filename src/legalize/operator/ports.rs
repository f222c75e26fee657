//! Formatted output to a port that is not open.
//!
//! Law: where the source prints without it and the target does not, the port is opened before such output and
//! closed after it. Side condition: nothing in the library opens the port; where something does, whether it is open
//! at another place is for a reviewer, and so is output of a source whose port must be open and is not. Whether it is open is told by the order of the text. Counter-example: a
//! subprogram that prints for a caller which has opened the port; closing it there would end the caller's output.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Module, Program, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::text::Span;

const NEEDS: Question = Question::OutputNeedsPort;

/// Opens the port where it must be open on the target only.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let needs = [context.source, context.target].map(|control| control.is(NEEDS));
    let opened =
        module.programs.iter().any(|program| statements(program).any(|s| s.kind == StmtKind::OpenPort));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let Some(span) = shut(program) else { continue };
        context.rests_on_source(index, span, NEEDS);
        context.rests_on_target(index, span, NEEDS);
        match needs {
            [false, true] if opened => {
                let what = "the target prints only while the port is open: make sure that it is open here";
                context.add(index, Diagnostic::new(Code::Conditional, span, what));
            }
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

//! Drafts: refused programs with an alarm at every hole, so that they cannot be run past one.

use crate::diag::{Diagnostic, Severity};
use crate::ir::{Module, Program, SourceInfo, Stmt, StmtKind, TermKind};
use crate::text::Span;

/// Adds the places of errors to the holes of their programs; true where any is new.
pub fn holes(found: &[Vec<Diagnostic>], holes: &mut [Vec<(Span, &'static str)>]) -> bool {
    let mut new = false;
    for (all, holes) in found.iter().zip(holes) {
        for error in all.iter().filter(|d| d.severity() == Severity::Error) {
            let hole = (error.span, error.code.number());
            if !holes.iter().any(|(span, _)| *span == hole.0) {
                holes.push(hole);
                new = true;
            }
        }
    }
    new
}

/// Puts an alarm in the place of everything that overlaps a hole.
pub fn fill(module: &mut Module, holes: &[Vec<(Span, &'static str)>]) {
    for (program, holes) in module.programs.iter_mut().zip(holes) {
        holes.iter().for_each(|(span, code)| fill_one(program, *span, code));
    }
}

fn fill_one(program: &mut Program, hole: Span, code: &str) {
    let touches =
        |span: Span| !span.is_empty() && span.start < hole.end.max(hole.start + 1) && hole.start < span.end;
    let alarm = |span: Span| Stmt {
        kind: StmtKind::not_converted(code),
        site: SourceInfo { span, ..SourceInfo::default() },
    };
    let mut filled = false;
    for block in &mut program.blocks {
        // One alarm stops the machine before all of the hole that stands together.
        let mut stopped = false;
        block.stmts.retain_mut(|stmt| {
            if !touches(stmt.site.span) {
                stopped = false;
                return true;
            }
            filled = true;
            if std::mem::replace(&mut stopped, true) && stmt.site.comments.is_empty() {
                return false;
            }
            let site = std::mem::take(&mut stmt.site);
            *stmt = Stmt { site, ..alarm(hole) };
            true
        });
        if touches(block.term.site.span) {
            let site = std::mem::take(&mut block.term.site);
            if !stopped || !site.comments.is_empty() {
                block.stmts.push(Stmt { site, ..alarm(hole) });
            }
            block.term.kind = match &block.term.kind {
                TermKind::Call { next, .. } => TermKind::Jump(*next),
                TermKind::Jump(to) => TermKind::Jump(*to),
                _ => TermKind::End { rewind: true },
            };
            filled = true;
        }
    }
    if !filled {
        // What lowering could not keep stood before the first statement that comes after it.
        let behind = |span: Span| !span.is_empty() && span.start >= hole.end;
        for block in &mut program.blocks {
            let at = block.stmts.iter().position(|stmt| behind(stmt.site.span));
            if let Some(at) = at.or_else(|| behind(block.term.site.span).then_some(block.stmts.len())) {
                block.stmts.insert(at, alarm(hole));
                return;
            }
        }
        if let Some(block) = program.blocks.first_mut() {
            block.stmts.insert(0, alarm(hole));
        }
    }
}

/// What was found without the holes stays told: the errors that made them, and every condition of what a hole changed or
/// took away. What legalization finds in a draft alone comes of the holes: that a program names no unit, whose call that
/// names it became an alarm.
pub fn keep_findings(before: &[Vec<Diagnostic>], after: &mut [Vec<Diagnostic>]) {
    for (before, after) in before.iter().zip(after) {
        let legalizes = |d: &Diagnostic| d.code.number().starts_with("MG04");
        let is_new = |d: &Diagnostic| !before.contains(d);
        after.retain(|d| is_new(d) && (d.severity() == Severity::Error || !legalizes(d)));
        after.extend_from_slice(before);
    }
}

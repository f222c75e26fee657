//! Output that the target's profile says to leave out.
//!
//! Law: where nobody reads what a machine sends, a program without its output does the same to the part. That nobody
//! does is what the shop says by `outputs = "omit"` in the profile of a machine that has no output; each program that
//! sent something tells it to a reviewer. What stands right before a question to the operator is that question, and
//! stays. Counter-example: a measuring program whose output another computer waits for.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Outputs;
use crate::ir::{Block, Module, PrintPart, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};

/// True if the library sends something, and the target's profile says to leave it out.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let sends = features.has(Feature::Output) || features.has(Feature::Print);
    sends && context.target.profile().outputs == Some(Outputs::Omit)
}

/// Leaves output out.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let has = |name: &str| context.target.statement(name).is_some();
    let (prints, outputs) = (has("print"), has("output.formatted"));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut first = None;
        for block in &mut program.blocks {
            let asked = questions(block);
            for (at, stmt) in block.stmts.iter_mut().enumerate() {
                let goes = match &stmt.kind {
                    StmtKind::Output(_) | StmtKind::OpenPort | StmtKind::ClosePort => !outputs,
                    StmtKind::Print { .. } => !prints && !outputs && !asked.contains(&at),
                    _ => false,
                };
                if goes {
                    stmt.kind = StmtKind::Comment;
                    first = first.or(Some(stmt.site.span));
                }
            }
        }
        if let Some(span) = first {
            let what = "output is left out, as the target's profile says (outputs = \"omit\"): make sure that nobody waits \
                        for what the programs send";
            context.add(index, Diagnostic::new(Code::Conditional, span, what).asked_once());
        }
    }
}

/// The prints that are the text of the question after them.
fn questions(block: &Block) -> Vec<usize> {
    let mut found = Vec::new();
    let acts: Vec<(usize, &Stmt)> =
        block.stmts.iter().enumerate().filter(|(_, stmt)| stmt.kind != StmtKind::Comment).collect();
    for pair in acts.windows(2) {
        let [(at, print), (_, next)] = pair else { continue };
        let texts = |parts: &[PrintPart]| parts.iter().all(|part| matches!(part, PrintPart::Text(_)));
        if let (StmtKind::Print { parts, .. }, StmtKind::Input { .. }) = (&print.kind, &next.kind)
            && texts(parts)
        {
            found.push(*at);
        }
    }
    found
}

//! Messages longer than the target shows.
//!
//! Law: the message is cut where the target's display ends, and the whole of it stands in a comment beside; when
//! and why the machine stops does not change.

use crate::diag::{Code, Diagnostic};
use crate::ir::{Comment, Module, StmtKind};
use crate::legalize::Context;

/// Cuts messages to the target's length.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let limit = |name| context.target.limit(name).map_or(usize::MAX, |n| n as usize);
    let (alarm, stop) = (limit("message.alarm"), limit("message"));
    for (index, program) in module.programs.iter_mut().enumerate() {
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let (most, text) = match &mut stmt.kind {
                StmtKind::Alarm { text, .. } => (alarm, text),
                StmtKind::StopMessage { text, .. } => (stop, text),
                _ => continue,
            };
            if text.chars().count() <= most {
                continue;
            }
            let whole = std::mem::take(text).into_string();
            *text = whole.chars().take(most).collect::<String>().trim_end().into();
            let what = format!(
                "the target shows {most} characters of a message: '{text}'; a comment has the whole text"
            );
            stmt.site.comments.push(Comment { text: whole, leading: false });
            context.add(index, Diagnostic::new(Code::MessageCut, stmt.site.span, what));
        }
    }
}

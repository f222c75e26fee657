//! Messages longer than the target shows.
//!
//! Law: the message is cut where the target's display ends, and the whole of it stands in a comment beside; when
//! and why the machine stops does not change. The variable that an operator is asked for goes first where it would be cut
//! off.

use crate::diag::{Code, Diagnostic};
use crate::ir::{Comment, Module, StmtKind};
use crate::legalize::Context;
use crate::text::variable_to_set;

/// Cuts messages to the target's length.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let limit = |name| context.target.limit(name).map_or(usize::MAX, |n| n as usize);
    let (alarm, stop) = (limit("message.alarm"), limit("message"));
    let prefixes = context.target.prefixes();
    for (index, program) in module.programs.iter_mut().enumerate() {
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let (most, text, asks) = match &mut stmt.kind {
                StmtKind::Alarm { text, .. } => (alarm, text, false),
                StmtKind::StopMessage { text, .. } => (stop, text, true),
                _ => continue,
            };
            if text.chars().count() <= most {
                continue;
            }
            let whole = std::mem::take(text).into_string();
            let asked = variable_to_set(&whole, &prefixes).filter(|_| asks);
            let lost = asked.filter(|name| whole[..name.at.end].chars().count() > most);
            let shown = lost.map(|name| format!("{} {whole}", &whole[name.at]));
            *text = shown.as_ref().unwrap_or(&whole).chars().take(most).collect::<String>().trim_end().into();
            let what = format!(
                "the target shows {most} characters of a message: '{text}'; a comment has the whole text"
            );
            stmt.site.comments.push(Comment { text: whole, leading: false });
            context.add(index, Diagnostic::new(Code::MessageCut, stmt.site.span, what));
        }
    }
}

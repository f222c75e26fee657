//! Messages longer than the target shows.
//!
//! Law: the message is cut where the target's display ends, and the whole of it stands in a comment beside. A number that does not
//! fit is left out whole: 90 must not become 9. Where both machines have one control, and show as much, the text stays: the old one cuts
//! it off at the same place. When and why the machine stops does not change. The variable that an operator is asked for goes first where it would be cut
//! off.

use crate::diag::{Code, Diagnostic};
use crate::ir::{Comment, Module, StmtKind};
use crate::legalize::Context;
use crate::text::variable_to_set;

/// Cuts messages to the target's length.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let limit = |name| context.target.limit(name).map_or(usize::MAX, |n| n as usize);
    let (alarm, stop) = (limit("message.alarm"), limit("message"));
    let one_control = context.source.name() == context.target.name();
    let alike = |name| one_control && context.source.limit(name) == context.target.limit(name);
    let alike = ["message.alarm", "message"].map(alike);
    let prefixes = context.target.prefixes();
    for (index, program) in module.programs.iter_mut().enumerate() {
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let (most, text, asks) = match &mut stmt.kind {
                StmtKind::Alarm { text, .. } => (alarm, text, false),
                StmtKind::StopMessage { text, .. } => (stop, text, true),
                _ => continue,
            };
            if text.chars().count() <= most || alike[usize::from(asks)] {
                continue;
            }
            let whole = std::mem::take(text).into_string();
            let asked = variable_to_set(&whole, &prefixes).filter(|_| asks);
            let lost = asked.filter(|name| whole[..name.at.end].chars().count() > most);
            let shown = lost.map(|name| format!("{} {whole}", &whole[name.at]));
            *text = cut(shown.as_ref().unwrap_or(&whole), most).into();
            let what = format!(
                "the target shows {most} characters of a message: '{text}'; a comment has the whole text"
            );
            stmt.site.comments.push(Comment { text: whole, leading: false });
            context.add(index, Diagnostic::new(Code::MessageCut, stmt.site.span, what));
        }
    }
}

/// The beginning of a text, of so many signs at the most, that ends with no part of a number.
fn cut(text: &str, most: usize) -> &str {
    let end = text.char_indices().nth(most).map_or(text.len(), |(at, _)| at);
    let (shown, rest) = text.split_at(end);
    let of_number = |sign: char| sign.is_ascii_digit() || sign == '.';
    let kept = if rest.starts_with(of_number) { shown.trim_end_matches(of_number) } else { shown };
    // The sign of the number goes with it, and a text that is a number alone stays as it is.
    let kept = if kept.len() < shown.len() { kept.trim_end_matches(['-', '+']) } else { kept };
    let kept = kept.trim_end();
    if kept.is_empty() { shown.trim_end() } else { kept }
}

#[cfg(test)]
mod tests {
    use super::cut;

    #[test]
    fn no_number_loses_its_end() {
        assert_eq!(cut("H MUST DIVIDE INTO 90", 20), "H MUST DIVIDE INTO");
        assert_eq!(cut("H MUST DIVIDE INTO 90", 21), "H MUST DIVIDE INTO 90");
        assert_eq!(cut("GO TO Z-12.5 NOW", 9), "GO TO Z");
        assert_eq!(cut("GO TO Z-12.5 NOW", 12), "GO TO Z-12.5");
        assert_eq!(cut("CHECK THE VISE", 11), "CHECK THE V");
        assert_eq!(cut("123456", 4), "1234");
    }
}

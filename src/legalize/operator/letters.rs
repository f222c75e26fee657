//! Letters of messages, outputs and comments that the target is not known to show.
//!
//! Signs that the target's messages cannot have go: between two letters they leave nothing, elsewhere a blank.
//!
//! Law: a letter outside ASCII becomes what looks like it, small letters become capitals where the target may lack them,
//! and brackets inside a message become square ones: the operator reads the same. Side condition: something looks like
//! it; else `?` stands in its place, which in a message is for review.
//! Counter-example: `#3006=1 (TÜR AUF)`, of which a control may show `T R AUF`, or nothing.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Comment, Module, OutputPart, PrintPart, StmtKind};
use crate::legalize::Context;
use crate::text::{Span, likeness};

/// Replaces letters in everything that a person reads.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let letters = context.target.behaviour(Question::TextLetters).map_or("unknown", |row| row.value.as_str());
    let (comment, shown) =
        (Place::Comment { small: letters != "upper" }, Place::Shown { small: letters == "ascii" });
    let output = Place::Output { small: letters != "upper" };
    for (index, program) in module.programs.iter_mut().enumerate() {
        let lacks = context.target.text().message_lacks.clone();
        let mut writer = Writer { context, index, span: program.site.span, lacks };
        writer.comments(&mut program.site.comments, comment);
        for block in &mut program.blocks {
            for stmt in &mut block.stmts {
                writer.span = stmt.site.span;
                let stops =
                    matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::Stop) || nc.has(Op::OptionalStop));
                let here = if stops { Place::Beside } else { comment };
                writer.comments(&mut stmt.site.comments, here);
                match &mut stmt.kind {
                    StmtKind::Alarm { text, .. } | StmtKind::StopMessage { text, .. } => {
                        if let Some(new) = writer.written(text, shown) {
                            *text = new.into();
                        }
                    }
                    StmtKind::Output(parts) => parts.iter_mut().for_each(|part| {
                        if let OutputPart::Text(text) = part {
                            writer.take(text, output);
                        }
                    }),
                    StmtKind::Print { parts, .. } => parts.iter_mut().for_each(|part| {
                        if let PrintPart::Text(text) = part {
                            writer.take(text, Place::Printed);
                        }
                    }),
                    _ => {}
                }
            }
            writer.span = block.term.site.span;
            writer.comments(&mut block.term.site.comments, comment);
        }
    }
}

/// Where a text stands; `small` where it may have small letters.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// A comment.
    Comment { small: bool },
    /// A message of its own statement, between brackets.
    Shown { small: bool },
    /// The comment beside a stop, which the operator reads.
    Beside,
    /// A line of formatted output. What nothing looks like is left to the emitter, which refuses it.
    Output { small: bool },
    /// A print, of which a question or a line of output is made.
    Printed,
}

impl Place {
    /// True for what is shown by a statement of its own.
    fn is_message(self) -> bool {
        matches!(self, Self::Shown { .. } | Self::Printed)
    }
}

/// A text without these signs: between two letters they leave nothing, elsewhere a blank.
fn without(text: &str, lacks: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let (mut before, mut all) = (' ', text.chars().peekable());
    while let Some(c) = all.next() {
        let inside = before.is_alphabetic() && all.peek().is_some_and(|next| next.is_alphabetic());
        match lacks.contains(c) {
            true if inside => {}
            true => out.push(' '),
            false => out.push(c),
        }
        before = c;
    }
    out
}

struct Writer<'w, 'c> {
    context: &'w mut Context<'c>,
    index: usize,
    span: Span,
    /// Signs that the target's messages cannot have.
    lacks: String,
}

impl Writer<'_, '_> {
    fn comments(&mut self, comments: &mut [Comment], place: Place) {
        comments.iter_mut().for_each(|comment| self.take(&mut comment.text, place));
    }

    /// Writes a text as the target can show it.
    fn take(&mut self, text: &mut String, place: Place) {
        if let Some(new) = self.written(text, place) {
            *text = new;
        }
    }

    /// The text as the target can show it, told where letters were replaced; none where it stays as it is.
    fn written(&mut self, text: &str, place: Place) -> Option<String> {
        let lacks = if place.is_message() { self.lacks.as_str() } else { "" };
        let written = Written::of(&without(text, lacks), place);
        let written =
            Written { replaced: written.replaced || text.contains(|c| lacks.contains(c)), ..written };
        if written.text == *text {
            return None;
        }
        let (before, after) = (text.trim(), written.text.trim());
        if written.lost && !matches!(place, Place::Comment { .. }) {
            let what =
                format!("the message '{before}' becomes '{after}': some of its letters have no substitute");
            self.context.add(self.index, Diagnostic::new(Code::MessageAltered, self.span, what));
        } else if written.replaced {
            let what =
                format!("'{before}' becomes '{after}': the target is not known to show all its letters");
            let finding = Diagnostic::new(Code::LettersReplaced, self.span, what);
            self.context.add_once(self.index, "letters", finding);
        }
        Some(written.text)
    }
}

/// A text in letters that the target shows.
struct Written {
    text: String,
    /// True where a letter or sign became another one, small letters of what a person reads aside.
    replaced: bool,
    /// True where nothing stands for one.
    lost: bool,
}

impl Written {
    fn of(source: &str, place: Place) -> Self {
        let mut out = Written { text: String::with_capacity(source.len()), replaced: false, lost: false };
        let shown = matches!(place, Place::Shown { .. });
        let mut all = source.chars().peekable();
        while let Some(c) = all.next() {
            let sign = match c {
                '(' if shown => "[",
                ')' if shown => "]",
                '%' if shown => "PCT",
                ';' if shown => ",",
                // The sign of a diameter, which drawings have for the letter.
                'Ø' | 'ø' if all.peek() == Some(&' ') => "DIA",
                'Ø' | 'ø' if all.peek().is_some_and(|c| c.is_ascii_digit() || matches!(c, '.' | '#')) => {
                    "DIA "
                }
                c if c.is_ascii() || c.is_control() => {
                    out.text.push(if c.is_control() { ' ' } else { c });
                    continue;
                }
                c => match likeness(c) {
                    Some(sign) => sign,
                    None if matches!(place, Place::Output { .. }) => {
                        out.text.push(c);
                        continue;
                    }
                    None => {
                        out.lost = true;
                        "?"
                    }
                },
            };
            out.replaced = true;
            out.text.push_str(sign);
        }
        let small = match place {
            Place::Comment { small } | Place::Shown { small } | Place::Output { small } => small,
            Place::Beside | Place::Printed => false,
        };
        if !small {
            // Who receives a line of output may tell the cases apart.
            out.replaced |=
                matches!(place, Place::Output { .. }) && out.text.bytes().any(|b| b.is_ascii_lowercase());
            out.text.make_ascii_uppercase();
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_has_its_letters() {
        let of = |text, place| {
            let Written { text, replaced, lost } = Written::of(text, place);
            (text, replaced, lost)
        };
        let shown = Place::Shown { small: false };
        assert_eq!(of("Tür (auf) 50%", shown), ("TUER [AUF] 50PCT".into(), true, false));
        assert_eq!(of("open", shown), ("OPEN".into(), false, false));
        assert_eq!(of("open", Place::Shown { small: true }), ("open".into(), false, false));
        assert_eq!(of("日", shown), ("?".into(), true, true));
        assert_eq!(of("Ø10 BØR", shown), ("DIA 10 BOR".into(), true, false));
        let comment = Place::Comment { small: true };
        assert_eq!(of("façade (A) %", comment), ("facade (A) %".into(), true, false));
        let output = Place::Output { small: false };
        assert_eq!(of("Ü日a", output), ("UE日A".into(), true, false));
        assert_eq!(of("a", output), ("A".into(), true, false));
        assert_eq!(without("SAY \"HI\", DON'T", "\"'"), "SAY  HI , DONT");
        assert_eq!(without("SAY \"HI\"", ""), "SAY \"HI\"");
        // U with a dots' sign of its own after it.
        assert_eq!(of("TU\u{308}R", shown), ("TUR".into(), true, false));
    }
}

//! The rows of a profile in which is said what becomes of the codes of the machine's builder.

use super::filled::{ASKS, TELLS, plain};
use super::{AskedCode, Survey};
use crate::canon::Op;
use std::fmt::Write as _;

/// Puts a row to fill in for each code. With a target one answer is enough: its code, in the source's profile alone.
pub(super) fn rows(text: &mut String, survey: &Survey<'_>) {
    if survey.codes.is_empty() {
        return;
    }
    let told: &[&str] = match survey.goes {
        true => &[
            "What the machine's builder made of these codes: docs/builders-codes.md. Write the code that does the same on",
            "the target: target = \"M88\". Nothing of it has to stand in the target's profile. Where it has none, write do =",
            "\"omit\", \"stop\" or \"alarm\" in its place; do = \"same\" only where the target's own builder gave that very",
            "code the same meaning. For several machines give it a name instead, and their codes the same one.",
        ],
        false => &[
            "What the machine's builder made of these codes: docs/builders-codes.md. Give each a name (and the",
            "target's code the same one), or target = \"M88\", or do = \"omit\", \"stop\" or \"alarm\"; do = \"same\" only where",
            "the target's own builder gave that very code the same meaning.",
        ],
    };
    told.iter().for_each(|line| _ = writeln!(text, "{TELLS} {line}"));
    survey.codes.iter().for_each(|code| row(text, code, survey.goes));
}

fn row(text: &mut String, code: &AskedCode, goes: bool) {
    let programs = if code.programs == 1 { String::new() } else { format!("{} programs: ", code.programs) };
    let _ = writeln!(text, "{ASKS} [[site]] # {programs}{}", plain(&code.places.join(", ")));
    let _ = writeln!(text, "{ASKS} code = \"{}\"", code.code);
    let said = code.comment.as_ref().map_or(String::new(), |(comment, _)| comment.clone());
    let said: String =
        said.chars().filter(|letter| !letter.is_control() && !"\"\\".contains(*letter)).collect();
    // What lets an axis go after a hole stands in no block: the control gives it by itself.
    let how = if code.block.contains(&code.code) { "as in" } else { "goes with" };
    let _ = writeln!(text, "{ASKS} text = \"{said}\" # {how}: {}", plain(&code.block));
    let _ = match (code.op, goes) {
        (Some(op @ Op::Probe), _) => writeln!(
            text,
            "{ASKS} op = \"{op}\" # where the probe of this signal ends the moves of the target's code too; else do = \"alarm\" in its place"
        ),
        (Some(op), _) => writeln!(
            text,
            "{ASKS} op = \"{op}\" # where P says the spindle that the target's code turns too; else name = \"\" in its place"
        ),
        (None, true) => {
            writeln!(
                text,
                "{ASKS} target = \"\" # or in its place: do = \"omit\", \"stop\", \"alarm\" or \"same\""
            )
        }
        (None, false) => writeln!(text, "{ASKS} name = \"\""),
    };
    if !code.words.is_empty() {
        let words = code.words.iter().map(|letter| format!("{letter} = \"{letter}\"")).collect::<Vec<_>>();
        let each = match goes {
            true => "each with the letter that its value has there; beside a name with a name",
            false => "each with a name, or beside target with that code's letter",
        };
        let _ = writeln!(text, "{ASKS} words = {{ {} }} # its words: {each}", words.join(", "));
    }
}

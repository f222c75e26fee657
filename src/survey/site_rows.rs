//! The lines of a profile in which is said what becomes of the codes of the machine's builder.

use super::filled::{ASKS, TELLS, plain};
use super::{AskedCode, Survey};
use crate::canon::Op;
use std::fmt::Write as _;

/// The section of a profile with a line for each code.
pub(super) const SECTION: &str = "codes";

/// A line to fill in for each code. With a target one answer is enough: its code, in the source's profile alone.
pub(super) fn lines(survey: &Survey<'_>) -> String {
    let mut text = String::new();
    if survey.codes.is_empty() {
        return text;
    }
    let told: &[&str] = match survey.goes {
        true => &[
            "What the machine's builder made of these codes: docs/builders-codes.md. Write the code that does the same on",
            "the target: target = \"M88\". Nothing of it has to stand in the target's profile. Where it has none, write do =",
            "\"omit\", \"stop\" or \"alarm\" in its place; do = \"same\" only where the target's own builder gave that very",
            "code the same meaning. For several machines give it a name instead, and their codes the same one.",
            "A text says what it does; a stop or an alarm needs it as its message.",
        ],
        false => &[
            "What the machine's builder made of these codes: docs/builders-codes.md. Give each a name (and the",
            "target's code the same one), or target = \"M88\", or do = \"omit\", \"stop\" or \"alarm\"; do = \"same\" only where",
            "the target's own builder gave that very code the same meaning.",
            "A text says what it does; a stop or an alarm needs it as its message.",
        ],
    };
    told.iter().for_each(|line| _ = writeln!(text, "{TELLS} {line}"));
    survey.codes.iter().for_each(|code| line(&mut text, code, survey.goes));
    text
}

fn line(text: &mut String, code: &AskedCode, goes: bool) {
    let (called, may_call) = super::callers::answer(&code.calls, &code.code);
    let answer = match (code.op, goes) {
        _ if let Some(answer) = &called => answer.clone(),
        (Some(op), _) => format!("op = \"{op}\""),
        (None, true) => "target = \"\"".to_owned(),
        (None, false) => "name = \"\"".to_owned(),
    };
    let said = code.comment.as_ref().and_then(|(comment, _)| said(comment));
    let letters = code.words.iter().filter(|_| called.is_none());
    let words: Vec<String> = letters.map(|letter| format!("{letter} = \"{letter}\"")).collect();
    let keys = [Some(answer), said, in_braces(&words)].into_iter().flatten().collect::<Vec<_>>().join(", ");
    let programs = if code.programs == 1 { String::new() } else { format!("{} programs: ", code.programs) };
    // What lets an axis go after a hole stands in no block: the control gives it by itself.
    let how = if code.block.contains(&code.code) { "as in" } else { "goes with" };
    let mut about = format!("{programs}{}; {how}: {}", code.places.join(", "), code.block);
    about.push_str(match code.op {
        Some(Op::Probe) if code.code.contains(" R") => {
            "; where R says how the move stops, and the target may stop it its own way; else do = \"alarm\" in place of op"
        }
        Some(Op::Probe) => {
            "; where the probe of this signal ends the moves of the target's code too; else do = \"alarm\" in place of op"
        }
        Some(_) => "; where P says the spindle that the target's code turns too; else name = \"\" in place of op",
        None => "",
    });
    about.push_str(&may_call);
    about.push_str(match (words.is_empty(), goes) {
        (true, _) => "",
        (false, true) => {
            "; its words each with the letter that its value has there, beside a name with a name"
        }
        (false, false) => "; its words each with a name, beside target with that code's letter",
    });
    let _ = writeln!(text, "{ASKS} {} = {{ {keys} }} # {}", key(&code.code), plain(&about));
}

/// A code as the key of its line: `M14`, or `"M3 P11"`.
pub(super) fn key(code: &str) -> String {
    match !code.is_empty() && code.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
        true => code.to_owned(),
        false => format!("\"{code}\""),
    }
}

/// What a code does, as a key of its line; none if nothing is known.
pub(super) fn said(text: &str) -> Option<String> {
    let text: String =
        text.chars().filter(|letter| !letter.is_control() && !"\"\\".contains(*letter)).collect();
    (!text.trim().is_empty()).then(|| format!("text = \"{}\"", text.trim()))
}

/// The words of a code, as a key of its line; none if it has none.
pub(super) fn in_braces(words: &[String]) -> Option<String> {
    (!words.is_empty()).then(|| format!("words = {{ {} }}", words.join(", ")))
}

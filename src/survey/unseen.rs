//! Facts that no page of a machine shows: each is told in a line of its own, and one line takes them all as told.

use super::filled::{ASKS, TELLS};
use std::fmt::Write;

/// The list of a profile that they are put into.
pub(super) const SECTION: &str = "confirm";

/// What is said before them.
const HEAD: &str = "No page of the machine shows these. Take out of the line after them what you know to be otherwise, and its sign if the \
                    programs may rest on the rest.";

/// Lines of single facts, `#? "code:M60", # text (places)`, as one question with a line that tells of each.
pub(super) fn together(lines: &str) -> String {
    let mut out = format!("{TELLS} {HEAD}\n");
    let mut names = Vec::new();
    for (name, text) in lines.lines().filter_map(parted) {
        let _ = writeln!(out, "{TELLS} \"{name}\": {text}");
        names.push(format!("\"{name}\","));
    }
    let _ = writeln!(out, "{ASKS} {}", names.join(" "));
    out
}

/// The name of a single fact, and what is said of it.
fn parted(line: &str) -> Option<(&str, &str)> {
    line.trim().strip_prefix(ASKS)?.trim_start().strip_prefix('"')?.split_once("\", # ")
}

/// A line that tells of a fact, as a single fact again; none if the line is another.
pub(super) fn single(line: &str) -> Option<String> {
    let (name, text) = line.trim().strip_prefix(TELLS)?.trim_start().strip_prefix('"')?.split_once("\": ")?;
    Some(format!("{ASKS} \"{name}\", # {text}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_are_one_question_and_single_again() {
        let lines = r##"#? "code:M60", # a brake (A.NC:1)
#? "code:M61", # another: "off" (B.NC:2)
"##;
        let text = together(lines);
        assert_eq!(text.lines().last(), Some(r##"#? "code:M60", "code:M61","##));
        assert_eq!(text.lines().filter(|line| line.starts_with(ASKS)).count(), 1);
        let back: String = text.lines().filter_map(single).map(|line| line + "\n").collect();
        assert_eq!(back, lines);
    }
}

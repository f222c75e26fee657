//! Comments and messages: what characters the target can hold.

use crate::text::likeness;

/// Adds `( )` and a comment's text between them.
pub(in crate::emit) fn write_comment(out: &mut Vec<u8>, text: &str) {
    write_spelled(out, &spelled(text));
}

/// Adds `( )` and between them a text that is spelled as the target spells it.
pub(in crate::emit) fn write_spelled(out: &mut Vec<u8>, spelled: &str) {
    out.push(b'(');
    out.extend_from_slice(spelled.as_bytes());
    out.push(b')');
}

/// A comment's text in the characters of the target.
///
/// A comment ends at its first closing bracket and may hold nothing that ends a block or
/// a tape: those characters become others that look alike, so that every comment stays
/// one. Letters outside ASCII lose their accents; what has no like becomes `?`.
pub(in crate::emit) fn spelled(text: &str) -> String {
    let text = unfenced(text);
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '(' => out.push('['),
            ')' => out.push(']'),
            '%' => out.push_str("PCT"),
            ';' => out.push(','),
            ' '..='~' => out.push(c),
            c if c.is_control() => out.push(' '),
            c => out.push_str(likeness(c).unwrap_or("?")),
        }
    }
    out
}

/// The text without a bracket at its end that people closed a comment with on a control whose
/// comments go to the end of the line.
fn unfenced(text: &str) -> &str {
    let text = text.trim_end();
    let count = |bracket| text.matches(bracket).count();
    match text.strip_suffix(')') {
        Some(rest) if count(')') > count('(') => rest.trim_end(),
        _ => text,
    }
}

/// True where a message comes out as it is written.
pub(in crate::emit) fn is_writable(text: &str) -> bool {
    text.chars().all(|c| matches!(c, ' '..='~') && !matches!(c, '(' | ')' | '%' | ';'))
}

/// Splits a comment into pieces of at most `most` characters, at spaces where there are any.
pub(in crate::emit) fn wrap(text: &str, most: usize) -> Vec<&str> {
    let mut lines = Vec::new();
    let mut rest = text.trim_end();
    while let Some((cut, _)) = rest.char_indices().nth(most.max(1)) {
        let ends_word = rest.get(cut..).is_some_and(|tail| tail.starts_with(' '));
        let space = rest.get(..cut).and_then(|head| head.rfind(' ')).filter(|&at| at > 0 && !ends_word);
        let (head, tail) = rest.split_at(space.unwrap_or(cut));
        lines.push(head);
        rest = tail.trim_start();
    }
    lines.push(rest);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comment(text: &str) -> String {
        let mut out = Vec::new();
        write_comment(&mut out, text);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn nothing_in_a_comment_can_end_it() {
        assert_eq!(comment("A (B) 50%; C"), "(A [B] 50PCT, C)");
        assert_eq!(comment("TO THE LINE END)"), "(TO THE LINE END)");
        assert_eq!(comment("A (B)"), "(A [B])");
        assert_eq!(comment("TAB\tLF\nNUL\0."), "(TAB LF NUL .)");
        assert_eq!(comment("Fräser Ø10 日"), "(Fraeser O10 ?)");
        assert_eq!(comment(""), "()");
    }

    #[test]
    fn long_comments_break_at_spaces() {
        assert_eq!(wrap("ONE TWO THREE", 7), ["ONE TWO", "THREE"]);
        assert_eq!(wrap("ABCDEFGH", 3), ["ABC", "DEF", "GH"]);
        assert_eq!(wrap("", 3), [""]);
    }

    /// Letters that become several are counted as what they become.
    #[test]
    fn pieces_are_as_long_as_they_are_written() {
        assert_eq!(wrap(&spelled("ÄÖ%%"), 5), ["AEOEP", "CTPCT"]);
    }
}

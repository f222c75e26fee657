//! Which lines of a text changed, and which words within them.

use super::result::{Hunk, Line, On, Piece, Text};
use similar::{Algorithm, DiffOp, capture_diff_slices};

/// Lines about a change that are shown.
const ABOUT: usize = 3;

/// Changed lines of a file that are shown, at the most.
const MOST: usize = 2000;

/// Words of a line that are held against those of another one, at the most: a longer line is shown as a whole.
const WORDS: usize = 2000;

/// A line as it is compared, with its number.
pub type Numbered = (usize, String);

/// The changes from the old lines to the new ones.
pub fn changed(old: &[Numbered], new: &[Numbered]) -> Text {
    let keys = |lines: &[Numbered]| lines.iter().map(|(_, text)| text.clone()).collect::<Vec<_>>();
    let ops = capture_diff_slices(Algorithm::Myers, &keys(old), &keys(new));
    let mut text = Text::default();
    let (mut shown, mut hunk) = (0, Vec::new());
    for (at, op) in ops.iter().enumerate() {
        let (i, j) = (op.old_range(), op.new_range());
        if let DiffOp::Equal { len, .. } = *op {
            let both = |at: usize| line(On::Both, old.get(i.start + at), new.get(j.start + at));
            let last = if at > 0 { ABOUT } else { 0 };
            let next = if at + 1 < ops.len() { ABOUT } else { 0 };
            if len <= last + next {
                hunk.extend((0..len).map(both));
                continue;
            }
            // What follows the last change, and what comes before the next one.
            hunk.extend((0..last).map(both));
            close(&mut text, &mut hunk);
            hunk.extend((len - next..len).map(both));
            continue;
        }
        let lines = i.len() + j.len();
        if shown + lines > MOST {
            text.left_out += lines;
            continue;
        }
        shown += lines;
        let (ours, theirs) = (&old[i], &new[j]);
        let pairs: Vec<[Vec<Piece>; 2]> = ours.iter().zip(theirs).map(|(a, b)| words(&a.1, &b.1)).collect();
        let one = |on, lines: &[Numbered], side: usize| {
            let all = lines.iter().enumerate().map(|(at, numbered)| {
                let (a, b) = if side == 0 { (Some(numbered), None) } else { (None, Some(numbered)) };
                let plain = line(on, a, b);
                match pairs.get(at) {
                    Some(pair) => Line { pieces: pair[side].clone(), ..plain },
                    None => plain,
                }
            });
            all.collect::<Vec<_>>()
        };
        hunk.extend(one(On::Old, ours, 0));
        hunk.extend(one(On::New, theirs, 1));
    }
    close(&mut text, &mut hunk);
    text
}

/// Ends a run of lines, if anything changed in it.
fn close(text: &mut Text, hunk: &mut Vec<Line>) {
    let lines = std::mem::take(hunk);
    if lines.iter().any(|line| line.on != On::Both) {
        text.hunks.push(Hunk { lines });
    }
}

fn line(on: On, old: Option<&Numbered>, new: Option<&Numbered>) -> Line {
    let text = old.or(new).map(|(_, text)| text.clone()).unwrap_or_default();
    let number = |side: Option<&Numbered>| side.map(|(number, _)| *number);
    let pieces = vec![Piece { text, changed: on != On::Both }];
    Line { on, old: number(old), new: number(new), pieces }
}

/// Two lines in pieces, by the words that differ. Lines that have nothing in common but signs are marked whole.
fn words(a: &str, b: &str) -> [Vec<Piece>; 2] {
    let (ours, theirs) = (cut(a), cut(b));
    let whole = |text: &str| vec![Piece { text: text.to_owned(), changed: true }];
    if ours.len() + theirs.len() > WORDS {
        return [whole(a), whole(b)];
    }
    let ops = capture_diff_slices(Algorithm::Myers, &ours, &theirs);
    let is_word = |word: &&str| word.chars().any(char::is_alphanumeric);
    let common = |op: &DiffOp| matches!(op, DiffOp::Equal { .. }) && ours[op.old_range()].iter().any(is_word);
    if !ops.iter().any(common) {
        return [whole(a), whole(b)];
    }
    let mut out = [Vec::new(), Vec::new()];
    for op in &ops {
        let changed = !matches!(op, DiffOp::Equal { .. });
        for (side, text) in
            [ours[op.old_range()].concat(), theirs[op.new_range()].concat()].into_iter().enumerate()
        {
            if !text.is_empty() {
                out[side].push(Piece { text, changed });
            }
        }
    }
    out
}

/// The words of a line: a letter with its number, a name, blanks, each other sign.
fn cut(text: &str) -> Vec<&str> {
    let mut out = Vec::new();
    let (mut start, mut before) = (0, None);
    for (at, sign) in text.char_indices() {
        let is_number = |sign: char| sign.is_ascii_digit() || sign == '.';
        let goes_on = match before {
            None => true,
            Some(last) if is_number(sign) => is_number(last) || char::is_alphabetic(last),
            Some(last) if sign.is_alphabetic() => last.is_alphabetic(),
            Some(last) => sign == ' ' && last == ' ',
        };
        if !goes_on {
            out.push(&text[start..at]);
            start = at;
        }
        before = Some(sign);
    }
    out.extend(Some(&text[start..]).filter(|rest| !rest.is_empty()));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_into_words() {
        assert_eq!(cut("N10 G1X-10.5F#100"), ["N10", " ", "G1", "X", "-", "10.5", "F", "#", "100"]);
        assert_eq!(cut("IF[#1EQ0]GOTO 9 (ÄÖ  1)")[..4], ["IF", "[", "#", "1"]);
        assert!(cut("").is_empty());
    }

    #[test]
    fn one_sign_is_marked_in_its_line() {
        let marked = |pieces: &[Piece]| {
            let all = pieces.iter().map(|p| if p.changed { format!("[{}]", p.text) } else { p.text.clone() });
            all.collect::<String>()
        };
        let [a, b] = words("G1 X10. F100", "G1 X-10. F100");
        assert_eq!((marked(&a).as_str(), marked(&b).as_str()), ("G1 [X10.] F100", "G1 [X-10.] F100"));
    }

    #[test]
    fn what_lies_far_from_a_change_is_left_out() {
        let old: Vec<Numbered> = (1..=20).map(|n| (n, format!("X{n}"))).collect();
        let mut new = old.clone();
        new[9].1 = "Y1".into();
        let text = changed(&old, &new);
        let numbers: Vec<_> = text.hunks[0].lines.iter().map(|line| (line.old, line.new)).collect();
        assert_eq!((text.hunks.len(), text.left_out), (1, 0));
        assert_eq!(numbers.len(), 8);
        assert_eq!(
            (numbers[0], numbers[3], numbers[4]),
            ((Some(7), Some(7)), (Some(10), None), (None, Some(10)))
        );
        assert!(changed(&old, &old).hunks.is_empty());
    }
}

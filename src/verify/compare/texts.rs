//! Texts that an operator reads: whether one says what the other says.
//!
//! Controls differ in the signs that they show and in how they write numbers; so letters are compared
//! without regard to case, numbers by their values, and other signs not at all. A text that is shorter
//! counts as the same only where the control that shows it had no room for what is missing.

use super::letters::{Form, plain};

/// Decimal places to which numbers that were written with different formats are compared.
const PLACES: usize = 4;

/// A piece of a text.
#[derive(Clone, Debug, PartialEq)]
enum Piece {
    Letter(char),
    Number { value: f64, places: usize },
}

/// True where the second text says what the first one does; `room` is how many characters more it could
/// have had, none where that is not limited.
pub fn say_the_same(source: &str, target: &str, room: Option<usize>) -> bool {
    if !source.is_ascii() || !target.is_ascii() || source.contains('%') || target.contains('%') {
        return [Form::Long, Form::Short].into_iter().any(|form| {
            let (ours, theirs) = (plain(source, form), plain(target, form));
            // What is written in more letters needs more room.
            let longer = ours.chars().count().saturating_sub(source.chars().count());
            alike(&ours, &theirs, room.map(|room| room.saturating_sub(longer)))
        });
    }
    alike(source, target, room)
}

fn alike(source: &str, target: &str, room: Option<usize>) -> bool {
    let (ours, theirs) = (pieces(source), pieces(target));
    let same = theirs.len() <= ours.len() && ours.iter().zip(&theirs).all(|((a, ..), (b, ..))| agree(a, b));
    let Some(((missing, place), cut_at)) = ours.get(theirs.len()).zip(room) else {
        return same && ours.len() == theirs.len();
    };
    // What is missing begins after the signs that follow what was shown.
    let shown = theirs.len().checked_sub(1).and_then(|last| ours.get(last)).map_or(0, |(_, at)| at.end);
    let signs = |upto: usize| source.get(shown..upto).map_or(0, |text| text.chars().count());
    // A number is shown whole, or not at all.
    let is_cut = match missing {
        Piece::Number { .. } => signs(place.end) > cut_at,
        _ => signs(place.start) >= cut_at,
    };
    same && is_cut
}

fn agree(a: &Piece, b: &Piece) -> bool {
    match (a, b) {
        (Piece::Number { value, places }, Piece::Number { value: other, places: other_places }) => {
            let allowed = match places == other_places {
                true if *places < PLACES => 1e-9,
                true => 1.01 * 10f64.powi(-(*places as i32)),
                false => 0.501 * 10f64.powi(-(PLACES as i32)),
            };
            (value - other).abs() <= allowed
        }
        _ => a == b,
    }
}

/// The letters and numbers of a text, and where each stands in it.
fn pieces(text: &str) -> Vec<(Piece, std::ops::Range<usize>)> {
    let bytes = text.as_bytes();
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(sign) = text.get(at..).and_then(|rest| rest.chars().next()) {
        let start = at;
        let negative = sign == '-';
        let from = at + usize::from(negative);
        let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
        let behind_letter = start.checked_sub(1).is_some_and(|at| bytes[at].is_ascii_alphabetic());
        if digit(from) || (bytes.get(from) == Some(&b'.') && digit(from + 1) && !behind_letter) {
            at = from;
            while digit(at) {
                at += 1;
            }
            let mut places = 0;
            if bytes.get(at) == Some(&b'.') {
                at += 1;
                while digit(at) {
                    (at, places) = (at + 1, places + 1);
                }
            }
            let value: f64 = text.get(start..at).and_then(|text| text.parse().ok()).unwrap_or(f64::NAN);
            out.push((Piece::Number { value: value + 0.0, places }, start..at));
            continue;
        }
        at += sign.len_utf8();
        match sign {
            // Signs that formatted output gives a meaning of its own are written as letters there.
            '#' => out.extend("NO".chars().map(|letter| (Piece::Letter(letter), start..at))),
            '*' => out.push((Piece::Letter('X'), start..at)),
            _ if sign.is_alphanumeric() => {
                out.push((Piece::Letter(sign.to_ascii_uppercase()), start..at));
            }
            _ => {}
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::say_the_same;

    #[test]
    fn formats_and_signs_do_not_matter() {
        for (a, b) in [
            ("25.45", "  25.4500"),
            ("-66.037511", " -66.0375"),
            ("Depth: 5", "DEPTH  5.0000"),
            ("TOOL #5", "TOOL NO.5"),
            ("0", "   0.0000"),
            ("", " "),
        ] {
            assert!(say_the_same(a, b, None), "{a} {b}");
        }
    }

    #[test]
    fn words_and_values_do() {
        for (a, b) in [
            ("25.45", "25.4512"),
            ("TOOL 5", "TOOL 6"),
            ("DRILL .505", "DRILL .506"),
            ("HOLE SPACING TOO SMALL", "HOLE SPACING TOO LARGE"),
            ("CHECK PART", "CHECK"),
            ("CHECK", "CHECK PART"),
            ("CHECK", ""),
            ("1", "-1"),
        ] {
            assert!(!say_the_same(a, b, None), "{a} {b}");
        }
    }

    #[test]
    fn letters_may_be_written_as_what_looks_like_them() {
        for (a, b) in [
            ("TÜR AUF", "TUER AUF"),
            ("TÜR AUF", "Tur auf"),
            ("façade", "FACADE"),
            ("50% OF 5°", "50PCT OF 5 DEG"),
            ("Ø10 ±0.1", "DIA 10 +/-0.1"),
            ("ŁÓDŹ €5", "LODZ EUR5"),
        ] {
            assert!(say_the_same(a, b, None), "{a} {b}");
        }
        for (a, b) in [("TÜR AUF", "TR AUF"), ("TÜR", "TAR"), ("50%", "50"), ("Ø10", "10"), ("TÖR", "TÜR")]
        {
            assert!(!say_the_same(a, b, None), "{a} {b}");
        }
    }

    #[test]
    fn a_text_is_cut_only_where_there_is_no_room() {
        assert!(say_the_same("ENTER THE DEPTH", "ENTER THE D", Some(0)));
        assert!(!say_the_same("ENTER THE DEPTH", "ENTER THE D", Some(3)));
        // The space after the last word that fits was cut off too.
        assert!(say_the_same("ENTER THE DEPTH", "ENTER THE", Some(1)));
        assert!(!say_the_same("ENTER THE DEPTH", "ENTER THE", Some(2)));
        assert!(!say_the_same("ENTER THE DEPTH", "ENTER A", Some(0)));
    }
}

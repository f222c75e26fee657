//! How a row of `codes` spells its code: a head and the words that must stand beside it.

use super::CodeMeaning;
use crate::canon::Role;

/// True for a letter whose numbers may count increments where they have no point: all but those that count things, by the
/// common rules of the trade (ISO 6983). A builder's code is given such a number with a point.
pub const fn measures(letter: char) -> bool {
    !matches!(letter, 'D' | 'H' | 'L' | 'P' | 'S' | 'T')
}

/// The letter of a word among those that stand beside a code: in lower case where a comma stands before it.
pub const fn beside_letter(letter: char, comma: bool) -> char {
    if comma { letter.to_ascii_lowercase() } else { letter }
}

/// The letter and number of a code, the number in thousandths so that `G54.1` is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CodeHead {
    /// The letter, upper case.
    pub letter: char,
    /// The number, in thousandths.
    pub thousandths: u32,
}

/// A word that must stand beside a code for a row to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beside {
    /// Its letter, as [`beside_letter`] has it.
    pub letter: char,
    /// Its value in thousandths; absent where any will do.
    pub thousandths: Option<u32>,
}

impl CodeHead {
    /// The code of a letter and a number; none if the number is no code:
    /// negative, not finite, larger than any, or finer than a thousandth.
    pub fn new(letter: char, number: f64) -> Option<Self> {
        let scaled = number * 1000.0;
        let rounded = scaled.round();
        let is_code = (0.0..=999_999_000.0).contains(&rounded) && (scaled - rounded).abs() < 1e-6;
        // In range by the test above.
        is_code.then(|| Self { letter: letter.to_ascii_uppercase(), thousandths: rounded as u32 })
    }

    /// The number without its fraction.
    pub fn whole(self) -> u32 {
        self.thousandths / 1000
    }

    /// The number.
    pub fn number(self) -> f64 {
        f64::from(self.thousandths) / 1000.0
    }

    pub(super) fn read(word: &str) -> Option<Self> {
        let (letter, number) = split(word).filter(|(letter, _)| letter.is_ascii_uppercase())?;
        Self::new(letter, number?)
    }
}

fn split(word: &str) -> Option<(char, Option<f64>)> {
    let (comma, word) = match word.strip_prefix(',') {
        Some(word) => (true, word),
        None => (false, word),
    };
    let mut chars = word.chars();
    let letter = beside_letter(chars.next().filter(char::is_ascii_uppercase)?, comma);
    let rest = chars.as_str();
    if rest.is_empty() {
        return Some((letter, None));
    }
    let is_number = rest.chars().all(|c| c.is_ascii_digit() || c == '.');
    is_number.then(|| rest.parse().ok()).flatten().map(|number| (letter, Some(number)))
}

impl CodeMeaning {
    /// The code itself, without the words beside it; none if it is misspelt,
    /// which the loader refuses.
    pub fn head(&self) -> Option<CodeHead> {
        CodeHead::read(self.code.split(' ').next()?)
    }

    /// The words that must stand beside the code; none if one is misspelt.
    pub fn beside(&self) -> Option<Vec<Beside>> {
        self.code
            .split(' ')
            .skip(1)
            .map(|word| {
                let (letter, number) = split(word)?;
                let thousandths = match number {
                    Some(number) => Some(CodeHead::new(letter, number)?.thousandths),
                    None => None,
                };
                Some(Beside { letter, thousandths })
            })
            .collect()
    }

    /// True for codes that do the same with the same operands of their own.
    pub fn does_the_same(&self, other: &Self) -> bool {
        (self.op, &self.with, &self.fixed) == (other.op, &other.with, &other.fixed)
    }

    /// True where a word beside the code has the role.
    pub fn takes(&self, role: Role) -> bool {
        self.words.values().any(|found| *found == role)
    }
}

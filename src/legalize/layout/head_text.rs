//! The comment at a program's head that an earlier conversion wrote: `V31=#100 V40=FLAG OF #100 SCRATCH R5`.

use crate::dialect::Control;

/// Registers that a run of them may name, `#100-#102`; a longer one is nothing that was written so.
const LONGEST_RUN: u32 = 1000;

/// What a comment of nothing but names says.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::legalize) struct Head {
    /// It says what registers hold: `V31=#100`, and one of the names is the source's.
    pub pairs: bool,
    /// It names registers for values in between; the rest of them may stand in the next comment.
    pub scratch: bool,
    /// The source's registers, each with what its value was called on the control that it came from.
    pub held: Vec<(String, String)>,
    /// The source's registers that hold values in between.
    pub between: Vec<String>,
}

impl Head {
    /// None for a comment with another word in it. With `goes_on` the comment before it ended in scratch registers.
    pub fn of(text: &str, source: &Control, goes_on: bool) -> Option<Self> {
        let spaced = text.replace('=', " = ");
        let words: Vec<&str> = spaced.split_ascii_whitespace().collect();
        let mut head = Self::default();
        let (mut equals, mut own) = (false, false);
        for (at, word) in words.iter().enumerate() {
            match *word {
                "=" => {
                    equals = true;
                    let before = at.checked_sub(1).and_then(|before| words.get(before));
                    let sides = before.zip(words.get(at + 1));
                    head.held.extend(sides.and_then(|(left, right)| held(left, right, source)));
                }
                "FLAG" | "OF" => {}
                "SCRATCH" => head.scratch = true,
                word => {
                    let (first, last) = word.split_once('-').unwrap_or((word, word));
                    let (first, last) = (Name::of(first)?, Name::of(last)?);
                    own |= first.is_of(source) || last.is_of(source);
                    if head.scratch || goes_on && !equals {
                        head.between.extend(run(&first, &last));
                    }
                }
            }
        }
        head.pairs = own && (equals || head.scratch);
        own.then_some(head)
    }
}

/// The source's register of a pair, and what its value was called: one side is the source's. Where both may be, the register
/// stands first.
fn held(left: &str, right: &str, source: &Control) -> Option<(String, String)> {
    let (first, second) = (Name::of(left)?, Name::of(right)?);
    match (first.is_of(source), second.is_of(source)) {
        (true, _) => Some((left.to_owned(), right.to_owned())),
        (false, true) => Some((right.to_owned(), left.to_owned())),
        (false, false) => None,
    }
}

/// The names from one number to another.
fn run(first: &Name<'_>, last: &Name<'_>) -> Vec<String> {
    let numbers = first.rest.parse::<u32>().ok().zip(last.rest.parse::<u32>().ok());
    match numbers {
        Some((from, to))
            if first.sign == last.sign && to.checked_sub(from).is_some_and(|n| n < LONGEST_RUN) =>
        {
            (from..=to).map(|number| format!("{}{number}", first.sign)).collect()
        }
        _ => Vec::new(),
    }
}

/// The name of a register as any control may have it: a sign, and a number or a letter.
struct Name<'t> {
    sign: &'t str,
    rest: &'t str,
}

impl<'t> Name<'t> {
    fn of(word: &'t str) -> Option<Self> {
        let sign = word.chars().next().filter(|sign| sign.is_ascii_graphic() && !sign.is_ascii_digit())?;
        let (sign, rest) = word.split_at_checked(sign.len_utf8())?;
        let is_number = rest.len() < 6 && rest.bytes().all(|digit| digit.is_ascii_digit());
        let is_letter = rest.len() == 1 && rest.bytes().all(|letter| letter.is_ascii_uppercase());
        (!rest.is_empty() && (is_number || is_letter)).then_some(Self { sign, rest })
    }

    fn is_of(&self, control: &Control) -> bool {
        match self.rest.parse() {
            Ok(number) => control.variable_class(self.sign, number).is_some(),
            Err(_) => {
                let letter = self.rest.chars().next();
                letter.is_some_and(|letter| control.letter_class(self.sign, letter).is_some())
            }
        }
    }
}

//! Sees from its leaves that nothing is wrong with a block that the grammar reads, so that no tree need be built.
//!
//! Where it is in doubt it says no: then the tree is built, and [`super::checks`] decides. Tests hold it to them.

use super::Rules;
use super::lexeme::{Lex, Lexeme};
use super::statements::MOST_CONDITIONS;
use super::tree::{MOST_DIGITS, MOST_OPERATORS, read_number};

/// Digits of a whole number that every control reads.
pub const USUAL_DIGITS: usize = 8;

/// What has been met of a block.
#[derive(Default)]
struct Met {
    /// The last leaf but blanks.
    last: Lex,
    /// The last that is neither a comment nor the end of the block.
    last_said: Lex,
    /// The letter of the last word, until its number comes.
    letter: u8,
    words: usize,
    codes: usize,
    calls: bool,
    conditions: usize,
    operators: usize,
    divides: bool,
    arc_tangent: bool,
    /// True where the operand that comes next is a divisor.
    divisor: bool,
    /// True where it is the argument of a function that does not take each number.
    argument: bool,
    /// True where the last variable is `#0`.
    null: bool,
}

/// True for leaves that surely make a block without a fault.
pub fn is_sound(rules: &Rules, source: &[u8], row: &[Lexeme]) -> bool {
    let mut met = Met::default();
    let mut leaves = row.iter().filter(|leaf| leaf.kind != Lex::Space);
    leaves.all(|leaf| met.take(rules, leaf.kind, leaf.span.of(source))) && met.end()
}

impl Met {
    /// Takes the next leaf; false where it may be wrong.
    fn take(&mut self, rules: &Rules, kind: Lex, text: &[u8]) -> bool {
        let precheck = match kind {
            Lex::Letter => self.word(text),
            Lex::Number => self.number(rules, text),
            Lex::Hash => {
                self.letter = 0;
                true
            }
            Lex::Integer => self.integer(text),
            Lex::Open => self.open(),
            Lex::Operator | Lex::Join => self.operator(text),
            Lex::Function => self.function(text),
            Lex::Equals => !self.null,
            Lex::If => {
                self.conditions += 1;
                true
            }
            Lex::Bit => text.len() <= USUAL_DIGITS,
            Lex::Output | Lex::SetNames | Lex::Name => false,
            _ => true,
        };
        self.last = kind;
        if !matches!(kind, Lex::Comment | Lex::EndOfBlock) {
            self.last_said = kind;
        }
        precheck
    }

    fn word(&mut self, text: &[u8]) -> bool {
        self.letter = text.first().map_or(0, u8::to_ascii_uppercase);
        self.words += 1;
        self.codes += usize::from(self.letter == b'G');
        true
    }

    fn number(&mut self, rules: &Rules, text: &[u8]) -> bool {
        let word = match self.last {
            Lex::Letter | Lex::Sign => std::mem::take(&mut self.letter),
            _ => 0,
        };
        let called = word == b'G' && (65.0..67.0).contains(&read_number(text).value);
        self.calls |= called;
        let whole = rules.whole_letters.contains(&char::from(word));
        let behind_words = called && self.words > 1;
        let with_point = whole && text.contains(&b'.');
        let zero_divides = self.divisor && read_number(text).value == 0.0;
        let argument = std::mem::take(&mut self.argument);
        self.divisor = false;
        // What is assigned may be the number alone, for which there is a limit.
        let most = match self.last {
            Lex::Equals | Lex::Sign => rules.constant_digits.unwrap_or(MOST_DIGITS),
            _ => MOST_DIGITS,
        };
        !(behind_words || with_point || zero_divides || argument) && text.len() <= usize::from(most)
    }

    fn integer(&mut self, text: &[u8]) -> bool {
        (self.divisor, self.argument) = (false, false);
        self.null = self.last == Lex::Hash && text.iter().all(|digit| *digit == b'0');
        match self.last {
            Lex::Do | Lex::End => matches!(text, b"1" | b"2" | b"3"),
            _ => text.len() <= USUAL_DIGITS,
        }
    }

    /// A bracket where no operand comes is a condition without IF.
    fn open(&mut self) -> bool {
        use Lex::{
            Comma, Equals, Function, Goto, Hash, If, Join, Letter, Open, Operator, Sign, Slash, While,
        };
        self.conditions += usize::from(!matches!(
            self.last,
            Comma
                | Equals
                | Function
                | Goto
                | Hash
                | If
                | Join
                | Letter
                | Open
                | Operator
                | Sign
                | Slash
                | While
        ));
        // `G[65]` is a call, too.
        !(self.letter == b'G' && matches!(self.last, Letter | Sign))
    }

    fn operator(&mut self, text: &[u8]) -> bool {
        self.operators += 1;
        self.divisor = matches!(text.first(), Some(b'/' | b'M' | b'm'));
        self.divides |= self.divisor;
        true
    }

    fn function(&mut self, text: &[u8]) -> bool {
        let is = |names: &[&str]| names.iter().any(|name| text.eq_ignore_ascii_case(name.as_bytes()));
        self.divisor = false;
        self.argument = is(&["ASIN", "ACOS", "SQRT", "SQR", "LN"]);
        self.arc_tangent |= is(&["ATAN", "ATN"]);
        true
    }

    /// Judges what takes the whole block.
    fn end(&self) -> bool {
        let nothing_follows = self.conditions > 0 && matches!(self.last_said, Lex::Close | Lex::Then);
        !nothing_follows
            && self.conditions <= MOST_CONDITIONS
            && self.operators <= MOST_OPERATORS
            && !(self.calls && self.codes > 1)
            && !(self.divides && self.arc_tangent)
    }
}

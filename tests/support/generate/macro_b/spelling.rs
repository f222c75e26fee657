//! Names, words and values.

use super::Writer;
use crate::generate::{Binary, Policy, Test, Unary, Value, plain, pointed};

impl Writer<'_> {
    pub(super) fn name(&self, slot: usize) -> String {
        let all_local = self.program.policy == Policy::Arguments;
        let number = match slot {
            0..=5 => slot + 1,
            9 if all_local => 11,
            6..=9 if all_local => slot + 1,
            6 | 7 => slot + 100,
            // Variables that the other control may not have.
            8 | 9 if self.program.policy == Policy::Reach && !self.haas => slot + 700,
            8 | 9 => slot + 500,
            // What circumstances give: some that power-off clears, some that it does not.
            10..=15 if slot.is_multiple_of(2) => slot + 130,
            10..=15 => slot + 510,
            _ if self.locals_count && slot < 33 => slot,
            _ => slot + 100,
        };
        format!("#{number}")
    }

    /// A value of at least 1 behind a letter.
    pub(super) fn size(&self, letter: char, value: &Value) -> String {
        match value {
            Value::Number(number) => format!("{letter}{}", pointed(number.abs() + 1.0)),
            value => format!("{letter}[ABS[{}]+1]", self.value(value, 0)),
        }
    }

    pub(super) fn word(&self, letter: char, value: &Value, bare: bool) -> String {
        match value {
            Value::Number(number) if bare && number.fract() == 0.0 => format!("{letter}{}", plain(*number)),
            Value::Number(number) => format!("{letter}{}", pointed(*number)),
            Value::Slot(slot) => format!("{letter}{}", self.name(*slot)),
            Value::Empty => format!("{letter}#0"),
            Value::Unary(Unary::Negate, inner) if matches!(**inner, Value::Slot(_)) => {
                format!("{letter}-{}", self.value(inner, 9))
            }
            value => format!("{letter}[{}]", self.value(value, 0)),
        }
    }

    /// A value beside operators of a rank.
    pub(super) fn value(&self, value: &Value, rank: u32) -> String {
        match value {
            Value::Number(number) if *number < 0.0 && rank > 0 => format!("[{}]", plain(*number)),
            Value::Number(number) => plain(*number),
            Value::Slot(slot) => self.name(*slot),
            Value::Empty => "#0".into(),
            Value::Unary(Unary::Negate, a) if rank > 0 => format!("[-{}]", self.value(a, 9)),
            Value::Unary(Unary::Negate, a) => format!("-{}", self.value(a, 9)),
            Value::Unary(function, a) => {
                let name = match function {
                    Unary::Abs | Unary::Negate => "ABS",
                    Unary::Sine => "SIN",
                    Unary::Cosine => "COS",
                    // Behind it a slash would begin the divisor of the form with two arguments.
                    Unary::ArcTangent if rank > 0 => return format!("[ATAN[{}]]", self.value(a, 0)),
                    Unary::ArcTangent => "ATAN",
                    // Two brackets each: some controls take five.
                    Unary::Root if holds_root(a) => "ABS",
                    Unary::Root => return format!("SQRT[ABS[{}]]", self.value(a, 0)),
                    Unary::Fix => "FIX",
                    Unary::Up if self.haas => "FIX",
                    Unary::Up => "FUP",
                    Unary::Round => "ROUND",
                };
                format!("{name}[{}]", self.value(a, 0))
            }
            Value::Binary(Binary::ArcTangent, a, b) => {
                format!("ATAN[{}]/[{}]", self.value(a, 0), self.value(b, 0))
            }
            Value::Binary(operation, a, b) => {
                let (name, own) = match operation {
                    Binary::Add => ("+", 5),
                    Binary::Subtract => ("-", 5),
                    Binary::Multiply => ("*", 6),
                    Binary::Divide => ("/", 6),
                    Binary::Remainder => (" MOD ", 6),
                    Binary::And => (" AND ", 6),
                    Binary::Or => (" OR ", 5),
                    Binary::Xor | Binary::ArcTangent => (" XOR ", 5),
                };
                // Where bit operations stand in the order one of the controls does not say.
                let own = if name.starts_with(' ') { 4 } else { own };
                let text = format!("{}{name}{}", self.value(a, own), self.value(b, own + 1));
                if own < rank || (own == 4 && rank > 0) { format!("[{text}]") } else { text }
            }
        }
    }

    pub(super) fn test(&self, test: &Test) -> String {
        match test {
            Test::Compare(relation, a, b) => {
                format!("[{} {} {}]", self.value(a, 5), relation.letters(), self.value(b, 5))
            }
            Test::Empty(slot, empty) => {
                format!("[{} {} #0]", self.name(*slot), if *empty { "EQ" } else { "NE" })
            }
            Test::Both(a, b) => format!("[{} AND {}]", self.test(a), self.test(b)),
            Test::Either(a, b) => format!("[{} OR {}]", self.test(a), self.test(b)),
        }
    }
}

fn holds_root(value: &Value) -> bool {
    match value {
        Value::Unary(function, a) => *function == Unary::Root || holds_root(a),
        Value::Binary(_, a, b) => holds_root(a) || holds_root(b),
        _ => false,
    }
}

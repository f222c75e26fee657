//! Names, values and conditions.

use crate::generate::{Binary, Test, Unary, Value, plain};

pub(super) fn name(slot: usize) -> String {
    match slot {
        0..=3 => format!("R{}", slot + 5),
        4..=9 => format!("V{}", slot - 3),
        _ => format!("V{slot}"),
    }
}

/// A value beside operators of a rank.
pub(super) fn text(value: &Value, rank: u32) -> String {
    match value {
        Value::Number(number) if *number < 0.0 && rank > 0 => format!("({})", plain(*number)),
        Value::Number(number) => plain(*number),
        Value::Slot(slot) => name(*slot),
        Value::Empty => "0".into(),
        Value::Unary(Unary::Negate, a) if rank > 0 => format!("(-{})", text(a, 9)),
        Value::Unary(Unary::Negate, a) => format!("-{}", text(a, 9)),
        Value::Unary(function, a) => {
            let name = match function {
                Unary::Abs | Unary::Negate => "ABS",
                Unary::Sine => "SIN",
                Unary::Cosine => "COS",
                Unary::ArcTangent => "ATN",
                Unary::Root => return format!("SQR(ABS({}))", text(a, 0)),
                Unary::Fix | Unary::Up => "INT",
                Unary::Round => "RND",
            };
            format!("{name}({})", text(a, 0))
        }
        Value::Binary(Binary::ArcTangent, a, b) => format!("ATN({}/{})", text(a, 6), text(b, 7)),
        Value::Binary(operation, a, b) => {
            let (name, own) = match operation {
                Binary::Multiply => ("*", 6),
                Binary::Divide | Binary::Remainder => ("/", 6),
                Binary::Subtract => ("-", 5),
                _ => ("+", 5),
            };
            let text = format!("{}{name}{}", text(a, own), text(b, own + 1));
            if own < rank { format!("({text})") } else { text }
        }
    }
}

pub(super) fn condition(test: &Test) -> String {
    match test {
        Test::Compare(relation, a, b) => format!("{}{}{}", text(a, 5), relation.signs(), text(b, 5)),
        Test::Empty(slot, true) => format!("{}=0", name(*slot)),
        Test::Empty(slot, false) => format!("{}<>0", name(*slot)),
        Test::Both(a, b) => format!("({}) AND ({})", condition(a), condition(b)),
        Test::Either(a, b) => format!("({}) OR ({})", condition(a), condition(b)),
    }
}

//! Assignments and branches.

use super::{Writer, branch, name};
use crate::generate::{Binary, Test, Unary, Value, plain};

impl Writer {
    /// A variable that holds a value.
    pub(super) fn variable(&mut self, value: &Value) -> String {
        if let Value::Slot(slot) = value {
            return name(*slot);
        }
        let name = self.temporary();
        self.assign(&name, value);
        name
    }

    pub(super) fn assign(&mut self, name: &str, value: &Value) {
        match value {
            Value::Number(number) => self.line(&format!("{name}={}", plain(*number))),
            Value::Empty => self.line(&format!("{name}=0")),
            Value::Slot(slot) => self.line(&format!("{name}={}", self::name(*slot))),
            Value::Unary(function, a) => {
                let a = self.variable(a);
                match function {
                    Unary::Negate => self.line(&format!("{name}={a}* -1")),
                    Unary::Abs | Unary::Root => {
                        self.line(&format!("V79={a}*{a}"));
                        self.line(&format!("{name}=SQR V79"));
                    }
                    // Angles have to be within a turn.
                    Unary::Sine | Unary::Cosine => {
                        self.line(&format!("V79=ATN {a}"));
                        let function = if *function == Unary::Sine { "SIN" } else { "COS" };
                        self.line(&format!("{name}={function} V79"));
                    }
                    Unary::ArcTangent => self.line(&format!("{name}=ATN {a}")),
                    Unary::Fix | Unary::Up | Unary::Round => {
                        self.line(&format!("{name}={a}"));
                        self.line(&format!("INC {name}"));
                        self.line(&format!("DEC {name}"));
                    }
                }
            }
            Value::Binary(operation, a, b) => {
                let a = self.variable(a);
                let b = match &**b {
                    Value::Number(number) if *number >= 0.0 => plain(*number),
                    b => self.variable(b),
                };
                let sign = match operation {
                    Binary::Multiply => "*",
                    Binary::Divide | Binary::ArcTangent | Binary::Remainder => "/",
                    Binary::Subtract => "-",
                    _ => "+",
                };
                self.line(&format!("{name}={a}{sign}{b}"));
            }
        }
    }

    /// Goes on at a label where a condition holds.
    pub(super) fn when(&mut self, test: &Test, label: u32) {
        match test {
            Test::Compare(relation, a, b) => {
                let branch = branch(*relation);
                match (a, b) {
                    (Value::Slot(slot), Value::Number(0.0)) => self.line(&format!("TST {}", name(*slot))),
                    (a, b) => {
                        let difference =
                            Value::Binary(Binary::Subtract, Box::new(a.clone()), Box::new(b.clone()));
                        self.assign("V79", &difference);
                    }
                }
                self.line(&format!("{branch} P{label}"));
            }
            Test::Empty(slot, empty) => {
                self.line(&format!("TST {}", name(*slot)));
                self.line(&format!("{} P{label}", if *empty { "BEQ" } else { "BNE" }));
            }
            Test::Either(a, b) => {
                self.when(a, label);
                self.when(b, label);
            }
            Test::Both(a, b) => {
                let past = self.labels(1);
                self.unless(a, past);
                self.when(b, label);
                self.place(past);
            }
        }
    }

    pub(super) fn unless(&mut self, test: &Test, label: u32) {
        self.when(&test.opposite(), label);
    }

    pub(super) fn temporary(&mut self) -> String {
        self.used += 1;
        format!("V{}", 60 + (self.used - 1) % 18)
    }
}

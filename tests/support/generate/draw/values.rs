//! Draws numbers, values and conditions.

use super::{Draw, GIVEN, GIVENS, SLOTS};
use crate::generate::{Binary, Policy, Relation, Test, Unary, Value};

impl Draw<'_, '_> {
    pub(super) fn some_slot(&mut self) -> Value {
        if !self.around.is_empty() && self.source.one_in(3) {
            return Value::Slot(self.source.pick(&self.around.clone()));
        }
        // Most reads are of what the head set, unless it is vacancy that is wanted.
        let from = if self.policy == Policy::Vacancy || self.source.one_in(6) { SLOTS } else { 4 };
        Value::Slot(self.source.below(from))
    }

    pub(super) fn number(&mut self) -> Value {
        const NEAR: [f64; 20] = [
            0.0005, 1.0005, 0.00049, -0.0005, 2.5, -2.5, 0.4999999, 0.5, -0.5, 1.5, 0.0015, 2.0025, 3.9999,
            0.99995, 0.1, 0.2, 0.3, 1.00005, 12.34565, -7.9995,
        ];
        let near = self.policy == Policy::NearRounding;
        Value::Number(match self.source.below(if near { 8 } else { 5 }) {
            0 => self.source.below(10) as f64,
            1 => self.source.below(41) as f64 / 2.0 - 10.0,
            2 => self.source.below(2000) as f64 / 100.0 - 10.0,
            3 => self.source.pick(&[0.0, 1.0, -1.0, 2.0]),
            4 => 1.0 + self.source.below(20) as f64,
            _ => self.source.pick(&NEAR),
        })
    }

    pub(super) fn value(&mut self, depth: usize) -> Value {
        let leaf = depth == 0 || self.source.one_in(2);
        if leaf {
            let empty = self.macro_b && self.policy == Policy::Vacancy && self.source.one_in(8);
            return match self.source.below(3) {
                _ if empty => Value::Empty,
                0 => self.number(),
                _ => self.some_slot(),
            };
        }
        if self.source.one_in(3) {
            const COMMON: [Unary; 6] =
                [Unary::Negate, Unary::Abs, Unary::Sine, Unary::Cosine, Unary::ArcTangent, Unary::Root];
            const WHOLE: [Unary; 3] = [Unary::Fix, Unary::Up, Unary::Round];
            let whole = self.source.one_in(if self.policy == Policy::NearRounding { 2 } else { 4 });
            let function = if whole { self.source.pick(&WHOLE) } else { self.source.pick(&COMMON) };
            return Value::Unary(function, Box::new(self.value(depth - 1)));
        }
        let operation = match self.source.below(16) {
            0..5 => Binary::Add,
            5..9 => Binary::Subtract,
            9..12 => Binary::Multiply,
            12..14 => Binary::Divide,
            _ => self.source.pick(&[
                Binary::Remainder,
                Binary::And,
                Binary::Or,
                Binary::Xor,
                Binary::ArcTangent,
            ]),
        };
        let left = Box::new(self.value(depth - 1));
        let right = match operation {
            Binary::Divide | Binary::Remainder | Binary::ArcTangent => {
                Value::Number(self.source.pick(&[2.0, 3.0, 4.0, 7.0, 10.0]))
            }
            // A product of two variables grows without bound in a loop.
            Binary::Multiply => Value::Number(self.source.pick(&[0.5, 2.0, -1.0, 0.1, 1.5, 3.0])),
            _ => self.value(depth - 1),
        };
        Value::Binary(operation, left, Box::new(right))
    }

    /// A condition. Most hold what the program is given against a number, so that circumstances decide which way
    /// it goes; nothing that the conditions around hold against one.
    pub(super) fn test(&mut self, depth: usize) -> Test {
        if depth > 0 && self.source.one_in(5) {
            let a = Box::new(self.test(depth - 1));
            let known = self.tested.len();
            self.tested.extend(a.given());
            let b = Box::new(self.test(depth - 1));
            self.tested.truncate(known);
            return if self.source.one_in(2) { Test::Both(a, b) } else { Test::Either(a, b) };
        }
        let given = self.given();
        let empty = self.source.one_in(if self.policy == Policy::Vacancy { 3 } else { 20 });
        if self.macro_b && empty {
            let slot = given.unwrap_or_else(|| self.source.below(SLOTS));
            return Test::Empty(slot, self.source.one_in(2));
        }
        if let Some(slot) = given.filter(|_| !self.source.one_in(12)) {
            let number = 1.0 + self.source.below(9) as f64;
            if self.policy == Policy::NearRounding && self.source.one_in(2) {
                let relation = self.source.pick(&Relation::ALL[2..]);
                return Test::Compare(relation, self.about(slot), Value::Number(number));
            }
            // One number out of all has to be tried for by itself, so most ask for more or less.
            let from = if self.source.one_in(4) { 0 } else { 2 };
            let relation = self.source.pick(&Relation::ALL[from..]);
            return Test::Compare(relation, Value::Slot(slot), Value::Number(number));
        }
        if let (Some(counter), true) = (self.around.last().copied(), self.source.one_in(2)) {
            // A counter goes up from 0 or down to it.
            let relation = self.source.pick(&Relation::ALL[..4]);
            return Test::Compare(relation, Value::Slot(counter), Value::Number(1.0));
        }
        let left = if self.policy == Policy::NearRounding { self.value(2) } else { self.some_slot() };
        let right = if self.source.one_in(3) { self.value(1) } else { self.number() };
        Test::Compare(self.source.pick(&Relation::ALL), left, right)
    }

    /// A variable that the program is given, and that no condition around looks at.
    pub(super) fn given(&mut self) -> Option<usize> {
        let first = self.source.below(GIVENS);
        let mut all = (0..GIVENS).map(|at| GIVEN + (first + at) % GIVENS);
        all.find(|slot| !self.tested.contains(slot))
    }

    /// A value that goes up and down with what is given.
    fn about(&mut self, slot: usize) -> Value {
        let number = self.number();
        let slot = Box::new(Value::Slot(slot));
        let sum = Value::Binary(Binary::Add, slot, Box::new(number));
        match self.source.below(4) {
            0 => Value::Unary(self.source.pick(&[Unary::Fix, Unary::Round]), Box::new(sum)),
            1 => Value::Binary(Binary::Multiply, Box::new(sum), Box::new(Value::Number(0.1))),
            2 => Value::Binary(Binary::Divide, Box::new(sum), Box::new(Value::Number(3.0))),
            _ => sum,
        }
    }
}

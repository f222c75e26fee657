//! Branches, assignments and what is too long for a line.

use super::spelling::{condition, name, text};
use super::{LINE, Writer};
use crate::generate::{Kind, Source, Step, Test, Value};

impl Writer {
    /// Every third label is a sequence number.
    pub(super) fn place(&mut self, label: u32) {
        let line = if label.is_multiple_of(3) { format!("N{label} (PLACE") } else { format!("#:L{label}") };
        self.line(&line);
    }

    pub(super) fn to(label: u32) -> String {
        if label.is_multiple_of(3) { format!("GOTO N{label}") } else { format!("GOTO :L{label}") }
    }

    pub(super) fn branch(
        &mut self,
        test: &Test,
        then: &[Step],
        otherwise: &[Step],
        choices: &mut Source<'_>,
    ) {
        if let ([Step { kind: Kind::Set { slot, value }, .. }], []) = (then, otherwise)
            && choices.one_in(2)
        {
            return self.when(test, &format!("{}={}", name(*slot), text(value, 0)));
        }
        let end = self.labels(2);
        if otherwise.is_empty() && choices.one_in(2) {
            self.when(&test.opposite(), &Self::to(end));
            self.steps(then);
        } else {
            self.when(test, &Self::to(end + 1));
            self.steps(otherwise);
            self.line(&format!("#{}", Self::to(end)));
            self.place(end + 1);
            self.steps(then);
        }
        self.place(end);
    }

    /// A statement under a condition; what is too long for a line is worked out on lines before it.
    pub(super) fn when(&mut self, test: &Test, statement: &str) {
        let line = format!("#IF {} THEN {statement}", condition(test));
        if line.len() <= LINE {
            return self.line(&line);
        }
        let short = self.shorter(test);
        let line = format!("#IF {} THEN {statement}", condition(&short));
        if line.len() <= LINE {
            return self.line(&line);
        }
        let (end, other) = (self.labels(1), short.opposite());
        self.line(&format!("#IF {} THEN {}", condition(&other), Self::to(end)));
        match statement.split_once('=') {
            Some((name, _)) if line.len() > LINE + 20 => self.line(&format!("#{name}=0")),
            _ => self.line(&format!("#{statement}")),
        }
        self.place(end);
    }

    pub(super) fn shorter(&mut self, test: &Test) -> Test {
        match test {
            Test::Compare(relation, a, b) => Test::Compare(*relation, self.temporary(a), self.temporary(b)),
            Test::Empty(slot, empty) => Test::Empty(*slot, *empty),
            Test::Both(a, b) => Test::Both(Box::new(self.shorter(a)), Box::new(self.shorter(b))),
            Test::Either(a, b) => Test::Either(Box::new(self.shorter(a)), Box::new(self.shorter(b))),
        }
    }

    /// A variable that holds a value, on the lines before the one that is being written.
    pub(super) fn temporary(&mut self, value: &Value) -> Value {
        if matches!(value, Value::Slot(_) | Value::Number(_)) {
            return value.clone();
        }
        let at = self.temporaries;
        let slot = 90 + at;
        self.assign(&name(slot), value);
        self.temporaries = at + 1;
        Value::Slot(slot)
    }

    pub(super) fn assign(&mut self, name: &str, value: &Value) {
        let line = format!("#{name}={}", text(value, 0));
        if line.len() <= LINE {
            return self.line(&line);
        }
        let short = match value {
            Value::Binary(operation, a, b) => {
                let (a, b) = (self.temporary(a), self.temporary(b));
                Value::Binary(*operation, Box::new(a), Box::new(b))
            }
            Value::Unary(function, a) => Value::Unary(*function, Box::new(self.temporary(a))),
            other => other.clone(),
        };
        self.line(&format!("#{name}={}", text(&short, 0)));
    }
}

//! Conditions, as they stand between the brackets of IF and WHILE.

use super::Emitter;
use crate::dialect::Question;
use crate::ir::Cond;

impl Emitter<'_> {
    /// Writes a condition in brackets, or its opposite.
    pub(super) fn bracketed_condition(&mut self, condition: &Cond, negated: bool) {
        self.open();
        self.condition(condition, negated);
        self.close();
    }

    /// Writes a condition, or its opposite: the opposite of a comparison is a comparison,
    /// and the opposite of two that both hold is that one of their opposites does.
    pub(super) fn condition(&mut self, condition: &Cond, negated: bool) {
        if self.nested >= 300 {
            return self.out.unmapped("a condition of so many parts");
        }
        self.nested += 1;
        match condition {
            Cond::Compare(relation, a, b) => {
                let relation = if negated { relation.negated() } else { *relation };
                let text = self.spellings.relation(relation).text;
                if text.is_empty() {
                    self.out.unmapped(format_args!("the comparison {relation:?}"));
                }
                self.compared(a, relation);
                self.out.push(' ');
                self.out.push_str(text);
                self.out.push(' ');
                self.compared(b, relation);
            }
            Cond::Not(inner) => self.condition(inner, !negated),
            Cond::And(parts) => self.joined(parts, !negated, negated),
            Cond::Or(parts) => self.joined(parts, negated, negated),
            Cond::Switch(_) => self.out.unmapped("the block-skip switch in a condition"),
        }
        self.nested -= 1;
    }

    fn joined(&mut self, parts: &[Cond], all: bool, negated: bool) {
        if let [only] = parts {
            return self.condition(only, negated);
        }
        if parts.is_empty() || !self.control.is(Question::ConditionAndOr) {
            return self.out.unmapped("conditions joined by AND or OR");
        }
        let (truth, bits) = if all { ("and", "and.bits") } else { ("or", "or.bits") };
        let control = self.control;
        let Some(row) = control.operator(truth).or_else(|| control.operator(bits)) else {
            return self.out.unmapped(format_args!("the operator '{truth}' between conditions"));
        };
        for (at, part) in parts.iter().enumerate() {
            if at > 0 {
                self.out.push(' ');
                self.out.push_str(&row.spelling);
                self.out.push(' ');
            }
            self.bracketed_condition(part, negated);
        }
    }
}

//! Codes of a builder that take the speed of their tool as S, which lasts as the speed of the spindle does.

use super::Control;
use super::control_codes::address;
use crate::canon::{Act, Op, Role};

impl Control {
    /// The word of a builder's code that stands under the letter of the spindle's speed: without it the last speed counts.
    /// None if the code takes no word of that letter.
    pub fn speed_word(&self, act: Act) -> Option<Role> {
        let is = |written: &str| {
            address(written)
                .and_then(|(letter, comma)| self.word(letter, comma))
                .is_some_and(|row| row.role == Role::Speed)
        };
        let rows = self.dialect().codes.iter();
        let own = rows.filter(|row| row.op == Op::Act && row.fixed.get(&Role::Act) == Some(&act.number()));
        own.flat_map(|row| &row.words).find(|(written, _)| is(written)).map(|(_, role)| *role)
    }

    /// The words that the codes of a name take.
    pub fn act_words(&self, act: Act) -> Vec<Role> {
        let rows = self.dialect().codes.iter();
        let own = rows.filter(|row| row.op == Op::Act && row.fixed.get(&Role::Act) == Some(&act.number()));
        own.flat_map(|row| row.words.values().copied()).collect()
    }
}

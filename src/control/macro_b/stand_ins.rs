//! Codes of the machine's builder for which the profile has a stop or an alarm: what an operator and the words of their block do then.

use super::code::Meaning;
use super::run::Runner;
use crate::canon::{Act, Op, Role};
use crate::dialect::Without;
use crate::text::variable_to_set;

impl Runner<'_> {
    /// The variable that a builder's code asks the operator for: its profile says by the text of the stop that stands for it.
    pub(super) fn asks_at(&self, role: Role, act: f64) -> Option<u32> {
        let act = Act::of(act).filter(|_| role == Role::Act)?;
        let site = self.session.control.site_of(act)?;
        let stands = site.without == Some(Without::Stop) && site.name.is_none();
        variable_to_set(&site.text, &["#"]).filter(|_| stands).map(|name| name.number)
    }

    /// True where a builder's G code stands alone, and the profile has an alarm for it without saying what its words are: they are its
    /// own, and move nothing.
    pub(super) fn is_alarm_alone(&self, meaning: &Meaning) -> bool {
        let [code] = meaning.codes.as_slice() else { return false };
        let Some(row) = self.row(code.row).filter(|row| row.op == Op::Act && code.letter == 'G') else {
            return false;
        };
        let act = row.fixed.get(&Role::Act).and_then(|act| Act::of(*act));
        let site = act.and_then(|act| self.session.control.site_of(act));
        site.is_some_and(|site| {
            let named = site.name.is_some() || site.target.is_some();
            site.without == Some(Without::Alarm) && !named && site.words.is_empty()
        })
    }
}

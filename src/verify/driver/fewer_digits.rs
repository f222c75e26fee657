//! Whether the last digits of the target's arithmetic decide what it does.

use super::verifier::Verifier;
use crate::control::trace::Event;
use crate::control::{FEWER_DIGITS, ProgramRef, Run, Scenario};
use crate::verify::compare::compare;
use crate::verify::sides::SymbolMap;

impl Verifier<'_, '_> {
    /// The target's run with fewer digits, their last ones rounded or drawn with a seed.
    fn nudged(&self, (there, circumstances): (ProgramRef, &Scenario), last_digits: Option<u64>) -> Run {
        let target = self.job.target;
        let nudged = Scenario { digits: Some(FEWER_DIGITS), last_digits, ..circumstances.clone() };
        target.run(there, &nudged)
    }

    /// True where the target does something else with fewer digits: rounded, and off by errors that are drawn, and their
    /// opposites, for where rounding hits a tie other errors miss it. Nothing after `upto` counts: from there on the source
    /// does not say what the target should do.
    ///
    /// Errors are drawn for the first runs, and for each that went a new way.
    pub(super) fn is_sensitive(
        &self,
        of: (ProgramRef, &Scenario),
        run: &Run,
        upto: Option<Option<&Event>>,
        went_new_way: bool,
    ) -> bool {
        // With fewer digits it would be the same run.
        if !run.lacked_digits {
            return false;
        }
        let target = self.job.target;
        let place = |event: Option<&Event>| {
            let is = |other: &Event| event.is_some_and(|event| std::ptr::eq(event, other));
            run.events.iter().position(is).unwrap_or(run.events.len())
        };
        let differs = |nudged: &Run| {
            let apart = compare((target, run), (target, nudged), &SymbolMap::default(), self.tolerance);
            let at = apart.difference.map(|difference| place(difference.source));
            at.is_some_and(|at| upto.is_none_or(|upto| at < place(upto)))
        };
        let rounded = self.nudged(of, None);
        let seed = 2 * self.compared as u64;
        let mut drawn = [seed, seed + 1].into_iter().map(|seed| self.nudged(of, Some(seed)));
        let is_drawn = rounded.lacked_digits && (went_new_way || self.compared <= self.job.effort.drawn);
        differs(&rounded) || (is_drawn && drawn.any(|nudged| differs(&nudged)))
    }

    /// True where the target goes elsewhere, by however little, with fewer digits.
    pub(super) fn wavers(&self, of: (ProgramRef, &Scenario), run: &Run) -> bool {
        if !run.lacked_digits {
            return false;
        }
        let target = self.job.target;
        let nudged = self.nudged(of, None);
        let apart = compare((target, run), (target, &nudged), &SymbolMap::default(), self.tolerance);
        apart.difference.is_some() || apart.hair.is_some()
    }
}

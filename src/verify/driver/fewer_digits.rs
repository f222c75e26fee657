//! Whether the last digits of the target's arithmetic decide what it does.

use super::verifier::Verifier;
use crate::control::trace::Event;
use crate::control::{FEWER_DIGITS, ProgramRef, Run, Scenario};
use crate::verify::compare::compare;
use crate::verify::sides::SymbolMap;

impl Verifier<'_, '_> {
    /// The target's run with fewer digits, their last ones rounded or drawn with a seed.
    fn nudged(&self, (there, circumstances): (ProgramRef, &Scenario), last_digits: Option<u64>) -> Run {
        self.off((there, circumstances), last_digits, false)
    }

    /// The same; where all but functions comes to the same on both machines, functions alone are off.
    fn off(&self, of: (ProgramRef, &Scenario), last_digits: Option<u64>, functions_only: bool) -> Run {
        let (there, circumstances) = of;
        let digits = Some(FEWER_DIGITS);
        self.job.target.run(there, &Scenario { digits, last_digits, functions_only, ..circumstances.clone() })
    }

    /// True if both machines are said to calculate with doubles: sums, products and quotients of the same operands come to
    /// the same on both.
    fn calculate_alike(&self) -> bool {
        [self.job.source, self.job.target].iter().all(|side| side.control.is_said_double())
    }

    /// True where the target does something else with fewer digits: rounded, and off by errors that are drawn, and their
    /// opposites, for where rounding hits a tie other errors miss it. Nothing after `upto` counts: from there on the source
    /// does not say what the target should do.
    ///
    /// Errors are drawn for the first runs, and for each that went a new way. Of machines that are both said to calculate with
    /// doubles they are errors of functions, which nobody says to be the same on both.
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
        let functions = self.calculate_alike();
        let rounded = self.off(of, None, functions);
        let seed = 2 * self.compared as u64;
        let mut drawn = [seed, seed + 1].into_iter().map(|seed| self.off(of, Some(seed), functions));
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

//! What a called program does where it begins otherwise than in what its callers give it.

use super::Verifier;
use crate::canon::Op;
use crate::control::ProgramRef;
use crate::verify::certificate::Why;
use crate::verify::given::Given;
use crate::verify::scenarios::unit;

impl Verifier<'_, '_> {
    /// Looks at what the program does in the other unit that callers come in, and as after power-on in the machine's own
    /// unit, where its callers run it otherwise.
    ///
    /// What no caller gives it is no fault. Where none comes to it, the modes that it was run in are those in
    /// which their runs ended, and may not be those of the call: a difference counts that shows in the modes of power-on
    /// too. The unit counts, for a library names it at the heads of its programs.
    pub(super) fn elsewhere(&mut self, there: ProgramRef) {
        let own = unit(self.job.source, self.job.target).unwrap_or(false);
        if self.given.never_come_to && !self.given.unlike_power_on().is_empty() {
            let plain = self.begun_as(self.given.unit_alone(), there);
            let (here, other) = (self.witness.take(), plain.witness);
            let only = here.as_ref().xor(other.as_ref()).map(|witness| witness.what.clone());
            match only {
                None => self.witness = here,
                Some(what) => {
                    let (modes, power_on) = (in_words(&self.given, own), "as after power-on");
                    let (bad, good) = if here.is_some() { (&*modes, power_on) } else { (power_on, &*modes) };
                    let text = format!(
                        "no run of what calls it comes to it: {good} it does the same, {bad} not: {what}"
                    );
                    self.because(Why::NotByItself, &text);
                }
            }
        }
        for inch in self.given.both_units().filter(|inch| *inch != own).collect::<Vec<_>>() {
            if self.witness.is_none() {
                let other = self.begun_as(self.given.in_unit(inch), there);
                (self.witness, self.shown) = (other.witness, other.shown);
            }
        }
        let is_own = self.given.inch().is_none_or(|given| given == own);
        let is_plain = self.given.never_come_to || self.given.unlike_power_on().is_empty();
        if self.witness.is_some() || (is_own && is_plain) {
            return;
        }
        let Some(witness) = self.begun_as(Given::default(), there).witness else { return };
        let given = in_words(&self.given, own);
        let whose = if self.given.never_come_to {
            "in which the runs of its callers end before they come to it"
        } else {
            "as its callers run it"
        };
        let text = format!("{given}, {whose}, it does the same; otherwise not: {}", witness.what);
        self.because(Why::NotByItself, &text);
    }

    /// The program tried anew, in other circumstances.
    fn begun_as(&self, given: Given, there: ProgramRef) -> Self {
        let mut other = Self { given, ..Self::new(self.job, self.program) };
        other.search(there);
        other
    }
}

/// What a program is given that is not as after power-on: `in inches, distance.incremental`.
fn in_words(given: &Given, own: bool) -> String {
    let unit =
        given.inch().filter(|inch| *inch != own).map(|inch| if inch { "inches" } else { "millimetres" });
    let modes = given.unlike_power_on().iter().map(Op::to_string).collect::<Vec<_>>();
    let all = unit.map(str::to_owned).into_iter().chain(modes);
    format!("in {}", all.collect::<Vec<_>>().join(", "))
}

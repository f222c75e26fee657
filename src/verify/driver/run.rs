//! The verification of programs, step by step.

use super::as_called::AsCalled;
use super::verifier::Verifier;
use crate::control::ProgramRef;
use crate::verify::certificate::{Certificate, ProgramCertificate, Why, implicate};
use crate::verify::entry::look_at_callers;
use crate::verify::sides::Job;
use rayon::prelude::*;

/// Verifies programs of the source; all of them where none is named.
pub fn verify(job: &Job<'_>, programs: &[ProgramRef]) -> Certificate {
    let all = if programs.is_empty() { job.source.links().programs().to_vec() } else { programs.to_vec() };
    prepare(job, &all);
    let found = all.into_par_iter().map(|program| Verifier::new(job, program).run()).collect();
    let mut certificate = Certificate::new(job.source.control, job.target.control, job.effort, found);
    implicate(std::slice::from_mut(&mut certificate).iter_mut());
    certificate
}

/// Works out on all cores what programs have in common; whoever calls [`verify`] for several files at a time does this
/// before.
pub fn prepare(job: &Job<'_>, programs: &[ProgramRef]) {
    look_at_callers(job, programs);
}

impl Verifier<'_, '_> {
    fn run(mut self) -> ProgramCertificate {
        let Job { source, target, names, .. } = self.job;
        let there = names.program(source, self.program, target);
        match (there, there.map(|_| self.as_called())) {
            (None, _) => self.because(Why::NoTarget, "the target has no such program"),
            (_, Some(AsCalled::Shown)) => {}
            (Some(there), Some(AsCalled::Open)) if self.with_arguments(there) => {}
            (Some(there), _) => self.all(there),
        }
        self.job.spent.add(&self.clock);
        self.certificate(there)
    }

    /// All runs of a program by itself, and of its callers for what is in force.
    pub(super) fn all(&mut self, there: ProgramRef) {
        self.search(there);
        self.in_modes_left(there);
        self.in_other_unit(there);
        self.otherwise(there);
        self.entries(there);
        self.elsewhere(there);
        self.edited(there);
    }
}

//! How many programs came out how.

use super::Part;
use crate::library::Outcome;
use crate::verify;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// How many programs came out how.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Totals {
    /// Files read.
    pub files: usize,
    /// Programs in them.
    pub programs: usize,
    /// Programs that do the same by all that is known.
    pub converted: usize,
    /// Programs of which a person has accepted all that must hold.
    pub accepted: usize,
    /// Programs that a person must look at.
    pub review: usize,
    /// Programs without a conversion.
    pub refused: usize,
    /// Conversions that were verified to be the same.
    pub verified: usize,
    /// Conversions that the verifier could not decide on.
    pub undecided: usize,
    /// Conversions that the verifier found to differ; they are among the refused.
    pub different: usize,
    /// How many programs have each code.
    pub codes: BTreeMap<&'static str, usize>,
}

impl Totals {
    /// Counts conversions.
    pub fn of(parts: &[Part<'_>]) -> Self {
        let mut totals = Self::default();
        for part in parts {
            totals.files += part.files();
            for (_, program) in part.programs() {
                totals.programs += 1;
                *match program.outcome {
                    Outcome::Converted => &mut totals.converted,
                    Outcome::Accepted => &mut totals.accepted,
                    Outcome::Review => &mut totals.review,
                    Outcome::Refused => &mut totals.refused,
                } += 1;
                match program.verdict {
                    Some(verify::Outcome::Same) => totals.verified += 1,
                    Some(verify::Outcome::Undecided) => totals.undecided += 1,
                    Some(verify::Outcome::Different) => totals.different += 1,
                    None => {}
                }
                let codes: BTreeSet<_> = program.diagnostics.iter().map(|d| d.code).collect();
                codes.into_iter().for_each(|code| *totals.codes.entry(code.number()).or_default() += 1);
            }
        }
        totals
    }
}

impl std::fmt::Display for Totals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            files,
            programs,
            converted,
            accepted,
            review,
            refused,
            verified,
            undecided,
            different,
            ..
        } = self;
        let (program, file) = (plural(*programs, "program"), plural(*files, "file"));
        write!(f, "{program} in {file}: {converted} converted, ")?;
        if *accepted > 0 {
            write!(f, "{accepted} accepted, ")?;
        }
        write!(f, "{review} for review, {refused} refused")?;
        if verified + undecided + different > 0 {
            write!(f, "; {verified} verified, {undecided} undecided, {different} different")?;
        }
        Ok(())
    }
}

/// So many of a thing.
pub(super) fn plural(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

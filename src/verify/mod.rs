//! Runs a program and its conversion on their own controls, and says whether the machines do the same.
//!
//! The verifier reads `syntax` and drives `control`; it knows nothing of `lower`, `legalize` and
//! `emit`, so that a fault of theirs cannot hide in it. What it is told of a conversion is the map of
//! registers and program numbers that a reviewer reads too ([`SymbolMap`]).
//!
//! What is compared is what an observer of the machine could tell: moves with their feeds, arcs,
//! dwells, spindle, coolant, tools, offsets written, stops, alarms, output, questions, how the run ended,
//! and the final values of the variables that both sides keep. Calls, temporaries, and the
//! order of settings between two moves are not observable.
//!
//! The outcome of a program is [`Outcome::Same`] only where every run agreed, every branch of
//! the source went every way, and nothing that mattered rests on an unconfirmed fact.

mod assumed;
mod branches;
mod callers;
mod certificate;
mod clock;
mod compare;
mod constants;
mod differ;
mod edits;
mod entry_state;
mod exit_state;
mod inputs;
mod letters;
mod links;
mod loose;
mod observe;
mod paths;
mod pauses;
mod program;
mod questions;
mod random;
mod rounding;
mod scenarios;
mod side;
mod starts;
mod stops;
mod substitutes;
mod symbol_map;
#[cfg(test)]
mod tests;
mod texts;
mod variables;

pub use assumed::Assumptions;
pub use branches::NotReached;
pub use callers::implicate;
pub use certificate::{
    Assumed, Certificate, Identity, Moment, ProgramCertificate, Reason, Why, Witness, sha256,
};
pub use clock::Spent;
pub use program::{Job, prepare, verify};
pub use side::Side;
pub use symbol_map::SymbolMap;

/// What a verification amounts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Both sides did the same in all that was tried, and all was tried.
    Same,
    /// No difference was found, but something was not looked at or cannot be said.
    Undecided,
    /// They differ, and the witness says where.
    Different,
}

/// How much a verification may do.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Scenarios that are compared, at the most.
    pub scenarios: usize,
    /// Scenarios that the source is tried with in search of new branches, at the most.
    pub tries: usize,
    /// Blocks that a run executes, at the most.
    pub steps: u64,
    /// Blocks that all runs of a program's source execute together, at the most.
    pub all_steps: u64,
    /// Seed of the scenarios that are drawn.
    pub seed: u64,
    /// Seconds of processor time for one program, at the most.
    pub program_seconds: f64,
    /// Seconds of processor time for all programs of a library together, at the most.
    pub library_seconds: f64,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            scenarios: 160,
            tries: 400,
            steps: 50_000,
            all_steps: 1_000_000,
            seed: 0x6d67_0001,
            program_seconds: 60.0,
            library_seconds: 3600.0,
        }
    }
}

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
//!
//! Its rooms stand in one order, in which each uses only those before it: `sides`, `compare`, `explore`, `certificate`,
//! `entry`, `triage`, `driver`. `tests/architecture.rs` fails otherwise.

mod certificate;
mod compare;
mod driver;
mod entry;
mod explore;
mod sides;
#[cfg(test)]
mod tests;
mod triage;

pub use certificate::{
    Assumed, Certificate, Change, Identity, Listing, Moment, OpenFact, Outcome, ProgramCertificate, Reason,
    Seen, Why, Witness, implicate,
};
pub use driver::{Picture, listed, pictured, prepare, verify};
pub use explore::NotReached;
pub use sides::{Assumptions, Effort, Job, Side, Spent, SymbolMap, beside, class_of, name_of, sha256};

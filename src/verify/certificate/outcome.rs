//! What a verification amounts to, and why.

use serde::Serialize;

/// What a verification amounts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Both sides did the same in all that was tried, and all was tried.
    Same,
    /// No difference was found, but something was not looked at or cannot be said.
    Undecided,
    /// They differ, and the witness says where.
    Different,
}

/// Why a program is undecided.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reason {
    /// The kind of reason.
    pub why: Why,
    /// In words.
    pub text: String,
}

/// Kinds of reasons for being undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Why {
    /// The target has no such program.
    NoTarget,
    /// No scenario could be compared to its end.
    NothingCompared,
    /// A control could not run it.
    CannotRun,
    /// A run did not come to its end.
    Endless,
    /// Its verification took the processor time that it may.
    OutOfTime,
    /// The source stops with an alarm of its control where the target goes on, or stops elsewhere.
    SourceAlarms,
    /// The target cannot do what the source does, and does something else or nothing in its place.
    Substituted,
    /// A run breaks what the conversion supposes, and what comes then was not compared.
    Condition,
    /// No run kept something that the conversion supposes.
    NoRunKept,
    /// It calls a program that is not written.
    Callee,
    /// It does the same as its library calls it, but something else where it is run by itself.
    NotByItself,
    /// With another literal at the head of both texts they do different things.
    Edited,
    /// What the source does rests on a state that it finds on the machine, and from another one they do different things.
    EntryState,
    /// A branch went one way only.
    NotReached,
    /// Something rests on a fact that no source confirms.
    Unconfirmed,
}

//! Facts that no source confirms, in words.

use super::moment::Moment;
use crate::dialect::{Question, Side, matters};

/// A fact that no source confirms, and that nobody reported.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenFact {
    /// Its name.
    pub fact: String,
    /// The side whose machine profile can confirm it.
    pub side: Side,
    /// What it asks, and where it mattered first.
    pub text: String,
}

impl OpenFact {
    /// One that mattered first at a moment of a run.
    pub fn new(fact: &str, side: Side, at: &Moment) -> Self {
        Self { fact: fact.to_owned(), side, text: unconfirmed(fact, side, at) }
    }
}

fn unconfirmed(fact: &str, side: Side, at: &Moment) -> String {
    let meaning = Question::of_fact(fact).map(Question::meaning).or_else(|| matters::meaning(fact));
    let what = meaning.map(|meaning| format!(" ({meaning})")).unwrap_or_default();
    let (line, file, block) = (at.line, &at.file, at.block.trim());
    format!("no manual confirms '{fact}'{what}: the {side} depends on it in line {line} of {file}, '{block}'")
}

//! Facts that no source confirms, in words.

use super::moment::Moment;
use crate::dialect::{Question, matters};

/// Says that a fact is not confirmed, what it asks, and where it mattered first. The machine profile of that `side`
/// can confirm it.
pub fn unconfirmed(fact: &str, side: &str, at: &Moment) -> String {
    let meaning = Question::of_fact(fact).map(Question::meaning).or_else(|| matters::meaning(fact));
    let what = meaning.map(|meaning| format!(" ({meaning})")).unwrap_or_default();
    let (line, file, block) = (at.line, &at.file, at.block.trim());
    format!("no manual confirms '{fact}'{what}: the {side} depends on it in line {line} of {file}, '{block}'")
}

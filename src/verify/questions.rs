//! Facts that no source confirms, in words.

use super::certificate::Moment;
use crate::dialect::{behaviours, matters};

/// Says that a fact is not confirmed, what it asks, and where it mattered first. The machine profile of that `side`
/// can confirm it.
pub fn unconfirmed(fact: &str, side: &str, at: &Moment) -> String {
    let question = fact.strip_prefix("behaviour:").and_then(behaviours::find);
    let meaning = question.map(|question| question.meaning).or_else(|| matters::meaning(fact));
    let what = meaning.map(|meaning| format!(" ({meaning})")).unwrap_or_default();
    let (line, file, block) = (at.line, &at.file, at.block.trim());
    format!("{fact} is not confirmed{what}: the {side} rests on it in line {line} of {file}, '{block}'")
}

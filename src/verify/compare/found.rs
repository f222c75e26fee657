//! What a comparison of two runs found.

use crate::canon::Op;
use crate::control::trace::Event;
use std::collections::BTreeSet;

/// What a comparison found.
#[derive(Clone, Debug, Default)]
pub struct Comparison<'r> {
    /// The first difference.
    pub difference: Option<Difference<'r>>,
    /// The first difference that is no more than a least increment, where the words of both sides rounded less.
    pub hair: Option<Difference<'r>>,
    /// The largest distance between positions that counted as the same, millimetres.
    pub largest: f64,
    /// Texts that are written differently: messages, outputs, alarm numbers.
    pub texts: BTreeSet<(String, String)>,
    /// What the target cannot do and did otherwise, or left out.
    pub substituted: BTreeSet<String>,
    /// The same of operations that the target has not, which the conversion may have told.
    pub replaced: BTreeSet<(Op, String)>,
    /// What the target stops for good for: a builder's code, in whose place the source's profile wants an alarm.
    pub stopped: Option<String>,
}

/// A difference: the events that should be the same, where there are any, and what is wrong.
#[derive(Clone, Debug)]
pub struct Difference<'r> {
    /// Of the source.
    pub source: Option<&'r Event>,
    /// Of the target.
    pub target: Option<&'r Event>,
    /// What differs.
    pub what: String,
    /// True for a variable that is just as far off as a place that was read.
    pub by_place: bool,
}

impl<'r> Difference<'r> {
    /// A difference of two events; none for a side that does nothing more, or for what is seen at the end.
    pub fn new(source: Option<&'r Event>, target: Option<&'r Event>, what: String) -> Self {
        Self { source, target, what, by_place: false }
    }
}

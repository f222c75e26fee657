//! Expressions and conditions that the target can read.

pub(in crate::legalize) mod codes_by_variable;
pub(in crate::legalize) mod conditions;
pub(in crate::legalize) mod constants;
pub(in crate::legalize) mod cost;
pub(in crate::legalize) mod functions;
pub(in crate::legalize) mod halves;
pub(in crate::legalize) mod operands;
pub(in crate::legalize) mod split;
pub(in crate::legalize) mod truth;
pub(in crate::legalize) mod whole_words;

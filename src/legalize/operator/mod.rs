//! What the operator reads and answers.

pub(in crate::legalize) mod alarms;
pub(in crate::legalize) mod formatted;
pub(in crate::legalize) mod letters;
pub(in crate::legalize) mod messages;
pub(in crate::legalize) mod omitted;
pub(in crate::legalize) mod ports;
pub(in crate::legalize) mod questions;
pub(in crate::legalize) mod renamed;
mod rounded;
pub(in crate::legalize) mod shown_stops;
pub(in crate::legalize) mod switches;
pub(in crate::legalize) mod variable_names;

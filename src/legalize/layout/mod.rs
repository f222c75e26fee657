//! Sequence numbers, program numbers and blocks without words.

pub(in crate::legalize) mod blanks;
pub(in crate::legalize) mod emptied;
pub(in crate::legalize) mod heads;
pub(in crate::legalize) mod macro_lines;
pub(in crate::legalize) mod program_numbers;
pub(in crate::legalize) mod sequence_numbers;

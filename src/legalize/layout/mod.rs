//! Sequence numbers, program numbers and blocks without words.

pub(in crate::legalize) mod blank_lines;
pub(in crate::legalize) mod blanks;
pub(in crate::legalize) mod counted;
pub(in crate::legalize) mod earlier;
pub(in crate::legalize) mod emptied;
mod head_text;
pub(in crate::legalize) mod heads;
pub(in crate::legalize) mod line_comments;
pub(in crate::legalize) mod macro_lines;
pub(in crate::legalize) mod program_numbers;
pub(in crate::legalize) mod scratch;
pub(in crate::legalize) mod sequence_numbers;
pub(in crate::legalize) mod skip_runs;
pub(in crate::legalize) mod text_ends;

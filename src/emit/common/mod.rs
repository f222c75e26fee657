//! What the text of every target needs: the layout of a program's blocks, the numbers that jumps find them by,
//! digits, what a comment can hold, and lines with what stands before and after their words.
//!
//! Nothing here knows how a target spells what stands on a line.

pub mod comments;
pub mod digits;
pub mod flow;
pub mod labels;
pub mod lines;
pub mod loops;
pub mod reach;
pub mod sheet;
pub mod spellings;
pub(in crate::emit) mod taken;

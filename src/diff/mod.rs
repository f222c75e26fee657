//! What changed for the machine between two programs, or two libraries.
//!
//! Four levels: the text; the text without what no machine sees; the build of each program;
//! and what the machine does, found by running both on their emulated controls. The last decides: [`Verdict`]. A program
//! in which nothing changed for its control, nor in anything that it may call, is the same without being run.

mod labels;
mod lines;
mod normal;
mod programs;
mod renamed;
mod result;
mod sides;
mod structure;
mod whole;

pub use normal::variables;
pub use result::{
    Diff, FORMAT, FileDiff, Hunk, Line, Note, On, Pictured, Piece, ProgramDiff, Renamed, Text, Verdict,
};
pub use sides::Shelf;
pub use whole::{Levels, Request, diff, normalised};

//! What a file and its programs consist of.

mod contents;
mod labels;
mod split;

pub use contents::{Words, acts, literal, site};
pub use labels::{Label, Labels};
pub use split::{Piece, cuts, split};

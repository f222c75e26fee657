//! Reviews that somebody accepted: kept in the project file with who, when and the hash of what they concerned, and asked
//! again when that changes.
//!
//! - `entry`: what stands in the project file.
//! - `scope`: the hash of what a question concerns.
//! - `questions`: what a conversion asks, program by program, and once for the library.
//! - `answers`: which question has an answer, and what that makes of the programs.
//! - `everywhere`: what is accepted of the programs themselves, for every machine they go to.
//! - `select`: which of them a person accepts.
//! - `edit`: puts entries into the text of the project file, and leaves the rest of it as it stands.

mod answers;
mod edit;
mod entry;
mod everywhere;
mod questions;
mod scope;
mod select;

pub use answers::{Answered, Asked, Fit, answered};
pub use edit::{Edit, edited};
pub use entry::{Entry, acceptable};
pub use everywhere::{Answers, OfPrograms};
pub(super) use questions::seen_from;
pub use questions::{Question, asks_any, questions};
pub use scope::Scopes;
pub use select::{Chosen, Signer, edits};

//! What is compared: two libraries on their controls, and what a verification is told of them.
//!
//! All other rooms use these types; none of these knows what a run shows.

mod arguments;
mod clock;
mod edited_text;
mod entry_state;
mod hash;
mod job;
mod links;
mod names;
mod numbers;
mod outside;
mod program_texts;
mod side;
mod stands;
mod symbol_map;

pub use arguments::Arguments;
pub use clock::{Clock, Spent};
pub use edited_text::EditedText;
pub use entry_state::EntryState;
pub use hash::{hex, sha256};
pub use job::{Assumptions, Effort, Job, of_target};
pub(in crate::verify) use names::numbered;
pub use names::{class_of, name_of};
pub use outside::beside;
pub use side::Side;
pub use symbol_map::SymbolMap;

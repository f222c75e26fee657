//! Bytes to lines and back, with nothing lost.
//!
//! A program file is cut at its line ends only: CRLF, LF, a lone CR, and a
//! mixture of them are all kept as they stand. Nothing is decoded but the text
//! of comments and messages, where a person reads it ([`decode`]): every
//! position in the project is a byte offset into the file ([`Span`]).

mod columns;
mod json;
mod letters;
mod lines;
mod names;
mod shown;
mod span;

pub use columns::CodePoints;
pub use json::{Texts, json, json_pretty, write_json, write_json_pretty};
pub use letters::{decode, likeness};
pub use lines::{Line, Lines, MAX_FILE};
pub use names::{VariableName, variable_names, variable_to_set};
pub use shown::{acts, shown, shown_lines};
pub use span::{LineIndex, Span};

//! What changed for the machine, for people and for programs.

mod html;
mod markdown;
mod sarif;
mod text;
mod words;

pub use html::diff as html;
pub use markdown::diff as markdown;
pub use sarif::diff as sarif;
pub use text::{Colour, diff as text};
pub use words::{headline, lines as change_lines, what as change_text};

use crate::diff::Diff;
use crate::text::json_pretty;

/// A diff as JSON; `docs/diff.md` explains its keys.
pub fn json(diff: &Diff) -> String {
    json_pretty(diff) + "\n"
}

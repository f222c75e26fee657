//! What people and programs are told: one renderer a format, one file each.

mod accepting;
mod asked;
mod certificate;
pub mod check;
mod date;
pub mod diff;
mod drawn;
mod html;
mod json;
mod markdown;
mod part;
mod plot;
mod question_groups;
mod questions;
mod sarif;
mod text;
mod totals;
mod trace;

pub use accepting::{Accepting, accepting};
pub use asked::asked;
pub use certificate::certificate;
pub use date::Date;
pub use drawn::Drawings;
pub use html::conversion as html;
pub use json::{conversion as json, write_conversion as write_json};
pub use markdown::conversion as markdown;
pub use part::{Part, Place};
pub use plot::{Coordinates, PairOfRuns, backplot, pair, png};
pub use questions::{Fact, Machine, Question, Questions};
pub use sarif::conversion as sarif;
pub use text::{Sheet, explain, left_out_text, outcomes, summary};
pub use totals::Totals;
pub use trace::{TraceFormat, TraceWriter};

use crate::diag::Severity;
use crate::library::Outcome;

/// An outcome, in the words of reports.
fn words(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Converted => "converted",
        Outcome::Accepted => "accepted",
        Outcome::Review => "for review",
        Outcome::Refused => "refused",
    }
}

/// A severity, in the words of reports.
fn grade(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Review => "review",
        Severity::Note => "note",
    }
}

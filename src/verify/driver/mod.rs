//! The verification of a program from its first run to its certificate.

mod as_called;
mod by_registers;
mod edited;
mod elsewhere;
mod entries;
mod fewer_digits;
mod kept;
mod left_modes;
mod listed;
mod otherwise;
mod pictured;
mod run;
mod search;
mod settled;
mod steered;
mod steered_conditions;
mod steered_edits;
mod stuck;
mod summary;
mod supposed;
mod trial;
mod twins;
mod unit_check;
mod unusual;
mod verifier;
mod weigh;

pub use listed::listed;
pub use pictured::{Picture, pictured};
pub use run::{prepare, verify};

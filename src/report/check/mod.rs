//! What a check found, for people and for programs: one renderer a format.

mod github;
mod json;
mod junit;
mod sarif;
mod text;

pub use github::check as github;
pub use json::check as json;
pub use junit::check as junit;
pub use sarif::check as sarif;
pub use text::{check as text, statistics};

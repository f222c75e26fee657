//! Which modal state holds at each block: the parts of a program's text, and the ways through it.

mod exit_modes;
mod others;
mod settings;
mod shape;
mod state;
#[cfg(test)]
mod tests;
mod ways;

pub use others::Others;
pub use shape::{Goal, Shape, goal, return_goal};
pub use state::{DEFAULT_PLACES, State};
pub use ways::{Flow, end_skips};

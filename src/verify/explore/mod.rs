//! The search for runs that tell something: what a program takes from outside, the circumstances that it is tried in, and
//! which ways its branches went.

mod branches;
mod constants;
mod inputs;
mod random;
mod scenarios;

pub use branches::{Coverage, NotReached};
#[cfg(test)]
pub use inputs::Inputs;
pub use inputs::{inputs, inputs_of_both};
pub use scenarios::{Proposals, asked, on_target, set_by_hand, unit};

//! The search for runs that tell something: what a program takes from outside, the circumstances that it is tried in, and
//! which ways its branches went.

mod alarms;
mod branches;
mod constants;
mod inputs;
mod nearby;
mod on_target;
mod random;
mod scenarios;
mod settled;
mod steer;

pub use alarms::compare_alarms;
pub use branches::{Coverage, NotReached};
pub use constants::{Given, ends_head};
pub use inputs::{Inputs, inputs, inputs_of_both};
pub use nearby::{hangs_on, in_order};
pub use on_target::{asked, on_target, set_by_hand, unit};
pub use scenarios::Proposals;
pub use settled::{by_own_numbers, is_settled};
pub use steer::{Attempt, Circumstances, Input, Steer, inputs_of};

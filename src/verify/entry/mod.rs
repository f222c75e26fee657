//! What programs find in force where they begin: what their callers give, and the states of a machine that may be found.

mod given;
mod looks;
mod starts;

pub use given::{given, look_at_callers};
pub use looks::{is_root, scenarios};
pub use starts::{CYCLE, Start, UNIT, leaves_cycle, starts};

//! Whether a difference is held against the conversion: what it supposes, what callers do, where the source's control
//! stops by itself, and what no source says of rounding.

mod assumed;
mod callers;
mod computed;
mod rounding;
mod standing;
mod stops;

pub use assumed::{Tried, excuse, facts, moved, telling_numbers, told_substitutes, tried};
pub use callers::{Shown, Through, through, ways};
pub use computed::off;
pub use rounding::{ROUNDS, hangs_on_rounding};
pub use stops::{off_its_circle, stops_by_itself};

//! Whether two runs amount to the same for who watches the machines.

mod aligned;
mod all;
mod arcs;
mod builders;
mod deeds;
mod differ;
mod exit_state;
mod found;
mod kinds;
mod lengths;
mod letters;
mod loose;
mod observe;
mod pairs;
mod paths;
mod pauses;
mod renamed;
mod roughing;
mod shown;
mod substitutes;
mod texts;
mod threads;
mod tolerance;
mod unseen;
mod variables;
mod waits;

pub use all::{Apart, differences};
#[cfg(test)]
pub use exit_state::seen_differs;
pub use found::Difference;
pub use kinds::{is_cut, is_move, is_pause, returns, setting};
pub use pairs::compare;
pub use shown::lacks_messages;
pub use substitutes::lacks;
pub use texts::say_the_same;
pub use tolerance::Tolerance;
pub use variables::writes_elsewhere;

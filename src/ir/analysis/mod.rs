//! Questions about programs: where control goes, which temporaries are live, what may be vacant, which
//! constants a variable may hold, between which bounds.
//!
//! Every answer errs to the safe side. Nothing recurses on the size of a program.

mod call_graph;
mod cfg;
mod dominators;
mod effects;
mod liveness;
mod loops;
mod ranges;
mod set;
mod temps;
mod vacancy;
mod values;

pub use call_graph::CallGraph;
pub use cfg::{Cfg, may_come_back};
pub use dominators::Dominators;
pub use effects::{Seen, Summaries, Vars};
pub use liveness::{Liveness, Transfer, Ways, behind, live_before};
pub use loops::{Loop, Loops};
pub use ranges::{Numbers, Ranges, Values};
pub use set::{Row, Universe, VarSet};
pub use temps::Temps;
pub use vacancy::Vacancy;
pub use values::{Constant, values_at};

/// Whether something holds of a thing at the place that is being visited.
pub type Holds<'a, T> = &'a dyn Fn(&T) -> bool;

#[cfg(test)]
mod tests;

//! Questions about programs: where control goes, which temporaries are live, what may be vacant, which
//! constants a variable may hold, between which bounds.
//!
//! Every answer errs to the safe side. Nothing recurses on the size of a program. What is followed until nothing
//! changes is followed by [`dataflow`].

mod call_graph;
mod cfg;
pub mod dataflow;
mod effects;
mod liveness;
mod ranges;
mod set;
mod temps;
mod vacancy;
mod values;

pub use call_graph::CallGraph;
pub use cfg::{Cfg, may_come_back};
pub use effects::{Seen, Summaries, Vars};
pub use liveness::{Liveness, Transfer, Ways, live_after};
pub use ranges::{Numbers, Ranges, Values};
pub use set::{Row, Universe, VarSet};
pub use temps::Temps;
pub use vacancy::Vacancy;
pub use values::{Constant, values_at};

/// Whether something holds of a thing at the place that is being visited.
pub type Holds<'a, T> = &'a dyn Fn(&T) -> bool;

#[cfg(test)]
mod tests;

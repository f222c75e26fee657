//! Questions about programs: where control goes, which temporaries are live, what may be vacant, which
//! constants a variable may hold, between which bounds, what is in force, what calls come to.
//!
//! Every answer errs to the safe side. Nothing recurses on the size of a program. What is followed until nothing
//! changes is followed by [`dataflow`].

mod arrivals;
pub(crate) mod behind;
mod block_calls;
mod call_graph;
mod cfg;
pub(crate) mod computed_calls;
mod contour;
pub mod dataflow;
mod effects;
mod length_lost;
mod live_statics;
mod liveness;
pub(crate) mod modal;
pub(crate) mod modal_facts;
pub(crate) mod named;
pub mod over_calls;
pub(crate) mod programmed;
mod ranges;
mod set;
mod shared_values;
mod temps;
mod text_ends;
pub(crate) mod tool_word;
mod touches;
mod under_skip;
pub(crate) mod upward_exposed;
mod vacancy;
mod values;

pub use arrivals::{Arrivals, callees};
pub use block_calls::{calls_of, span_of};
pub use call_graph::CallGraph;
pub use cfg::{Cfg, entries, may_come_back, modal_bodies, own_call, reachable};
pub use effects::{Seen, Summaries, Vars};
pub use live_statics::{LiveStatics, statics};
pub use liveness::{Liveness, Transfer, Ways, live_after};
pub use modal::{Modal, Setting};
pub use modal_facts::{ModalFacts, replace_statements};
pub use ranges::{LAST_P, Numbers, Ranges, Values, evaluate};
pub use set::{BitRow, Universe, VarSet};
pub use shared_values::SharedValues;
pub use temps::Temps;
pub use text_ends::{last_place, text_ends};
pub use under_skip::{kept_level, part_under_skip};
pub use vacancy::{Around, Filled, Vacancy};
pub use values::{Assigned, Constant, values_at};

/// Whether something holds of a thing at the place that is being visited.
pub type Holds<'a, T> = &'a dyn Fn(&T) -> bool;

#[cfg(test)]
mod tests;

//! What stands in for something the target lacks does the same.
//!
//! Programs are built in the text form of the IR, legalized by one pass, and run by the IR's own evaluator. Expected
//! values come from the arithmetic of the standard library, bounds from the documentation of each emulation.

mod arcs;
mod bits;
mod conditions;
mod constants;
#[path = "../support/domain.rs"]
mod domain;
mod dwell;
mod functions;
mod harness;
mod levels;
mod operands;
mod oversize;
mod truth;

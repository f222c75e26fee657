//! Calls, jumps, conditions and loops.

mod call;
mod jumps;
mod loops;
mod targets;

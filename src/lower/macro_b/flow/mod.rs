//! Calls, jumps, conditions and loops.

mod call;
mod called_blocks;
mod jumps;
mod loops;
mod targets;

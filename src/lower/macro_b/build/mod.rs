//! A program while it is lowered: what is built, what was found, what holds before the present block.

mod lowering;

pub use lowering::{Loop, Lowering, Motion, RolesUnder, SkippedLoop};

//! What the lowering of macro lines and that of NC words build with.

mod lowering;

pub use lowering::Lowering;

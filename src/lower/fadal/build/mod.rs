//! What the lowering of macro lines and that of NC words build with.

mod lowering;
mod planes;

pub use lowering::Lowering;
pub use planes::{PLANE, Planes};

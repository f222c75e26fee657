//! The codes of the control.

mod lookup;

pub use lookup::{CodeId, Codes};

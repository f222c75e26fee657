//! Registers of the target for everything that programs keep values in.
//!
//! [`allocate`] gives each variable its register, in a map for the whole library ([`map`]); [`locked`] are the choices
//! of earlier runs. Temporaries share registers by their live ranges before that ([`temporaries`]).

pub(in crate::legalize) mod allocate;
pub(in crate::legalize) mod clear;
pub(in crate::legalize) mod frames;
pub(in crate::legalize) mod locked;
pub(in crate::legalize) mod map;
pub(in crate::legalize) mod names;
mod needs;
mod pool;
mod runs;
mod statics;
pub(in crate::legalize) mod temporaries;

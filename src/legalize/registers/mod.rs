//! Registers of the target for everything that programs keep values in.
//!
//! [`frames`] makes statics of locals, on a target that has none. [`temporaries`] and [`statics`] colour what may share:
//! two whose live ranges, calls included, do not meet; [`needs`] tells which must be of a class that words take.
//! [`allocate`] then gives each variable its register, in a map for the whole library ([`map`]); [`locked`] are the choices
//! of earlier runs, [`outside`] tells who sets variables that moved, and [`interface`] where arguments from outside stand.

pub(in crate::legalize) mod allocate;
pub(in crate::legalize) mod clear;
pub(in crate::legalize) mod frames;
pub(in crate::legalize) mod interface;
pub(in crate::legalize) mod locked;
pub(in crate::legalize) mod map;
pub(in crate::legalize) mod names;
pub(in crate::legalize) mod needs;
pub(in crate::legalize) mod outside;
mod pool;
mod results;
mod runs;
mod shortage;
pub(in crate::legalize) mod standing;
mod statics;
pub(in crate::legalize) mod temporaries;

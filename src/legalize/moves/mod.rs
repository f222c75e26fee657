//! Moves, coordinates and units.

pub(in crate::legalize) mod added_angles;
pub(in crate::legalize) mod bare_arcs;
pub(in crate::legalize) mod first_increments;
pub(in crate::legalize) mod home;
pub(in crate::legalize) mod increments;
pub(in crate::legalize) mod inverse_feeds;
pub(in crate::legalize) mod joined;
pub(in crate::legalize) mod machine_feeds;
pub(in crate::legalize) mod machine_moves;
mod mains;
pub(in crate::legalize) mod mixed_places;
pub(in crate::legalize) mod polar;
pub(in crate::legalize) mod rapid_in_force;
pub(in crate::legalize) mod rapid_once;
pub(in crate::legalize) mod reference;
pub(in crate::legalize) mod rotary_places;
pub(in crate::legalize) mod rotary_ways;
pub(in crate::legalize) mod rotations;
pub(in crate::legalize) mod shaped;
pub(in crate::legalize) mod shift;
pub(in crate::legalize) mod short_arcs;
pub(in crate::legalize) mod start;
pub(in crate::legalize) mod under_increments;
pub(in crate::legalize) mod unit_agrees;
pub(in crate::legalize) mod unit_checks;
pub(in crate::legalize) mod units;
pub(in crate::legalize) mod word_rounds;

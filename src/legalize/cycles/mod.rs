//! Drilling cycles and dwells.

pub(in crate::legalize) mod bare_dwells;
pub(in crate::legalize) mod cycle_arcs;
pub(in crate::legalize) mod cycle_ends;
pub(in crate::legalize) mod cycle_here;
pub(in crate::legalize) mod cycle_planes;
pub(in crate::legalize) mod cycle_waits;
pub(in crate::legalize) mod cycle_words;
pub(in crate::legalize) mod drill_planes;
pub(in crate::legalize) mod dwell;
pub(in crate::legalize) mod even_pecks;
mod fine_shifts;
pub(in crate::legalize) mod hole_circles;
pub(in crate::legalize) mod hole_moves;
pub(in crate::legalize) mod inherited_words;
pub(in crate::legalize) mod leadless_taps;
pub(in crate::legalize) mod lone_words;
pub(in crate::legalize) mod missing_pecks;
mod peck_clear;
pub(in crate::legalize) mod pockets;
pub(in crate::legalize) mod rigid_cycles;
pub(in crate::legalize) mod rigid_taps;
pub(in crate::legalize) mod stored_places;
pub(in crate::legalize) mod tap_leads;
mod tap_waits;
pub(in crate::legalize) mod tapping;
pub(in crate::legalize) mod turn_feeds;
pub(in crate::legalize) mod uneven_pecks;

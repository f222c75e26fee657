//! Codes of a block: when they act, how many it takes, and which the target lacks.

pub(in crate::legalize) mod act_speeds;
pub(in crate::legalize) mod acts;
pub(in crate::legalize) mod ahead;
pub(in crate::legalize) mod beside_moves;
pub(in crate::legalize) mod by_number;
pub(in crate::legalize) mod c_axis;
pub(in crate::legalize) mod code_chains;
mod compensated;
pub(in crate::legalize) mod forbidden;
mod found_codes;
mod left_zeros;
pub(in crate::legalize) mod lookahead;
pub(in crate::legalize) mod machine_codes;
pub(in crate::legalize) mod missing;
pub(in crate::legalize) mod offset_chains;
mod outside;
pub(in crate::legalize) mod pauses;
pub(in crate::legalize) mod quality_stops;
pub(in crate::legalize) mod substitutes;
pub(in crate::legalize) mod through_coolant;
pub(in crate::legalize) mod waits;

//! What a conversion takes for granted of the controls and of a run.

pub(in crate::legalize) mod bare_changes;
pub(in crate::legalize) mod barred;
pub(in crate::legalize) mod changes;
pub(in crate::legalize) mod cutter_tables;
pub(in crate::legalize) mod facts;
mod from_home;
pub(in crate::legalize) mod machine_places;
pub(in crate::legalize) mod missing_axes;
mod mistakes;
mod moved_places;
pub(in crate::legalize) mod runtime;
pub(in crate::legalize) mod shop;
pub(in crate::legalize) mod standing;
pub(in crate::legalize) mod top_speed;
pub(in crate::legalize) mod top_tool;
pub(in crate::legalize) mod unchanged_tools;

//! Variables, their registers, and the machine's state in variables.

pub(in crate::legalize) mod banks;
pub(in crate::legalize) mod computed_numbers;
pub(in crate::legalize) mod counted_clears;
mod cycle_seconds;
pub(in crate::legalize) mod dates;
pub(in crate::legalize) mod last_words;
pub(in crate::legalize) mod modal_reads;
pub(in crate::legalize) mod most_values;
pub(in crate::legalize) mod output_codes;
pub(in crate::legalize) mod output_states;
pub(in crate::legalize) mod probe_points;
pub(in crate::legalize) mod retention;
pub(in crate::legalize) mod signals;
pub(in crate::legalize) mod state;
pub(in crate::legalize) mod subscript_chains;
pub(in crate::legalize) mod timers;
pub(in crate::legalize) mod touch_points;
pub(in crate::legalize) mod vacancy;
pub(in crate::legalize) mod vacancy_flags;
pub(in crate::legalize) mod vacant_writes;

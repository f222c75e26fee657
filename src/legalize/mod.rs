//! IR to IR that the target control can say.
//!
//! Nothing here knows a pair of controls. Each pass asks the target whether it
//! has something and, where it has not, puts an emulation in its place: one file
//! each, with its law, its side condition and where it ends. What cannot be
//! emulated becomes a diagnostic of severity error, at its place, and the
//! program is refused.
//!
//! Passes see a whole library, because variables, programs and modal state are shared by it; those that
//! need only one program are given each alone, all of them in a row while it is at hand.

mod active_offsets;
mod alarms;
mod banks;
mod bare_arcs;
mod behind;
mod beside_moves;
mod blanks;
mod carried;
mod census;
mod chain;
mod clear;
mod codes;
mod computed_calls;
mod computed_numbers;
mod conditions;
mod constants;
mod context;
mod cycle_here;
mod cycle_words;
mod dwell;
mod emptied;
mod exposed;
mod external;
mod facts;
mod functions;
mod heads;
mod increments;
mod kept_length;
mod lathe;
mod length_radius;
mod letters;
mod link;
mod locked;
mod lookahead;
mod machine_codes;
mod matters;
mod measure;
mod messages;
mod missing;
mod modal;
mod modal_calls;
mod modal_facts;
mod modal_off;
mod nesting;
mod offset_rows;
mod operator;
mod outline;
mod oversize;
mod pauses;
pub mod pipeline;
mod polar;
mod ports;
mod position_length;
mod probe_points;
mod program_numbers;
mod programmed;
mod rapid_once;
mod reference;
mod registers;
mod repeats;
mod retention;
mod rewrite;
mod set_position;
mod shaped;
mod shift;
mod state;
mod substitutes;
mod tapping;
mod temporaries;
mod tool_word;
mod truth;
mod units;
mod vacancy;
mod vacant_writes;

pub use context::Context;
pub use locked::Locked;
pub use modal::{Modal, Setting, calls_of, reachable, span_of};
pub use modal_facts::{ModalFacts, replace_statements};
pub use oversize::shares_line;
pub use program_numbers::ProgramNumbers;
pub use registers::{Register, Registers};
pub use rewrite::{Position, Prelude, Rewriter, Wanted, rewrite_program};

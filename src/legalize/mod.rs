//! IR to IR that the target control can say.
//!
//! Nothing here knows a pair of controls. Each pass asks the target whether it
//! has something and, where it has not, puts an emulation in its place: one file
//! each, with its law, its side condition and where it ends. What cannot be
//! emulated becomes a diagnostic of severity error, at its place, and the
//! program is refused.
//!
//! The passes run over a whole library at once, because variables, programs and
//! modal state are shared by it.

mod active_offsets;
mod alarms;
mod bare_arcs;
mod blanks;
mod chain;
mod clear;
mod codes;
mod computed_numbers;
mod conditions;
mod constants;
mod context;
mod cycle_here;
mod dwell;
mod emptied;
mod exposed;
mod facts;
mod functions;
mod increments;
mod link;
mod locked;
mod lookahead;
mod machine_codes;
mod messages;
mod missing;
mod modal;
mod modal_calls;
mod operator;
mod outline;
mod polar;
mod programmed;
mod reference;
mod registers;
mod repeats;
mod retention;
mod rewrite;
mod shift;
mod state;
mod substitutes;
mod tapping;

mod temporaries;
mod truth;
mod units;
mod vacancy;

pub use context::Context;
pub use modal::{Modal, ModalFacts, Setting, calls_of, reachable};
use registers::allocate;
pub use registers::{Register, Registers};
pub use rewrite::{Position, Prelude, Rewriter, rewrite_program};

use crate::ir::Module;
use std::collections::BTreeMap;

/// One step of legalization.
pub struct Pass {
    /// Its name, for tests, dumps and `--stop-after`.
    pub name: &'static str,
    /// What it does to a library.
    pub run: fn(&mut Module, &mut Context<'_>),
}

/// The passes, in the order they run in.
pub const PASSES: &[Pass] = &[
    Pass { name: "source-facts", run: facts::of_source },
    Pass { name: "blanks", run: blanks::run },
    Pass { name: "link", run: link::run },
    Pass { name: "outline", run: outline::run },
    Pass { name: "codes", run: codes::run },
    Pass { name: "chain", run: chain::chain },
    Pass { name: "repeats", run: repeats::run },
    Pass { name: "modal-calls", run: modal_calls::run },
    // Behind the modal calls: the calls that they become must look at the register too.
    Pass { name: "return-to", run: chain::return_to },
    Pass { name: "polar", run: polar::run },
    Pass { name: "bare-arcs", run: bare_arcs::run },
    Pass { name: "active-offsets", run: active_offsets::run },
    Pass { name: "increments", run: increments::run },
    Pass { name: "units", run: units::run },
    Pass { name: "tapping", run: tapping::run },
    Pass { name: "reference", run: reference::run },
    Pass { name: "shift", run: shift::run },
    Pass { name: "computed-numbers", run: computed_numbers::run },
    Pass { name: "state", run: state::run },
    Pass { name: "alarms", run: alarms::run },
    Pass { name: "dwell", run: dwell::run },
    Pass { name: "lookahead", run: lookahead::run },
    Pass { name: "cycle-here", run: cycle_here::run },
    Pass { name: "substitutes", run: substitutes::run },
    Pass { name: "machine-codes", run: machine_codes::run },
    Pass { name: "missing", run: missing::run },
    Pass { name: "functions", run: functions::run },
    Pass { name: "truth", run: truth::run },
    Pass { name: "conditions", run: conditions::run },
    Pass { name: "constants", run: constants::run },
    Pass { name: "printed-values", run: operator::hold_values },
    Pass { name: "vacancy", run: vacancy::run },
];

/// Runs every pass.
pub fn legalize(module: &mut Module, context: &mut Context<'_>) {
    for pass in PASSES {
        (pass.run)(module, context);
    }
}

/// Gives every variable its register, and does what needs to know them; `locked` and `scratch` are the
/// choices of earlier runs. Nothing changes the variables of the module after this.
pub fn assign_registers(
    module: &mut Module,
    locked: &BTreeMap<String, u32>,
    scratch: &[u32],
    context: &mut Context<'_>,
) -> Registers {
    temporaries::run(module, context);
    let registers = allocate(module, locked, scratch, context);
    clear::run(module, &registers, context);
    retention::check(module, &registers, context);
    // Questions name the register that the answer goes to, and take up the print before them.
    operator::questions(module, &registers, context);
    operator::prints(module, context);
    messages::run(module, context);
    facts::of_target(module, context);
    registers
}

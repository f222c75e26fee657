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
mod polar;
mod ports;
mod position_length;
mod probe_points;
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

use census::{Census, Thing};
pub use context::Context;
pub use locked::Locked;
pub use modal::{Modal, Setting, calls_of, reachable, span_of};
pub use modal_facts::{ModalFacts, replace_statements};
pub use oversize::shares_line;
use registers::allocate;
pub use registers::{Register, Registers};
pub use rewrite::{Position, Prelude, Rewriter, Wanted, rewrite_program};

use crate::canon::{Op, Role};
use crate::ir::{Module, Program};

/// One step of legalization.
pub struct Pass {
    /// Its name, for tests, dumps and `--stop-after`.
    pub name: &'static str,
    /// Whether anything in a library concerns it: where not, it would change nothing and say nothing.
    concerns: fn(&Census, &Context<'_>) -> bool,
    /// What it does to a library.
    run: Run,
}

enum Run {
    /// Only has something to say.
    Reports(fn(&Module, &mut Context<'_>)),
    Rewrites(fn(&mut Module, &mut Context<'_>)),
    /// Finds nothing to change in most libraries that concern it; true where it changed anything.
    Edits(fn(&mut Module, &mut Context<'_>) -> bool),
    /// Looks at one program alone, whose index it is given; true where it changed anything.
    Each(fn(&mut Program, usize, &mut Context<'_>) -> bool),
}
use Run::{Each, Edits, Reports, Rewrites};

impl Pass {
    /// Runs it where anything concerns it.
    pub fn apply(&self, module: &mut Module, context: &mut Context<'_>) {
        self.apply_to(&Census::of(&module.programs), module, context);
    }

    /// As [`Pass::apply`]; true where that may have changed the library.
    fn apply_to(&self, census: &Census, module: &mut Module, context: &mut Context<'_>) -> bool {
        if !(self.concerns)(census, context) {
            return false;
        }
        match self.run {
            Reports(run) => {
                run(module, context);
                false
            }
            Rewrites(run) => {
                run(module, context);
                true
            }
            Each(_) => each(std::slice::from_ref(self), module, context).1,
            Edits(run) => {
                let before = cfg!(debug_assertions).then(|| module.clone());
                let changed = run(module, context);
                debug_assert!(changed || before.is_none_or(|before| before == *module), "{}", self.name);
                changed
            }
        }
    }
}

/// The passes, in the order they run in.
pub const PASSES: &[Pass] = &[
    Pass { name: "source-facts", concerns: |c, _| c.has(Thing::Computed), run: Reports(facts::of_source) },
    Pass { name: "lathe", concerns: lathe::concerns, run: Reports(lathe::run) },
    Pass { name: "matters", concerns: |c, _| matters::concerns(c), run: Reports(matters::run) },
    Pass { name: "blanks", concerns: |_, context| !context.same_family(), run: Rewrites(blanks::run) },
    Pass { name: "link", concerns: |c, _| c.has(Thing::Call) || c.has(Thing::Chain), run: Edits(link::run) },
    Pass { name: "outline", concerns: |c, _| c.has(Thing::LocalCall), run: Rewrites(outline::run) },
    Pass { name: "codes", concerns: |c, _| c.has(Thing::Code), run: Reports(codes::run) },
    Pass {
        name: "beside-moves",
        concerns: |c, _| beside_moves::concerns(c),
        run: Rewrites(beside_moves::run),
    },
    Pass {
        name: "pauses",
        concerns: |c, context| pauses::concerns(c, &context.entry),
        run: Rewrites(pauses::run),
    },
    Pass { name: "chain", concerns: |c, _| c.has(Thing::Chain), run: Rewrites(chain::chain) },
    Pass { name: "repeats", concerns: |c, _| c.role(Role::Repeat), run: Rewrites(repeats::run) },
    Pass {
        name: "modal-off",
        concerns: |c, context| c.has(Thing::Modal) && !context.same_family(),
        run: Rewrites(modal_off::run),
    },
    Pass { name: "modal-calls", concerns: |c, _| c.has(Thing::Modal), run: Rewrites(modal_calls::run) },
    // Behind the modal calls: the calls that they become must look at the register too.
    Pass { name: "return-to", concerns: |c, _| c.has(Thing::ReturnTo), run: Rewrites(chain::return_to) },
    Pass {
        name: "nesting",
        concerns: |c, _| c.has(Thing::Call) || c.has(Thing::LocalCall),
        run: Reports(nesting::run),
    },
    Pass {
        name: "polar",
        concerns: |c, _| c.op(Op::Pole) || c.role(Role::PolarAngle) || c.role(Role::PolarDistance),
        run: Rewrites(polar::run),
    },
    Pass {
        name: "bare-arcs",
        concerns: |c, _| c.op(Op::ArcCw) || c.op(Op::ArcCcw),
        run: Reports(bare_arcs::run),
    },
    Pass { name: "active-offsets", concerns: |c, _| c.has(Thing::System), run: Reports(active_offsets::run) },
    Pass {
        name: "set-position",
        concerns: |c, context| c.op(Op::SetPosition) && c.op(Op::SelectWork) && !context.same_family(),
        run: Reports(set_position::run),
    },
    Pass {
        name: "external",
        concerns: |c, _| c.has(Thing::System) || c.op(Op::WriteWork) || c.op(Op::LocalShift),
        run: Rewrites(external::run),
    },
    Pass {
        name: "shaped",
        concerns: |c, _| c.op(Op::RotateOn) || c.op(Op::ScaleOn) || c.op(Op::MirrorOn),
        run: Rewrites(shaped::run),
    },
    Pass { name: "increments", concerns: |c, _| c.has(Thing::Increments), run: Edits(increments::run) },
    Pass { name: "units", concerns: units::concerns, run: Edits(units::run) },
    Pass { name: "rapid-once", concerns: |c, _| c.op(Op::RapidOnce), run: Rewrites(rapid_once::run) },
    Pass {
        name: "length-radius",
        concerns: |c, _| c.role(Role::RadiusOffset),
        run: Rewrites(length_radius::run),
    },
    Pass { name: "tapping", concerns: |c, _| c.role(Role::Lead), run: Rewrites(tapping::run) },
    Pass { name: "reference", concerns: |c, _| c.op(Op::ReferenceReturn), run: Rewrites(reference::run) },
    Pass {
        name: "kept-length",
        concerns: |c, _| {
            c.role(Role::LengthOffset)
                && c.any_op(|op| matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::MachineOnce))
        },
        run: Rewrites(kept_length::run),
    },
    Pass { name: "shift", concerns: |c, _| c.op(Op::ShiftCancel), run: Rewrites(shift::run) },
    Pass { name: "banks", concerns: |c, _| c.has(Thing::Indirect), run: Reports(banks::run) },
    Pass {
        name: "computed-numbers",
        concerns: |c, _| c.has(Thing::Indirect),
        run: Edits(computed_numbers::run),
    },
    Pass {
        name: "vacant-writes",
        concerns: |c, _| (c.op(Op::WriteRadius) || c.op(Op::WriteRadiusWear)) && c.has(Thing::Variable),
        run: Rewrites(vacant_writes::run),
    },
    Pass {
        name: "probe-points",
        concerns: |c, _| c.role(Role::ProbePoint),
        run: Rewrites(probe_points::run),
    },
    Pass {
        name: "position-length",
        concerns: |c, _| c.has(Thing::System) || c.has(Thing::Indirect),
        run: Rewrites(position_length::run),
    },
    Pass { name: "tool-word", concerns: |c, _| c.has(Thing::System), run: Reports(tool_word::run) },
    Pass { name: "offset-rows", concerns: |c, _| c.has(Thing::System), run: Rewrites(offset_rows::run) },
    Pass {
        name: "state",
        concerns: |c, _| c.has(Thing::System) || c.op(Op::WriteRadius) || c.op(Op::WriteRadiusWear),
        run: Rewrites(state::run),
    },
    Pass { name: "alarms", concerns: |c, _| c.has(Thing::Message), run: Reports(alarms::run) },
    Pass {
        name: "dwell",
        concerns: |c, _| c.op(Op::Dwell) || c.role(Role::CycleDwell),
        run: Rewrites(dwell::run),
    },
    Pass {
        name: "lookahead",
        concerns: |c, _| c.has(Thing::Wait) || c.has(Thing::Emptied),
        run: Rewrites(lookahead::run),
    },
    Pass {
        name: "cycle-here",
        concerns: |c, _| c.any_op(|op| op.is_cycle() || op == Op::CycleHere),
        run: Rewrites(cycle_here::run),
    },
    Pass {
        name: "cycle-words",
        concerns: |c, _| cycle_words::ROLES.iter().any(|role| c.role(*role)),
        run: Rewrites(cycle_words::run),
    },
    // From here on a program goes through all passes while it is at hand: a library is larger than any cache.
    Pass { name: "substitutes", concerns: |c, _| substitutes::concerns(c), run: Each(substitutes::run) },
    Pass { name: "machine-codes", concerns: machine_codes::concerns, run: Each(machine_codes::run) },
    Pass { name: "missing", concerns: missing::concerns, run: Each(missing::run) },
    Pass { name: "functions", concerns: |c, _| c.has(Thing::Function), run: Each(functions::run) },
    Pass { name: "truth", concerns: truth::concerns, run: Each(truth::run) },
    Pass { name: "conditions", concerns: |c, _| c.has(Thing::Compound), run: Each(conditions::run) },
    Pass { name: "constants", concerns: |c, _| c.has(Thing::Long), run: Each(constants::run) },
    Pass { name: "printed-values", concerns: |c, _| c.has(Thing::Print), run: Each(operator::hold_values) },
    Pass { name: "oversize", concerns: |c, _| c.has(Thing::Computed), run: Each(oversize::run) },
    Pass { name: "ports", concerns: |c, _| c.has(Thing::Output), run: Rewrites(ports::run) },
    Pass { name: "vacancy", concerns: vacancy::concerns, run: Rewrites(vacancy::run) },
];

/// Runs every pass.
pub fn legalize(module: &mut Module, context: &mut Context<'_>) {
    let (mut census, mut fresh) = (Census::of(&module.programs), true);
    for passes in PASSES.chunk_by(|a, b| matches!((&a.run, &b.run), (Each(_), Each(_)))) {
        let [pass] = passes else {
            if !fresh || passes.iter().any(|pass| (pass.concerns)(&census, context)) {
                (census, _) = each(passes, module, context);
                fresh = true;
            }
            continue;
        };
        // What stood there before may be gone: then the pass finds nothing to do.
        if !fresh && !(pass.concerns)(&census, context) {
            (census, fresh) = (Census::of(&module.programs), true);
        }
        fresh &= !pass.apply_to(&census, module, context);
    }
    context.census = fresh.then_some(census);
}

/// Takes each program through passes that look at one alone; what stands in the library then, and whether
/// they changed anything.
fn each(passes: &[Pass], module: &mut Module, context: &mut Context<'_>) -> (Census, bool) {
    let (mut all, mut any) = (Census::default(), false);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut census = Census::of(std::slice::from_ref(program));
        for pass in passes {
            let Each(run) = pass.run else { continue };
            if !(pass.concerns)(&census, context) {
                continue;
            }
            let before = cfg!(debug_assertions).then(|| program.clone());
            if run(program, index, context) {
                (census, any) = (Census::of(std::slice::from_ref(program)), true);
            } else {
                debug_assert!(before.is_none_or(|before| before == *program), "{}", pass.name);
            }
        }
        all.add_all(&census);
    }
    (all, any)
}

/// Gives every variable its register, and does what needs to know them; `locked` and `scratch` are the
/// choices of earlier runs. Nothing changes the variables of the module after this.
pub fn assign_registers(module: &mut Module, locked: &Locked<'_>, context: &mut Context<'_>) -> Registers {
    // Optimization between brings nothing in.
    let census = context.census.take().unwrap_or_else(|| Census::of(&module.programs));
    if census.has(Thing::Temp) {
        temporaries::run(module);
    }
    let registers = allocate(module, &census, locked, context);
    computed_numbers::report(&registers, context);
    if clear::concerns(&census, context) {
        clear::run(module, &registers);
    }
    retention::check(module, &registers, context);
    // Before prints and questions are made of them.
    letters::run(module, context);
    // Questions name the register that the answer goes to, and take up the print before them.
    if census.has(Thing::Input) {
        operator::questions(module, &registers, context);
    }
    if census.has(Thing::Print) {
        operator::prints(module, context);
    }
    // A question becomes a message.
    if census.has(Thing::Message) || census.has(Thing::Input) {
        messages::run(module, context);
    }
    heads::run(module);
    // What was put in above was put in for one of these.
    let source = [Thing::Computed, Thing::Variable, Thing::Temp, Thing::Clear, Thing::Call, Thing::LocalCall];
    let asked = [Thing::Input, Thing::Print, Thing::Message];
    let computes = source.into_iter().chain(asked).any(|thing| census.has(thing));
    facts::of_target(module, computes, context);
    registers
}

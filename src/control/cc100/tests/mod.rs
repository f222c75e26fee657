//! The course's values and programs, each expected value from the course or from arithmetic here.

mod programs;
mod rules;
mod values;

use crate::control::testing::{run_corpus, survives_mutation};
use crate::control::{Run, Scenario};

/// The builder's cycles, which the programs call by G820 to G822.
const CYCLES: [&str; 3] = ["cycle20-auto-offset.nc", "cycle21.nc", "cycle22.nc"];

/// Runs a corpus program with the builder's cycles.
fn corpus(name: &str, scenario: &Scenario) -> Run {
    run_corpus("cc100", &[&[name], CYCLES.as_slice()].concat(), scenario)
}

/// No damage to a program of the corpus makes the emulation panic or run on.
#[test]
fn survives_damaged_programs() {
    survives_mutation("cc100", &CYCLES);
}

//! The manual's values and programs, each expected value from the manual or from arithmetic here.

mod programs;
mod rules;
mod values;

use crate::control::testing::{run_corpus, survives_mutation};
use crate::control::{End, Scenario};

/// No damage to a program of the corpus, and no program, makes the emulation panic or run on.
#[test]
fn survives_damaged_programs() {
    survives_mutation("fadal", &["o800-dhole.nc", "o900-rotate.nc", "o810-row-column.nc"]);
}

#[test]
fn endless_loops_end_at_the_budget() {
    let scenario = Scenario { steps: 5_000, ..Scenario::default() };
    let run = run_corpus("fadal", &["ex-labels.nc"], &scenario);
    assert_eq!((run.end, run.steps), (End::StepBudget, 5_000));
}

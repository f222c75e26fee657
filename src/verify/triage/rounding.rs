//! Whether a difference hangs on what no source says of a control: if it rounds computed words.

use crate::control::{ProgramRef, Run, Scenario};
use crate::dialect::Question;
use crate::verify::compare::{Tolerance, compare};
use crate::verify::sides::Job;

/// The fact that says whether words are rounded.
pub const ROUNDS: &str = Question::WordRoundsToIncrement.fact();

/// True where two runs differ only while a control rounds no computed word of which no source says whether it does.
/// Where moves end hardly tells that; what a program reads back of a position or a table does.
pub fn hangs_on_rounding(
    job: &Job<'_>,
    tolerance: Tolerance,
    (program, scenario, run): (ProgramRef, &Scenario, &Run),
    (there, circumstances, other): (ProgramRef, &Scenario, &Run),
) -> bool {
    let (source, target) = (job.source, job.target);
    let rounded = Scenario { rounds_words: true, ..scenario.clone() };
    let again = (source.execute)(&source.library, program, source.control, &rounded);
    let rounded = Scenario { rounds_words: true, ..circumstances.clone() };
    let there = target.run(there, &rounded);
    let changed = again.events != run.events || there.events != other.events;
    let compared = compare((source, &again), (target, &there), job.names, tolerance);
    changed && compared.difference.is_none() && compared.hair.is_none()
}

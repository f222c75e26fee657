//! What programs rest on that shows only where they run: each that could be converted is run a time or two.
//!
//! Nothing is judged by it: what a run of either control doubts is asked with the rest, and `convert` asks it then no more. Programs that
//! are long, or that run long, are asked of as far as they were run.

use crate::dialect::Control;
use crate::library::{Conversion, Input, judge};
use crate::verify::Effort;

/// Bytes of all files together, over which nothing is run: a survey takes seconds.
const MOST: usize = 4 << 20;

/// A run, with few blocks.
fn effort() -> Effort {
    Effort {
        scenarios: 1,
        fewest: 1,
        telling: 1,
        drawn: 0,
        tries: 1,
        steps: 5_000,
        all_steps: 20_000,
        program_seconds: 5.0,
        library_seconds: 60.0,
        ..Effort::default()
    }
}

/// Adds the facts that runs rest on to what is found in a conversion.
pub(super) fn add_facts(inputs: &[Input], conversion: &mut Conversion, [source, target]: [&Control; 2]) {
    if inputs.iter().map(|input| input.bytes.len()).sum::<usize>() > MOST {
        return;
    }
    let mut run = conversion.clone();
    judge(inputs, &mut run, source, target, effort());
    for (program, run) in conversion.programs.iter_mut().zip(run.programs) {
        let known = program.diagnostics.len();
        let new = run.diagnostics.into_iter().skip(known).filter(|finding| finding.fact().is_some());
        program.diagnostics.extend(new);
    }
}

//! Programs that the bytes draw are converted, and do the same on the target.

#![no_main]

use macroglot_fuzz::generate::{fuzzed, trial};

libfuzzer_sys::fuzz_target!(|choices: &[u8]| {
    let program = fuzzed(choices);
    let text = program.text();
    let faults = trial::run(program.dialect, &text).faults;
    assert!(faults.is_empty(), "{} {:?}\n{text}-- {}", program.dialect, program.policy, faults.join("\n"));
});

//! Programs that the bytes draw are converted, and do the same on the target.

#![no_main]

use macroglot_fuzz::generate::{fuzzed, trial};

libfuzzer_sys::fuzz_target!(|choices: &[u8]| {
    macroglot_fuzz::on_one_thread();
    let program = fuzzed(choices);
    let faults = trial::run(&program).faults;
    assert!(
        faults.is_empty(),
        "{} {:?}\n{}-- {}",
        program.dialect,
        program.policy,
        program.text(),
        faults.join("\n")
    );
});

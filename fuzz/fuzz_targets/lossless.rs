//! What was read prints as it was, and its tokens tile it.

#![no_main]

use libfuzzer_sys::fuzz_target;
use macroglot::syntax::{parse_file, parse_totals};

fuzz_target!(|input: &[u8]| {
    let Some((parser, program)) = macroglot_fuzz::choose(input) else { return };
    assert_eq!(parse_file(program, parser).print(), program);
    assert!(parse_totals(program, parser).lossless);
});

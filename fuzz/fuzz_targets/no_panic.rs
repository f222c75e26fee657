//! Nothing that can be written in a file makes a parser panic, overflow its stack or hang.

#![no_main]

use libfuzzer_sys::fuzz_target;
use macroglot::syntax::{for_each_expr, for_each_item, parse_file};

fuzz_target!(|input: &[u8]| {
    let Some((parser, program)) = macroglot_fuzz::choose(input) else { return };
    let file = parse_file(program, parser);
    for block in &file.blocks {
        // Trees are shallow enough to be walked, and to be dropped at the end.
        for_each_item(&block.items, &mut |_| {});
        for_each_expr(&block.items, &mut |_| {});
        for error in &block.errors {
            assert!(error.span.start <= error.span.end && error.span.end as usize <= program.len());
        }
    }
});

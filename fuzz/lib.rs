//! What the fuzz targets share.

use macroglot::control::{Library, LoadedFile, ProgramRef, Scenario};
use macroglot::dialect::Control;
use macroglot::library::{Input, Lock, Options, convert, detect};
use macroglot::syntax::{for_each_expr, for_each_item, parse_file, parse_totals};
use std::path::PathBuf;
use std::sync::{LazyLock, Once};

pub mod blocks;

#[path = "../tests/support/generate/mod.rs"]
pub mod generate;

/// Bytes of a program that are fuzzed; longer ones say nothing that short ones do not.
const LONGEST: usize = 4096;

/// Changes the first `size` bytes in their place, and yields how many there are then: mostly by blocks, now and then as
/// libFuzzer does.
pub fn mutated(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    if seed.is_multiple_of(8) {
        return libfuzzer_sys::fuzzer_mutate(data, size, most);
    }
    let made = blocks::mutate(&data[..size], most.min(data.len()), seed);
    data[..made.len()].copy_from_slice(&made);
    made.len()
}

/// The plain controls: to lay one over its table takes longer than to read a small program.
static CONTROLS: LazyLock<Vec<Control>> = LazyLock::new(|| {
    ["fadal", "fanuc", "haas", "cc100"].map(|name| Control::plain(name).expect("the table loads")).into()
});

fn control(dialect: &str) -> &'static Control {
    CONTROLS.iter().find(|control| control.name() == dialect).expect("a dialect")
}

/// Keeps all work on the thread that libFuzzer calls: an input is too small to be worth waking another for.
pub fn on_one_thread() {
    static DONE: Once = Once::new();
    DONE.call_once(|| {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
        one.build_global().expect("nothing has started a pool before");
    });
}

/// What was read prints as it was, and its tokens tile it.
pub fn lossless(dialect: &str, program: &[u8]) {
    on_one_thread();
    let parse = control(dialect).entry().parse;
    assert_eq!(parse_file(program, parse).print(), program);
    assert!(parse_totals(program, parse).lossless);
}

/// Nothing that can be written in a file makes a parser, a compiler or an emulated control panic, overflow
/// its stack or hang.
pub fn no_panic(dialect: &str, program: &[u8]) {
    on_one_thread();
    let program = &program[..program.len().min(LONGEST)];
    let source = control(dialect);
    let parsed = parse_file(program, source.entry().parse);
    for block in &parsed.blocks {
        // Trees are shallow enough to be walked, and to be dropped at the end.
        for_each_item(&block.items, &mut |_| {});
        for_each_expr(&block.items, &mut |_| {});
        for error in &block.errors {
            assert!(error.span.start <= error.span.end && error.span.end as usize <= program.len());
        }
    }
    if let Some(execute) = source.entry().execute {
        let files = [LoadedFile { name: "fuzz.nc", parsed: &parsed }];
        let scenario = Scenario { steps: 500, events: 2000, ..Scenario::default() };
        execute(&Library::new(&files), ProgramRef::FIRST, source, &scenario);
    }
    let inputs = [Input { path: PathBuf::from("fuzz.nc"), name: "fuzz.nc".into(), bytes: program.to_vec() }];
    detect(&inputs);
    // One way of converting an input is enough: its length chooses.
    let target = ["fanuc", "haas"][program.len() % 2];
    let options = Options { draft: program.len() % 4 < 2, ..Options::default() };
    convert(&inputs, source, control(target), Lock::new(dialect, target), options);
}

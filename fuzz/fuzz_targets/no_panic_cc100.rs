#![no_main]

libfuzzer_sys::fuzz_target!(|program: &[u8]| macroglot_fuzz::no_panic("cc100", program));

libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    macroglot_fuzz::mutated(data, size, max_size, seed)
});

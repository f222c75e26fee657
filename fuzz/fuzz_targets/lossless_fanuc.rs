#![no_main]

libfuzzer_sys::fuzz_target!(|program: &[u8]| macroglot_fuzz::lossless("fanuc", program));

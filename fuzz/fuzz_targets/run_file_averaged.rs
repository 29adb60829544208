#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| tumble_io::fuzzing::run_file_averaged(data));

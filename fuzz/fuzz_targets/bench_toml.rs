#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| tumble_io::fuzzing::bench_toml(data));

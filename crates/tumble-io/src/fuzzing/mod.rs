//! What must hold for any bytes at all, a function a parser: for the fuzz targets of `fuzz/` and for the test that
//! replays their corpus. No part of the library's promises.
//!
//! Each function returns quietly or panics: an assertion here is a test that any input may break.

mod documents;
mod files;
mod noise;
mod plans;
mod texts;

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

pub use documents::{catalogue_toml, experiment_toml, init, passport_json};
pub use files::{
    code_stream, continuous_record, gz_source, run_file_averaged, run_file_raw, zst_source,
};
pub use noise::noise_record;
pub use plans::{bench_toml, plan_file};
pub use texts::{dates, dial_angles, header, numbers, plan_string};

/// A target: its name and what it asserts.
pub type Target = (&'static str, fn(&[u8]));

/// All targets, in the order in which a value passes through the parsers. Names are those of `fuzz/fuzz_targets` and
/// `fuzz/corpus`.
pub const TARGETS: [Target; 18] = [
    ("experiment_toml", experiment_toml),
    ("run_file_raw", run_file_raw),
    ("run_file_averaged", run_file_averaged),
    ("continuous_record", continuous_record),
    ("header", header),
    ("numbers", numbers),
    ("dial_angles", dial_angles),
    ("dates", dates),
    ("init", init),
    ("code_stream", code_stream),
    ("passport_json", passport_json),
    ("gz_source", gz_source),
    ("zst_source", zst_source),
    ("plan_string", plan_string),
    ("catalogue_toml", catalogue_toml),
    ("bench_toml", bench_toml),
    ("plan_file", plan_file),
    ("noise_record", noise_record),
];

/// Longest message: what nobody scrolls back for.
const LONGEST_MESSAGE: usize = 16 << 10;

/// A message for people: not empty, safe to print on a terminal, not endless. Gives its text.
fn said(message: &dyn Display) -> String {
    let text = message.to_string();
    assert!(!text.trim().is_empty(), "an empty message");
    assert!(!text.chars().any(char::is_control), "control characters: {text:?}");
    assert!(text.len() < LONGEST_MESSAGE, "{} bytes of message: {text:.200}", text.len());
    text
}

/// A folder of its own, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("tumble-fuzz-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&folder).expect("a scratch folder can be made");
        Self(folder)
    }

    fn path(&self) -> &Path {
        &self.0
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).expect("a scratch file can be written");
        path
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // Best effort: it lies in the folder for temporary files.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A choice by the digits of a number: takes one digit of the given base.
fn digit(number: &mut u32, base: u32) -> u32 {
    let digit = *number % base;
    *number /= base;
    digit
}

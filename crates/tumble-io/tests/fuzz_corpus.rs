//! Every input that fuzzing keeps, through the same assertions as the fuzz targets of `fuzz/`.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tumble_io::fuzzing::TARGETS;

/// One input, on a busy machine, without optimization of everything.
const LONGEST: Duration = Duration::from_secs(10);

fn fuzz() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz")
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn every_input_of_the_corpus_keeps_every_assertion() {
    for (target, assertions) in TARGETS {
        let folder = fuzz().join("corpus").join(target);
        let inputs = names(&folder);
        assert!(inputs.len() >= 10, "{target} has {} inputs", inputs.len());
        for name in inputs {
            let bytes = std::fs::read(folder.join(&name)).unwrap();
            let started = Instant::now();
            // A panic does not say which input it was.
            let held = std::panic::catch_unwind(|| assertions(&bytes));
            assert!(held.is_ok(), "fuzz/corpus/{target}/{name}");
            let took = started.elapsed();
            assert!(took < LONGEST, "fuzz/corpus/{target}/{name} took {took:?}");
        }
    }
}

#[test]
fn every_target_has_its_file_and_its_corpus() {
    let expected: BTreeSet<String> = TARGETS.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(names(&fuzz().join("corpus")), expected);
    let files: BTreeSet<String> = expected.iter().map(|name| format!("{name}.rs")).collect();
    assert_eq!(names(&fuzz().join("fuzz_targets")), files);
    let manifest = std::fs::read_to_string(fuzz().join("Cargo.toml")).unwrap();
    for name in &expected {
        assert!(manifest.contains(&format!("name = \"{name}\"")), "{name} is no target");
    }
}

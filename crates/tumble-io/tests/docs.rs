//! docs/experiment.md shows an experiment.toml; every key in it exists.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_io::{Problem, read_experiment};

const PAGE: &str = include_str!("../../../docs/experiment.md");

/// Reads an experiment.toml without any run files; gives what is wrong with it.
fn problem(toml: &str) -> Problem {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    read_experiment(dir.path(), &()).unwrap_err().problem
}

#[test]
fn the_example_is_an_experiment_with_and_without_its_options() {
    let example = PAGE.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    // The first file that it names is missing: everything before that was understood.
    assert!(matches!(problem(example), Problem::NoFile { .. }), "{}", problem(example));
    let switched_on: String = example
        .lines()
        .filter(|l| !l.starts_with("# unit ="))
        .map(|l| match l.strip_prefix("# ") {
            Some(key) if key.split_once(" = ").is_some_and(|(k, _)| !k.contains(' ')) => {
                format!("{key}\n")
            }
            _ => format!("{l}\n"),
        })
        .collect();
    assert!(switched_on.contains("\ncode_bits = 16") && switched_on.contains("\nangles_deg = "));
    assert!(matches!(problem(&switched_on), Problem::NoFile { .. }), "{}", problem(&switched_on));
    let wrong = example.replacen("[bench]", "[bench]\nangle_untis = 1", 1);
    assert!(matches!(problem(&wrong), Problem::UnknownKey { .. }));
}

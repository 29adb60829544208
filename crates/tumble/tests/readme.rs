//! Commands in the documents print what the documents say.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Blocks ```` ```console ````: a line `$ command`, then its output.
fn transcripts(document: &str) -> Vec<(String, String)> {
    let text = std::fs::read_to_string(root().join(document)).unwrap();
    text.split("```console\n")
        .skip(1)
        .map(|rest| rest.split("\n```").next().unwrap())
        .map(|block| {
            let (command, output) = block.split_once('\n').unwrap();
            (command.strip_prefix("$ ").unwrap().to_owned(), output.to_owned())
        })
        .collect()
}

/// Runs a documented command with the binaries of this build, in an empty folder that sees `examples`.
fn run(command: &str, folder: &Path) -> String {
    let examples = Path::new(env!("CARGO_BIN_EXE_tumble")).with_file_name("examples");
    let command = command
        .replace(
            "cargo run --release --example paper",
            &examples.join("paper").display().to_string(),
        )
        .replace("cargo run --release --", env!("CARGO_BIN_EXE_tumble"));
    let out = Command::new("sh").arg("-c").arg(&command).current_dir(folder).output().unwrap();
    let text = [out.stdout, out.stderr].concat();
    String::from_utf8(text).unwrap().trim_end().to_owned()
}

#[cfg(unix)]
#[test]
fn documented_commands_print_what_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(
        root().canonicalize().unwrap().join("examples"),
        folder.path().join("examples"),
    )
    .unwrap();
    let mut compared = 0;
    for document in ["README.md", "examples/paper/README.md"] {
        for (command, expected) in transcripts(document) {
            assert_eq!(run(&command, folder.path()), expected, "{document}: {command}");
            compared += 1;
        }
    }
    assert_eq!(compared, 4);
}

#[test]
fn links_lead_somewhere() {
    let mut followed = 0;
    for document in [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "SECURITY.md",
        "docs/estimators.md",
        "docs/likelihood.md",
        "docs/passport.md",
        "docs/findings.md",
        "docs/experiment.md",
        "docs/catalogue.md",
    ] {
        let text = std::fs::read_to_string(root().join(document)).unwrap();
        let folder = root().join(document).parent().unwrap().to_path_buf();
        for target in text.split("](").skip(1).filter_map(|t| t.split(')').next()) {
            let path = target.split('#').next().unwrap();
            if !path.is_empty() && !path.contains("://") {
                assert!(folder.join(path).exists(), "{document}: {target}");
                followed += 1;
            }
        }
    }
    assert!(followed > 5, "{followed}");
}

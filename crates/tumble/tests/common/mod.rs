//! The binary, started in a folder, and what it said.
#![allow(dead_code, clippy::unwrap_used)] // Every test file is a crate of its own and takes what it needs.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

pub fn tumble(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tumble")).args(args).current_dir(folder).output().unwrap()
}

pub fn with_input(folder: &Path, args: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tumble"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A refusal need not wait for its input.
    if let Err(e) = child.stdin.take().unwrap().write_all(input.as_bytes()) {
        assert_eq!(e.kind(), std::io::ErrorKind::BrokenPipe, "{e}");
    }
    child.wait_with_output().unwrap()
}

pub fn out(o: &Output) -> String {
    String::from_utf8(o.stdout.clone()).unwrap()
}

pub fn err(o: &Output) -> String {
    String::from_utf8(o.stderr.clone()).unwrap()
}

pub fn code(o: &Output) -> i32 {
    o.status.code().unwrap()
}

/// A folder with a short simulated experiment `demo`.
pub fn demo(extra: &[&str]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    let args = [&["simulate", "demo", "--dwell", "1"], extra].concat();
    let made = tumble(dir.path(), &args);
    assert_eq!(code(&made), 0, "{}", err(&made));
    dir
}

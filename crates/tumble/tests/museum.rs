//! The museum: files as people have them, and what Tumble makes of each (`museum/README.md`).
//!
//! What is expected stands in `case.toml`, written by `museum/make.py` from what was put into the files; the whole
//! transcript is compared, too. `TUMBLE_BLESS=1` writes the transcripts anew.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use serde_json::Value as Json;
use toml::{Table, Value};

const FEWEST: usize = 40;
const WIDEST: usize = 80;

#[test]
fn every_file_gives_the_right_reading_or_the_right_message() {
    let cases = cases();
    let (pending, shown): (Vec<_>, Vec<_>) = cases.iter().partition(|c| c.pending());
    for case in &pending {
        eprintln!("SKIPPED {}: pending", case.name);
    }
    eprintln!("museum: {} cases, and {} pending that were skipped", shown.len(), pending.len());
    assert!(shown.len() >= FEWEST, "{} cases, at least {FEWEST} are promised", shown.len());

    let faults = Mutex::new(Vec::new());
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(|| {
                while let Some(case) = shown.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let found = case.faults();
                    faults.lock().unwrap_or_else(PoisonError::into_inner).extend(found);
                }
            });
        }
    });
    let mut faults = faults.into_inner().unwrap();
    faults.sort();
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

struct Case {
    name: String,
    folder: PathBuf,
    told: Table,
}

fn cases() -> Vec<Case> {
    let museum = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/museum");
    let mut cases: Vec<Case> = std::fs::read_dir(museum)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .map(|folder| Case {
            name: folder.file_name().unwrap().to_string_lossy().into_owned(),
            told: std::fs::read_to_string(folder.join("case.toml")).unwrap().parse().unwrap(),
            folder,
        })
        .collect();
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    cases
}

impl Case {
    fn pending(&self) -> bool {
        self.told.get("pending").and_then(Value::as_bool).unwrap_or(false)
    }

    fn texts(&self, key: &str) -> Vec<&str> {
        self.told[key].as_array().unwrap().iter().map(|v| v.as_str().unwrap()).collect()
    }

    /// Runs the commands in a copy of the folder, and lists what is not as told.
    fn faults(&self) -> Vec<String> {
        let dir = tempfile::tempdir().unwrap();
        for entry in std::fs::read_dir(&self.folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_owned();
            if name != "case.toml" && name != "transcript.txt" {
                std::fs::copy(&path, dir.path().join(name)).unwrap();
            }
        }
        let mut faults = Vec::new();
        let transcript = self.transcript(dir.path(), &mut faults);
        for wanted in self.texts("must_say") {
            // Long lines are wrapped: blanks are as good as line ends.
            if !contains(&transcript, wanted) {
                faults.push(format!("does not say `{wanted}`"));
            }
        }
        for unwanted in self.texts("must_not_say") {
            if contains(&transcript, unwanted) {
                faults.push(format!("says `{unwanted}`"));
            }
        }
        looks(&transcript, &mut faults);
        self.dwells(dir.path(), &mut faults);
        self.truth(dir.path(), &mut faults);
        self.golden(&transcript, &mut faults);
        faults.into_iter().map(|f| format!("{}: {f}", self.name)).collect()
    }

    fn transcript(&self, folder: &Path, faults: &mut Vec<String>) -> String {
        let exits = self.told["exit"].as_array().unwrap();
        let mut text = String::new();
        for (command, wanted) in self.texts("commands").into_iter().zip(exits) {
            let (out, exit) = run(folder, command);
            let _ = write!(text, "$ {command}\n{out}exit {exit}\n");
            if wanted.as_integer() != Some(i64::from(exit)) {
                faults.push(format!("`{command}` ends with {exit}, not {wanted}"));
            }
        }
        text
    }

    fn golden(&self, transcript: &str, faults: &mut Vec<String>) {
        let path = self.folder.join("transcript.txt");
        if std::env::var_os("TUMBLE_BLESS").is_some_and(|v| v == "1") {
            std::fs::write(&path, transcript).unwrap();
        } else if std::fs::read_to_string(&path).ok().as_deref() != Some(transcript) {
            faults.push(format!("transcript.txt is another one; now:\n{transcript}"));
        }
    }

    /// Angles and samples, of all runs and the up/down pair.
    fn dwells(&self, folder: &Path, faults: &mut Vec<String>) {
        let Some(wanted) = self.told.get("dwells").and_then(Value::as_array) else { return };
        let Some(check) = json(folder, &["check", ".", "--json"]) else {
            return faults.push("tumble check . --json gives none".into());
        };
        let seen: Vec<(f64, u64)> = check["runs"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|run| run["dwells"].as_array().unwrap())
            .map(|d| (d["angle_deg"].as_f64().unwrap(), d["samples"].as_u64().unwrap()))
            .collect();
        let same = seen.len() == wanted.len()
            && seen.iter().zip(wanted).all(|(seen, wanted)| {
                let angle = wanted[0].as_float().unwrap();
                (seen.0 - angle).abs() < 1e-5
                    && i64::try_from(seen.1).ok() == wanted[1].as_integer()
            });
        if !same {
            faults.push(format!("dwells are {seen:?}, not {wanted:?}"));
        }
    }

    /// Every estimate of the first run lies within so many expanded uncertainties of the truth.
    fn truth(&self, folder: &Path, faults: &mut Vec<String>) {
        let Some(truth) = self.told.get("truth") else { return };
        let Some(passport) = json(folder, &["certify", ".", "--json"]) else {
            return faults.push("tumble certify . --json gives none".into());
        };
        let rejected = self.told.get("rejected").and_then(Value::as_bool).unwrap_or(false);
        if (passport["verdict"] == "rejected") != rejected {
            faults.push(format!("{}: {}", passport["verdict"], passport["reasons"]));
        }
        let estimates = &passport["runs"][0]["estimates"];
        let nominal = passport["nominal_scale_m_s2_per_lsb"].as_f64().unwrap();
        let of = |key: &str| truth[key].as_float().unwrap();
        let scale_error = of("scale_factor_m_s2_per_unit") / nominal - 1.0;
        for (name, true_value) in [
            ("bias", of("bias_m_s2")),
            ("misalignment", of("misalignment_rad")),
            ("scale_error", scale_error),
        ] {
            let estimate = &estimates[name];
            let (Some(value), Some(low), Some(high)) = (
                estimate["value"].as_f64(),
                estimate["interval"][0].as_f64(),
                estimate["interval"][1].as_f64(),
            ) else {
                faults.push(format!("no {name} with an interval"));
                continue;
            };
            let off = (value - true_value).abs() / (0.5 * (high - low));
            if off > of("within") {
                faults.push(format!(
                    "{name} is {value}, in truth {true_value}: {off:.2} expanded uncertainties"
                ));
            }
        }
    }
}

/// No control characters; no line wider than a terminal, other than those of errors, which cannot know what they quote.
fn looks(transcript: &str, faults: &mut Vec<String>) {
    if let Some(c) = transcript.chars().find(|c| c.is_control() && *c != '\n') {
        faults.push(format!("holds the control character {c:?}"));
    }
    let mut of_cat = false;
    for line in transcript.lines() {
        if let Some(command) = line.strip_prefix("$ ") {
            of_cat = command.starts_with("cat ") || command.ends_with("--print");
            continue;
        }
        let width = line.chars().count();
        // A file for an editor may be a little wider, and names of columns are as long as they are.
        let widest = if of_cat { 100 } else { WIDEST };
        let free = line.starts_with("tumble: ") || (of_cat && line.starts_with("columns = "));
        if width > widest && !free {
            faults.push(format!("{width} columns wide: {line}"));
        }
    }
}

fn contains(transcript: &str, text: &str) -> bool {
    let flat = |t: &str| t.split_whitespace().collect::<Vec<_>>().join(" ");
    transcript.contains(text) || flat(transcript).contains(&flat(text))
}

/// One command line: of `tumble`, or one of the few that the harness knows itself.
fn run(folder: &Path, command: &str) -> (String, i32) {
    let words: Vec<&str> = command.split_whitespace().collect();
    match words[..] {
        ["tumble", ref args @ ..] => {
            let done = tumble(folder, args);
            let text =
                String::from_utf8(done.stdout).unwrap() + &String::from_utf8(done.stderr).unwrap();
            (text, done.status.code().unwrap())
        }
        ["cat", file] => (std::fs::read_to_string(folder.join(file)).unwrap_or_default(), 0),
        ["cp", from, to] => {
            std::fs::copy(folder.join(from), folder.join(to)).unwrap();
            (String::new(), 0)
        }
        ["append", file, ..] => {
            let path = folder.join(file);
            let line = command.split_once(file).unwrap().1.trim();
            let text = std::fs::read_to_string(&path).unwrap() + line + "\n";
            std::fs::write(&path, text).unwrap();
            (String::new(), 0)
        }
        _ => panic!("no such command: {command}"),
    }
}

fn tumble(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tumble")).args(args).current_dir(folder).output().unwrap()
}

fn json(folder: &Path, args: &[&str]) -> Option<Json> {
    serde_json::from_slice(&tumble(folder, args).stdout).ok()
}

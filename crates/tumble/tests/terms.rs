//! Further terms as a user meets them: by name, refused, and in `compensate`.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn tumble(folder: &Path, args: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tumble"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that reads nothing may be gone already.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    child.wait_with_output().unwrap()
}

fn bench(extra: &[&str]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    let args = [
        &[
            "simulate",
            "demo",
            "--dwell",
            "1",
            "--runs",
            "3",
            "--angles=-65:65:60",
            "--updown",
            "--seed",
            "3",
        ],
        extra,
    ]
    .concat();
    assert_eq!(tumble(dir.path(), &args, "").status.code(), Some(0));
    dir
}

fn json(o: &Output) -> serde_json::Value {
    serde_json::from_slice(&o.stdout).unwrap()
}

#[test]
fn a_named_term_stands_in_the_passport_and_is_undone() {
    let dir = bench(&["--k2", "500ug/g2"]);
    let o = tumble(dir.path(), &["certify", "demo", "--terms", "k2", "--out", "p", "--json"], "");
    let p = json(&o);
    assert_eq!((o.status.code(), p["verdict"].as_str()), (Some(0), Some("accepted")), "{p:#}");
    assert_eq!(p["options"]["terms"], "k2");
    let k2 = &p["terms"][0];
    let number = |v: &serde_json::Value| v.as_f64().unwrap();
    let of = &k2["in_usual_unit"];
    assert!((number(&of["value"]) - 500.0).abs() < number(&of["expanded_uncertainty"]), "{of}");
    // K2 is fitted, so the budget has no line for it.
    let lines = p["budget"].as_array().unwrap();
    assert!(
        !lines.iter().any(|l| l["quantity"] == "K2") && lines.iter().any(|l| l["quantity"] == "K3")
    );
    // x = k (N + ½) − Δa = a + K2 a², solved for a.
    let c = &p["compensation"];
    let x = number(&c["scale_factor"]) * 600.5 - number(&c["bias"]);
    let out = tumble(dir.path(), &["compensate", "p/passport.json"], "600\n");
    let text = String::from_utf8(out.stdout).unwrap();
    let a: f64 = text.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((a + number(&k2["value"]) * a * a - x).abs() < 1e-8, "{a} {x}");
}

#[test]
fn what_no_term_is_called_and_what_it_needs_is_said() {
    let dir = bench(&[]);
    for (args, exit, says) in [
        (&["--terms", "k4"][..], 2, "did you mean k2?"),
        (&["--terms", "k2", "--method", "paper"], 2, "has no further terms"),
        (&["--terms", "temp-bias"], 4, "T0323"),
    ] {
        let o = tumble(dir.path(), &[&["certify", "demo"], args].concat(), "");
        let text = String::from_utf8([o.stdout, o.stderr].concat()).unwrap();
        assert_eq!(o.status.code(), Some(exit), "{text}");
        assert!(text.contains(says), "{says}: {text}");
    }
}

#[test]
fn a_term_on_temperature_wants_the_temperature() {
    let dir = bench(&["--temperature", "20:26", "--bias-per-kelvin", "5mg"]);
    let o = tumble(dir.path(), &["certify", "demo", "--terms", "temp-bias", "--out", "p"], "");
    assert_eq!(o.status.code(), Some(0), "{}", String::from_utf8_lossy(&o.stdout));
    let refused = tumble(dir.path(), &["compensate", "p/passport.json"], "600\n");
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--temperature"));
    let at = |t: &str| -> f64 {
        let o = tumble(dir.path(), &["compensate", "p/passport.json", "--temperature", t], "600\n");
        let text = String::from_utf8(o.stdout).unwrap();
        text.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap()
    };
    // 5 mg per kelvin more bias reads so much too high: the acceleration is so much lower.
    assert!((at("20") - at("21") - 5e-3 * 9.80665).abs() < 2e-3, "{}", at("20") - at("21"));
}

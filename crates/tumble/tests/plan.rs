//! `tumble plan` as a user meets it.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

mod common;

use common::{code, err, out, tumble};

#[test]
fn a_plan_needs_three_words_and_is_simulated_and_certified() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["plan", "--sensor", "ADXL203", "--range", "65", "--hours", "1", "--out", "plan"];
    let made = tumble(dir.path(), &args);
    assert_eq!(code(&made), 0, "{}", err(&made));
    let text = out(&made);
    assert!(text.starts_with("PLAN - ") && text.contains("paper's plan"), "{text}");
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    let page = std::fs::read_to_string(dir.path().join("plan/plan.html")).unwrap();
    assert!(page.contains("Run 1 of") && !page.contains("<script"));
    let simulated = ["simulate", "demo", "--plan", "plan/plan.toml", "--averaged"];
    assert_eq!(code(&tumble(dir.path(), &simulated)), 0);
    let certified = tumble(dir.path(), &["certify", "demo"]);
    assert_eq!(code(&certified), 0, "{}", out(&certified));
    // The same question, the same plan.
    assert!(err(&tumble(dir.path(), &args)).contains("already"));
}

#[test]
fn a_target_out_of_reach_is_a_no_with_what_would_do() {
    let dir = tempfile::tempdir().unwrap();
    let base = ["plan", "--range", "65", "--k2", "0ug/g2", "--k3", "0", "--lean", "5arcmin"];
    let hard = [&base[..], &["--target", "bias=1mm/s2"]].concat();
    let no = tumble(dir.path(), &hard);
    assert_eq!(code(&no), 1, "{}", out(&no));
    assert!(
        out(&no).starts_with("TARGETS NOT MET") && out(&no).contains("up and down"),
        "{}",
        out(&no)
    );
    let with = [&hard[..], &["--updown", "--json"]].concat();
    let yes = tumble(dir.path(), &with);
    assert_eq!(code(&yes), 0, "{}", out(&yes));
    let json: serde_json::Value = serde_json::from_str(&out(&yes)).unwrap();
    assert_eq!((json["met"].as_bool(), json["updown"].as_bool()), (Some(true), Some(true)));
    // Where no single change does, several together.
    let usual = tumble(dir.path(), &["plan", "--range", "65", "--target", "bias=1mm/s2"]);
    assert_eq!(code(&usual), 1);
    assert!(
        out(&usual).contains("together: ") && out(&usual).contains("K3 known twice as well"),
        "{}",
        out(&usual)
    );
    for wrong in
        [["--target", "bias=1mrad"], ["--hours", "0.05"], ["--range", "120"], ["--rate", "0"]]
    {
        let refused = tumble(dir.path(), &[&["plan"], &wrong[..]].concat());
        assert_eq!(code(&refused), 2, "{wrong:?}: {}", out(&refused));
    }
}

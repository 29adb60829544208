//! Positions that do not belong, as a user leaves them out.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

mod common;

use std::process::Output;

use common::{code, demo, err, out, tumble};

#[test]
fn positions_are_left_out_on_request_and_recorded() {
    let dir = demo(&["--seed", "3"]);
    let of = |args: &[&str]| tumble(dir.path(), &[&["certify", "demo"], args].concat());
    let json = |o: &Output| -> serde_json::Value { serde_json::from_slice(&o.stdout).unwrap() };
    let asked = of(&["--json", "--leave-out", "run-2:12,7", "--leave-out", "run-1:3"]);
    let p = json(&asked);
    assert_eq!(code(&asked), 0, "{}", err(&asked));
    assert_eq!(
        p["options"]["left_out"],
        serde_json::json!([
            {"run": "run-1", "positions": [3]},
            {"run": "run-2", "positions": [7, 12]}
        ])
    );
    assert_eq!(p["runs"][1]["positions"], 58);
    let findings = p["findings"].as_array().unwrap();
    assert_eq!(findings.iter().filter(|f| f["id"] == "T0132").count(), 2);
    let outliers = p["outliers"].as_array().unwrap();
    assert_eq!(outliers.iter().filter(|o| o["left_out"] == true).count(), 3, "{outliers:?}");
    assert_eq!(p["left_out_comparison"].as_array().unwrap().len(), 3);
    // The folder may say it, too: the same numbers.
    let file = dir.path().join("demo/experiment.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let with = |run: &str, list: &str, text: &str| {
        let key = format!("file = \"{run}.csv\"\n");
        assert!(text.contains(&key), "{text}");
        text.replace(&key, &format!("{key}leave_out = {list}\n"))
    };
    let by_folder = with("run-1", "[3]", &with("run-2", "[7, 12]", &text));
    std::fs::write(&file, by_folder).unwrap();
    let q = json(&of(&["--json"]));
    assert_eq!((&q["result"], &q["options"]), (&p["result"], &p["options"]));
    // What is not there is refused with what is.
    std::fs::write(&file, with("run-2", "[61]", &text)).unwrap();
    let refused = of(&[]);
    assert_eq!(code(&refused), 2);
    assert!(
        err(&refused).contains("leave_out") && err(&refused).contains("1 to 60"),
        "{}",
        err(&refused)
    );
    std::fs::write(&file, &text).unwrap();
    for (wrong, says) in [
        ("run-9:1", "run-1, run-2"),
        ("run-1:61", "1 to 60"),
        ("run-1:0", "1 to 60"),
        ("run-1", "RUN:POSITION"),
        ("run-1:a", "RUN:POSITION"),
    ] {
        let refused = of(&["--leave-out", wrong]);
        assert_eq!(code(&refused), 2, "{wrong}");
        assert!(err(&refused).contains(says), "{wrong}: {}", err(&refused));
    }
    // A report that says what was done.
    let text = out(&of(&["--leave-out", "run-2:7"]));
    assert!(
        text.contains("T0132 positions were left out on request") && text.contains("run-2:7"),
        "{text}"
    );
    let chosen = of(&["--leave-out", "run-2:1,2,3,4,5,6,7"]);
    assert_eq!(code(&chosen), 4);
    assert!(out(&chosen).contains("T0133"), "{}", out(&chosen));
}

//! The binary as a user meets it: exit codes, streams, folders.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

mod common;

use std::path::Path;
use std::process::{Command, Output};

use common::{code, demo, err, out, tumble, with_input};

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let dir = demo(&["--gz", "--seed", "5"]);
    let read = |f: &str| std::fs::read(dir.path().join("demo").join(f)).unwrap();
    let first = (read("run-1.csv.gz"), read("truth.toml"), read("experiment.toml"));
    let again = tumble(dir.path(), &["simulate", "demo", "--dwell", "1", "--gz", "--seed", "5"]);
    assert_eq!(code(&again), 0);
    assert!(err(&again).contains("already"), "{}", err(&again));
    assert_eq!(first, (read("run-1.csv.gz"), read("truth.toml"), read("experiment.toml")));
    let other = tumble(dir.path(), &["simulate", "demo", "--dwell", "1", "--gz", "--seed", "6"]);
    assert_eq!(code(&other), 2, "{}", err(&other));
    assert!(err(&other).contains("--replace"));
}

#[test]
fn a_result_is_written_once_and_never_overwritten_in_silence() {
    let dir = demo(&["--seed", "3"]);
    let first = tumble(dir.path(), &["certify", "demo", "--out", "out"]);
    assert_eq!(code(&first), 0, "{}", err(&first));
    for file in [
        "passport.json",
        "passport.html",
        "figures/residuals.svg",
        "figures/settling.svg",
        "figures/intervals.svg",
        "figures/error-level.svg",
    ] {
        assert!(dir.path().join("out").join(file).exists(), "{file}");
    }
    let json = std::fs::read(dir.path().join("out/passport.json")).unwrap();
    let again = tumble(dir.path(), &["certify", "demo", "--out", "out", "--quiet"]);
    assert_eq!((code(&again), out(&again).as_str()), (0, ""));
    let other = tumble(dir.path(), &["certify", "demo", "--out", "out", "--level", "0.9"]);
    assert_eq!(code(&other), 2);
    assert_eq!(std::fs::read(dir.path().join("out/passport.json")).unwrap(), json);
    let replaced =
        tumble(dir.path(), &["certify", "demo", "--out", "out", "--level", "0.9", "--replace"]);
    assert_eq!(code(&replaced), 0);
    assert_eq!(std::fs::read(dir.path().join("out.old-1/passport.json")).unwrap(), json);
}

#[test]
fn exit_codes_of_the_contract() {
    let dir = demo(&["--seed", "3"]);
    let at = dir.path();
    assert_eq!(code(&tumble(at, &["certify", "demo"])), 0);
    // The paper's plan is usable with a warning.
    assert_eq!(code(&tumble(at, &["certify", "demo", "--strict"])), 3);
    assert_eq!(code(&tumble(at, &["simulate", "one", "--dwell", "1", "--runs", "1"])), 0);
    let one = tumble(at, &["certify", "one"]);
    assert_eq!(code(&one), 4);
    assert!(out(&one).starts_with("INDETERMINATE"), "{}", out(&one));
    assert_eq!(
        code(&tumble(
            at,
            &["simulate", "bent", "--dwell", "1", "--angles", "-65:65:60", "--k2", "9000ug/g2"]
        )),
        0
    );
    let bent = tumble(at, &["certify", "bent", "--out", "bent-out"]);
    assert_eq!(code(&bent), 1);
    assert!(out(&bent).starts_with("REJECTED"));
    assert!(at.join("bent-out/passport.html").exists(), "a rejected experiment gets a report");
    for usage in [
        &["certify", "nowhere"][..],
        &["certify"],
        &["certify", "demo", "--level", "95"],
        &["certify", "demo", "--method", "paper", "--weights", "angle"],
        &["simulate", "x", "--bias", "3"],
        &["frobnicate"],
    ] {
        let o = tumble(at, usage);
        assert_eq!(code(&o), 2, "{usage:?}: {}", err(&o));
        assert!(out(&o).is_empty() && !err(&o).is_empty(), "{usage:?}");
    }
}

#[test]
fn several_folders_and_one_that_is_broken() {
    let dir = demo(&["--seed", "3", "--serial", "A/1"]);
    let at = dir.path();
    std::fs::create_dir(at.join("broken")).unwrap();
    std::fs::write(at.join("broken/experiment.toml"), "[sensor]\nmodle = \"x\"\n").unwrap();
    assert_eq!(
        code(&tumble(at, &["simulate", "twin", "--dwell", "1", "--seed", "4", "--serial", "A/1"])),
        0
    );
    let o = tumble(at, &["certify", "demo", "broken", "twin", "--out", "all"]);
    assert_eq!(code(&o), 2);
    assert!(
        err(&o).contains("broken: ") && err(&o).contains("line 2") && err(&o).contains("`model`"),
        "{}",
        err(&o)
    );
    assert!(at.join("all/A_1/passport.json").exists());
    assert!(at.join("all/A_1-twin/passport.json").exists());
}

#[test]
fn readings_become_accelerations_with_two_uncertainties() {
    let dir = demo(&["--seed", "3", "--max-code", "2047", "--min-code", "-2048"]);
    let at = dir.path();
    assert_eq!(code(&tumble(at, &["certify", "demo", "--out", "out", "--quiet"])), 0);
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(at.join("out/passport.json")).unwrap()).unwrap();
    let c = &json["compensation"];
    let (k, b) = (c["scale_factor"].as_f64().unwrap(), c["bias"].as_f64().unwrap());
    let o = with_input(
        at,
        &["compensate", "out/passport.json"],
        "t_s,code\n0.00,100\n0.02,-7\n0.04,2047\n",
    );
    assert_eq!(code(&o), 0, "{}", err(&o));
    let text = out(&o);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "t_s,code,acceleration_m_s2,u_calibration_m_s2,u_reading_m_s2");
    let first: Vec<f64> = lines[1].split(',').map(|f| f.parse().unwrap()).collect();
    assert!((first[2] - (k * 100.5 - b)).abs() < 1e-8, "{}", lines[1]);
    assert!(first[3] > 0.0 && first[4] > k / 12f64.sqrt());
    assert_eq!(lines[3], "0.04,2047,,,");
    assert!(err(&o).contains("converter's end"), "{}", err(&o));
    // The passport's own worked number.
    let example = &c["example"];
    let o = with_input(at, &["compensate", "out/passport.json"], &format!("{}\n", example["code"]));
    let a: f64 = out(&o).lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((a - example["acceleration_m_s2"].as_f64().unwrap()).abs() < 1e-8);
    // A bad line is named; what came before it stays.
    let o = with_input(at, &["compensate", "out/passport.json"], "1\n2\n=cmd\n");
    assert_eq!((code(&o), out(&o).lines().count()), (2, 3));
    assert!(err(&o).contains("line 3"), "{}", err(&o));
}

#[test]
fn coefficients_without_proof_are_refused() {
    let dir = demo(&["--runs", "1"]);
    let at = dir.path();
    assert_eq!(code(&tumble(at, &["certify", "demo", "--out", "out", "--quiet"])), 4);
    let o = with_input(at, &["compensate", "out/passport.json"], "1\n");
    assert_eq!(code(&o), 4);
    assert!(out(&o).is_empty() && err(&o).contains("--unproven"), "{}", err(&o));
    assert_eq!(code(&with_input(at, &["compensate", "out/passport.json", "--unproven"], "1\n")), 0);
    let rejected = std::fs::read_to_string(at.join("out/passport.json"))
        .unwrap()
        .replace("\"indeterminate\"", "\"rejected\"");
    std::fs::write(at.join("rejected.json"), rejected).unwrap();
    assert_eq!(code(&with_input(at, &["compensate", "rejected.json", "--unproven"], "1\n")), 1);
    let mut edited: serde_json::Value =
        serde_json::from_slice(&std::fs::read(at.join("out/passport.json")).unwrap()).unwrap();
    edited["compensation"]["bias"] = 5.0.into();
    std::fs::write(at.join("edited.json"), edited.to_string()).unwrap();
    let o = with_input(at, &["compensate", "edited.json", "--unproven"], "1\n");
    assert_eq!((code(&o), out(&o).as_str()), (2, ""));
    assert!(err(&o).contains("edited or damaged"), "{}", err(&o));
    std::fs::write(at.join("junk.json"), "{\"schema\": \"tumble-passport/9\"}").unwrap();
    let junk = with_input(at, &["compensate", "junk.json"], "1\n");
    assert_eq!(code(&junk), 2);
    assert!(err(&junk).contains("tumble-passport/9"));
}

#[test]
fn json_is_the_passport_and_nothing_else() {
    let dir = demo(&["--seed", "3"]);
    let o =
        tumble(dir.path(), &["certify", "demo", "--json", "--id", "K-7", "--issued", "2026-11-23"]);
    let json: serde_json::Value = serde_json::from_slice(&o.stdout).unwrap();
    assert_eq!((json["id"].as_str(), json["issued"].as_str()), (Some("K-7"), Some("2026-11-23")));
    assert!(o.stderr.is_empty());
    let without = tumble(dir.path(), &["certify", "demo", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&without.stdout).unwrap();
    assert_eq!((json["id"].as_str(), json["issued"].as_str()), (Some(""), None));
}

#[test]
fn an_averaged_record_and_an_upright_pair_are_read() {
    let dir = demo(&[
        "--averaged",
        "--updown",
        "--lean",
        "20arcmin",
        "--scale-pair",
        "--angles",
        "-60:60:13",
    ]);
    let o = tumble(dir.path(), &["certify", "demo", "--json"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let json: serde_json::Value = serde_json::from_slice(&o.stdout).unwrap();
    assert_eq!(json["runs"][0]["positions"], 15);
    assert_eq!(json["inputs"].as_array().unwrap().len(), 8);
    assert!(json["findings"].as_array().unwrap().iter().any(|f| f["id"] == "T0308"));
}

#[test]
fn methods_and_weights_that_do_not_go_together_are_refused() {
    let dir = demo(&["--seed", "3"]);
    for (method, weights) in [("exact", "stated"), ("paper", "angle"), ("paper", "stated")] {
        let o = tumble(dir.path(), &["certify", "demo", "--method", method, "--weights", weights]);
        assert_eq!(code(&o), 2, "{method} {weights}");
        assert!(err(&o).contains("--weights"), "{}", err(&o));
    }
    let stated = tumble(dir.path(), &["certify", "demo", "--weights", "stated", "--json"]);
    assert!(out(&stated).contains("\"weights\": \"stated\""), "{}", out(&stated));
    // What is not stated cannot be taken as known.
    let file = dir.path().join("demo/experiment.toml");
    let toml = std::fs::read_to_string(&file).unwrap();
    let silent: Vec<&str> =
        toml.lines().filter(|l| !l.starts_with("angle_uncertainty_arcmin")).collect();
    std::fs::write(&file, silent.join("\n")).unwrap();
    let o = tumble(dir.path(), &["certify", "demo", "--weights", "stated"]);
    assert_eq!(code(&o), 2);
    assert!(err(&o).contains("angle_uncertainty_arcmin"), "{}", err(&o));
}

/// The bench has a converter that ends at ±500 codes: the default method uses those dwells, the others leave them out.
#[test]
fn dwells_at_the_converters_ends_are_bounds_for_the_likelihood() {
    let dir = demo(&["--seed", "3", "--angles", "-40:40:41", "--min-code=-500", "--max-code=500"]);
    let positions = |o: &Output| -> u64 {
        let passport: serde_json::Value = serde_json::from_str(&out(o)).unwrap();
        passport["runs"][0]["positions"].as_u64().unwrap()
    };
    let bounds = tumble(dir.path(), &["certify", "demo", "--json"]);
    assert!(out(&bounds).contains("used as bounds"), "{}", out(&bounds));
    let averages = tumble(dir.path(), &["certify", "demo", "--json", "--method", "exact"]);
    assert!(out(&averages).contains("left out"), "{}", out(&averages));
    assert_eq!(positions(&bounds), 41);
    assert!(positions(&averages) < 30);
}

#[test]
fn findings_are_explained_by_id_by_list_as_page_and_as_json() {
    let dir = tempfile::tempdir().unwrap();
    let explain = |args: &[&str]| tumble(dir.path(), &[&["explain"], args].concat());
    let one = explain(&["T0205"]);
    assert_eq!((code(&one), err(&one).as_str()), (0, ""));
    assert!(out(&one).starts_with("T0205  warning  two parameters are hard to tell apart\n"));
    for typed in ["t205", "205", "t0205"] {
        assert_eq!(out(&explain(&[typed])), out(&one), "{typed}");
    }
    let two = out(&explain(&["205", "T0107"]));
    assert!(two.contains("T0205  warning") && two.contains("\nT0107  rejects"), "{two}");
    let all = out(&explain(&[]));
    for kind in tumble_core::FindingKind::ALL {
        assert!(all.contains(&format!("{}  ", kind.id())) && all.contains(kind.title()));
    }
    let wrong = explain(&["T0199"]);
    assert_eq!((code(&wrong), out(&wrong).as_str()), (2, ""));
    assert!(
        err(&wrong).contains("no finding has the id `T0199`") && err(&wrong).contains("T0201"),
        "{}",
        err(&wrong)
    );
    let json: serde_json::Value =
        serde_json::from_slice(&explain(&["205", "--json"]).stdout).unwrap();
    assert_eq!(json[0]["id"], "T0205");
    for field in ["severity", "title", "means", "why", "todo", "verdict", "source"] {
        assert!(json[0][field].as_str().is_some_and(|t| !t.is_empty()), "{field}");
    }
    let json: serde_json::Value = serde_json::from_slice(&explain(&["--json"]).stdout).unwrap();
    assert_eq!(json.as_array().unwrap().len(), tumble_core::FindingKind::ALL.len());
}

/// `TUMBLE_BLESS=1` writes the page anew.
#[test]
fn the_page_of_findings_is_what_the_code_says() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/findings.md");
    let written = out(&tumble(Path::new("."), &["explain", "--markdown"]));
    if std::env::var_os("TUMBLE_BLESS").is_some() {
        std::fs::write(&page, &written).unwrap();
    }
    let there = std::fs::read_to_string(&page).unwrap_or_default();
    assert!(
        there == written,
        "docs/findings.md is not what the code says; TUMBLE_BLESS=1 cargo test -p tumble writes it"
    );
}

#[test]
fn without_a_command_there_are_first_steps() {
    let o = tumble(Path::new("."), &[]);
    assert_eq!((code(&o), out(&o).as_str()), (2, ""));
    assert!(err(&o).contains("First steps:") && err(&o).contains("tumble certify"), "{}", err(&o));
}

#[test]
fn completions_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let o = tumble(Path::new("."), &["completions", shell]);
        assert_eq!((code(&o), err(&o).as_str()), (0, ""), "{shell}");
        for word in ["certify", "explain", "--issued"] {
            let word = if shell == "fish" { word.trim_start_matches('-') } else { word };
            assert!(out(&o).contains(word), "{shell}: {word}");
        }
    }
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("tumble.bash");
    std::fs::write(&file, tumble(dir.path(), &["completions", "bash"]).stdout).unwrap();
    match Command::new("bash").arg("-n").arg(&file).output() {
        Ok(o) => assert!(o.status.success(), "{}", err(&o)),
        Err(e) => eprintln!("bash -n was not run: {e}"),
    }
}

#[test]
fn manual_pages_are_written_beside_those_of_others() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    std::fs::create_dir(at.join("man1")).unwrap();
    std::fs::write(at.join("man1/other.1"), "not ours").unwrap();
    let first = tumble(at, &["man", "--out", "man1"]);
    assert_eq!((code(&first), out(&first).as_str()), (0, ""), "{}", err(&first));
    let read = |f: &str| std::fs::read_to_string(at.join("man1").join(f)).unwrap();
    assert_eq!(read("other.1"), "not ours");
    assert_eq!(read("tumble.1"), out(&tumble(at, &["man"])));
    assert!(read("tumble-certify.1").contains("Examples:"));
    let again = tumble(at, &["man", "--out", "man1"]);
    assert!(code(&again) == 0 && err(&again).contains("wrote 0 of"), "{}", err(&again));
    std::fs::write(at.join("man1/tumble-certify.1"), "somebody's own").unwrap();
    std::fs::remove_file(at.join("man1/tumble.1")).unwrap();
    let refused = tumble(at, &["man", "--out", "man1"]);
    assert!(code(&refused) == 2 && err(&refused).contains("--replace"), "{}", err(&refused));
    assert!(!at.join("man1/tumble.1").exists(), "all or nothing");
    assert_eq!(read("tumble-certify.1"), "somebody's own");
    assert_eq!(code(&tumble(at, &["man", "--out", "man1", "--replace"])), 0);
    assert!(read("tumble-certify.1").contains("Examples:"));
}

#[test]
fn errors_say_what_where_and_one_thing_to_do() {
    let dir = demo(&["--seed", "3"]);
    let at = dir.path();
    let toml = std::fs::read_to_string(at.join("demo/experiment.toml")).unwrap();
    let with = |from: &str, to: &str| {
        assert!(toml.contains(from), "{from}");
        std::fs::write(at.join("demo/experiment.toml"), toml.replace(from, to)).unwrap();
        let o = tumble(at, &["certify", "demo"]);
        assert_eq!((code(&o), out(&o).as_str()), (2, ""), "{to}: {}", err(&o));
        err(&o)
    };
    for (from, to, told) in [
        (
            "\"run-1.csv\"",
            "\"run1.csv\"",
            "`run1.csv` is not in the folder; did you mean `run-1.csv`",
        ),
        ("\"run-1.csv\"", "\"photo.jpg\"", "`photo.jpg` is not in the folder; name a file"),
        ("gravity = 9.81", "gravity = 9,81", "write gravity = 9.81"),
        ("\"run-1.csv\"", "\"C:\\data\\run-1.csv\"", "write file = \"C:/data/run-1.csv\""),
        ("\"run-1.csv\"", "\"data\\run-1.csv\"", "/ between folders"),
        ("\"run-1.csv\"", "'data\\run-1.csv'", "has backslashes; write / between folders"),
        ("format = 1", "format = 1\nissued = \"soon\"", "YYYY-MM-DD"),
    ] {
        let text = with(from, to);
        assert!(text.contains(told) && !text.contains("os error"), "{text}");
    }
    let o = tumble(at, &["compensate", "demo"]);
    assert_eq!(code(&o), 2);
    assert!(
        err(&o).contains("demo: it is a folder where a file should be; name a file in it"),
        "{}",
        err(&o)
    );
    let o = tumble(at, &["compensate", "demo/truth.tml"]);
    assert!(err(&o).contains("did you mean `truth.toml`"), "{}", err(&o));
    let o = tumble(at, &["simulate", "x", "--dwell", "-1"]);
    assert!(code(&o) == 2 && err(&o).contains("give a positive number"), "{}", err(&o));
}

/// What a reader without colours misses is nothing: there are none. Verdict, severities and ids are words.
#[test]
fn data_on_standard_output_have_no_colour() {
    let dir = demo(&["--seed", "3", "--runs", "1"]);
    for (args, word) in [
        (&["certify", "demo"][..], "INDETERMINATE"),
        (&["explain"], "rejects"),
        (&["explain", "T0205"], "warning"),
    ] {
        let o = Command::new(env!("CARGO_BIN_EXE_tumble"))
            .args(args)
            .current_dir(dir.path())
            .env("CLICOLOR_FORCE", "1")
            .env_remove("NO_COLOR")
            .output()
            .unwrap();
        let text = out(&o);
        assert!(text.contains(word) && !text.contains('\u{1b}'), "{args:?}: {text}");
        assert!(text.lines().all(|l| l.chars().count() <= 80), "{args:?}: {text}");
    }
}

#[test]
fn limits_judge_the_unit_and_change_no_exit_code() {
    let dir = demo(&["--seed", "3"]);
    let at = dir.path();
    let file = at.join("demo/experiment.toml");
    let plain = std::fs::read_to_string(&file).unwrap();
    let with = |lines: &str| std::fs::write(&file, format!("{plain}\n[spec]\n{lines}\n")).unwrap();
    for (lines, words) in [
        (
            "bias_limits_mg = [900, 1000]",
            "conformity    FAIL - guarded acceptance, guard band 1 U (95 %)",
        ),
        ("bias_limits_mg = 900", "conformity    PASS - guarded acceptance, guard band 1 U (95 %)"),
        (
            "scale_error_limits_percent = 90\ndecision_rule = \"simple\"",
            "PASS - simple acceptance, no guard band",
        ),
    ] {
        with(lines);
        let o = tumble(at, &["certify", "demo"]);
        assert_eq!(code(&o), 0, "{lines}: {}", err(&o));
        assert!(out(&o).starts_with("ACCEPTED") && out(&o).contains(words), "{}", out(&o));
    }
    for (lines, key, remedy) in [
        ("bias_limits_m_s2 = [1, -1]", "bias_limits_m_s2", "[lowest, highest]"),
        ("bias_limits_m_s2 = \"25 mg\"", "limits", "[lowest, highest]"),
        ("bias_limits = 1", "bias_limits", "did you mean"),
        ("decision_rule = \"strict\"", "decision_rule", "\"guarded\""),
    ] {
        with(lines);
        let o = tumble(at, &["certify", "demo"]);
        let line = format!("line {}", plain.lines().count() + 3);
        assert_eq!(code(&o), 2, "{lines}: {}", out(&o));
        for text in ["experiment.toml", key, remedy, &line] {
            assert!(err(&o).contains(text), "{lines}: no {text} in {}", err(&o));
        }
    }
}

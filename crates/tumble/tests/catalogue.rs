//! `tumble catalogue`, catalogues of users, and what a limit of a type does to a certificate.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use common::{code, err, out, tumble};
use serde_json::Value;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn json(o: &Output) -> Value {
    serde_json::from_str(&out(o)).unwrap_or_else(|e| panic!("{e}: {}{}", out(o), err(o)))
}

/// The example of `docs/catalogue.md`.
fn documented() -> String {
    let page = fs::read_to_string(repository().join("docs/catalogue.md")).unwrap();
    let (_, rest) = page.split_once("```toml\n").unwrap();
    rest.split_once("```").unwrap().0.to_owned()
}

/// A folder with a short simulated experiment `demo` of a wide range.
fn demo(extra: &[&str]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    let base = ["simulate", "demo", "--dwell", "1", "--runs", "2", "--angles", "-60:60:13"];
    let made = tumble(dir.path(), &[&base, extra].concat());
    assert_eq!(code(&made), 0, "{}", err(&made));
    dir
}

/// Findings T0125 of a certificate in JSON.
fn outside(passport: &Value) -> Vec<&Value> {
    passport["findings"].as_array().unwrap().iter().filter(|f| f["id"] == "T0125").collect()
}

#[test]
fn the_list_and_every_entry_fit_a_terminal() {
    let here = tempfile::tempdir().unwrap();
    let list = tumble(here.path(), &["catalogue"]);
    assert_eq!((code(&list), err(&list).as_str()), (0, ""));
    let all = json(&tumble(here.path(), &["catalogue", "--json"]));
    let sensors = all["sensors"].as_array().unwrap();
    assert!(sensors.len() >= 9, "{}", sensors.len());
    for entry in sensors.iter().chain(all["converters"].as_array().unwrap()) {
        let model = entry["model"].as_str().unwrap();
        assert!(out(&list).contains(model), "{model}");
        let one = tumble(here.path(), &["catalogue", model]);
        assert_eq!(code(&one), 0, "{}", err(&one));
        assert!(out(&one).contains("source") && out(&one).starts_with(model), "{}", out(&one));
        assert!(out(&one).is_ascii() && out(&one).lines().all(|l| l.len() <= 80), "{}", out(&one));
        assert_eq!(&json(&tumble(here.path(), &["catalogue", model, "--json"])), entry);
    }
    assert!(out(&list).lines().all(|l| l.len() <= 80), "{}", out(&list));
    let adxl = out(&tumble(here.path(), &["catalogue", "adxl 203ce"]));
    assert!(adxl.contains("1000 mV/g (verified); tolerance +-4 % (recalled)"), "{adxl}");
}

#[test]
fn an_unknown_model_is_refused_with_the_nearest() {
    let here = tempfile::tempdir().unwrap();
    let near = tumble(here.path(), &["catalogue", "ADXL204"]);
    assert_eq!((code(&near), out(&near).as_str()), (2, ""));
    assert!(err(&near).contains("ADXL203"), "{}", err(&near));
    let far = tumble(here.path(), &["catalogue", "flux capacitor"]);
    assert_eq!(code(&far), 2);
    assert!(err(&far).contains("docs/catalogue.md"), "{}", err(&far));
    let file = tumble(here.path(), &["catalogue", "--catalogue", "nowhere.toml"]);
    assert_eq!(code(&file), 2);
    assert!(err(&file).contains("nowhere.toml"), "{}", err(&file));
}

#[test]
fn the_documented_example_is_a_catalogue() {
    let here = tempfile::tempdir().unwrap();
    fs::write(here.path().join("mine.toml"), documented()).unwrap();
    let run = |args: &[&str]| {
        tumble(here.path(), &[&["catalogue", "--catalogue", "mine.toml"], args].concat())
    };
    let board = run(&["My-Board"]);
    assert_eq!(code(&board), 0, "{}", err(&board));
    assert!(
        out(&board).contains("Drawing 7-113") && out(&board).contains("5 V: 500 mV/g (verified)")
    );
    assert!(out(&board).contains("mine.toml (--catalogue)"), "{}", out(&board));
    assert_eq!(code(&run(&["MC-3"])), 0);
    // The built-in ones are still there.
    assert_eq!(code(&run(&["ADXL203"])), 0);
    let list = out(&run(&[]));
    assert!(list.contains("MB-7") && list.contains("MPU-6050"), "{list}");
}

#[test]
fn a_folders_catalogue_is_read_recorded_and_judged_by() {
    let dir = demo(&["--model", "my board", "--bias", "60mg"]);
    let at = dir.path();
    let free = json(&tumble(at, &["certify", "demo", "--json"]));
    assert_eq!((free["sensor"].get("type"), outside(&free).len()), (None, 0));

    let file = at.join("demo/catalogue.toml");
    fs::write(&file, documented()).unwrap();
    let inside = json(&tumble(at, &["certify", "demo", "--json"]));
    assert_eq!(inside["verdict"], "accepted");
    assert_eq!(inside["sensor"]["type"]["model"], "MB-7");
    assert_eq!(inside["sensor"]["type"]["catalogue"], "catalogue.toml");
    assert_eq!(inside["inputs"][1]["file"], "catalogue.toml");
    assert_eq!(outside(&inside), Vec::<&Value>::new());

    fs::write(&file, documented().replace("maximum = 100.0", "maximum = 50.0")).unwrap();
    let o = tumble(at, &["certify", "demo", "--json"]);
    let p = json(&o);
    assert_eq!((code(&o), p["verdict"].as_str()), (0, Some("accepted")));
    let found = outside(&p);
    assert_eq!((found.len(), found[0]["severity"].as_str()), (1, Some("warning")), "{found:?}");
    assert_eq!(found[0]["place"].as_str().or(found[0]["where"].as_str()), Some("bias"));
    let limit = found[0]["limit"].as_str().unwrap();
    for words in ["MB-7", "50 mg", "recalled, not verified", "Drawing 7-113"] {
        assert!(limit.contains(words), "{words}: {limit}");
    }
    assert_ne!(p["inputs"][1]["sha256"], inside["inputs"][1]["sha256"]);

    // A catalogue of the command line goes before the folder's.
    fs::write(at.join("lab.toml"), documented()).unwrap();
    let lab = json(&tumble(at, &["certify", "demo", "--json", "--catalogue", "lab.toml"]));
    assert_eq!(outside(&lab).len(), 0);
    assert_eq!(lab["sensor"]["type"]["catalogue"], "lab.toml (--catalogue)");
    assert_eq!(lab["inputs"][2]["file"], "lab.toml (--catalogue)");
    // Wherever it lies: no path of this machine gets into the passport.
    let whole = at.join("lab.toml").display().to_string();
    let again = tumble(at, &["certify", "demo", "--json", "--catalogue", &whole]);
    assert_eq!(json(&again), lab);
}

#[test]
fn a_broken_catalogue_is_refused_with_its_place() {
    let dir = demo(&[]);
    let at = dir.path();
    let broken = documented().replace("tolerance_percent", "tolerence_percent");
    fs::write(at.join("demo/catalogue.toml"), &broken).unwrap();
    let o = tumble(at, &["certify", "demo"]);
    assert_eq!((code(&o), out(&o).as_str()), (2, ""));
    let text = err(&o);
    assert!(text.contains("catalogue.toml, line 17, column 1"), "{text}");
    assert!(text.contains("did you mean `tolerance_percent`?"), "{text}");
    fs::remove_file(at.join("demo/catalogue.toml")).unwrap();
    fs::write(at.join("lab.toml"), broken).unwrap();
    let o = tumble(at, &["certify", "demo", "--catalogue", "lab.toml"]);
    assert_eq!(code(&o), 2);
    assert!(err(&o).contains("lab.toml, line 17"), "{}", err(&o));
    assert_eq!(code(&tumble(at, &["certify", "demo", "--catalogue", "none.toml"])), 2);
}

#[cfg(unix)]
#[test]
fn a_catalogue_that_is_a_link_out_of_the_folder_is_refused() {
    let dir = demo(&[]);
    fs::write(dir.path().join("outside.toml"), documented()).unwrap();
    let link = dir.path().join("demo/catalogue.toml");
    std::os::unix::fs::symlink(dir.path().join("outside.toml"), link).unwrap();
    let o = tumble(dir.path(), &["certify", "demo"]);
    assert_eq!(code(&o), 2);
    assert!(err(&o).contains("leaves the experiment folder"), "{}", err(&o));
}

/// The example and the presets of the paper are ADXL203s through a converter that nobody names: no false alarm.
#[test]
fn the_papers_sensors_raise_no_alarm() {
    let example = json(&tumble(&repository(), &["certify", "examples/adxl203-3", "--json"]));
    assert_eq!(example["verdict"], "accepted");
    assert_eq!(example["sensor"]["type"]["model"], "ADXL203");
    assert_eq!(example["sensor"]["type"]["catalogue"], "built-in");
    assert_eq!(outside(&example), Vec::<&Value>::new());
    for preset in ["paper-1", "paper-2", "paper-3"] {
        let dir = demo(&["--preset", preset]);
        let p = json(&tumble(dir.path(), &["certify", "demo", "--json"]));
        assert_eq!(p["sensor"]["type"]["model"], "ADXL203", "{preset}");
        assert_eq!(outside(&p), Vec::<&Value>::new(), "{preset}");
    }
}

/// A digital sensor of the catalogue: its nominal scale is that of its mode, and a unit beyond the tolerance warns.
#[test]
fn a_digital_sensor_is_held_against_its_sensitivity() {
    let scale = (9.80665 / 16_384.0).to_string();
    for (error, expected) in [("2%", 0), ("5%", 1), ("-5%", 1)] {
        let dir = demo(&[
            "--model",
            "mpu6050",
            "--nominal-scale",
            &scale,
            "--scale-error",
            error,
            "--noise",
            "400ug/rtHz",
            "--bias",
            "10mg",
            "--scatter",
            "0.5arcmin",
        ]);
        // Its nonlinearity of 0.5 % (verified) is more than the paper's plan can bear; here the sensitivity is asked for.
        let file = dir.path().join("demo/experiment.toml");
        let text = std::fs::read_to_string(&file).unwrap();
        let straight = "[sensor]\nk2_uncertainty_ug_per_g2 = 0\nk3_uncertainty_ug_per_g3 = 0\n";
        std::fs::write(&file, text.replace("[sensor]\n", straight)).unwrap();
        let p = json(&tumble(dir.path(), &["certify", "demo", "--json"]));
        assert_eq!(p["verdict"], "accepted", "{error}: {:#}", p["reasons"]);
        let found = outside(&p);
        assert_eq!(found.len(), expected, "{error}: {found:#?}");
        for f in found {
            let limit = f["limit"].as_str().unwrap();
            assert!(limit.contains("16384 LSB/g ± 3 % (verified"), "{limit}");
        }
    }
}

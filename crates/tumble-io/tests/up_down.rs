//! Measured records with the axis up and down: a MEMS sensor and a navigation-grade one (`../shared/data/talhaitis_updown`).
//!
//! The published program calls the sensitivity error −200.5 % where the axis that reads +g is taken for the one that points
//! down: a sign-convention error. The data are made by others and stay outside this repository; without them this is
//! skipped aloud.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

use std::path::{Path, PathBuf};

use tumble_io::passport::Passport;
use tumble_io::{CertifyOptions, InitFacts, certify, draft_experiment, experiment_file};

fn data() -> Option<PathBuf> {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/talhaitis_updown");
    if folder.exists() {
        return Some(folder);
    }
    println!("SKIPPED: {} is not here", folder.display());
    None
}

/// Copies two records into a folder, drafts its experiment.toml with the author's gravity, and certifies it.
fn certified(data: &Path, up: &str, down: &str, change: impl Fn(String) -> String) -> Passport {
    let dir = tempfile::tempdir().unwrap();
    let files: Vec<PathBuf> = [up, down]
        .iter()
        .map(|name| {
            let to = dir.path().join(name);
            std::fs::copy(data.join(name), &to).unwrap();
            to
        })
        .collect();
    let facts = InitFacts { gravity_m_s2: Some(9.81), ..InitFacts::default() };
    let draft = draft_experiment(&files, &facts, &()).unwrap();
    assert!(
        draft.toml.contains("up = ") && draft.toml.contains("unit = \"m/s2\""),
        "{}",
        draft.toml
    );
    std::fs::write(experiment_file(dir.path()), change(draft.toml)).unwrap();
    certify(dir.path(), &CertifyOptions::default()).unwrap()
}

/// The two-position formulae take the axis to stand upright exactly.
fn upright(toml: String) -> String {
    toml.replacen("[bench]\n", "[bench]\nupdown_lean_arcmin = 0.0\n", 1)
}

/// Reference values of `reference.json`, computed with numpy by the two-position formulae.
fn reference(data: &Path, sensor: &str, key: &str) -> f64 {
    let text = std::fs::read_to_string(data.join("reference.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    json[sensor][key].as_f64().unwrap()
}

#[test]
fn bias_and_scale_as_published_misalignment_undetermined() {
    let Some(data) = data() else { return };
    for (sensor, up, down) in
        [("adi", "x_adi_up.txt", "x_adi_down.txt"), ("ln100", "x_LN100_up.csv", "x_LN100_down.csv")]
    {
        let p = certified(&data, up, down, upright);
        let e = &p.runs[0].estimates;
        // S = ((down − up) − 2g)/2g with up and down exchanged: the sensitivity error is −2 − S.
        let published = -2.0 - reference(&data, sensor, "scale_err");
        let expected = 1.0 / (1.0 + published) - 1.0;
        let scale_error = e.scale_error.as_ref().unwrap().value;
        println!(
            "{sensor}: sensitivity error {:+.6} %, scale error {:+.6} %",
            100.0 * published,
            100.0 * scale_error
        );
        assert!((scale_error - expected).abs() < 1e-9, "{scale_error} {expected}");
        // b = (up + down)/2 is a reading; as an acceleration it has the scale factor in it.
        let bias = reference(&data, sensor, "bias") * (1.0 + expected);
        assert!((e.bias.as_ref().unwrap().value - bias).abs() < 1e-9, "{:?} {bias}", e.bias);
        assert!(e.misalignment.is_none());
        assert_eq!(p.verdict, "indeterminate");
        let missing = p.findings.iter().find(|f| f.id == "T0201").unwrap();
        assert!(
            missing.observed.contains("misalignment") && missing.todo.contains("−30°, 0° and 30°"),
            "{missing:?}"
        );
        assert!(p.result.is_none() && p.compensation.is_none());
    }
    let of = |p: &Passport| p.runs[0].estimates.scale_error.as_ref().unwrap().value;
    let adi = of(&certified(&data, "x_adi_up.txt", "x_adi_down.txt", upright));
    assert!((adi - -0.004_990_03).abs() < 1e-8, "{adi}");
    // Nobody says how upright the boxes stood: by default 30′ of lean are expected, which only ever take from 1 g.
    let leaning = of(&certified(&data, "x_adi_up.txt", "x_adi_down.txt", |t| t));
    let lean = (30.0f64 / 60.0).to_radians();
    assert!((leaning - adi + 0.5 * lean * lean).abs() < 1e-6, "{leaning} {adi}");
}

#[test]
fn the_sign_trap_is_named() {
    let Some(data) = data() else { return };
    let exchanged = |t: String| {
        t.replace("x_adi_up.txt", "x_adi_other.txt")
            .replace("x_adi_down.txt", "x_adi_up.txt")
            .replace("x_adi_other.txt", "x_adi_down.txt")
    };
    let p = certified(&data, "x_adi_up.txt", "x_adi_down.txt", exchanged);
    assert_eq!(p.verdict, "rejected");
    let found = p.findings.iter().find(|f| f.id == "T0101").unwrap();
    assert_eq!(found.place, "[scale]");
    assert!(
        found.observed.contains("-9.8553") && found.todo.contains("pull of gravity"),
        "{found:?}"
    );
    assert!(!p.findings.iter().any(|f| f.id == "T0117"), "{:?}", p.findings);
}

#[test]
fn records_whose_names_are_exchanged_are_drafted_as_they_read() {
    let Some(data) = data() else { return };
    let dir = tempfile::tempdir().unwrap();
    let (up, down) = (dir.path().join("up.txt"), dir.path().join("down.txt"));
    std::fs::copy(data.join("x_adi_down.txt"), &up).unwrap();
    std::fs::copy(data.join("x_adi_up.txt"), &down).unwrap();
    let draft = draft_experiment(&[up, down], &InitFacts::default(), &()).unwrap();
    assert!(
        draft.toml.contains("up = \"down.txt\"") && draft.toml.contains("down = \"up.txt\""),
        "{}",
        draft.toml
    );
    let said = draft.assumed.iter().find(|a| a.key == "[scale] up").unwrap();
    assert!(said.why.contains("pull of gravity"), "{said:?}");
}

//! Hopeless experiments: none is accepted, each says why and what to do.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed.

#[path = "degenerate/bench.rs"]
mod bench;
#[path = "degenerate/misleading.rs"]
mod misleading;

use std::fmt::Write as _;
use std::path::Path;

use tumble_io::passport::Passport;
use tumble_io::{CertifyOptions, certify};

const G: f64 = 9.81;
const K0: f64 = 0.007_69;

/// Deterministic noise: sum of twelve uniform numbers, close enough to Gaussian here.
struct Noise(u64);
impl Noise {
    fn next(&mut self) -> f64 {
        (0..12)
            .map(|_| {
                self.0 = self
                    .0
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (self.0 >> 33) as f64 / f64::from(1u32 << 31)
            })
            .sum::<f64>()
            - 6.0
    }
}

/// A hopeless experiment.
struct Case {
    name: &'static str,
    /// Angles as written, degrees.
    angles: Vec<f64>,
    /// Mean code at an angle (degrees, number of the position), before noise.
    code: fn(f64, usize) -> f64,
    /// Scatter of the positions, LSB.
    scatter: f64,
    runs: u64,
    /// What replaces or adds to the usual experiment.toml.
    nominal_scale: f64,
    extra_output: &'static str,
    /// Accepted verdicts, and a finding that must be there.
    verdict: &'static str,
    finding: &'static str,
    /// A word of the cure.
    cure: &'static str,
}

fn healthy(deg: f64, _: usize) -> f64 {
    (G * deg.to_radians().sin() - 0.0063) / K0
}

fn steps(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..n).map(|i| from + (to - from) * i as f64 / (n - 1) as f64).collect()
}

impl Case {
    fn new(
        name: &'static str,
        angles: Vec<f64>,
        verdict: &'static str,
        finding: &'static str,
        cure: &'static str,
    ) -> Self {
        Self {
            name,
            angles,
            code: healthy,
            scatter: 0.2,
            runs: 3,
            nominal_scale: K0,
            extra_output: "",
            verdict,
            finding,
            cure,
        }
    }

    fn code(self, code: fn(f64, usize) -> f64) -> Self {
        Self { code, ..self }
    }

    fn certify(&self) -> Passport {
        let dir = tempfile::tempdir().unwrap();
        let mut toml = format!(
            "format = 1\n[sensor]\nmodel = \"ADXL203\"\nserial = \"x\"\naxis = \"X\"\n[output]\nquantizer = \"round\"\n\
             nominal_scale = {}\n{}\n[bench]\ngravity = {G}\ngravity_uncertainty = 0.0\nangle_uncertainty_arcmin = 0.55\n",
            self.nominal_scale, self.extra_output
        );
        for run in 0..self.runs {
            let _ = write!(toml, "[[run]]\nfile = \"run-{run}.csv\"\n");
            let mut noise = Noise(run * 7919 + 17);
            let mut csv = String::from("angle_deg,mean_code,samples,std_code\n");
            for (i, angle) in self.angles.iter().enumerate() {
                let mean = (self.code)(*angle, i) + self.scatter * noise.next();
                let _ = writeln!(
                    csv,
                    "{angle},{mean:.6},1500,{}",
                    if self.scatter > 0.0 { "1.25" } else { "0" }
                );
            }
            std::fs::write(dir.path().join(format!("run-{run}.csv")), csv).unwrap();
        }
        std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
        certify_folder(dir.path())
    }
}

fn certify_folder(path: &Path) -> Passport {
    certify(path, &CertifyOptions::default()).unwrap()
}

fn hopeless(name: &str, p: &Passport, verdict: &str, finding: &str, cure: &str) {
    let ids: Vec<&str> = p.findings.iter().map(|f| f.id.as_str()).collect();
    assert_eq!(p.verdict, verdict, "{name}: {ids:?} {:?} {:?}", p.reasons, p.missing);
    let found = p.findings.iter().find(|f| f.id == finding);
    let found = found.unwrap_or_else(|| panic!("{name}: no {finding} in {:#?}", p.findings));
    assert!(found.todo.contains(cure), "{name}: the cure `{}` does not name `{cure}`", found.todo);
    assert!(!found.observed.is_empty() && !found.limit.is_empty(), "{name}: {found:?}");
    let stated = if verdict == "rejected" { &p.reasons } else { &p.missing };
    assert!(stated.iter().any(|r| r.starts_with(finding)), "{name}: {stated:?}");
    assert!(p.result.is_none() && p.compensation.is_none(), "{name} got coefficients");
}

fn cases() -> Vec<Case> {
    let paper = || steps(-30.0, 29.0, 60);
    let wide = || steps(-60.0, 60.0, 60);
    vec![
        Case::new("±10°", steps(-10.0, 10.0, 60), "indeterminate", "T0204", "whole range"),
        Case::new("±5°", steps(-5.0, 5.0, 60), "indeterminate", "T0204", "whole range"),
        Case::new("9…11°", steps(9.0, 11.0, 60), "indeterminate", "T0204", "whole range"),
        Case::new(
            "40…50°, narrow and one-sided",
            steps(40.0, 50.0, 60),
            "indeterminate",
            "T0204",
            "on both sides",
        ),
        Case::new(
            "0…5°, narrow and one-sided",
            steps(0.0, 5.0, 60),
            "indeterminate",
            "T0204",
            "whole range",
        ),
        Case::new(
            "ten positions within 20°",
            steps(0.0, 20.0, 10),
            "indeterminate",
            "T0204",
            "whole range",
        ),
        Case::new("one angle", vec![20.0; 60], "indeterminate", "T0201", "three or more"),
        Case::new("one position", vec![20.0], "indeterminate", "T0201", "three or more"),
        Case::new(
            "two angles",
            [vec![-30.0; 30], vec![30.0; 30]].concat(),
            "indeterminate",
            "T0201",
            "both sides",
        ),
        Case::new("two positions", vec![-30.0, 30.0], "indeterminate", "T0201", "both sides"),
        Case::new(
            "three without repeats",
            vec![-60.0, 0.0, 60.0],
            "indeterminate",
            "T0202",
            "at least twice",
        ),
        Case::new(
            "up and down only, in the run file",
            vec![90.0, -90.0],
            "indeterminate",
            "T0201",
            "both sides of 0°",
        ),
        Case {
            scatter: 0.0,
            ..Case::new(
                "identical positions",
                vec![20.0; 60],
                "rejected",
                "T0115",
                "measure the run again",
            )
        },
        Case {
            scatter: 0.0,
            ..Case::new("all codes equal", wide(), "rejected", "T0107", "fresh samples")
        }
        .code(|_, _| 17.0),
        Case {
            extra_output: "min_code = -2048\nmax_code = 2047",
            scatter: 0.0,
            ..Case::new("saturated throughout", wide(), "rejected", "T0108", "lower the gain")
        }
        .code(|_, _| 2047.0),
        Case {
            extra_output: "min_code = -100\nmax_code = 100",
            ..Case::new("saturated but for a narrow arc", wide(), "indeterminate", "T0204", "")
        }
        .code(|d, i| healthy(d, i).clamp(-100.0, 100.0)),
        Case {
            nominal_scale: K0 / 9.806_65,
            ..Case::new("scale given in g", wide(), "rejected", "T0102", "9.80665")
        },
        Case {
            nominal_scale: K0 * 9.806_65,
            ..Case::new("scale multiplied by g twice", wide(), "rejected", "T0102", "m/s² per LSB")
        },
        Case {
            nominal_scale: K0 * 1000.0,
            ..Case::new("scale in mm/s²", wide(), "rejected", "T0103", "nominal_scale")
        },
        Case {
            nominal_scale: 1.0 / K0,
            ..Case::new("scale upside down", wide(), "rejected", "T0103", "nominal_scale")
        },
        Case {
            nominal_scale: K0 * 4.0,
            ..Case::new("another range of the sensor", wide(), "rejected", "T0103", "range")
        },
        Case::new("sign reversed", wide(), "rejected", "T0101", "angle_sign = -1")
            .code(|d, i| healthy(-d, i)),
        Case::new("sign reversed, paper's plan", paper(), "rejected", "T0101", "angle_sign = -1")
            .code(|d, i| healthy(-d, i)),
        Case::new("strongly cubic", wide(), "rejected", "T0112", "K3")
            .code(|d, i| healthy(d, i) + 30.0 * d.to_radians().sin().powi(3)),
        Case::new("strongly quadratic", wide(), "rejected", "T0111", "K2")
            .code(|d, i| healthy(d, i) + 60.0 * d.to_radians().sin().powi(2)),
        Case::new("K2 of 5 mg/g²", steps(-65.0, 65.0, 60), "rejected", "T0111", "K2")
            .code(|d, i| healthy(d, i) + 0.005 * G * d.to_radians().sin().powi(2) / K0),
        Case::new("scale factor 5 % larger above zero", wide(), "rejected", "T0111", "")
            .code(|d, i| healthy(d, i) * if d > 0.0 { 1.05 } else { 1.0 }),
        Case::new(
            "angle column is a counter",
            (0..60).map(f64::from).collect(),
            "rejected",
            "T0105",
            "counter",
        )
        .code(|d, i| healthy(d - 30.0, i)),
        Case::new(
            "counter over steps of 2°",
            (0..60).map(f64::from).collect(),
            "rejected",
            "T0112",
            "",
        )
        .code(|d, i| healthy(2.0 * d - 60.0, i)),
        Case::new("angles in radians", steps(-1.047, 1.047, 60), "rejected", "T0110", "degrees")
            .code(|d, i| healthy(d.to_degrees(), i)),
        Case::new("angles shuffled", wide(), "rejected", "T0110", "in the order")
            .code(|_, i| healthy(((i * 37) % 60) as f64 * 2.0 - 60.0, i)),
        Case::new("codes without relation to the angle", wide(), "rejected", "T0110", "angles")
            .code(|_, i| ((i * 7919) % 2000) as f64 - 1000.0),
        Case::new("magnitudes only", wide(), "rejected", "T0110", "")
            .code(|d, i| healthy(d, i).abs()),
        Case::new(
            "offset-binary codes taken for signed",
            wide(),
            "rejected",
            "T0104",
            "signed or unsigned",
        )
        .code(|d, i| healthy(d, i) + 2048.0),
        Case::new("converter wraps round", wide(), "rejected", "T0110", "").code(|d, i| {
            let n = healthy(d, i);
            if n > 512.0 { n - 1024.0 } else { n }
        }),
    ]
}

#[test]
fn none_is_accepted_and_each_says_why_and_what_to_do() {
    let cases = cases();
    assert!(cases.len() >= 25, "{} cases", cases.len());
    // All of them, not only the first that fails.
    let failed: Vec<&str> = cases
        .iter()
        .filter(|c| {
            let judged = || hopeless(c.name, &c.certify(), c.verdict, c.finding, c.cure);
            std::panic::catch_unwind(std::panic::AssertUnwindSafe(judged)).is_err()
        })
        .map(|c| c.name)
        .collect();
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn a_converter_that_sticks_in_the_middle_is_named_with_its_place() {
    let case = Case::new("sticks", steps(-60.0, 60.0, 60), "rejected", "T0107", "fresh samples")
        .code(|d, i| if (30..34).contains(&i) { 42.0 } else { healthy(d, i) });
    // Only raw codes show one code in a whole dwell.
    let dir = tempfile::tempdir().unwrap();
    let mut csv = String::from("angle_deg,code\n");
    let mut noise = Noise(5);
    for (i, a) in case.angles.iter().enumerate() {
        for _ in 0..30 {
            let jitter = if (30..34).contains(&i) { 0.0 } else { 1.2 * noise.next() };
            let _ = writeln!(csv, "{a:.4},{:.0}", ((case.code)(*a, i) + jitter).round());
        }
    }
    std::fs::write(dir.path().join("run.csv"), csv).unwrap();
    let toml = format!(
        "[sensor]\nserial = \"x\"\n[output]\nquantizer = \"round\"\nnominal_scale = {K0}\n[bench]\ngravity = {G}\n[[run]]\nfile = \"run.csv\"\n"
    );
    std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    let p = certify_folder(dir.path());
    hopeless("sticks", &p, "rejected", "T0107", "fresh samples");
    let place = &p.findings.iter().find(|f| f.id == "T0107").unwrap().place;
    assert!(place.contains("dwell 32"), "{place}");
}

#[test]
fn scale_pair_alone_gives_what_it_can() {
    let dir = tempfile::tempdir().unwrap();
    let toml = format!(
        "[sensor]\nserial = \"x\"\n[output]\nquantizer = \"round\"\nnominal_scale = {K0}\n[bench]\ngravity = {G}\n\
         [scale]\nup_mean_code = 1290.0\ndown_mean_code = -1260.0\n"
    );
    std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    let p = certify_folder(dir.path());
    hopeless("pair alone", &p, "indeterminate", "T0201", "both sides of 0°");
    let e = &p.runs[0].estimates;
    assert!(e.misalignment.is_none());
    // α = 15 LSB, R = 1275 LSB but for the expected lean of 30′, at most 0.1 LSB here.
    let k = G / 1275.0;
    assert!((e.bias.as_ref().unwrap().value - 15.0 * k).abs() < 1e-4);
    assert!((e.scale_error.as_ref().unwrap().value - (k / K0 - 1.0)).abs() < 1e-4);
}

#[test]
fn the_papers_plan_is_usable_with_a_warning() {
    let case = Case::new("paper", steps(-30.0, 29.0, 60), "accepted", "T0205", "");
    let p = Case { runs: 5, ..case }.certify();
    assert_eq!(p.verdict, "accepted", "{:?} {:?}", p.reasons, p.missing);
    let warning = p.findings.iter().find(|f| f.id == "T0205").unwrap();
    assert!(
        warning.observed.contains("−0.999") || warning.observed.contains("-0.999"),
        "{warning:?}"
    );
    assert!(p.result.is_some() && p.compensation.is_some());
}

#[test]
fn three_angles_with_repeats_are_usable_but_cannot_test_the_model() {
    let angles = [-60.0, 0.0, 60.0].into_iter().flat_map(|a| [a; 20]).collect();
    let case = Case::new("three with repeats", angles, "accepted", "T0203", "");
    let p = Case { runs: 5, ..case }.certify();
    assert_eq!(p.verdict, "accepted", "{:?} {:?}", p.reasons, p.missing);
    assert!(p.findings.iter().any(|f| f.id == "T0203"));
}

#[test]
fn one_run_gets_a_result_that_says_what_is_missing() {
    let case = Case::new("one run", steps(-60.0, 60.0, 60), "indeterminate", "T0206", "");
    let p = Case { runs: 1, ..case }.certify();
    assert_eq!(p.verdict, "indeterminate");
    assert!(p.missing.iter().all(|m| m.starts_with("T0206")), "{:?}", p.missing);
    assert!(p.result.is_some() && p.compensation.is_some());
}

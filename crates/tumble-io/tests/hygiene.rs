//! Faults of the data through files: what a user reads, with file and line.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::fmt::Write as _;

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

fn analogue(deg: f64) -> f64 {
    (G * deg.to_radians().sin() + 0.04) / K0
}

/// Thirteen angles over ±60°.
fn angles() -> impl Iterator<Item = f64> {
    (-6..=6).map(|i| f64::from(i) * 10.0)
}

/// A run of averages: `typed` says what stands in the angle column, `reading` what the sensor delivers.
fn averages(
    seed: u64,
    typed: impl Fn(usize, f64) -> String,
    reading: impl Fn(f64) -> f64,
) -> String {
    let mut noise = Noise(seed);
    let mut csv = String::from("angle_deg,mean_code,samples,std_code\n");
    for (i, deg) in angles().enumerate() {
        let mean = reading(analogue(deg) + 0.2 * noise.next());
        let _ = writeln!(csv, "{},{mean:.9},1500,{:.9}", typed(i + 1, deg), reading(1.2).abs());
    }
    csv
}

/// A run of codes, a hundred a dwell.
fn codes(seed: u64, code: impl Fn(usize, usize, f64) -> i64) -> String {
    let mut noise = Noise(seed);
    let mut csv = String::from("angle_deg,code\n");
    for (i, deg) in angles().enumerate() {
        let level = analogue(deg) + 0.2 * noise.next();
        for k in 0..100 {
            let _ = writeln!(csv, "{deg},{}", code(i + 1, k, (level + 1.2 * noise.next()).round()));
        }
    }
    csv
}

fn judged(output: &str, bench: &str, runs: &[String]) -> Passport {
    let dir = tempfile::tempdir().unwrap();
    let mut toml = format!(
        "[sensor]\nserial = \"x\"\n[output]\n{output}\n[bench]\ngravity = {G}\ngravity_uncertainty = 0.0\n\
         angle_uncertainty_arcmin = 0.55\n{bench}\n"
    );
    for (i, run) in runs.iter().enumerate() {
        std::fs::write(dir.path().join(format!("run-{}.csv", i + 1)), run).unwrap();
        let _ = write!(toml, "[[run]]\nfile = \"run-{}.csv\"\n", i + 1);
    }
    std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    certify(dir.path(), &CertifyOptions::default()).unwrap()
}

/// The finding stands once, where and as it should.
fn says(p: &Passport, verdict: &str, id: &str, [place, observed, todo]: [&str; 3]) {
    let found: Vec<_> = p.findings.iter().filter(|f| f.id == id).collect();
    assert_eq!(found.len(), 1, "{id} in {:#?}", p.findings);
    let f = found[0];
    assert!(f.place.contains(place), "{f:?}");
    assert!(f.observed.contains(observed), "{f:?}");
    assert!(f.todo.contains(todo), "{f:?}");
    assert_eq!(p.verdict, verdict, "{:?} {:?}", p.reasons, p.missing);
}

const ROUND: &str = "quantizer = \"round\"\nnominal_scale = 0.00769\nrate_hz = 50.0";

fn plain(_: usize, deg: f64) -> String {
    deg.to_string()
}

#[test]
fn sound_runs_raise_nothing() {
    let runs: Vec<String> = (1..=3).map(|s| averages(s, plain, |x| x)).collect();
    let p = judged(ROUND, "", &runs);
    assert_eq!(p.verdict, "accepted", "{:?} {:?}", p.reasons, p.missing);
    let of_hygiene = |id: &str| ("T0118".."T0131").contains(&id);
    assert!(p.findings.iter().all(|f| !of_hygiene(&f.id)), "{:#?}", p.findings);
}

#[test]
fn a_mistyped_angle_is_corrected_in_its_line() {
    let typed = |i, deg: f64| if i == 9 { "2".into() } else { deg.to_string() };
    let runs = [averages(1, plain, |x| x), averages(2, typed, |x| x), averages(3, plain, |x| x)];
    let p = judged(ROUND, "", &runs);
    let cure = "if the table stood at 20°, correct the angle in line 10 of run-2.csv";
    says(
        &p,
        "rejected",
        "T0119",
        ["run-2.csv, line 10, dwell 9", "2° is typed where the readings fit 20.0°", cure],
    );
    assert!(p.result.is_none() && p.compensation.is_none());
}

#[test]
fn one_run_among_others_is_backwards() {
    let turned = |_, deg: f64| (-deg).to_string();
    let runs = [averages(1, plain, |x| x), averages(2, turned, |x| x), averages(3, plain, |x| x)];
    let p = judged(ROUND, "", &runs);
    says(&p, "rejected", "T0101", ["run-2", "", "orientation = \"reversed\" in its [[run]]"]);
}

#[test]
fn volts_with_a_scale_per_lsb() {
    let volts = |x: f64| 2.5 * x * 5.0 / 4096.0;
    let runs: Vec<String> = (1..=3).map(|s| averages(s, plain, volts)).collect();
    let output = "quantizer = \"none\"\nunit = \"V\"\nnominal_scale = 0.00769";
    let p = judged(output, "", &runs);
    let of_kind = p.findings.iter().filter(|f| f.id == "T0130").count();
    assert_eq!((of_kind, p.verdict.as_str()), (3, "rejected"), "{:#?}", p.findings);
    assert!(p.findings.iter().all(|f| f.id != "T0103"));
    assert!(p.findings.iter().any(|f| f.id == "T0130" && f.todo.contains("nominal_scale")));
}

#[test]
fn codes_through_files() {
    let sound = || codes(1, |_, _, x| x as i64);
    // Words of sixteen bits without their sign.
    let wrapped = codes(2, |_, _, x| (x as i64).rem_euclid(65_536));
    let p = judged(ROUND, "", &[sound(), wrapped]);
    says(&p, "rejected", "T0118", ["run-2.csv", "2^16", "code_bits = 16 in [csv]"]);
    // A dropped bit.
    let spiked = codes(3, |i, k, x| x as i64 + if (i, k) == (4, 50) { 256 } else { 0 });
    let p = judged(ROUND, "", &[sound(), spiked]);
    says(
        &p,
        "accepted",
        "T0124",
        ["run-2.csv, line 302, dwell 4", "one bit", "look at these rows"],
    );
    // The table slipped by 0.2° in the middle of a dwell.
    let slipped = codes(4, |i, k, x| x as i64 + if i == 4 && k >= 50 { 4 } else { 0 });
    let p = judged(ROUND, "", &[sound(), slipped]);
    says(
        &p,
        "accepted",
        "T0123",
        ["run-2.csv, line 302, dwell 4", "jumps by", "measure the dwell again"],
    );
    // Beyond the table.
    let p =
        judged(ROUND, "angle_range_deg = [-65.0, 55.0]", &[sound(), codes(5, |_, _, x| x as i64)]);
    let found: Vec<_> = p.findings.iter().filter(|f| f.id == "T0320").collect();
    assert!(found.len() == 2 && found[0].place.contains("line 1202"), "{found:#?}");
}

//! The reference files beside the workspace: PHASE.DAT with every table of Stable32 whose deviation we have, octaves and all
//! its averaging factors, and the table values of NIST SP 1065. Skipped aloud elsewhere: `nbs14.rs` and `stable32.rs` hold
//! the same numbers in part.

use std::path::{Path, PathBuf};

use tumble_core::noise::{Deviation, NoiseKind, Velocity, band, degrees_of_freedom, variances};

fn folder() -> Option<PathBuf> {
    let folder =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/allan_reference");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no {}", folder.display());
    None
}

/// Numbers of the lines that are no comment.
fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |l: &str| l.split_whitespace().map(|n| n.parse().ok()).collect();
    let rows = text.lines().filter_map(numbers);
    rows.filter(|r: &Vec<f64>| !r.is_empty()).collect()
}

/// Half of the last of five digits, and rounding of the file's phase.
const FIVE_DIGITS: f64 = 5.1e-5;
/// Half a band of the total deviation, relative: Stable32's are 0.6 % narrower up to a factor of 8 (with 0.68 for 0.683 they
/// would be the same), 0.1 % beyond.
const BAND: f64 = 0.01;

/// Stable32's tables: factor, time, number of differences, kind, lower, value, upper.
#[test]
fn phase_dat_with_the_tables_of_stable32() {
    let Some(folder) = folder().map(|f| f.join("phasedat")) else { return };
    // Phase: its differences are the readings.
    let phase: Vec<f64> = rows(&folder.join("PHASE.DAT")).into_iter().map(|r| r[0]).collect();
    let readings: Vec<f64> = phase.windows(2).map(|w| w[1] - w[0]).collect();
    let velocity = Velocity::of(&readings, 1.0).unwrap();
    let mut compared = 0;
    for (name, deviation) in [
        ("adev", Deviation::AllanPlain),
        ("oadev", Deviation::Allan),
        ("mdev", Deviation::Modified),
        ("ohdev", Deviation::Hadamard),
        ("totdev", Deviation::Total),
    ] {
        for table in ["", "_octave"] {
            let table = rows(&folder.join(format!("phase_dat_{name}{table}.txt")));
            assert!(table.len() >= 8, "{name}: {}", table.len());
            let mut worst = 0.0f64;
            for row in table {
                let [factor, _, terms, _, low, sigma, high] = row.try_into().unwrap();
                let found = variances(&velocity, deviation, &[factor as usize])[0];
                let ours = found.variance.sqrt();
                worst = worst.max((ours / sigma - 1.0).abs());
                assert_eq!(found.terms as f64, terms, "{name} {factor}");
                if deviation == Deviation::Total && low > 0.0 {
                    let kind = NoiseKind::White;
                    let edf = degrees_of_freedom(deviation, kind, phase.len(), factor as usize, 1);
                    let [l, h] = band(ours, edf.unwrap(), 0.683).unwrap();
                    println!("totdev {factor}: {l:.5e} ({low:.5e}), {h:.5e} ({high:.5e})");
                    let narrower = [(ours - l) / (sigma - low), (h - ours) / (high - sigma)];
                    assert!(narrower.iter().all(|w| (w - 1.0).abs() < BAND));
                }
                compared += 1;
            }
            println!("{name}: {worst:.1e} from Stable32 at most");
            assert!(worst < FIVE_DIGITS, "{name}: {worst}");
        }
    }
    println!("{compared} values");
    assert!(compared > 500, "{compared}");
}

/// A list of `expected.json`.
fn list(text: &str, data: &str, key: &str) -> Vec<f64> {
    let own = text.split(&format!("\"{data}\": {{")).nth(1).unwrap();
    let own = own.split(&format!("\"{key}\": [")).nth(1).unwrap().split(']').next().unwrap();
    own.split(',').map(|n| n.trim().parse().unwrap()).collect()
}

#[test]
fn nbs14_files() {
    let Some(folder) = folder().map(|f| f.join("nbs14")) else { return };
    let expected = std::fs::read_to_string(folder.join("expected.json")).unwrap();
    for data in ["nbs14_10", "nbs14_1000"] {
        let readings = rows(&folder.join(format!("{data}_frequency.txt"))).concat();
        let velocity = Velocity::of(&readings, 1.0).unwrap();
        let factors: Vec<usize> =
            list(&expected, data, "tau").into_iter().map(|t| t as usize).collect();
        for (key, deviation) in [
            ("adev", Deviation::AllanPlain),
            ("oadev", Deviation::Allan),
            ("mdev", Deviation::Modified),
            ("ohdev", Deviation::Hadamard),
            ("totdev", Deviation::Total),
        ] {
            let published = list(&expected, data, key);
            assert_eq!(published.len(), factors.len());
            for (factor, published) in factors.iter().zip(published) {
                let ours = variances(&velocity, deviation, &[*factor])[0].variance.sqrt();
                // Seven digits are published: half of the last one.
                let digit = 10f64.powf(published.log10().floor() - 6.0);
                println!("{data} {key} {factor}: {ours:.9} ({published})");
                assert!((ours - published).abs() <= 0.51 * digit, "{data} {key} {factor}");
            }
        }
    }
}

//! Honest data raise nothing.

use std::collections::BTreeMap;

use tumble_core::simulate::Truth;
use tumble_core::{Angle, Quantizer};

use super::bench::{LSB, averaged, findings, recorded, truth};

/// An honest bench: name, truth, whether its dwells come as averages.
fn benches() -> Vec<(&'static str, Truth, bool)> {
    use Quantizer::{None, Round, Truncate};
    let twice = format!("{0},{0}", "-60,-40,-20,0,20,40,60");
    let noisy = |plan: &str, lsb: f64| Truth { noise_m_s2: lsb * LSB, ..truth(plan) };
    let rounding = |t: Truth, quantizer| Truth { quantizer, ..t };
    let scatter = |t: Truth, arcmin| Truth { setting_scatter: Angle::from_arcmin(arcmin), ..t };
    let walking = |t: Truth, lsb: f64| Truth { random_walk_m_s2_rts: lsb * LSB, ..t };
    let near_zero =
        |t: Truth| Truth { bias_m_s2: 0.1 * LSB, misalignment: Angle::from_rad(0.0), ..t };
    let long = |t: Truth| Truth { dwell_s: 30.0, ..t };
    vec![
        ("paper, truncate", near_zero(rounding(truth("paper"), Truncate)), false),
        ("paper, averaged", near_zero(rounding(truth("paper"), Truncate)), true),
        ("±60°, 60, 3′", scatter(truth("-60:60:60"), 3.0), false),
        ("±65°, 13, 3′, round", scatter(rounding(truth("-65:65:13"), Round), 3.0), false),
        ("±60°, 13, averaged", truth("-60:60:13"), true),
        ("7 twice", truth(&twice), false),
        ("7 twice, 3′, averaged", scatter(truth(&twice), 3.0), true),
        ("7 once", truth("-60:60:7"), false),
        ("0.05 LSB, truncate", near_zero(rounding(noisy("-60:60:60", 0.05), Truncate)), false),
        ("0.1 LSB, round", rounding(noisy("paper", 0.1), Round), false),
        ("0.2 LSB, floor, 13", noisy("-60:60:13", 0.2), false),
        ("0.3 LSB, truncate, averaged", rounding(noisy("-60:60:60", 0.3), Truncate), true),
        ("0.1 LSB, no scatter", scatter(noisy("-60:60:60", 0.1), 0.0), false),
        ("3 LSB, truncate", near_zero(rounding(noisy("paper", 3.0), Truncate)), false),
        ("3 LSB, 20 samples", Truth { dwell_s: 0.4, ..noisy("-60:60:13", 3.0) }, false),
        ("not quantized", rounding(truth("-60:60:60"), None), false),
        ("not quantized, walk", walking(rounding(truth("paper"), None), 0.03), false),
        ("walk 0.01 LSB/√s", walking(long(truth("paper")), 0.01), false),
        ("walk 0.05 LSB/√s", walking(long(truth("-60:60:60")), 0.05), false),
        ("walk 0.02 LSB/√s, quiet", walking(noisy("-60:60:60", 0.1), 0.02), false),
        ("walk 0.2 LSB/√s, 13", walking(long(truth("-60:60:13")), 0.2), false),
        (
            "walk 0.1 LSB/√s, 7, not quantized",
            walking(long(rounding(truth("-60:60:7"), None)), 0.1),
            false,
        ),
        ("walk 0.05 LSB/√s, 4", walking(long(noisy("-60:60:4", 0.7)), 0.05), false),
        ("±85°, 10′", scatter(truth("-85:85:60"), 10.0), false),
        ("±3°, 13, 0.2 LSB", noisy("-3:3:13", 0.2), false),
        ("three angles", truth(&["-60,0,60"; 20].join(",")), false),
        (
            "eccentric dial",
            Truth { eccentricity: Angle::from_arcmin(3.0), ..truth("-60:60:60") },
            false,
        ),
        (
            "upright dwells in the run",
            Truth { upright_in_each_run: true, ..truth("-60:60:13") },
            false,
        ),
        (
            "warming by 10 K",
            Truth {
                temperature_degc: Some((20.0, 30.0)),
                bias_per_k_m_s2: 0.1 * LSB,
                ..truth("paper")
            },
            false,
        ),
    ]
}

#[test]
fn honest_data_raise_nothing() {
    let wanted = if std::env::var_os("TUMBLE_LONG").is_some() { 20_000 } else { 1_000 };
    let benches = benches();
    let each = wanted / benches.len() + 1;
    let (mut runs, mut alarms) = (0, 0);
    for (name, truth, means) in &benches {
        let mut here: BTreeMap<&str, usize> = BTreeMap::new();
        for seed in 0..each as u64 {
            let e = recorded(&Truth { seed: 1000 + seed, ..truth.clone() });
            let found = findings(&if *means { averaged(e) } else { e });
            runs += 1;
            alarms += usize::from(!found.is_empty());
            for f in &found {
                *here.entry(f.kind.id()).or_default() += 1;
                println!("  {name}, seed {seed}: {} {}: {}", f.kind.id(), f.place, f.observed);
            }
        }
        println!("{name}: {here:?} of {each}");
    }
    println!("{alarms} of {runs} honest runs raise something");
    assert!(runs >= wanted && alarms * 100 < runs, "{alarms} of {runs}");
}

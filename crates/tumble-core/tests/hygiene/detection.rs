//! How small a fault is still found, printed and held at its measured size.

use tumble_core::simulate::Truth;
use tumble_core::{Angle, Experiment, FindingKind};

use super::bench::{LSB, SEVEN, SIXTY, THIRTEEN, disturbed, findings, mistype, recorded, truth};

/// Share of seeds in which a kind is found at a dwell.
fn share(name: &str, kinds: &[FindingKind], dwell: usize, made: impl Fn(u64) -> Experiment) -> f64 {
    let n = if std::env::var_os("TUMBLE_LONG").is_some() { 1000 } else { 60 };
    let place = format!("dwell {dwell} ");
    let found = (0..n)
        .filter(|seed| {
            findings(&made(seed + 1))
                .iter()
                .any(|f| kinds.contains(&f.kind) && f.place.contains(&place))
        })
        .count();
    let share = found as f64 / n as f64;
    println!("{name}: {:.1} %", 100.0 * share);
    share
}

#[test]
fn how_small_an_error_of_an_angle_is_found() {
    let both = [FindingKind::MistypedAngle, FindingKind::DwellDoesNotFit];
    // Plan, dwell near its middle and its angle, scatter in minutes, error in degrees, least share found.
    for (plan, dwell, angle, arcmin, error, least) in [
        (SIXTY, 40, 9.0, 0.55, 0.1, 0.4),
        (SIXTY, 40, 9.0, 0.55, 0.2, 0.95),
        (SIXTY, 40, 9.0, 3.0, 0.5, 0.9),
        (SIXTY, 40, 9.0, 3.0, 1.0, 1.0),
        (SIXTY, 60, 29.0, 3.0, 1.0, 0.95),
        (THIRTEEN, 8, 10.0, 0.55, 0.2, 0.4),
        (THIRTEEN, 8, 10.0, 0.55, 0.5, 0.95),
        (THIRTEEN, 8, 10.0, 3.0, 1.0, 0.6),
        (THIRTEEN, 13, 60.0, 3.0, 3.0, 0.6),
        (SEVEN, 4, 0.0, 0.55, 1.0, 0.3),
        (SEVEN, 4, 0.0, 0.55, 3.0, 0.9),
        (SEVEN, 4, 0.0, 3.0, 9.0, 0.9),
    ] {
        let name = format!("{plan}, scatter {arcmin}′, {error}° wrong at {angle}°");
        let found = share(&name, &both, dwell, |seed| {
            let scatter = Angle::from_arcmin(arcmin);
            let mut e = recorded(&Truth { seed, setting_scatter: scatter, ..truth(plan) });
            mistype(&mut e, 0, dwell, &(angle + error).to_string());
            e
        });
        assert!(found >= least, "{name}: {found}");
    }
}

#[test]
fn how_small_a_movement_is_found() {
    let both = [FindingKind::DwellDrifts, FindingKind::DwellTwoLevels];
    for (noise, dwell_s, lsb, step, least) in [
        (1.2, 30.0, 1.0, false, 0.1),
        (1.2, 30.0, 1.5, false, 0.9),
        (1.2, 30.0, 1.0, true, 0.1),
        (1.2, 30.0, 1.5, true, 0.9),
        (1.2, 6.0, 2.0, false, 0.6),
        (0.1, 30.0, 2.5, false, 0.9),
        (3.0, 6.0, 6.0, false, 0.9),
    ] {
        let word = if step { "jump half way" } else { "drift" };
        let name = format!("{word} of {lsb} LSB in {dwell_s} s, noise {noise} LSB");
        let t = Truth { dwell_s, noise_m_s2: noise * LSB, ..truth(SIXTY) };
        let found = share(&name, &both, 20, |seed| {
            disturbed(&Truth { seed, ..t.clone() }, |i, s| {
                let n = s.len() as f64;
                let shape = |k: usize| {
                    let x = k as f64 / n;
                    if step { f64::from(x > 0.5) } else { x }
                };
                if i == 20 {
                    s.iter_mut().enumerate().for_each(|(k, x)| *x += lsb * shape(k));
                }
            })
        });
        assert!(found >= least, "{name}: {found}");
    }
}

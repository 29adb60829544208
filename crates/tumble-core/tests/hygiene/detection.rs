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

/// Uniform numbers below `n`.
fn draws(seed: u64) -> impl FnMut(usize) -> usize {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move |n| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    }
}

/// A slip of the pen in a typed angle, at least a degree off.
fn slip(typed: &str, mut draw: impl FnMut(usize) -> usize) -> String {
    let value: f64 = typed.parse().unwrap();
    for _ in 0..100 {
        let mut digits: Vec<char> = typed.chars().filter(|c| *c != '-').collect();
        let at = draw(digits.len());
        let mut negative = value < 0.0;
        match draw(5) {
            0 => negative = !negative,
            1 if digits.len() > 1 => digits.swap(0, 1),
            2 => digits[at] = char::from_digit(draw(10) as u32, 10).unwrap(),
            3 if digits.len() > 1 => drop(digits.remove(at)),
            _ => digits.insert(at, digits[at]),
        }
        let other = format!("{}{}", if negative { "-" } else { "" }, String::from_iter(digits));
        let off = (other.parse::<f64>().unwrap() - value).abs();
        // 90° is stood upright.
        if off >= 1.0 && other.parse::<f64>().unwrap().abs() != 90.0 {
            return other;
        }
    }
    "45".into()
}

#[test]
fn slips_of_any_kind_several_in_a_run() {
    let n = if std::env::var_os("TUMBLE_LONG").is_some() { 2000 } else { 100 };
    for (plan, wrong, arcmin, least) in [
        (SEVEN, 1, 0.55, 0.85),
        (THIRTEEN, 1, 0.55, 0.97),
        (THIRTEEN, 2, 0.55, 0.9),
        (SIXTY, 1, 0.55, 0.97),
        (SIXTY, 5, 0.55, 0.9),
        (SIXTY, 5, 3.0, 0.6),
    ] {
        let (mut all, mut named, mut innocent) = (0, 0, 0);
        for seed in 1..=n {
            let scatter = Angle::from_arcmin(arcmin);
            let mut e = recorded(&Truth { seed, setting_scatter: scatter, ..truth(plan) });
            let mut draw = draws(seed);
            let total = e.runs[0].positions.len();
            let mut dwells = Vec::new();
            while dwells.len() < wrong {
                let dwell = 1 + draw(total);
                if !dwells.contains(&dwell) {
                    dwells.push(dwell);
                }
            }
            for dwell in &dwells {
                let typed = e.runs[0].positions[dwell - 1].record.dial.clone().unwrap().typed;
                mistype(&mut e, 0, *dwell, &slip(&typed, &mut draw));
            }
            let found = findings(&e);
            let at = |d: &usize| found.iter().find(|f| f.place.contains(&format!("dwell {d} ")));
            all += usize::from(dwells.iter().all(|d| at(d).is_some()));
            named += usize::from(
                dwells.iter().all(|d| at(d).is_some_and(|f| f.kind == FindingKind::MistypedAngle)),
            );
            innocent += usize::from(
                found
                    .iter()
                    .any(|f| !dwells.iter().any(|d| f.place.contains(&format!("dwell {d} ")))),
            );
        }
        let percent = |k: usize| 100.0 * k as f64 / n as f64;
        println!(
            "{wrong} slips in {plan}, scatter {arcmin}′: all found {:.1} %, all as mistyped {:.1} %, others blamed {:.1} %",
            percent(all),
            percent(named),
            percent(innocent)
        );
        assert!(percent(all) >= 100.0 * least, "{wrong} slips in {plan}, {arcmin}′: {all} of {n}");
        assert!(percent(innocent) <= 3.0, "{wrong} slips in {plan}, {arcmin}′: {innocent} of {n}");
    }
}

#[test]
fn a_disturbance_seldom_looks_like_a_slip() {
    let n = if std::env::var_os("TUMBLE_LONG").is_some() { 2000 } else { 200 };
    let (mut slips, mut others) = (0, 0);
    for seed in 1..=n {
        let mut draw = draws(seed);
        let (dwell, lsb) = (1 + draw(60), 10.0 + draw(30_000) as f64 / 100.0);
        let e = disturbed(&Truth { seed, ..truth(SIXTY) }, |i, s| {
            if i == dwell {
                s.iter_mut().for_each(|x| *x += lsb);
            }
        });
        for f in findings(&e) {
            assert!(f.place.contains(&format!("dwell {dwell} ")), "{f:?}");
            slips += usize::from(f.kind == FindingKind::MistypedAngle);
            others += usize::from(f.kind == FindingKind::DwellDoesNotFit);
        }
    }
    println!("disturbed by 0.5…14°: {slips} look like slips, {others} do not, of {n}");
    assert!(slips + others == n as usize && slips * 4 < n as usize);
}

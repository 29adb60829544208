//! Angles that do not belong to their readings.

use tumble_core::simulate::Truth;
use tumble_core::{Angle, Experiment, FindingKind, Quantizer};

use super::bench::{
    LSB, SEVEN, SIXTY, THIRTEEN, averaged, disturbed, expect_one, findings, mistype, recorded,
    truth,
};

const EVERY_TWELVE: &str = "-48,-36,-24,-12,0,12,21,33,45,57";

fn kinds(e: &Experiment) -> Vec<&'static str> {
    findings(e).iter().map(|f| f.kind.id()).collect()
}

/// Dwells that do not fit the others.
fn blamed(e: &Experiment) -> Vec<String> {
    findings(e)
        .into_iter()
        .filter(|f| matches!(f.kind, FindingKind::MistypedAngle | FindingKind::DwellDoesNotFit))
        .map(|f| format!("{}: {}", f.place, f.observed))
        .collect()
}

#[test]
fn a_mistyped_angle_is_named_with_the_one_that_fits() {
    // Plan, dwell, what was typed, slip, angle that fits.
    for (plan, dwell, typed, slip, meant) in [
        (EVERY_TWELVE, 7, "12", "digits transposed", "21"),
        (EVERY_TWELVE, 6, "-12", "the sign", "12"),
        (EVERY_TWELVE, 3, "24", "the sign", "-24"),
        (EVERY_TWELVE, 8, "3.3", "the decimal point", "33"),
        (EVERY_TWELVE, 9, "4", "a digit left out", "45"),
        (EVERY_TWELVE, 9, "35", "one digit", "45"),
        (EVERY_TWELVE, 9, "44", "one digit", "45"),
        (EVERY_TWELVE, 5, "-12", "a neighbour's angle typed again", "0"),
        ("-50,-37.5,-25,-12.5,0,12.5,25,37.5,50", 6, "125", "the decimal point", "12.5"),
        ("-50,-37.5,-25,-12.5,0,12.5,25,37.5,50", 6, "1.25", "the decimal point", "12.5"),
        ("-50,-37.5,-25,-12.5,0,12.5,25,37.5,50", 6, "122.5", "a digit typed twice", "12.5"),
        (SIXTY, 42, "1", "a digit left out", "11"),
        (SIXTY, 52, "12", "digits transposed", "21"),
        (SIXTY, 60, "92", "digits transposed", "29"),
        (SIXTY, 1, "30", "the sign", "-30"),
        (SIXTY, 43, "11", "a neighbour's angle typed again", "12"),
        (SEVEN, 5, "-20", "the sign", "20"),
        (SEVEN, 7, "6", "a digit left out", "60"),
    ] {
        let name = format!("{typed} for {meant} in {plan}");
        for (how, seed) in [(false, 1), (true, 2), (false, 3)] {
            let mut e = recorded(&Truth { seed, ..truth(plan) });
            mistype(&mut e, 0, dwell, typed);
            let e = if how { averaged(e) } else { e };
            let place = format!("dwell {dwell} ");
            expect_one(
                &name,
                &e,
                FindingKind::MistypedAngle,
                [&place, slip, &format!("at {meant}°, correct the angle in line")],
            );
        }
    }
}

#[test]
fn the_number_is_the_dials_own() {
    // A dial in gon that counts the other way, turned round by the reader.
    let mut e = recorded(&truth(THIRTEEN));
    for p in &mut e.runs[0].positions {
        let dial = p.record.dial.as_mut().unwrap();
        (dial.unit_deg, dial.direction) = (0.9, -1.0);
        dial.value = (-p.angle.deg() / 0.9 * 100.0).round() / 100.0;
        dial.typed = dial.value.to_string();
        p.angle = Angle::from_deg(-dial.value * 0.9);
    }
    assert_eq!(kinds(&e), [""; 0]);
    // −44.44 gon is 40°; typed with two digits changed over.
    assert_eq!(e.runs[0].positions[9].record.dial.as_ref().unwrap().typed, "-33.33");
    mistype(&mut e, 0, 9, "-22.32");
    mistype(&mut e, 0, 10, "33.33");
    expect_one(
        "gon",
        &e,
        FindingKind::MistypedAngle,
        ["dwell 10 ", "the sign: -33.33 gon", "-33.33 gon"],
    );
}

#[test]
fn several_wrong_angles_do_not_hide_one_another() {
    let wrong: [(&str, &[(usize, &str)]); 6] = [
        (SEVEN, &[(3, "20")]),
        (THIRTEEN, &[(2, "50"), (12, "-50")]),
        (THIRTEEN, &[(12, "5"), (13, "6")]),
        (THIRTEEN, &[(10, "-30"), (11, "-40")]),
        (SIXTY, &[(42, "1"), (43, "21"), (52, "12"), (59, "82"), (60, "92")]),
        (SIXTY, &[(1, "30"), (2, "29"), (3, "28"), (5, "26"), (6, "25")]),
    ];
    for (plan, typed) in wrong {
        for seed in 1..=10 {
            let mut e = recorded(&Truth { seed, ..truth(plan) });
            typed.iter().for_each(|(dwell, angle)| mistype(&mut e, 0, *dwell, angle));
            let found = findings(&e);
            for (dwell, angle) in typed {
                let place = format!("dwell {dwell} ");
                assert!(
                    found
                        .iter()
                        .any(|f| f.kind == FindingKind::MistypedAngle && f.place.contains(&place)),
                    "{plan}, seed {seed}: {angle} at dwell {dwell} not found in {found:#?}"
                );
            }
            assert_eq!(found.len(), typed.len(), "{plan}, seed {seed}: {found:#?}");
        }
    }
}

#[test]
fn a_disturbed_dwell_is_named_with_its_size() {
    // 2.5 LSB and more on 0.2 LSB of scatter; by no number of whole degrees.
    for (plan, dwell, lsb) in
        [(SIXTY, 17, 8.7), (SIXTY, 60, -33.0), (THIRTEEN, 6, 33.0), (SEVEN, 3, 99.3)]
    {
        let name = format!("{lsb} LSB in {plan}");
        let e = disturbed(&truth(plan), |i, samples| {
            if i == dwell {
                samples.iter_mut().for_each(|x| *x += lsb);
            }
        });
        let place = format!("dwell {dwell} ");
        let sign = if lsb > 0.0 { "+" } else { "-" };
        expect_one(
            &name,
            &e,
            FindingKind::DwellDoesNotFit,
            [&place, sign, "measure the dwell again"],
        );
    }
}

#[test]
fn the_run_as_a_whole_blames_no_dwell() {
    let bent = |k2: f64, k3: f64| Truth { k2_per_m_s2: k2, k3_per_m2_s4: k3, ..truth("-60:60:60") };
    let drifting =
        |t: Truth| Truth { temperature_degc: Some((20.0, 40.0)), bias_per_k_m_s2: 2.0 * LSB, ..t };
    let shuffled =
        (0..60).map(|i| (i * 37 % 60 * 2 - 60).to_string()).collect::<Vec<_>>().join(",");
    let cases: Vec<(&str, Experiment)> = vec![
        ("K2", recorded(&bent(5e-4, 0.0))),
        ("K2, 13", recorded(&Truth { k2_per_m_s2: 5e-4, ..truth(THIRTEEN) })),
        ("K3", recorded(&bent(0.0, 2e-4))),
        ("K3, 13", recorded(&Truth { k3_per_m2_s4: 2e-4, ..truth(THIRTEEN) })),
        ("K3, 7", recorded(&Truth { k3_per_m2_s4: 2e-4, ..truth(SEVEN) })),
        ("drift", recorded(&drifting(truth(SIXTY)))),
        ("drift, ±60°", recorded(&drifting(truth("-60:60:60")))),
        (
            "warm-up",
            disturbed(&truth("-60:60:60"), |i, s| {
                s.iter_mut().for_each(|x| *x += 40.0 * (-(i as f64) / 3.0).exp())
            }),
        ),
        (
            "kink",
            disturbed(&truth("-60:60:60"), |i, s| {
                if i > 30 {
                    s.iter_mut().for_each(|x| *x *= 1.02)
                }
            }),
        ),
        (
            "moved half way",
            disturbed(&truth("-60:60:60"), |i, s| {
                if i > 40 {
                    s.iter_mut().for_each(|x| *x += 9.0)
                }
            }),
        ),
        (
            "moved near the end",
            disturbed(&truth("-60:60:60"), |i, s| {
                if i > 54 {
                    s.iter_mut().for_each(|x| *x += 9.0)
                }
            }),
        ),
        (
            "moved near the end, angles in any order",
            disturbed(&truth(&shuffled), |i, s| {
                if i > 54 {
                    s.iter_mut().for_each(|x| *x += 9.0)
                }
            }),
        ),
        (
            "eccentric dial",
            recorded(&Truth { eccentricity: Angle::from_arcmin(10.0), ..truth("-65:65:60") }),
        ),
    ];
    for (name, e) in cases {
        assert_eq!(blamed(&e), [""; 0], "{name}");
    }
}

#[test]
fn angles_that_are_none_blame_no_dwell() {
    let angled = |f: fn(usize, f64) -> f64| {
        let mut e = recorded(&truth("-60:60:60"));
        for (i, p) in e.runs[0].positions.iter_mut().enumerate() {
            p.angle = Angle::from_deg(f(i, p.angle.deg()));
        }
        e
    };
    for (name, e) in [
        ("radians", angled(|_, deg| deg.to_radians())),
        ("counter", angled(|i, _| i as f64)),
        ("shuffled", angled(|i, _| (i * 37 % 60) as f64 * 2.0 - 60.0)),
        ("magnitudes", angled(|_, deg| deg.abs())),
        ("half of them mirrored", angled(|i, deg| if i < 30 { deg } else { -deg })),
    ] {
        assert_eq!(blamed(&e), [""; 0], "{name}");
    }
    // Backwards as a whole: one finding, and it is not a dwell's.
    expect_one(
        "reversed",
        &angled(|_, deg| -deg),
        FindingKind::SignReversed,
        ["run-1", "fall", "angle_sign = -1"],
    );
}

#[test]
fn too_few_positions_say_nothing() {
    let two = ["-30,30"; 10].join(",");
    for plan in ["-60,0,60", "-60,-20,20,60", "-60,-30,0,30,60", &two] {
        let mut e = recorded(&truth(plan));
        mistype(&mut e, 0, 2, "41");
        assert_eq!(blamed(&e), [""; 0], "{plan}");
    }
}

#[test]
fn angles_in_quiet_dwells_are_found_too() {
    for (quantizer, noise) in
        [(Quantizer::Truncate, 0.05), (Quantizer::Round, 0.1), (Quantizer::Floor, 0.3)]
    {
        let t = Truth { quantizer, noise_m_s2: noise * LSB, ..truth(SIXTY) };
        let mut e = recorded(&t);
        mistype(&mut e, 0, 52, "12");
        expect_one("quiet", &e, FindingKind::MistypedAngle, ["dwell 52 ", "12° is typed", "21°"]);
    }
}

#[test]
fn a_reversed_run_among_others_is_told_its_orientation() {
    let mut e = recorded(&Truth { runs: 3, ..truth(THIRTEEN) });
    for p in &mut e.runs[1].positions {
        p.angle = Angle::from_deg(-p.angle.deg());
    }
    expect_one(
        "one of three",
        &e,
        FindingKind::SignReversed,
        ["run-2", "", "orientation = \"reversed\" in its [[run]]"],
    );
    // It says reversed, and is not.
    for p in &mut e.runs[1].positions {
        p.record.dial.as_mut().unwrap().direction = -1.0;
    }
    expect_one(
        "wrongly turned",
        &e,
        FindingKind::SignReversed,
        ["run-2", "", "take orientation = \"reversed\" out"],
    );
}

#[test]
fn upright_dwells_that_are_none_are_named() {
    for plan in [THIRTEEN, SIXTY] {
        let t = Truth { upright_in_each_run: true, ..truth(plan) };
        // Down and up changed over: both are named.
        let mut e = recorded(&t);
        mistype(&mut e, 0, 1, "-90");
        mistype(&mut e, 0, 2, "90");
        let found = findings(&e);
        assert_eq!(found.len(), 2, "{plan}: {found:#?}");
        for (f, axis) in found.iter().zip(["up", "down"]) {
            assert_eq!(f.kind, FindingKind::MistypedAngle);
            assert!(f.observed.contains(&format!("points {axis}")), "{f:?}");
        }
        // 90 typed for a table angle.
        let mut e = recorded(&t);
        mistype(&mut e, 0, 9, "90");
        expect_one(
            plan,
            &e,
            FindingKind::DwellDoesNotFit,
            ["dwell 9 ", "on the table at", "correct the angle in line"],
        );
    }
}

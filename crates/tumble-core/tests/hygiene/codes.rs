//! Readings that are not what the converter measured at rest.

use tumble_core::simulate::Truth;
use tumble_core::{
    Angle, BlockSums, Code, CodeHistogram, Experiment, FindingKind, Quantizer, Readings,
};

use super::bench::{
    LSB, SEVEN, SIXTY, THIRTEEN, averaged, disturbed, expect_one, findings, recorded, truth,
};

#[test]
fn a_dwell_that_drifts_is_named() {
    for (name, plan, quantizer, noise, lsb) in [
        ("2 LSB", SIXTY, Quantizer::Floor, 1.2, 2.0),
        ("−3 LSB", THIRTEEN, Quantizer::Round, 1.2, -3.0),
        ("3 LSB, seven", SEVEN, Quantizer::Floor, 0.6, 3.0),
        ("3 LSB, quiet", SIXTY, Quantizer::Floor, 0.1, 3.0),
        ("3 LSB, truncated", SIXTY, Quantizer::Truncate, 0.3, 3.0),
        ("2 units, not quantized", SIXTY, Quantizer::None, 1.2, 2.0),
    ] {
        let t = Truth { quantizer, noise_m_s2: noise * LSB, ..truth(plan) };
        let e = disturbed(&t, |i, s| {
            let n = s.len() as f64;
            if i == 5 {
                s.iter_mut().enumerate().for_each(|(k, x)| *x += lsb * (k as f64 / n - 0.5));
            }
        });
        expect_one(name, &e, FindingKind::DwellDrifts, ["dwell 5 ", "1 of ", "measure it again"]);
    }
}

#[test]
fn settling_at_the_start_is_told_how_much_to_throw_away() {
    let t = Truth { dwell_s: 30.0, ..truth(SIXTY) };
    let e = disturbed(&t, |_, s| {
        s.iter_mut().enumerate().for_each(|(k, x)| *x += 12.0 * (-(k as f64) / 50.0 / 2.0).exp());
    });
    // Time constant 2 s from 12 LSB: below 0.25 LSB after 7.7 s.
    expect_one(
        "settling",
        &e,
        FindingKind::DwellDrifts,
        ["dwell 1 ", "60 of 60 dwells", "discard_s = "],
    );
    let remedy = &findings(&e)[0].remedy;
    let seconds: f64 =
        remedy.split("discard_s = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((4.0..14.0).contains(&seconds), "{remedy}");
    // Without a rate nothing can be computed.
    let mut e = e;
    e.output.rate_hz = None;
    assert!(!findings(&e)[0].remedy.contains("discard_s"));
}

#[test]
fn a_dwell_with_two_levels_is_named() {
    for (name, plan, quantizer, noise, lsb, share) in [
        ("2 LSB half way", SIXTY, Quantizer::Floor, 1.2, 2.0, 0.5),
        ("5 LSB late", THIRTEEN, Quantizer::Floor, 1.2, -5.0, 0.8),
        ("40 LSB late", SEVEN, Quantizer::Floor, 1.2, 40.0, 0.85),
        ("2 LSB, quiet", SIXTY, Quantizer::Truncate, 0.1, 2.0, 0.4),
        ("not quantized", SIXTY, Quantizer::None, 1.2, 2.0, 0.5),
    ] {
        let t = Truth { quantizer, noise_m_s2: noise * LSB, ..truth(plan) };
        let e = disturbed(&t, |i, s| {
            let from = (share * s.len() as f64) as usize;
            if i == 3 {
                s[from..].iter_mut().for_each(|x| *x += lsb);
            }
        });
        // A large one moves the mean too: one finding is enough.
        expect_one(
            name,
            &e,
            FindingKind::DwellTwoLevels,
            ["dwell 3 ", "jumps by", "measure the dwell again"],
        );
    }
}

#[test]
fn samples_far_out_are_counted() {
    for (name, quantizer, noise, wild, word) in [
        ("one bit", Quantizer::Floor, 1.2, 512.0, "one bit"),
        ("small spike", Quantizer::Floor, 1.2, 16.0, "1 of 300"),
        ("quiet", Quantizer::Truncate, 0.1, 7.0, "1 of 300"),
        ("loud", Quantizer::Round, 3.0, -60.0, "1 of 300"),
        ("not quantized", Quantizer::None, 1.2, 200.0, "far out"),
    ] {
        let t = Truth { quantizer, noise_m_s2: noise * LSB, ..truth(SIXTY) };
        let e = disturbed(&t, |i, s| {
            if i == 9 {
                s[117] += wild
            }
        });
        expect_one(
            name,
            &e,
            FindingKind::OutlyingSamples,
            ["dwell 9 ", word, "look at these rows"],
        );
    }
    // In several dwells: one finding, the first place, all of them counted.
    let e = disturbed(&truth(SIXTY), |i, s| {
        if i % 20 == 7 {
            s[10] = 0.2;
            s[200] = 0.2
        }
    });
    let found = findings(&e);
    let f = found.iter().find(|f| f.kind == FindingKind::OutlyingSamples).unwrap();
    assert!(
        f.place.contains("dwell 7 ")
            && f.observed.contains("zeros")
            && f.observed.contains("6 in 3 dwells"),
        "{f:?}"
    );
    // At the converter's end.
    let mut t = truth(SIXTY);
    t.ends.max_code = Some(Code(2047));
    let e = disturbed(&t, |i, s| {
        if i == 12 {
            s[10] = 1e6
        }
    });
    let found = findings(&e);
    let f = found.iter().find(|f| f.kind == FindingKind::OutlyingSamples).unwrap();
    assert!(f.observed.contains("the converter's ends"), "{f:?}");
}

/// Words of `bits` bits without their sign.
fn unsigned(mut e: Experiment, bits: u32) -> Experiment {
    for p in e.runs.iter_mut().flat_map(|r| &mut r.positions) {
        let Readings::Codes { histogram, .. } = &p.readings else { continue };
        let mut wrapped = CodeHistogram::default();
        let mut blocks = BlockSums::default();
        for (c, k) in histogram.bins() {
            let code = if c.0 < 0 { c.0.wrapping_add(1i32.wrapping_shl(bits)) } else { c.0 };
            wrapped.record_many(Code(code), k);
            (0..k).for_each(|_| blocks.record(i128::from(code)));
        }
        p.readings = Readings::Codes { histogram: wrapped, blocks };
    }
    e
}

#[test]
fn words_without_their_sign_are_named_with_their_width() {
    for bits in [12, 14, 16, 24, 30] {
        for plan in [SEVEN, THIRTEEN, SIXTY] {
            for quantizer in [Quantizer::Floor, Quantizer::Truncate] {
                let e = unsigned(recorded(&Truth { quantizer, ..truth(plan) }), bits);
                let cure = format!("code_bits = {bits} in [csv]");
                let found = findings(&e);
                let f = found.iter().find(|f| f.kind == FindingKind::CodesWrap);
                let f = f.unwrap_or_else(|| panic!("{bits} bits, {plan}: {found:#?}"));
                assert!(f.remedy.contains(&cure), "{f:?}");
                // The scale is off as well, but no dwell is blamed.
                assert!(
                    found.iter().all(|f| !matches!(
                        f.kind,
                        FindingKind::MistypedAngle
                            | FindingKind::DwellDoesNotFit
                            | FindingKind::OutlyingSamples
                            | FindingKind::DwellTwoLevels
                            | FindingKind::DwellDrifts
                    )),
                    "{found:#?}"
                );
                let found = findings(&averaged(e));
                assert!(
                    found
                        .iter()
                        .any(|f| f.kind == FindingKind::CodesWrap && f.remedy.contains(&cure)),
                    "averaged, {bits} bits, {plan}: {found:#?}"
                );
            }
        }
    }
}

#[test]
fn offset_binary_codes_do_not_wrap() {
    let e = disturbed(&truth(SIXTY), |_, s| s.iter_mut().for_each(|x| *x += 2048.0));
    assert!(findings(&e).iter().all(|f| f.kind != FindingKind::CodesWrap));
}

#[test]
fn readings_in_another_unit_than_the_scale() {
    let real = |factor: f64, unit: &str, nominal: f64| {
        let t = Truth { quantizer: Quantizer::None, ..truth(THIRTEEN) };
        // Readings in units of `factor` LSB.
        let mut e = disturbed(&t, |_, s| s.iter_mut().for_each(|x| *x *= factor));
        e.output.unit = unit.into();
        e.output.nominal_scale_m_s2_per_lsb = Some(nominal);
        e
    };
    // The truth's scale is 1.01 times nominal: 1263 LSB a g.
    let volts = 1.0 / 1263.0;
    for (name, e, word) in [
        ("volts, a scale per LSB", real(volts, "LSB", LSB), "1 V per g"),
        ("volts, a scale per mV", real(volts, "V", 9.81e-3), "per thousandth"),
        ("millivolts, a scale per V", real(1000.0 * volts, "V", 9.6), "thousandths"),
        ("mg, taken for m/s²", real(1000.0 * volts * 9.81 / 9.80665, "m/s2", 1.0), "mg"),
    ] {
        expect_one(
            name,
            &e,
            FindingKind::UnitIsNotTheScales,
            ["run-1", "times nominal_scale", word],
        );
    }
    // Codes with a scale per volt.
    let mut e = recorded(&truth(THIRTEEN));
    e.output.nominal_scale_m_s2_per_lsb = Some(9.81 / 0.66);
    expect_one("codes, per volt", &e, FindingKind::UnitIsNotTheScales, ["run-1", "", "per volt"]);
    // Averages in volts, said to be rounded codes.
    let mut e = averaged(real(volts, "LSB", LSB));
    e.output.quantizer = Quantizer::Round;
    expect_one(
        "volts as codes",
        &e,
        FindingKind::UnitIsNotTheScales,
        ["run-1", "", "quantizer = \"none\""],
    );
    // What has a finding of its own keeps it.
    expect_one("g", &real(volts, "g", 1.0), FindingKind::UnitsMixedUp, ["", "", ""]);
    expect_one(
        "another range",
        &real(volts, "V", 2.4),
        FindingKind::ScaleImplausible,
        ["", "", ""],
    );
}

/// Zero rows as the reader reports them: a dwell of their own at 0°.
fn zero_dwell(mut e: Experiment, rows: u64) -> Experiment {
    let positions = &mut e.runs[0].positions;
    let mut p = positions.last().unwrap().clone();
    let (mut histogram, mut blocks) = (CodeHistogram::default(), BlockSums::default());
    histogram.record_many(Code(0), rows);
    (0..rows).for_each(|_| blocks.record(0));
    p.readings = Readings::Codes { histogram, blocks };
    p.angle = Angle::from_deg(0.0);
    p.place = "run-1.csv, line 18002, dwell 61 (0°)".into();
    p.record.line = Some(18_002);
    p.record.zero_rows = Some((rows, 18_002));
    p.record.closing_repeats = rows;
    positions.push(p);
    e
}

#[test]
fn zero_rows_at_the_end_are_named_with_their_line() {
    for plan in [SEVEN, THIRTEEN, SIXTY] {
        let e = zero_dwell(recorded(&truth(plan)), 40);
        expect_one(
            "a dwell of zeros",
            &e,
            FindingKind::ZeroRows,
            ["dwell 61", "40 rows", "line 18002"],
        );
    }
    // In the tail of the last dwell, where the file is one angle's.
    for known in [true, false] {
        let mut e = disturbed(&truth(THIRTEEN), |i, s| {
            if i == 13 {
                s[260..].iter_mut().for_each(|x| *x = 0.0)
            }
        });
        let record = &mut e.runs[0].positions[12].record;
        record.closing_repeats = 40;
        record.zero_rows = known.then_some((40, 3862));
        expect_one(
            "a tail of zeros",
            &e,
            FindingKind::ZeroRows,
            ["dwell 13 ", "40 rows", "take the rows"],
        );
    }
    // An honest last dwell at 0° may read zero.
    let honest = Truth {
        bias_m_s2: 0.0,
        misalignment: Angle::from_rad(0.0),
        noise_m_s2: 0.05 * LSB,
        quantizer: Quantizer::Round,
        ..truth(THIRTEEN)
    };
    let e = zero_dwell(recorded(&honest), 40);
    assert!(findings(&e).is_empty(), "{:#?}", findings(&e));
}

//! The likelihood at the ends of its range: noise from a hundredth of an LSB to thousands, single codes, saturation,
//! averages, real numbers, from 4 to 100 000 positions.

use proptest::prelude::*;
use tumble_core::estimate::{
    Estimate, EstimateError, EstimateOptions, Method, Parameter, Split, Weights, estimate,
};
use tumble_core::{
    Angle, BlockSums, Code, CodeHistogram, ConverterEnds, Position, Quantizer, Readings, Record,
    Seat, ValueMoments,
};

use crate::bench::{Truth, equal};

fn try_fit(
    truth: &Truth,
    positions: &[Position],
    method: Method,
    weights: Weights,
) -> Result<Estimate, EstimateError> {
    let bench = truth.bench();
    let refs: Vec<&Position> = positions.iter().collect();
    estimate(
        &refs,
        &truth.setting(&bench),
        &EstimateOptions { method, weights, ..EstimateOptions::default() },
    )
}

fn fit(truth: &Truth, positions: &[Position], weights: Weights) -> Estimate {
    try_fit(truth, positions, Method::Likelihood, weights).unwrap()
}

/// Largest error in standard uncertainties.
fn worst(truth: &Truth, e: &Estimate) -> f64 {
    let theta = truth.parameters();
    Parameter::ALL
        .map(|p| {
            let off = e.values[p.index()].unwrap() - theta[p.index()];
            off.abs() / e.standard_uncertainty(p).unwrap()
        })
        .into_iter()
        .fold(0.0, f64::max)
}

fn averaged(positions: &[Position]) -> Vec<Position> {
    positions
        .iter()
        .map(|p| Position {
            readings: Readings::Averaged {
                mean: p.readings.mean().unwrap(),
                samples: p.readings.samples(),
                std: p.readings.std(),
            },
            ..p.clone()
        })
        .collect()
}

#[test]
fn noise_from_a_hundredth_to_thousands_of_lsb() {
    for quantizer in [Quantizer::Truncate, Quantizer::Floor, Quantizer::Round] {
        for sigma in [0.01, 0.03, 0.1, 0.3, 0.7, 0.8, 1.25, 10.0, 300.0, 5000.0] {
            // Scatter of the size of g is no calibration.
            for level in [0.0, f64::min(0.3 * sigma, 30.0)] {
                let truth =
                    Truth { sigma, level, quantizer, samples: 400, ..Truth::new(equal(60.0, 30)) };
                let e = fit(&truth, &truth.run(5).positions, Weights::Angle);
                assert!(
                    worst(&truth, &e) < 4.5,
                    "{quantizer:?} σ {sigma} τ0 {level}: {:.1}",
                    worst(&truth, &e)
                );
                let s = e.scatter.unwrap();
                let n = s.noise_lsb.unwrap();
                assert!(
                    n.low <= n.value && n.value <= n.high,
                    "{quantizer:?} σ {sigma} τ0 {level}: {s:?}"
                );
                if sigma >= 0.1 && !s.noise_is_bound {
                    assert!((n.value / sigma - 1.0).abs() < 0.35, "{quantizer:?} σ {sigma}: {n:?}");
                }
            }
        }
    }
}

#[test]
fn dwells_of_a_single_code_are_bounds() {
    let truth = Truth { sigma: 0.0001, ..Truth::new(equal(60.0, 60)) };
    let run = truth.run(3).positions;
    assert!(run.iter().all(|p| p.readings.only_code().is_some()));
    let e = fit(&truth, &run, Weights::Angle);
    assert!(worst(&truth, &e) < 4.0, "{}", worst(&truth, &e));
    assert!(e.profile.is_some());
    // The noise is bounded by what single codes allow, and the bound holds the truth.
    let s = e.scatter.unwrap();
    let noise = s.noise_lsb.unwrap();
    assert!(s.noise_is_bound && noise.high >= truth.sigma && noise.high < 0.1, "{noise:?}");
    // One sample a dwell tells nothing of the noise.
    let single = Truth { samples: 1, ..truth.clone() };
    let bare = fit(&single, &single.run(3).positions, Weights::Angle);
    assert_eq!(bare.scatter.unwrap().noise_lsb, None);
    let averages = try_fit(&truth, &run, Method::Exact, Weights::Equal).unwrap();
    let u = |e: &Estimate| e.standard_uncertainty(Parameter::ScaleError).unwrap();
    // Sixty boxes narrow like 1/60, averages like 1/√60.
    assert!(u(&e) < 0.6 * u(&averages), "{} against {}", u(&e), u(&averages));
}

/// Codes at the converter's ends are inequalities: they help, where averages of them would ruin the result.
#[test]
fn saturated_samples_are_bounds() {
    let ends = ConverterEnds { min_code: Some(Code(-1000)), max_code: Some(Code(1000)) };
    let truth = Truth { sigma: 8.0, samples: 200, ends, ..Truth::new(equal(58.0, 24)) };
    let scale = Parameter::ScaleError.index();
    let (mut with, mut without, mut averaged) = (0.0, 0.0, 0.0);
    for seed in 0..60 {
        let run = truth.run(seed).positions;
        let off = |e: &Estimate| (e.values[scale].unwrap() - truth.scale_error).powi(2);
        let inside: Vec<Position> =
            run.iter().filter(|p| p.readings.censored(&ends) == 0).cloned().collect();
        let wholly = |p: &&Position| p.readings.censored(&ends) == p.readings.samples();
        assert!(inside.len() < run.len() && run.iter().any(|p| wholly(&p)));
        let e = fit(&truth, &run, Weights::Angle);
        assert!(worst(&truth, &e) < 5.0, "seed {seed}: {}", worst(&truth, &e));
        with += off(&e);
        without += off(&fit(&truth, &inside, Weights::Angle));
        averaged += off(&try_fit(&truth, &run, Method::Exact, Weights::Equal).unwrap());
    }
    assert!(with < 1.05 * without, "with {with}, without {without}");
    assert!(averaged > 100.0 * with, "averaged {averaged}, with {with}");
}

#[test]
fn averages_reduce_to_least_squares() {
    let truth = Truth {
        sigma: 1.25,
        level: 0.3,
        quantizer: Quantizer::Floor,
        ..Truth::new(equal(60.0, 25))
    };
    let run = averaged(&truth.run(4).positions);
    let ours = fit(&truth, &run, Weights::Equal);
    let least_squares = try_fit(&truth, &run, Method::Exact, Weights::Equal).unwrap();
    for p in Parameter::ALL {
        let i = p.index();
        let u = least_squares.standard_uncertainty(p).unwrap();
        // One kind of scatter and equal dwells: weights are equal, and the interval is Student's with n − p.
        let off = (ours.values[i].unwrap() - least_squares.values[i].unwrap()) / u;
        assert!(off.abs() < 1e-5, "{}: {off}", p.name());
        let ratio = ours.standard_uncertainty(p).unwrap() / u;
        assert!((ratio - 1.0).abs() < 0.005, "{}: {ratio}", p.name());
        assert!((ours.effective_dof[i] - 22.0).abs() < 0.3, "{:?}", ours.effective_dof);
    }
    assert_eq!(ours.scatter.unwrap().split, Split::NotAsked);
}

#[test]
fn averages_say_nearly_what_their_codes_say() {
    for sigma in [0.1, 0.25, 1.25] {
        let truth = Truth { sigma, level: 0.1, ..Truth::new(equal(60.0, 40)) };
        let run = truth.run(8).positions;
        let (codes, averages) =
            (fit(&truth, &run, Weights::Angle), fit(&truth, &averaged(&run), Weights::Angle));
        for p in Parameter::ALL {
            let off = codes.values[p.index()].unwrap() - averages.values[p.index()].unwrap();
            let u = codes.standard_uncertainty(p).unwrap();
            assert!(off.abs() < 0.3 * u, "σ {sigma} {}: {off} against {u}", p.name());
        }
    }
}

/// Near code zero the sign rule is off; the level whose codes have that mean is not.
#[test]
fn averages_near_code_zero_are_inverted() {
    let truth = Truth { sigma: 1.0, bias_lsb: 0.4, ..Truth::new(equal(0.06, 12)) };
    let mut run = averaged(&truth.run(2).positions);
    // Two far positions hold the scale.
    let far = Truth { angles_deg: vec![-60.0, -59.0, 59.0, 60.0], ..truth.clone() };
    run.extend(averaged(&far.run(3).positions));
    let e = fit(&truth, &run, Weights::Equal);
    let bias = e.values[0].unwrap() / truth.scale();
    let signs = try_fit(&truth, &run, Method::Exact, Weights::Equal).unwrap().values[0].unwrap()
        / truth.scale();
    assert!((bias - 0.4).abs() < 0.06, "likelihood {bias}, sign rule {signs}");
}

#[test]
fn readings_that_are_real_numbers() {
    let truth = Truth {
        sigma: 1.25,
        level: 0.2,
        quantizer: Quantizer::None,
        ..Truth::new(equal(60.0, 30))
    };
    let coded = Truth { quantizer: Quantizer::Round, ..truth.clone() };
    let simulated = coded.run(6);
    let run: Vec<Position> = simulated
        .positions
        .iter()
        .zip(&simulated.analogue_lsb)
        .map(|(p, mean)| {
            let (mut moments, mut blocks) = (ValueMoments::default(), BlockSums::default());
            for k in 0..200 {
                let x = mean + if k % 2 == 0 { 1.25 } else { -1.25 };
                let steps = ValueMoments::steps(x).unwrap();
                moments.record(steps);
                blocks.record(steps);
            }
            Position { readings: Readings::Values { moments, blocks }, ..p.clone() }
        })
        .collect();
    let e = fit(&truth, &run, Weights::Angle);
    assert!(worst(&truth, &e) < 4.0);
    assert!((e.scatter.unwrap().noise_lsb.unwrap().value - 1.253).abs() < 0.01);
}

#[test]
fn from_three_positions_to_a_hundred_thousand() {
    for count in [4, 5, 7] {
        let truth = Truth { level: 0.2, ..Truth::new(equal(60.0, count)) };
        let e = fit(&truth, &truth.run(1).positions, Weights::Angle);
        let [low, high] = e.interval(Parameter::Bias, 0.95).unwrap();
        assert!(low.is_finite() && high > low, "{count}");
    }
    // Three positions determine the parameters and nothing else.
    let three = Truth::new(equal(60.0, 3));
    let e = fit(&three, &three.run(1).positions, Weights::Angle);
    assert!(e.full().is_some() && e.covariance.is_none() && e.scatter.is_none());
    let many = Truth { level: 0.2, samples: 8, ..Truth::new(equal(60.0, 100_000)) };
    let e = fit(&many, &many.run(1).positions, Weights::Angle);
    assert!(worst(&many, &e) < 4.5, "{}", worst(&many, &e));
}

#[test]
fn the_order_of_the_positions_does_not_matter() {
    for sigma in [0.1, 1.25] {
        let truth = Truth { sigma, level: 0.1, ..Truth::new(equal(60.0, 30)) };
        let run = truth.run(7).positions;
        let mut turned = run.clone();
        turned.reverse();
        turned.rotate_left(11);
        let (a, b) = (fit(&truth, &run, Weights::Angle), fit(&truth, &turned, Weights::Angle));
        for p in Parameter::ALL {
            let off = a.values[p.index()].unwrap() - b.values[p.index()].unwrap();
            assert!(
                off.abs() < 0.02 * a.standard_uncertainty(p).unwrap(),
                "σ {sigma} {}: {off}",
                p.name()
            );
        }
    }
}

/// A narrow arc: hopeless, and said to be.
#[test]
fn a_narrow_arc_has_uncertainties_to_match() {
    let truth =
        Truth { level: 0.2, ..Truth::new((0..60).map(|i| 9.0 + f64::from(i) / 30.0).collect()) };
    let e = fit(&truth, &truth.run(1).positions, Weights::Angle);
    assert!(e.standard_uncertainty(Parameter::Bias).unwrap() > 1.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Whatever the codes: an answer that is finite, or an error. Never a panic.
    #[test]
    fn any_codes_give_an_answer_or_an_error(
        dwells in prop::collection::vec(
            (-80.0..80.0f64, prop::collection::vec((-1200..1200i32, 1..2000u64), 1..5)), 4..12),
        truncate in any::<bool>(),
        ends in any::<bool>(),
    ) {
        let truth = Truth {
            quantizer: if truncate { Quantizer::Truncate } else { Quantizer::Round },
            ends: if ends {
                ConverterEnds { min_code: Some(Code(-900)), max_code: Some(Code(900)) }
            } else {
                ConverterEnds::default()
            },
            ..Truth::new(Vec::new())
        };
        let positions: Vec<Position> = dwells
            .iter()
            .map(|(deg, codes)| {
                let mut histogram = CodeHistogram::default();
                codes.iter().for_each(|(n, k)| histogram.record_many(Code(*n), *k));
                Position {
                    angle: Angle::from_deg(*deg),
                    seat: Seat::Table,
                    readings: Readings::Codes { histogram, blocks: BlockSums::default() },
                    temperature_degc: None,
                    place: String::new(),
                record: Record::default(),
                }
            })
            .collect();
        if let Ok(e) = try_fit(&truth, &positions, Method::Likelihood, Weights::Angle) {
            for p in Parameter::ALL {
                if let Some(v) = e.values[p.index()] {
                    prop_assert!(v.is_finite());
                }
                if let Some(u) = e.standard_uncertainty(p) {
                    prop_assert!(u.is_finite() && u >= 0.0);
                }
            }
        }
    }
}

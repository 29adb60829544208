//! What the user decides, through the whole judgement.

use tumble_core::assess::{AssessError, LeftOut, Verdict, assess, assess_without};
use tumble_core::estimate::EstimateOptions;
use tumble_core::simulate::{Preset, Truth, experiment, parse_plan};
use tumble_core::{Angle, Experiment, FindingKind, Quantizer, Readings};

const LSB: f64 = 0.007_69;

fn bench(plan: &str, runs: u32) -> Experiment {
    seeded(plan, runs, Preset::Paper1.truth().seed)
}

fn seeded(plan: &str, runs: u32, seed: u64) -> Experiment {
    let mut e = experiment(&Truth {
        seed,
        angles_deg: parse_plan(plan).unwrap(),
        quantizer: Quantizer::Floor,
        dwell_s: 6.0,
        runs,
        misalignment: Angle::from_rad(0.002),
        bias_m_s2: 5.3 * LSB,
        ..Preset::Paper1.truth()
    });
    for run in &mut e.runs {
        for (i, p) in run.positions.iter_mut().enumerate() {
            p.place = format!("{}.csv, dwell {}", run.name, i + 1);
        }
    }
    e
}

/// Moves the mean of a dwell, counted from one.
fn shifted(mut e: Experiment, run: usize, dwell: usize, lsb: f64) -> Experiment {
    let p = &mut e.runs[run].positions[dwell - 1];
    let r = &p.readings;
    p.readings =
        Readings::Averaged { mean: r.mean().unwrap() + lsb, samples: r.samples(), std: r.std() };
    e
}

/// Through everything, three runs an experiment: hygiene before it and the rule after it.
#[test]
fn honest_experiments_name_a_position_as_seldom_as_stated() {
    let n = crate::study::runs(150, 5_000);
    for (plan, seed) in [("-60:60:60", 0), ("-60:60:12", 100_000)] {
        let named: usize = crate::study::each(n, |i| {
            let e = seeded(plan, 3, seed + i);
            let found = assess(&e, &EstimateOptions::default()).unwrap().findings;
            usize::from(found.iter().any(|f| f.kind == FindingKind::DoesNotBelong))
        })
        .iter()
        .sum();
        let (rate, se) = (named as f64 / n as f64, crate::study::fraction_se(0.01, n));
        println!("{plan}, three runs: {:.2} % of {n} (1 % ± {:.2})", 100.0 * rate, 200.0 * se);
        assert!(rate < 0.01 + 3.0 * se, "{plan}: {rate}");
    }
}

#[test]
fn what_repeats_in_all_runs_stays_when_a_position_is_left_out() {
    // A dial whose divisions err alike in every run.
    let mut e = bench("-60:60:60", 3);
    let errors = [0.9, -0.4, 0.2, -1.1, 0.6, 0.3, -0.7, 0.8, -0.2, -0.5];
    for run in 0..3 {
        for dwell in 1..=60 {
            e = shifted(e, run, dwell, errors[(dwell * 7) % 10]);
        }
    }
    let name = e.runs[1].name.clone();
    let repeats = |left: &[LeftOut]| {
        let a = assess_without(&e, &EstimateOptions::default(), left).unwrap();
        assert!(a.findings.iter().any(|f| f.kind == FindingKind::ErrorsRepeat), "{left:?}");
        a.pooled[0].standard_uncertainty
    };
    let (whole, rest) = (repeats(&[]), repeats(&[out(&name, 20)]));
    assert!((rest / whole - 1.0).abs() < 0.2, "{whole} {rest}");
}

fn out(run: &str, position: usize) -> LeftOut {
    LeftOut { run: run.into(), position }
}

#[test]
fn a_position_that_does_not_belong_is_named_kept_and_its_effect_shown() {
    let e = shifted(bench("-60:60:60", 3), 1, 31, 0.8);
    let a = assess(&e, &EstimateOptions::default()).unwrap();
    let f = a.findings.iter().find(|f| f.kind == FindingKind::DoesNotBelong).unwrap();
    let name = &e.runs[1].name;
    assert!(f.place.contains("dwell 31") && f.observed.contains("without it bias"), "{f:?}");
    assert!(f.remedy.contains(&format!("--leave-out {name}:31")), "{f:?}");
    assert!(f.observed.chars().count() < 400, "{f:?}");
    let o = &a.outliers.positions[0];
    assert_eq!((a.outliers.positions.len(), &o.run, o.position, o.left_out), (1, name, 31, false));
    assert!(o.p_value.unwrap() < 0.01 && o.effect.is_some() && o.pooled_effect.is_some(), "{o:?}");
    // It is in the result.
    assert_eq!(a.runs[1].estimate.as_ref().unwrap().positions, 60);
    assert!(a.outliers.comparison.is_empty());
    // The effect is the difference that leaving it out makes.
    let b = assess_without(&e, &EstimateOptions::default(), &[out(name, 31)]).unwrap();
    for i in 0..3 {
        let values = |a: &tumble_core::assess::Assessment| {
            a.runs[1].estimate.as_ref().unwrap().values[i].unwrap()
        };
        assert!((values(&b) - values(&a) - o.effect.unwrap()[i].change).abs() < 1e-12);
        let pooled = |a: &tumble_core::assess::Assessment| a.pooled[i].value;
        assert!((pooled(&b) - pooled(&a) - o.pooled_effect.unwrap()[i].change).abs() < 1e-12);
        // Put together in another order: rounding apart.
        assert!((b.outliers.comparison[i].with.0 - pooled(&a)).abs() < 1e-12);
        assert_eq!(b.outliers.comparison[i].without.0, pooled(&b));
    }
}

#[test]
fn left_out_positions_are_said_with_the_result_both_ways() {
    let e = shifted(bench("-60:60:60", 3), 0, 10, 3.0);
    let name = e.runs[0].name.clone();
    let left = [out(&name, 10), out(&name, 40)];
    let a = assess_without(&e, &EstimateOptions::default(), &left).unwrap();
    let f = a.findings.iter().find(|f| f.kind == FindingKind::LeftOutByUser).unwrap();
    assert!(f.observed.starts_with("positions 10, 40 of 60 left out"), "{f:?}");
    assert!(
        f.observed.contains("nothing in the data speaks against 40")
            && f.observed.contains("with all")
    );
    assert!(!a.findings.iter().any(|f| f.place.contains("dwell 10")), "{:?}", a.findings);
    assert_eq!(a.runs[0].estimate.as_ref().unwrap().positions, 58);
    let [ten, forty] = &a.outliers.positions[..] else { panic!("{:?}", a.outliers) };
    assert!(ten.left_out && ten.p_value.unwrap() < 1e-4 && ten.effect.is_some(), "{ten:?}");
    assert!(forty.left_out && forty.p_value.unwrap() > 0.01, "{forty:?}");
    assert_eq!(a.verdict, Verdict::Accepted);
}

#[test]
fn a_position_that_hygiene_names_is_named_once_and_its_effect_is_shown() {
    let e = shifted(bench("-60:60:60", 1), 0, 30, 9.0);
    let a = assess(&e, &EstimateOptions::default()).unwrap();
    let ids: Vec<&str> =
        a.findings.iter().filter(|f| f.place.contains("dwell 30")).map(|f| f.kind.id()).collect();
    assert_eq!(ids.len(), 1, "{:?}", a.findings);
    assert!(["T0119", "T0121"].contains(&ids[0]), "{ids:?}");
    let o = &a.outliers.positions[0];
    assert_eq!((o.position, o.named_by.map(FindingKind::id)), (30, Some(ids[0])));
    assert!(a.findings.iter().any(|f| f.observed.contains("without it bias")));
}

#[test]
fn choosing_too_much_is_no_result() {
    let e = bench("-60:60:60", 3);
    let name = e.runs[0].name.clone();
    let six: Vec<LeftOut> = (1..=6).map(|n| out(&name, 5 * n)).collect();
    let a = assess_without(&e, &EstimateOptions::default(), &six).unwrap();
    assert!(!a.findings.iter().any(|f| f.kind == FindingKind::TooManyLeftOut));
    let seven: Vec<LeftOut> = (1..=7).map(|n| out(&name, 5 * n)).collect();
    let a = assess_without(&e, &EstimateOptions::default(), &seven).unwrap();
    assert_eq!(a.verdict, Verdict::Indeterminate);
    assert!(a.compensation.is_none(), "coefficients from chosen positions");
}

#[test]
fn what_is_not_there_cannot_be_left_out() {
    let e = bench("-60:60:13", 2);
    let name = e.runs[0].name.clone();
    let of = |l: LeftOut| assess_without(&e, &EstimateOptions::default(), &[l]).unwrap_err();
    let no_run = of(out("morning", 1));
    assert!(matches!(no_run, AssessError::NoSuchRun { .. }) && no_run.to_string().contains(&name));
    for n in [0, 14] {
        let no_position = of(out(&name, n));
        assert!(matches!(no_position, AssessError::NoSuchPosition { .. }));
        assert!(no_position.to_string().contains("1 to 13"), "{no_position}");
    }
}

#[test]
fn up_and_down_dwells_do_not_shift_the_numbers() {
    let mut e = shifted(bench("-60:60:13", 2), 0, 5, 3.0);
    let name = e.runs[0].name.clone();
    let truth = Truth { angles_deg: vec![90.0, -90.0], runs: 1, ..Preset::Paper1.truth() };
    let pair = experiment(&truth).runs.remove(0).positions;
    let [up, down] = <[_; 2]>::try_from(pair).unwrap();
    e.vertical = Some(tumble_core::VerticalPair {
        up,
        down,
        run: Some(name.clone()),
        alone: tumble_core::PairUse::default(),
    });
    let a = assess_without(&e, &EstimateOptions::default(), &[out(&name, 5)]).unwrap();
    assert_eq!(a.outliers.positions[0].place, e.runs[0].positions[4].place);
    assert_eq!(a.runs[0].estimate.as_ref().unwrap().positions, 14);
}

//! An up/down pair that five runs share: entered in each as if it were new, and once in the joint adjustment.

use tumble_core::assess::{assess, pool_runs, shared_pair};
use tumble_core::estimate::{EstimateOptions, Method, Parameter, Weights};
use tumble_core::simulate::{Truth, experiment, parse_plan, readings, simulate_vertical};
use tumble_core::{
    Angle, Experiment, FindingKind, Orientation, PairUse, Position, Seat, VerticalPair,
};

use super::bench::{covers, find, quiet_table, run, setting};

const OPTIONS: EstimateOptions = EstimateOptions {
    method: Method::Exact,
    weights: Weights::Equal,
    level: 0.95,
    monte_carlo_digits: 0,
    terms: tumble_core::estimate::TermChoice::Named(tumble_core::estimate::TermSet::EMPTY),
};

fn with_pair(truth: &Truth) -> Experiment {
    let mut e = experiment(truth);
    let dwells: Vec<Position> = simulate_vertical(truth)
        .positions
        .iter()
        .map(|p| Position {
            angle: Angle::from_deg(p.angle_deg),
            seat: if p.angle_deg > 0.0 { Seat::Up } else { Seat::Down },
            readings: readings(truth, p),
            temperature_degc: None,
            place: String::new(),
            record: tumble_core::Record::default(),
        })
        .collect();
    let of = |seat: Seat| dwells.iter().find(|p| p.seat == seat).unwrap().clone();
    e.vertical = Some(VerticalPair {
        up: of(Seat::Up),
        down: of(Seat::Down),
        run: None,
        alone: PairUse::JointAdjustment,
    });
    e
}

/// Method section 7a: the naive way covers 21 %.
#[test]
fn a_shared_pair_enters_once_and_keeps_the_coverage() {
    let n = if super::long() { 5000 } else { 1000 };
    // A pair is worth most to a plan on one side of 0°.
    for (plan, turn_on_m_s2) in [("paper", 0.0), ("0:59:60", 0.004)] {
        let smuggled = turn_on_m_s2 == 0.0;
        let mut covered = [0usize; 4];
        let (mut with, mut without) = (0.0, 0.0);
        for seed in 0..n {
            let truth = Truth {
                turn_on_m_s2,
                seed: 70_000 + seed as u64,
                vertical_lean: Angle::from_arcmin(30.0),
                angles_deg: parse_plan(plan).unwrap(),
                ..quiet_table()
            };
            let e = with_pair(&truth);
            let pair = e.vertical.as_ref().unwrap();
            let together = |own: &[&Position]| {
                e.runs
                    .iter()
                    .map(|r| {
                        let all: Vec<&Position> = own.iter().copied().chain(&r.positions).collect();
                        run(&e, &all, "A", Orientation::Normal, &OPTIONS)
                    })
                    .collect::<Vec<_>>()
            };
            let runs = together(&[]);
            let shared = shared_pair(&e, &setting(&e), &runs).unwrap();
            let joint = pool_runs(&runs, Some(&shared), 0.95).parameters;
            let alone = pool_runs(&runs, None, 0.95).parameters;
            let truths = [truth.bias_m_s2, truth.misalignment.rad(), truth.scale_error];
            for p in Parameter::ALL {
                covered[p.index()] += usize::from(covers(find(&joint, p), truths[p.index()]));
            }
            if smuggled {
                let runs = together(&[&pair.up, &pair.down]);
                let naive = pool_runs(&runs, None, 0.95).parameters;
                covered[3] += usize::from(covers(find(&naive, Parameter::Bias), truth.bias_m_s2));
            }
            with += find(&joint, Parameter::ScaleError).standard_uncertainty;
            without += find(&alone, Parameter::ScaleError).standard_uncertainty;
        }
        let f = covered.map(|c| c as f64 / n as f64);
        println!(
            "{plan}, turn-on {turn_on_m_s2}: joint {:.4} {:.4} {:.4}, naive bias {:.4}, u(δk) {:.2}",
            f[0],
            f[1],
            f[2],
            f[3],
            with / without
        );
        for p in Parameter::ALL {
            assert!((f[p.index()] - 0.95).abs() <= 0.015, "{plan} {}: {f:?}", p.name());
        }
        if smuggled {
            assert!(f[3] < 0.40, "naive {f:?}");
        }
    }
}

/// Through `assess`: the pair is in the result and named, and no run has changed.
#[test]
fn the_joint_adjustment_leaves_the_runs_alone() {
    let e = with_pair(&Truth { seed: 5, ..quiet_table() });
    let mut apart = e.clone();
    apart.vertical.as_mut().unwrap().alone = PairUse::NominalScale;
    let options = EstimateOptions::default();
    let (joint, apart) = (assess(&e, &options).unwrap(), assess(&apart, &options).unwrap());
    for (a, b) in joint.runs.iter().zip(&apart.runs) {
        assert_eq!(a.estimate, b.estimate);
    }
    let named = |a: &tumble_core::assess::Assessment| {
        a.findings.iter().any(|f| f.kind == FindingKind::PairForScaleOnly)
    };
    assert!(joint.shared_pair.is_some() && !named(&joint));
    assert!(apart.shared_pair.is_none() && named(&apart));
    let scale =
        |a: &tumble_core::assess::Assessment| find(&a.pooled, Parameter::ScaleError).clone();
    assert!(scale(&joint).pair_weight > 0.0 && scale(&apart).pair_weight == 0.0);
    // A scale error that the runs and the pair have in common moves the result one to one.
    let s = scale(&joint);
    let sum = s.run_weights.iter().map(|w| w[2]).sum::<f64>() + s.pair_weight;
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    let bias: f64 = find(&joint.pooled, Parameter::Bias).run_weights.iter().map(|w| w[0]).sum();
    assert!((bias - 1.0).abs() < 1e-9, "{bias}");
}

/// The paper's method knows the pair for k0 alone.
#[test]
fn the_baseline_does_not_take_the_pair() {
    let e = with_pair(&Truth { seed: 6, ..quiet_table() });
    let options = EstimateOptions { method: Method::Paper, ..EstimateOptions::default() };
    assert!(assess(&e, &options).unwrap().shared_pair.is_none());
}

/// What the pair carries of the scale factor is as proportional to gravity as what the runs carry.
#[test]
fn gravity_is_in_the_pair_as_it_is_in_the_runs() {
    let mut e = with_pair(&Truth { seed: 5, ..quiet_table() });
    e.bench.gravity.standard_uncertainty_m_s2 = 1e-3;
    let a = assess(&e, &OPTIONS).unwrap();
    let scale = find(&a.pooled, Parameter::ScaleError);
    let of = |l: &&tumble_core::assess::BudgetLine| {
        l.parameter == Parameter::ScaleError && l.quantity == "local gravity"
    };
    let line = a.budget.iter().find(of).unwrap();
    let expected = (1.0 + scale.value) / e.bench.gravity.value_m_s2;
    // The runs' own values differ a little from the pooled one.
    assert!(scale.pair_weight > 0.01, "{}", scale.pair_weight);
    assert!((line.sensitivity / expected - 1.0).abs() < 1e-3, "{} {expected}", line.sensitivity);
}

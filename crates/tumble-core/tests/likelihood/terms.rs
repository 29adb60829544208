//! Further terms: whether their intervals, and those of the others beside them, hold what they say.

use tumble_core::estimate::{
    Estimate, EstimateOptions, Method, Parameter, Term, TermChoice, TermSet, estimate,
};
use tumble_core::stats::student_factor;
use tumble_core::{Position, STANDARD_GRAVITY_M_S2};

use crate::bench::{GRAVITY, Truth, equal};
use crate::study::{each, fraction_se, names, runs};

/// 100 µg/g².
const K2: f64 = 100e-6 / STANDARD_GRAVITY_M_S2;

fn set(truth: &Truth) -> TermSet {
    truth.further.iter().map(|(t, _)| *t).collect()
}

fn fitted(truth: &Truth, positions: &[Position], method: Method) -> Estimate {
    let bench = truth.bench();
    let refs: Vec<&Position> = positions.iter().collect();
    let options = EstimateOptions {
        method,
        terms: TermChoice::Named(set(truth)),
        ..EstimateOptions::default()
    };
    estimate(&refs, &truth.setting(&bench), &options).unwrap()
}

/// Fractions of runs whose 95 % intervals hold the truth: bias, misalignment, scale error, further terms.
fn covered(truth: &Truth, method: Method, n: usize, first_seed: u64) -> Vec<f64> {
    let q = truth.further.len();
    let all = each(n, |seed| {
        let truth = truth.dithered(seed + first_seed);
        let e = fitted(&truth, &truth.run(seed + first_seed + 1).positions, method);
        let theta = truth.parameters();
        let mut holds: Vec<bool> = Parameter::ALL
            .iter()
            .map(|p| {
                let [low, high] = e.interval(*p, 0.95).unwrap();
                (low..=high).contains(&theta[p.index()])
            })
            .collect();
        assert_eq!(e.terms.len(), q);
        for t in &e.terms {
            let (_, is) = truth.further.iter().find(|(x, _)| *x == t.term).unwrap();
            let half = student_factor(0.95, t.degrees_of_freedom).unwrap()
                * t.standard_uncertainty.unwrap();
            holds.push((t.value - is).abs() <= half);
        }
        holds
    });
    (0..3 + q).map(|i| all.iter().filter(|h| h[i]).count() as f64 / n as f64).collect()
}

#[test]
fn with_up_and_down_k2_is_covered_at_65_degrees() {
    let n = runs(600, 5_000);
    let realistic = |sigma| Truth {
        sigma,
        angle_arcmin: 0.55,
        stated_arcmin: Some(3.0),
        upright_arcmin: Some(30.0),
        further: vec![(Term::K2, K2)],
        ..Truth::new(equal(65.0, 60))
    };
    let with = |further: Vec<(Term, f64)>| Truth { further, ..realistic(1.2) };
    let warm = |further| Truth { temperature_degc: Some((20.0, 26.0)), ..with(further) };
    let cases = [
        ("K2", Method::Likelihood, realistic(1.2)),
        ("K2, quiet", Method::Likelihood, realistic(0.2)),
        ("K2, exact", Method::Exact, Truth { stated_arcmin: Some(0.55), ..realistic(1.2) }),
        ("K2 and K3", Method::Likelihood, with(vec![(Term::K2, K2), (Term::K3, K2 / GRAVITY)])),
        ("scale by sign", Method::Likelihood, with(vec![(Term::ScaleSign, 5e-4)])),
        (
            "temperature",
            Method::Likelihood,
            warm(vec![(Term::TempBias, 1e-3), (Term::TempScale, 1e-5)]),
        ),
    ];
    for (k, (name, method, truth)) in cases.iter().enumerate() {
        // 600 runs of the case that the method promises, fewer of the others in the default tier.
        let n = if k == 0 { n } else { runs(100, 5_000) };
        let share = covered(truth, *method, n, 40_000_000 + 1_000_000 * k as u64);
        let all = names().into_iter().chain(set(truth).iter().map(Term::name));
        let se = fraction_se(0.95, n);
        for (name_of, c) in all.zip(&share) {
            println!("{name:14} {name_of:13} {c:.4} ± {se:.4}");
            assert!((0.94 - 3.0 * se..=0.96 + 3.0 * se).contains(c), "{name}, {name_of}: {c:.4}");
        }
    }
}

//! Sensitivities against estimates of data that have the error.

use super::bench::{Errors, K0, PLANS, TRUTH, bench, plan, run, setting};
use tumble_core::estimate::{Estimate, EstimateOptions, Method, Parameter, Weights, estimate};
use tumble_core::systematic::{
    ExtraColumn, Inputs, Linearized, Quantity, Sites, SystematicEffect, effects, pattern,
    upright_lean,
};
use tumble_core::{Bench, Dial, Position, Seat};

/// Sizes at which the effect is well above rounding and well below second order.
fn size(q: Quantity) -> f64 {
    match q {
        Quantity::TiltTimesLean | Quantity::TiltAndLeanCosine => 1e-6,
        Quantity::Quadratic => 1e-6,
        Quantity::Cubic => 1e-7,
        Quantity::BiasTempco => 1e-3,
        Quantity::ConverterBow | Quantity::ConverterS => 0.01,
        _ => 1e-5,
    }
}

/// Quantities that a bench can have; tilt and lean come together.
const ALONE: [Quantity; 10] = [
    Quantity::DialScale,
    Quantity::EccentricitySine,
    Quantity::EccentricityCosine,
    Quantity::DialZero,
    Quantity::Quadratic,
    Quantity::Cubic,
    Quantity::BiasTempco,
    Quantity::ScaleTempco,
    Quantity::ConverterBow,
    Quantity::ConverterS,
];

fn fit(positions: &[Position], bench: &Bench, method: Method) -> Estimate {
    let refs: Vec<&Position> = positions.iter().collect();
    let options = EstimateOptions {
        method,
        weights: Weights::Angle,
        level: 0.95,
        ..EstimateOptions::default()
    };
    estimate(&refs, &setting(bench), &options).unwrap()
}

fn inputs() -> Inputs {
    let mut e = tumble_core::simulate::experiment(&tumble_core::simulate::Truth {
        runs: 1,
        dwell_s: 0.1,
        ..tumble_core::simulate::Preset::Paper3.truth()
    });
    e.bench.systematics = Default::default();
    Inputs::of(&e, K0)
}

fn find(all: &[SystematicEffect], q: Quantity) -> &SystematicEffect {
    all.iter().find(|e| e.quantity == q).unwrap()
}

/// Largest difference of the observed changes from the predicted ones, and largest predicted one, in standard uncertainties:
/// an error that hardly touches a parameter is held against what it does to the others.
fn distance(predicted: [f64; 3], observed: [f64; 3], u: [f64; 3]) -> (f64, f64) {
    let largest =
        |of: &dyn Fn(usize) -> f64| (0..3).map(|i| (of(i) / u[i]).abs()).fold(0.0, f64::max);
    (largest(&|i| predicted[i] - observed[i]), largest(&|i| predicted[i]))
}

/// How a run is fitted, and how far a re-fit may be from the derivative.
struct Comparison {
    method: Method,
    weights: Weights,
    plans: &'static [&'static str],
    /// Random scatter of the angles, arcminutes.
    scatter_arcmin: f64,
    /// Of the effect.
    relative: f64,
    /// Standard uncertainties, for an error that leaves residuals as large as the scatter.
    by_residuals: f64,
}

impl Comparison {
    fn fit(&self, positions: &[Position], bench: &Bench) -> Estimate {
        let refs: Vec<&Position> = positions.iter().collect();
        let options = EstimateOptions {
            method: self.method,
            weights: self.weights,
            level: 0.95,
            ..EstimateOptions::default()
        };
        estimate(&refs, &setting(bench), &options).unwrap()
    }

    fn run(&self) {
        let inputs = inputs();
        let mut worst = (0.0, String::new());
        for name in self.plans {
            let (angles, bench) = (plan(name), bench(3.0));
            let with = |e: &Errors| run(&angles, &bench, e, self.scatter_arcmin, 7);
            let base = with(&Errors::default());
            let at = self.fit(&base, &bench);
            let refs: Vec<&Position> = base.iter().collect();
            let all = effects(&at, &refs, &setting(&bench), &inputs, &[]).unwrap();
            let linearized = Linearized::new(&at, &[]).unwrap();
            let sites =
                Sites::of(&at, &refs, &setting(&bench), inputs.temperature_spread_k).unwrap();
            let u = Parameter::ALL.map(|p| at.standard_uncertainty(p).unwrap());
            let mut check = |q: Quantity, x: f64, up: &Errors, down: &Errors| {
                let predicted = find(&all, q).sensitivity.map(|c| c * x);
                let both = [up, down].map(|e| self.fit(&with(e), &bench).full().unwrap());
                let observed = core::array::from_fn(|i| 0.5 * (both[0][i] - both[1][i]));
                let left = linearized.left_over(&pattern(q, &sites).unwrap());
                let squares =
                    left.iter().zip(&at.weighted_rows).map(|(l, r)| (l * x / r.sd_lsb).powi(2));
                let residuals = (squares.sum::<f64>() / left.len() as f64).sqrt();
                let (difference, largest) = distance(predicted, observed, u);
                let text = format!(
                    "{name}, {}: {predicted:?} predicted, {observed:?} re-fitted",
                    q.name()
                );
                let allowed = self.relative * largest + self.by_residuals * residuals;
                assert!(difference < allowed, "{text}: {difference:.2e}, {allowed:.2e} allowed");
                if difference / largest > worst.0 {
                    worst = (difference / largest, text);
                }
            };
            for q in ALONE {
                check(q, size(q), &Errors::of(q, size(q)), &Errors::of(q, -size(q)));
            }
            // Tilt and lean are of second order: the product is odd in each of them, the cosine even.
            let tilted = |tilt, lean| Errors { tilt, lean, ..Errors::default() };
            let (eta, psi) = (4e-3, 3e-3);
            check(Quantity::TiltTimesLean, eta * psi, &tilted(eta, psi), &tilted(eta, -psi));
            check(
                Quantity::TiltAndLeanCosine,
                eta * eta / 4.0,
                &tilted(eta, 0.0),
                &tilted(0.0, 0.0),
            );
        }
        println!("{:?}: largest relative difference {:.1e} ({})", self.method, worst.0, worst.1);
    }
}

#[test]
fn exact() {
    Comparison {
        method: Method::Exact,
        weights: Weights::Angle,
        plans: &PLANS,
        scatter_arcmin: 0.0,
        relative: 0.003,
        by_residuals: 0.0,
    }
    .run();
}

#[test]
fn paper() {
    Comparison {
        method: Method::Paper,
        weights: Weights::Equal,
        plans: &PLANS,
        scatter_arcmin: 0.0,
        relative: 0.001,
        by_residuals: 0.0,
    }
    .run();
}

/// Weights that follow nothing.
#[test]
fn likelihood_of_one_kind_of_scatter() {
    Comparison {
        method: Method::Likelihood,
        weights: Weights::Equal,
        plans: &PLANS,
        scatter_arcmin: 1.0,
        relative: 0.01,
        by_residuals: 0.0,
    }
    .run();
}

/// Weights follow the scatter that is found, and the residuals that an error leaves are part of it: by chance they resemble the
/// scatter of angles or of levels. Nothing of that is in the derivative; it is small where the residuals are.
#[test]
fn likelihood_of_both_kinds_of_scatter() {
    Comparison {
        method: Method::Likelihood,
        weights: Weights::Angle,
        plans: &["narrow", "wide", "three"],
        scatter_arcmin: 1.0,
        relative: 0.01,
        by_residuals: 1.0,
    }
    .run();
}

/// Two upright dwells weigh as much as the scatter of the others says, and an error of the table sets the two kinds against each
/// other: over 30 samples the mean effect of the dial's scale is 4 % more than the derivative, that of eccentricity 20 %.
#[test]
fn likelihood_with_upright_dwells() {
    Comparison {
        method: Method::Likelihood,
        weights: Weights::Angle,
        plans: &["upright"],
        scatter_arcmin: 1.0,
        relative: 0.05,
        by_residuals: 3.0,
    }
    .run();
}

/// `g` used and `g` there.
#[test]
fn gravity() {
    let inputs = inputs();
    for method in [Method::Exact, Method::Paper, Method::Likelihood] {
        for name in PLANS {
            let b = bench(3.0);
            let positions = run(&plan(name), &b, &Errors::default(), 1.0, 3);
            let at = fit(&positions, &b, method);
            let refs: Vec<&Position> = positions.iter().collect();
            let all = effects(&at, &refs, &setting(&b), &inputs, &[]).unwrap();
            let c = find(&all, Quantity::Gravity).sensitivity;
            let step = 1e-4;
            let other = |x: f64| {
                let mut b = b.clone();
                b.gravity.value_m_s2 += x;
                fit(&positions, &b, method)
            };
            let (up, down) = (other(step), other(-step));
            for p in Parameter::ALL {
                let i = p.index();
                let observed = 0.5 * (up.values[i].unwrap() - down.values[i].unwrap());
                let u = at.standard_uncertainty(p).unwrap();
                assert!(
                    (c[i] * step - observed).abs() < 1e-3 * (c[i] * step).abs() + 1e-5 * u,
                    "{method:?} {name} {}: {} {observed}",
                    p.name(),
                    c[i] * step
                );
            }
        }
    }
}

/// A reversed body: its angle runs against the dial, and so do zero, cosine and lean; scale and sine do not care.
#[test]
fn a_reversed_run_turns_what_belongs_to_the_table() {
    let (b, inputs) = (bench(3.0), inputs());
    let positions = run(&plan("wide"), &b, &Errors::default(), 1.0, 3);
    let dialled = |direction: f64| -> Vec<Position> {
        let dial = Dial { typed: String::new(), value: 0.0, unit_deg: 1.0, direction };
        let with = |p: &Position| {
            let mut p = p.clone();
            p.record.dial = Some(dial.clone());
            p
        };
        positions.iter().map(with).collect()
    };
    let of = |positions: &[Position]| {
        let refs: Vec<&Position> = positions.iter().collect();
        effects(&fit(positions, &b, Method::Exact), &refs, &setting(&b), &inputs, &[]).unwrap()
    };
    let (normal, reversed) = (of(&dialled(1.0)), of(&dialled(-1.0)));
    for (n, r) in normal.iter().zip(&reversed) {
        let turns = matches!(
            n.quantity,
            Quantity::EccentricityCosine | Quantity::DialZero | Quantity::TiltTimesLean
        );
        let sign = if turns { -1.0 } else { 1.0 };
        assert_eq!(n.sensitivity.map(|c| sign * c), r.sensitivity, "{}", n.quantity.name());
    }
}

/// With K2 fitted beside the parameters it is no systematic error, and it has sensitivities of its own.
#[test]
fn a_fitted_term_takes_its_own_place() {
    let (b, inputs) = (bench(0.0), inputs());
    let positions = run(&plan("upright"), &b, &Errors::default(), 1.0, 3);
    let refs: Vec<&Position> = positions.iter().collect();
    let at = fit(&positions, &b, Method::Exact);
    let sites = Sites::of(&at, &refs, &setting(&b), 1.0).unwrap();
    let lsb = pattern(Quantity::Quadratic, &sites).unwrap();
    let columns = [ExtraColumn { lsb: lsb.clone(), replaces: Some(Quantity::Quadratic) }];
    let with = effects(&at, &refs, &setting(&b), &inputs, &columns).unwrap();
    assert!(with.iter().all(|e| e.quantity != Quantity::Quadratic));
    // K2 in the data shows as K2 alone.
    let joint = Linearized::new(&at, &columns).unwrap().shift(&lsb);
    assert!((joint.terms[0] - 1.0).abs() < 1e-9);
    assert!(joint.parameters.iter().all(|c| c.abs() < 1e-6), "{:?}", joint.parameters);
    // Eccentricity looks like K2: it shifts the term, and the bias differently from before.
    let without = effects(&at, &refs, &setting(&b), &inputs, &[]).unwrap();
    let (a, c) =
        (find(&with, Quantity::EccentricityCosine), find(&without, Quantity::EccentricityCosine));
    assert!(
        a.terms[0].abs() > 0.0
            && (a.sensitivity[0] - c.sensitivity[0]).abs() > 0.1 * c.sensitivity[0].abs()
    );
    // Against a joint least-squares fit of perturbed data, by its own normal equations.
    let x = 1e-5;
    let perturbed = run(&plan("upright"), &b, &Errors::of(Quantity::EccentricityCosine, x), 1.0, 3);
    let k2 = |positions: &[Position]| {
        let mut t = tumble_core::linalg::Triangular::new(4);
        for ((p, w), c) in positions.iter().zip(&at.weighted_rows).zip(&lsb) {
            let y = p.readings.mean().unwrap() / w.sd_lsb;
            t.push(&[w.row[0], w.row[1], w.row[2], c / w.sd_lsb], y);
        }
        t.solve().unwrap()[3]
    };
    let observed = (k2(&perturbed) - k2(&positions)) / x;
    assert!((observed / a.terms[0] - 1.0).abs() < 1e-3, "{observed} {}", a.terms[0]);
    // A column of another length, or one that is there already, is refused.
    let short = [ExtraColumn { lsb: vec![1.0; 3], replaces: None }];
    assert_eq!(Linearized::new(&at, &short), None);
    let constant = [ExtraColumn { lsb: vec![1.0; lsb.len()], replaces: None }];
    assert_eq!(Linearized::new(&at, &constant), None);
}

/// Repeats of one angle round alike, and their scatter does not tell.
#[test]
fn repeats_share_their_rounding() {
    let (mut b, inputs) = (bench(0.0), inputs());
    b.vertical_lean = tumble_core::Angle::from_rad(0.0);
    let step = 4.0;
    let rounded = |positions: Vec<Position>| -> Vec<Position> {
        let round = |mut p: Position| {
            let mean = (p.readings.mean().unwrap() / step).round() * step;
            p.readings = tumble_core::Readings::Averaged { mean, samples: 1, std: None };
            p
        };
        positions.into_iter().map(round).collect()
    };
    let mut inputs = inputs;
    for l in inputs.lines.iter_mut().filter(|l| l.quantity == Quantity::Resolution) {
        l.standard_uncertainty = step / 12f64.sqrt();
    }
    let u = |name: &str| {
        let positions = rounded(run(&plan(name), &b, &Errors::default(), 0.0, 3));
        let refs: Vec<&Position> = positions.iter().collect();
        let at = fit(&positions, &b, Method::Exact);
        let all = effects(&at, &refs, &setting(&b), &inputs, &[]).unwrap();
        (find(&all, Quantity::Resolution).contribution(), at)
    };
    let (three, at) = u("three");
    // The scatter is zero, and yet the bias is off by a good part of a step.
    assert!(at.residual_std_lsb.unwrap() < 1e-6);
    let error = (at.values[0].unwrap() - TRUTH[0]).abs();
    assert!(three[0] > 0.2 * step * K0 && error < 4.0 * three[0], "{three:?} {error}");
    // Every angle once: rounding is in the scatter.
    assert_eq!(u("wide").0, [0.0; 3]);
}

/// The lean's own part of the covariance.
#[test]
fn lean_of_upright_dwells_is_a_part_of_the_covariance() {
    let b = bench(0.0);
    let positions = run(&plan("upright"), &b, &Errors::default(), 0.1, 3);
    let refs: Vec<&Position> = positions.iter().collect();
    let at = fit(&positions, &b, Method::Exact);
    let lean = upright_lean(&at, &refs, &setting(&b)).unwrap();
    for p in Parameter::ALL {
        let u = at.standard_uncertainty(p).unwrap();
        assert!(lean[p.index()] > 0.0 && lean[p.index()] < u, "{}", p.name());
    }
    // What scatters beside it makes up the rest: X'X = sum over both kinds of positions.
    let table: Vec<&Position> = refs.iter().copied().filter(|p| p.seat == Seat::Table).collect();
    let alone = estimate(
        &table,
        &setting(&b),
        &EstimateOptions { method: Method::Exact, ..EstimateOptions::default() },
    )
    .unwrap();
    assert_eq!(upright_lean(&alone, &table, &setting(&b)), Some([0.0; 3]));
}

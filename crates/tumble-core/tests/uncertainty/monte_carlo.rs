//! Examples of JCGM 101 and others by Monte Carlo.

use tumble_core::uncertainty::{
    Distribution, Input, Measurement, Model, MonteCarloOptions, Scalar,
};

use super::printed;

/// Nearest half digit of a published number, and the draws' own error.
#[track_caller]
fn near(got: f64, published: f64, tolerance: f64) {
    println!("{got} ({published} ± {tolerance})");
    assert!((got - published).abs() <= tolerance, "{got} is not {published}");
}

struct Four;
impl Model<4, 1> for Four {
    fn evaluate<T: Scalar>(&self, [a, b, c, d]: &[T; 4]) -> [T; 1] {
        [*a + *b + *c + *d]
    }
}

fn million() -> MonteCarloOptions {
    MonteCarloOptions { fewest_draws: 1_000_000, digits: 2, threads: 2, ..Default::default() }
}

#[test]
fn supplement_1_additive_models() {
    let normal = Distribution::Normal { u: 1.0 };
    let rectangular = |u: f64| Distribution::Rectangular { half_width: u * 3f64.sqrt() };
    for (last, others, u, end, tolerance, holds) in [
        (normal, normal, 2.0, 3.92, 0.01, true),
        (rectangular(1.0), rectangular(1.0), 2.0, 3.88, 0.01, true),
        (rectangular(10.0), rectangular(1.0), 10.1, 17.0, 0.05, false),
    ] {
        let x = Input::new(0.0, others);
        let m = Measurement {
            inputs: [x, x, x, Input::new(0.0, last)],
            correlations: Vec::new(),
            model: Four,
        };
        let [gum] = m.propagate().outputs;
        printed(gum.standard_uncertainty, u, if u > 10.0 { 0.1 } else { 0.01 });
        let mc = m.draw(0.95, &million());
        let [y] = mc.outputs;
        near(y.standard_uncertainty, gum.standard_uncertainty, 0.005 * u);
        near(y.symmetric.low, -end, tolerance);
        near(y.symmetric.high, end, tolerance);
        near(y.shortest.high - y.shortest.low, 2.0 * end, 2.0 * tolerance);
        // Clause 8 at two digits: 9.2.2 and 9.2.3 hold, 9.2.4 does not (JCGM 101, table 3 and 9.2.4.5).
        let v = y.validate(gum.interval(0.95).unwrap());
        println!("d_low {:.3}, d_high {:.3}, tolerance {}", v.d_low, v.d_high, v.tolerance);
        assert_eq!(v.holds(), holds);
    }
}

struct Logarithm;
impl Model<1, 1> for Logarithm {
    fn evaluate<T: Scalar>(&self, [x]: &[T; 1]) -> [T; 1] {
        [x.ln()]
    }
}

#[test]
fn npl_logarithm() {
    let m = Measurement {
        inputs: [Input::new(0.6, Distribution::Rectangular { half_width: 0.5 })],
        correlations: Vec::new(),
        model: Logarithm,
    };
    let [gum] = m.propagate().outputs;
    printed(gum.value, -0.511, 1e-3);
    printed(gum.standard_uncertainty, 0.481, 1e-3);
    let [y] = m.draw(0.95, &million()).outputs;
    near(y.value, -0.665, 0.002);
    near(y.standard_uncertainty, 0.606, 0.002);
    near(y.shortest.low, -1.895, 0.005);
    near(y.shortest.high, 0.095, 0.001);
    assert!(!y.validate(gum.interval(0.95).unwrap()).holds());
}

struct Expansion;
impl Model<4, 1> for Expansion {
    fn evaluate<T: Scalar>(&self, [l0, t0, l1, t1]: &[T; 4]) -> [T; 1] {
        [(*l1 - *l0) / (*l0 * (*t1 - *t0))]
    }
}

#[test]
fn nist_tn_1900_thermal_expansion() {
    // Student with 3 degrees of freedom, rescaled to the stated standard deviation.
    let input =
        |x: f64, u: f64| Input::new(x, Distribution::Student { u: u / 3f64.sqrt(), dof: 3.0 });
    let m = Measurement {
        inputs: [
            input(1.4999, 0.0001),
            input(288.15, 0.02),
            input(1.5021, 0.0002),
            input(373.10, 0.05),
        ],
        correlations: Vec::new(),
        model: Expansion,
    };
    let [gum] = m.propagate().outputs;
    printed(gum.value, 1.7266e-5, 1e-9);
    // With the standard deviations themselves: √3 of the scales.
    printed(gum.standard_uncertainty * 3f64.sqrt(), 1.76e-6, 1e-8);
    let [y] = m.draw(0.95, &million()).outputs;
    near(y.value, 1.7268e-5, 1e-8);
    // Variances of t(3) converge slowly: the published 1.74 comes from a million draws of its own.
    near(y.standard_uncertainty, 1.75e-6, 0.02e-6);
}

#[test]
fn end_gauge_of_h1() {
    // JCGM 101 9.5 has other distributions; here the second order shows in u, 34 instead of 32.
    let m = super::gum::end_gauge();
    let [y] = m.draw(0.99, &million()).outputs;
    near(y.value, 50_000_838.0, 0.5);
    near(y.standard_uncertainty, 34.9, 0.5);
}

#[test]
fn correlated_draws_and_threads() {
    let normal = |u: f64| Input::new(1.0, Distribution::Student { u, dof: 8.0 });
    let m = Measurement {
        inputs: [normal(1.0), normal(2.0), normal(0.5), Input::exact(0.0)],
        correlations: vec![(0, 1, 0.8), (0, 2, -0.5), (1, 2, -0.2)],
        model: Pass,
    };
    let mc = m.draw::<3>(0.95, &million());
    // The variance of Student's distribution is ν/(ν − 2) times the square of its scale.
    let wider = 8.0 / 6.0;
    for (a, b, c) in [(0, 0, 1.0), (1, 1, 4.0), (0, 1, 1.6), (0, 2, -0.25), (1, 2, -0.2)] {
        near(mc.covariance[a][b], c * wider, 0.02 * wider * c.abs().max(0.5));
    }
    let t = tumble_core::stats::student_factor(0.95, 8.0).unwrap();
    near(mc.outputs[1].symmetric.high, 1.0 + 2.0 * t, 0.02);
    for threads in [1, 3] {
        assert_eq!(m.draw::<3>(0.95, &MonteCarloOptions { threads, ..million() }), mc);
    }
}

struct Pass;
impl Model<4, 3> for Pass {
    fn evaluate<T: Scalar>(&self, [a, b, c, _]: &[T; 4]) -> [T; 3] {
        [*a, *b, *c]
    }
}

#[test]
fn it_stops_when_it_stands_still() {
    let m = Measurement {
        inputs: [Input::new(0.0, Distribution::Normal { u: 1.0 }); 4],
        correlations: Vec::new(),
        model: Four,
    };
    // One digit of u = 2: δ = 0.5; three, δ = 0.005, are out of reach of so few draws.
    let o = MonteCarloOptions { digits: 1, ..Default::default() };
    let coarse = m.draw::<1>(0.95, &o);
    assert!(coarse.stabilized && coarse.draws == 100_000);
    let o = MonteCarloOptions { digits: 3, most_draws: 200_000, ..Default::default() };
    let fine = m.draw::<1>(0.95, &o);
    assert!(!fine.stabilized && fine.draws == 200_000);
}

//! Straight lines: least squares of the house, then propagation of what is read off them.

use tumble_core::linalg::Triangular;
use tumble_core::uncertainty::{Distribution, Input, Measurement, Model, Scalar};

use super::printed;

/// Intercept, slope, their covariance (unit weights are scaled by the residuals), residual sum of squares.
struct Line {
    at: [f64; 2],
    covariance: [[f64; 2]; 2],
    chi_squared: f64,
}

fn line(x: &[f64], y: &[f64], uy: impl Fn(usize) -> f64, scaled: bool) -> Line {
    let mut t = Triangular::new(2);
    for i in 0..x.len() {
        t.push(&[1.0 / uy(i), x[i] / uy(i)], y[i] / uy(i));
    }
    let c = t.unit_covariance().unwrap();
    let at = t.solve().unwrap();
    let chi_squared = t.residual_sum_of_squares();
    let s2 = if scaled { chi_squared / (x.len() as f64 - 2.0) } else { 1.0 };
    let covariance = [[c[(0, 0)] * s2, c[(0, 1)] * s2], [c[(1, 0)] * s2, c[(1, 1)] * s2]];
    Line { at: [at[0], at[1]], covariance, chi_squared }
}

impl Line {
    fn u(&self, i: usize) -> f64 {
        self.covariance[i][i].sqrt()
    }
    fn r(&self) -> f64 {
        self.covariance[0][1] / (self.u(0) * self.u(1))
    }
}

/// `a + b x` at a given place.
struct At(f64);
impl Model<2, 1> for At {
    fn evaluate<T: Scalar>(&self, [a, b]: &[T; 2]) -> [T; 1] {
        [*a + *b * T::constant(self.0)]
    }
}

/// `x = (y − a)/b`.
struct Inverse;
impl Model<3, 1> for Inverse {
    fn evaluate<T: Scalar>(&self, [a, b, y]: &[T; 3]) -> [T; 1] {
        [(*y - *a) / *b]
    }
}

#[test]
fn gum_h3_thermometer() {
    let t =
        [21.521, 22.012, 22.512, 23.003, 23.507, 23.999, 24.513, 25.002, 25.503, 26.010, 26.511];
    let b =
        [-0.171, -0.169, -0.166, -0.159, -0.164, -0.165, -0.156, -0.157, -0.159, -0.161, -0.160];
    let x: Vec<f64> = t.iter().map(|t| t - 20.0).collect();
    let l = line(&x, &b, |_| 1.0, true);
    printed(l.at[0], -0.1712, 1e-4);
    printed(l.u(0), 0.0029, 1e-4);
    printed(l.at[1], 0.00218, 1e-5);
    printed(l.u(1), 0.00067, 1e-5);
    printed(l.r(), -0.930, 1e-3);
    printed((l.chi_squared / 9.0).sqrt(), 0.0035, 1e-4);
    let student = |i: usize| Input::new(l.at[i], Distribution::Student { u: l.u(i), dof: 9.0 });
    let m = Measurement {
        inputs: [student(0), student(1)],
        correlations: vec![(0, 1, l.r())],
        model: At(10.0),
    };
    let [y] = m.propagate().outputs;
    printed(y.value, -0.1494, 1e-4);
    printed(y.standard_uncertainty, 0.0041, 1e-4);
    printed(y.degrees_of_freedom, 9.0, 1e-9);
}

#[test]
fn iso_28037_lines_and_inverse_prediction() {
    let x = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let cases = [
        (
            [3.3, 5.6, 7.1, 9.3, 10.7, 12.1],
            [0.5; 6],
            [1.866667, 1.757143, 0.4654747, 0.1195229, -0.05, 1.665],
            (10.5, 0.5, 4.913, 0.322),
        ),
        (
            [3.2, 4.3, 7.6, 8.6, 11.7, 12.8],
            [0.5, 0.5, 0.5, 1.0, 1.0, 1.0],
            [0.8852, 2.057, 0.5297081, 0.177892, -0.08227848, 4.131],
            (10.5, 1.0, 4.674, 0.533),
        ),
    ];
    for (k, (y, uy, published, (y0, uy0, x0, ux0))) in cases.into_iter().enumerate() {
        let l = line(&x, &y, |i| uy[i], false);
        let digits = if k == 0 { [1e-6, 1e-6] } else { [1e-4, 1e-3] };
        printed(l.at[0], published[0], digits[0]);
        printed(l.at[1], published[1], digits[1]);
        printed(l.u(0), published[2], 1e-7);
        printed(l.u(1), published[3], 1e-6);
        printed(l.covariance[0][1], published[4], 1e-8);
        printed(l.chi_squared, published[5], 1e-3);
        let normal = |i: usize| Input::new(l.at[i], Distribution::Normal { u: l.u(i) });
        let m = Measurement {
            inputs: [normal(0), normal(1), Input::new(y0, Distribution::Normal { u: uy0 })],
            correlations: vec![(0, 1, l.r())],
            model: Inverse,
        };
        let [x] = m.propagate().outputs;
        printed(x.value, x0, 1e-3);
        printed(x.standard_uncertainty, ux0, 1e-3);
    }
}

#[test]
fn bevington_line() {
    let x = [4.0, 8.0, 12.5, 16.0, 20.0, 25.0, 31.0, 36.0, 40.0, 40.0];
    let y = [3.7, 7.8, 12.1, 15.6, 19.8, 24.5, 30.7, 35.5, 39.4, 39.5];
    let l = line(&x, &y, |_| 1.0, true);
    printed(l.at[0], -0.222142, 1e-6);
    printed(l.u(0), 0.06962967, 1e-8);
    printed(l.at[1], 0.99278, 1e-5);
    printed(l.u(1), 0.002636608, 1e-9);
    printed(l.covariance[0][1], -0.0001616271, 1e-10);
}

#[test]
fn eurachem_a5_inverse_prediction() {
    let x: Vec<f64> = [0.1, 0.3, 0.5, 0.7, 0.9].iter().flat_map(|v| [*v; 3]).collect();
    let y = [
        0.028, 0.029, 0.029, 0.084, 0.083, 0.081, 0.135, 0.131, 0.133, 0.180, 0.181, 0.183, 0.215,
        0.230, 0.216,
    ];
    let l = line(&x, &y, |_| 1.0, true);
    let s = (l.chi_squared / 13.0).sqrt();
    let normal = |i: usize| Input::new(l.at[i], Distribution::Student { u: l.u(i), dof: 13.0 });
    // Two readings of the sample.
    let y0 = Input::new(0.0714, Distribution::Student { u: s / 2f64.sqrt(), dof: 13.0 });
    let m = Measurement {
        inputs: [normal(0), normal(1), y0],
        correlations: vec![(0, 1, l.r())],
        model: Inverse,
    };
    let [c] = m.propagate().outputs;
    printed(c.value, 0.26, 0.01);
    printed(c.standard_uncertainty, 0.018, 0.001);
}

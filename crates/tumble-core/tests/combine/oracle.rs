//! Against statsmodels, and numpy's algebra with scipy's optimizer.

use tumble_core::combine::{Unit, combine, heterogeneity};
use tumble_core::linalg::Symmetric3;

use super::answers::{MIXED, MULTIVARIATE, UNIVARIATE};

pub struct Univariate {
    pub values: &'static [f64],
    pub variances: &'static [f64],
    pub q: f64,
    pub p: f64,
    pub mandel_paule: f64,
    pub dersimonian_laird: f64,
    pub i_squared: f64,
    pub reml: f64,
    pub mean: f64,
    pub u: f64,
    pub interval: [f64; 2],
}

pub struct Mixed {
    pub means: &'static [f64],
    pub variance: f64,
    pub omega2: f64,
    pub mean: f64,
    pub u: f64,
}

pub struct Row {
    pub values: [Option<f64>; 3],
    pub c: [f64; 6],
    pub mounting: usize,
}

pub struct Multivariate {
    pub units: &'static [Row],
    pub mountings: usize,
    pub omega2: [f64; 3],
    pub log_likelihood: f64,
    pub mu: &'static [f64],
    pub u: &'static [f64],
    pub dof: &'static [f64],
}

#[track_caller]
fn near(name: &str, ours: f64, theirs: f64, relative: f64, absolute: f64) {
    let off = (ours - theirs).abs();
    assert!(off <= relative * theirs.abs() + absolute, "{name}: {ours:e}, theirs {theirs:e}");
}

pub fn bias_only(value: f64, variance: f64) -> Unit {
    Unit {
        values: [Some(value), None, None],
        covariance: Symmetric3([[variance, 0.0, 0.0], [0.0; 3], [0.0; 3]]),
        design: [vec![(0, 1.0)], vec![], vec![]],
        dof: [f64::INFINITY; 3],
    }
}

#[test]
fn one_parameter_against_statsmodels() {
    for set in UNIVARIATE {
        let (y, v) = (set.values, set.variances);
        let h = heterogeneity(y, v, &vec![0; y.len()], f64::INFINITY, 0.95).unwrap();
        let size = v.iter().sum::<f64>() / v.len() as f64;
        near("Q", h.cochran_q, set.q, 1e-9, 0.0);
        near("p", h.p_value, set.p, 1e-7, 0.0);
        // statsmodels stops where Q is 1e-5 from its target.
        near("Mandel-Paule", h.mandel_paule, set.mandel_paule, 1e-5, 1e-9 * size);
        near("DerSimonian-Laird", h.dersimonian_laird, set.dersimonian_laird, 1e-9, 1e-9 * size);
        near("I2", h.i_squared, set.i_squared, 1e-9, 1e-12);
        near("low", h.interval.0, set.interval[0], 1e-8, 1e-10 * size);
        near("high", h.interval.1, set.interval[1], 1e-8, 1e-10 * size);
        let units: Vec<Unit> = y.iter().zip(v).map(|(y, v)| bias_only(*y, *v)).collect();
        let c = combine(&units, 1).unwrap();
        near("REML", c.omega_squared[0].unwrap(), set.reml, 1e-7, 1e-9 * size);
        near("mean", c.columns[0].value, set.mean, 1e-9, 0.0);
        near("u", c.columns[0].standard_uncertainty, set.u, 1e-7, 0.0);
        near("dof", c.columns[0].degrees_of_freedom, (y.len() - 1) as f64, 1e-9, 0.0);
    }
}

#[test]
fn a_balanced_mixed_model_against_statsmodels() {
    let units: Vec<Unit> = MIXED.means.iter().map(|m| bias_only(*m, MIXED.variance)).collect();
    let c = combine(&units, 1).unwrap();
    // MixedLM stops where its gradient is small: six digits.
    near("omega2", c.omega_squared[0].unwrap(), MIXED.omega2, 2e-6, 0.0);
    near("mean", c.columns[0].value, MIXED.mean, 1e-9, 0.0);
    near("u", c.columns[0].standard_uncertainty, MIXED.u, 2e-6, 0.0);
}

#[test]
fn three_parameters_against_numpy_and_scipy() {
    for set in MULTIVARIATE {
        let units: Vec<Unit> = set
            .units
            .iter()
            .map(|r| {
                let [a, b, c, d, e, f] = r.c;
                Unit {
                    values: r.values,
                    covariance: Symmetric3([[a, b, c], [b, d, e], [c, e, f]]),
                    design: [vec![(0, 1.0)], vec![(2 + r.mounting, 1.0)], vec![(1, 1.0)]],
                    dof: [57.0; 3],
                }
            })
            .collect();
        let c = combine(&units, 2 + set.mountings).unwrap();
        near("log-likelihood", c.log_likelihood, set.log_likelihood, 0.0, 1e-6);
        for j in 0..3 {
            let size = [2e-5, 2e-7, 4e-9][j];
            near("omega2", c.omega_squared[j].unwrap(), set.omega2[j], 2e-6, 1e-7 * size);
        }
        for (i, column) in c.columns.iter().enumerate() {
            near("mu", column.value, set.mu[i], 1e-6, 1e-6 * set.u[i]);
            near("u", column.standard_uncertainty, set.u[i], 1e-6, 0.0);
            near("dof", column.degrees_of_freedom, set.dof[i], 1e-6, 0.0);
        }
    }
}

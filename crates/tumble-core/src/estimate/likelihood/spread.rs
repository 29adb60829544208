//! Uncertainty of the parameters from the whole surface of the restricted likelihood.

use super::basis::Basis;
use super::evidence::Evidence;
use super::integrate::{Dwell, Site, Solution};
use super::scatter::Node;
use crate::estimate::paper::ToParameters;
use crate::linalg::{Matrix, Symmetric3, dot3};

/// Degrees of freedom from which the residuals themselves say how large each parameter's variance is. With fewer, the
/// model of the scatter says it: three residuals that matter say little.
const RESIDUALS_FROM_DOF: f64 = 3.0;

/// Values, covariance and degrees of freedom of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spread {
    /// Bias, misalignment, scale error.
    pub values: [f64; 3],
    /// Their covariance.
    pub covariance: Matrix,
    /// Effective degrees of freedom, a parameter each.
    pub dof: [f64; 3],
    /// Intervals from the profile likelihood at the level asked for, where they are not `value ± t u`.
    pub profile: Option<[[f64; 2]; 3]>,
}

/// From shifts in the basis to parameters.
pub(super) struct Reading<'a> {
    pub basis: &'a Basis,
    pub reference: [f64; 3],
    pub to: ToParameters,
}

impl Reading<'_> {
    /// Parameters and their covariance.
    pub fn of(&self, solution: &Solution) -> ([f64; 3], Matrix) {
        let (values, jacobian) = self.to.at(self.unknowns(solution.shift));
        (values, self.basis.covariance(&solution.covariance).propagated(&jacobian))
    }

    /// `(α, β, γ)`.
    pub fn unknowns(&self, shift: [f64; 3]) -> [f64; 3] {
        let by = self.basis.unknowns(shift);
        core::array::from_fn(|i| self.reference[i] + by[i])
    }

    /// Gradient of each parameter by the shift.
    pub fn gradients(&self, shift: [f64; 3]) -> [[f64; 3]; 3] {
        let (_, jacobian) = self.to.at(self.unknowns(shift));
        let columns: [[f64; 3]; 3] = core::array::from_fn(|c| {
            let mut unit = [0.0; 3];
            unit[c] = 1.0;
            self.basis.unknowns(unit)
        });
        core::array::from_fn(|i| columns.map(|x| (0..3).map(|k| jacobian[(i, k)] * x[k]).sum()))
    }
}

/// Mean of the parameters over the surface, with the spread that comes from not knowing the scatter.
///
/// **Model** at each node the parameter is Gaussian with variance `U`; over the nodes `1/U` is taken as a gamma variable,
/// which makes the parameter Student's: scale `1/E[1/U]`, degrees of freedom `2 E[1/U]²/Var[1/U]`. With one component of
/// scatter that dominates this is exact: `t(n − p)`. The variance of the means over the nodes is added.
pub(super) fn over_surface(nodes: &[Node], reading: &Reading<'_>) -> Spread {
    let top = nodes.iter().map(|n| n.ln_weight).fold(f64::NEG_INFINITY, f64::max);
    let at = reading.to.at(reading.reference).0;
    let mut sum = 0.0;
    let (mut first, mut second) = ([0.0; 3], [0.0; 3]);
    let (mut precision, mut square) = ([0.0; 3], [0.0; 3]);
    let mut mean_covariance = Matrix::zeros(3, 3);
    for node in nodes {
        let w = (node.ln_weight - top).exp();
        // A node that weighs nothing costs nothing.
        if w < 1e-9 {
            continue;
        }
        let (values, c) = reading.of(&node.solution);
        sum += w;
        for i in 0..3 {
            let off = values[i] - at[i];
            first[i] += w * off;
            second[i] += w * off * off;
            precision[i] += w / c[(i, i)];
            square[i] += w / (c[(i, i)] * c[(i, i)]);
            for j in 0..3 {
                mean_covariance[(i, j)] += w * c[(i, j)];
            }
        }
    }
    let mut u = [0.0; 3];
    let mut dof = [0.0; 3];
    for i in 0..3 {
        let between = (second[i] / sum - (first[i] / sum).powi(2)).max(0.0);
        let mean = precision[i] / sum;
        u[i] = (1.0 / mean + between).sqrt();
        dof[i] = 2.0 / (square[i] / sum / (mean * mean) - 1.0).max(1e-9);
    }
    Spread {
        values: core::array::from_fn(|i| at[i] + first[i] / sum),
        covariance: with_deviations(&mean_covariance, u),
        dof,
        profile: None,
    }
}

/// A covariance with the correlations of one matrix and given standard deviations.
pub(super) fn with_deviations(c: &Matrix, u: [f64; 3]) -> Matrix {
    let mut out = Matrix::zeros(3, 3);
    for i in 0..3 {
        for j in 0..3 {
            let r = if i == j { 1.0 } else { c.correlation(i, j).unwrap_or(0.0) };
            out[(i, j)] = r * u[i] * u[j];
        }
    }
    out
}

/// Variances of scatter that give each dwell its mean precision over the surface.
pub(super) fn mean_scatter(
    nodes: &[Node],
    dwells: &[Dwell],
    components: impl Fn(&Node) -> (f64, f64),
) -> Vec<f64> {
    let top = nodes.iter().map(|n| n.ln_weight).fold(f64::NEG_INFINITY, f64::max);
    let mut precision = vec![0.0; dwells.len()];
    let mut sum = 0.0;
    for node in nodes {
        let w = (node.ln_weight - top).exp();
        let (level, angle) = components(node);
        sum += w;
        for (p, d) in precision.iter_mut().zip(dwells) {
            *p += w / own_variance(d, level + angle * d.steepness);
        }
    }
    precision
        .iter()
        .zip(dwells)
        .map(|(p, d)| (sum / p - own_variance(d, 0.0) + d.known_variance).max(d.known_variance))
        .collect()
}

/// Variance of a dwell about the model, for a given variance of scatter.
fn own_variance(d: &Dwell, scatter: f64) -> f64 {
    d.evidence.variance().min(1e6) + d.known_variance + scatter
}

/// Standard uncertainties and degrees of freedom as the residuals show them, whatever shape the scatter has.
///
/// **Model** for the weights of the solution, `u² = Σ g_j² r_j²/(1 − h_j)` with `g_j` the influence of dwell `j` on the
/// parameter and `h_j` its leverage; degrees of freedom by Satterthwaite for the scatter that the weights stand for.
/// Upright dwells enter with the model's variance: two residuals are no sample.
///
/// **Source** R. M. Bell, D. F. McCaffrey, Survey Methodology 28 (2002) 169–181.
///
/// `None` where codes, not scatter, make the dwells' uncertainty (then residuals are no sample either), or where fewer
/// than [`RESIDUALS_FROM_DOF`] degrees of freedom are left.
pub(super) fn from_residuals(
    dwells: &[Dwell],
    sites: &[Site],
    scatter: &[f64],
    solution: &Solution,
    reading: &Reading<'_>,
) -> Option<([f64; 3], [f64; 3])> {
    let dominated = dwells
        .iter()
        .zip(scatter)
        .filter(|(d, v)| {
            matches!(d.evidence, Evidence::Gaussian { .. }) || d.evidence.variance() < **v
        })
        .count();
    if 10 * dominated < 9 * dwells.len() {
        return None;
    }
    let gradients = reading.gradients(solution.shift);
    let mut u = [0.0; 3];
    let mut dof = [0.0; 3];
    for i in 0..3 {
        let direction = solution.covariance.times(gradients[i]);
        let (mut variance, mut expected, mut square) = (0.0, 0.0, 0.0);
        let mut outer = Symmetric3::default();
        for (d, site) in dwells.iter().zip(sites) {
            let v = site.precision.recip();
            let influence = dot3(direction, d.row) * site.precision;
            if d.steepness == 0.0 {
                variance += influence * influence * v;
                expected += influence * influence * v;
                continue;
            }
            let predicted = solution.covariance.quadratic(d.row);
            let leverage = (predicted * site.precision).min(0.999);
            let residual = site.pull * v - dot3(d.row, solution.shift);
            let weight = influence * influence / (1.0 - leverage);
            variance += weight * residual * residual;
            expected += weight * (v - predicted);
            square += weight * weight * (v * v - 2.0 * v * predicted);
            outer.add_outer(d.row, weight);
        }
        // Σ_jk w_j w_k (x_jᵀ C x_k)² = tr (C S C S) with S = Σ w x xᵀ.
        let cs: [[f64; 3]; 3] = core::array::from_fn(|a| {
            core::array::from_fn(|b| {
                (0..3).map(|k| solution.covariance.0[a][k] * outer.0[k][b]).sum()
            })
        });
        for a in 0..3 {
            for b in 0..3 {
                square += cs[a][b] * cs[b][a];
            }
        }
        u[i] = variance.sqrt();
        // What upright dwells add is taken as known, but never better than all residuals together could tell.
        dof[i] = (expected * expected / square).min(dwells.len() as f64 - 3.0);
        if !(dof[i] >= RESIDUALS_FROM_DOF && u[i] > 0.0) {
            return None;
        }
    }
    Some((u, dof))
}

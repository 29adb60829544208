//! Uncertainty of the parameters from the whole surface of the restricted likelihood.

use super::basis::Basis;
use super::evidence::Evidence;
use super::integrate::{Dwell, Site, Solution};
use super::scatter::Node;
use crate::estimate::paper::ToParameters;
use crate::linalg::{Matrix, Symmetric3, dot3};
use crate::stats::{normal_cdf, student_factor};

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
    /// Whether the residuals gave deviations and degrees of freedom.
    pub by_residuals: bool,
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
/// **Model** at each node the parameter is Gaussian; over the nodes it is a mixture. Student's distribution that has the
/// mixture's central 68 and 95 % stands for it. With one component of scatter that dominates this is exact: `t(n − p)`.
pub(super) fn over_surface(nodes: &[Node], reading: &Reading<'_>) -> Spread {
    let top = nodes.iter().map(|n| n.ln_weight).fold(f64::NEG_INFINITY, f64::max);
    let mut sum = 0.0;
    let mut mean = [0.0; 3];
    let mut mean_covariance = Matrix::zeros(3, 3);
    let at = reading.to.at(reading.reference).0;
    let mut parts: [Vec<Part>; 3] = Default::default();
    for node in nodes {
        let weight = (node.ln_weight - top).exp();
        // A node that weighs nothing costs nothing.
        if weight < 1e-9 {
            continue;
        }
        let (values, c) = reading.of(&node.solution);
        sum += weight;
        for i in 0..3 {
            let off = values[i] - at[i];
            mean[i] += weight * off;
            parts[i].push(Part { weight, off, sd: c[(i, i)].sqrt() });
            for j in 0..3 {
                mean_covariance[(i, j)] += weight * c[(i, j)];
            }
        }
    }
    let mut u = [0.0; 3];
    let mut dof = [0.0; 3];
    for i in 0..3 {
        mean[i] /= sum;
        parts[i].iter_mut().for_each(|p| p.off -= mean[i]);
        (u[i], dof[i]) = student_of(&parts[i], sum);
    }
    Spread {
        values: core::array::from_fn(|i| at[i] + mean[i]),
        covariance: with_deviations(&mean_covariance, u),
        dof,
        profile: None,
        by_residuals: false,
    }
}

/// One Gaussian of a mixture.
struct Part {
    weight: f64,
    off: f64,
    sd: f64,
}

/// Scale and degrees of freedom of the Student distribution that has the central 68 and 95 % of a mixture.
fn student_of(parts: &[Part], sum: f64) -> (f64, f64) {
    let inner = half_width(parts, sum, 0.68);
    let outer = half_width(parts, sum, 0.95);
    let dof = dof_of_ratio(outer / inner);
    let factor = student_factor(0.95, dof).unwrap_or(1.96);
    (outer / factor, dof)
}

/// Half the width of the central interval that holds a level of a mixture, by Newton steps held in a bracket.
fn half_width(parts: &[Part], sum: f64, level: f64) -> f64 {
    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut h = parts.iter().map(|p| p.weight * (p.sd + p.off.abs())).sum::<f64>() / sum;
    for _ in 0..100 {
        let (mut inside, mut density) = (0.0, 0.0);
        for p in parts {
            let (a, b) = ((h - p.off) / p.sd, (h + p.off) / p.sd);
            inside += p.weight * (normal_cdf(a) + normal_cdf(b) - 1.0);
            density += p.weight * ((-0.5 * a * a).exp() + (-0.5 * b * b).exp()) / p.sd;
        }
        let excess = inside / sum - level;
        if excess > 0.0 {
            high = h;
        } else {
            low = h;
        }
        let newton = h - excess * sum * (2.0 * core::f64::consts::PI).sqrt() / density;
        let next = match (newton > low && newton < high, high.is_finite()) {
            (true, _) => newton,
            (_, true) => 0.5 * (low + high),
            _ => 2.0 * h,
        };
        if (next - h).abs() < 1e-6 * h {
            return next;
        }
        h = next;
    }
    h
}

/// Degrees of freedom for a ratio of the two-sided 95 and 68 % factors: interpolated in `1/ν` (scipy's quantiles).
fn dof_of_ratio(ratio: f64) -> f64 {
    const NORMAL: f64 = 1.970886870;
    const TABLE: [(f64, f64); 20] = [
        (0.4, 103.9366748),
        (0.6, 22.5009997),
        (0.8, 10.7027655),
        (1.0, 6.9852952),
        (1.25, 5.0590468),
        (1.6, 3.8938011),
        (2.0, 3.2805149),
        (2.5, 2.8927811),
        (3.0, 2.6767345),
        (4.0, 2.4475082),
        (5.0, 2.3291254),
        (6.0, 2.2573494),
        (8.0, 2.1750160),
        (10.0, 2.1292916),
        (14.0, 2.0801902),
        (20.0, 2.0454561),
        (30.0, 2.0196209),
        (50.0, 1.9996681),
        (100.0, 1.9851084),
        (300.0, 1.9755903),
    ];
    if ratio <= TABLE[19].1 {
        // 300 and more: the excess over the normal ratio falls like 1/ν.
        let excess = (ratio - NORMAL) / (TABLE[19].1 - NORMAL);
        return (300.0 / excess.max(1e-6)).min(1e8);
    }
    if ratio >= TABLE[0].1 {
        return TABLE[0].0;
    }
    let k = TABLE.iter().position(|(_, r)| *r <= ratio).unwrap_or(19).max(1);
    let ((n0, r0), (n1, r1)) = (TABLE[k - 1], TABLE[k]);
    let share = (r0.ln() - ratio.ln()) / (r0.ln() - r1.ln());
    (1.0 / n0 + share * (1.0 / n1 - 1.0 / n0)).recip()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mixture_over_gamma_precisions_is_students() {
        for dof in [3.0, 9.0, 22.0, 57.0] {
            // 1/U = χ²(ν)/ν on a fine grid of ln U.
            let parts: Vec<Part> = (-400..400)
                .map(|k| {
                    let ln = f64::from(k) * 0.02;
                    let precision = (-ln).exp();
                    let weight = (0.5 * dof * (-ln) - 0.5 * dof * precision).exp();
                    Part { weight, off: 0.0, sd: (0.5 * ln).exp() }
                })
                .collect();
            let sum = parts.iter().map(|p| p.weight).sum();
            let (u, nu) = student_of(&parts, sum);
            assert!((nu / dof - 1.0).abs() < 0.01, "{dof}: {nu}");
            assert!((u - 1.0).abs() < 0.001, "{dof}: {u}");
        }
    }

    #[test]
    fn two_very_different_variances_make_a_heavy_tail() {
        let parts =
            [Part { weight: 0.5, off: 0.0, sd: 1.0 }, Part { weight: 0.5, off: 0.0, sd: 10.0 }];
        let (u, dof) = student_of(&parts, 1.0);
        let outer = u * student_factor(0.95, dof).unwrap();
        // Half of the tail beyond 16.4 belongs to the wide one: P(|z| > 1.645) = 10 %.
        assert!((outer - 16.4).abs() < 0.1, "{outer}");
        assert!(dof < 2.0, "{dof}");
    }
}

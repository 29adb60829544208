//! The parameters of one run when the scatter is given: mean, covariance and integral of their likelihood.

use super::evidence::Evidence;
use crate::linalg::{Symmetric3, dot3};

/// Sweeps over the dwells after which the answer must stand; three to six are usual.
const MAX_SWEEPS: usize = 80;
/// Sweeps after which steps are halved, so that they cannot swing for ever.
const DAMPED_FROM: usize = 12;
/// Largest shift of a dwell's modelled level, over its standard deviation, at which the sweeps
/// stop; the integral is then off by its square.
const CONVERGED: f64 = 5e-3;

/// One dwell of the adjustment.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dwell {
    /// Row of the design in an orthonormal basis: `m = origin + row · shift`.
    pub row: [f64; 3],
    /// Modelled level at the reference solution, LSB.
    pub origin: f64,
    /// `(∂m/∂φ)²`, LSB² per rad²; zero for upright dwells.
    pub steepness: f64,
    /// Variance that is known beforehand (lean of upright dwells, a stated angle uncertainty), LSB².
    pub known_variance: f64,
    /// What its readings say.
    pub evidence: Evidence,
}

/// A Gaussian that stands for a dwell: `exp(pull·x − ½ precision·x²)` with `x = m − origin`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Site {
    pub precision: f64,
    pub pull: f64,
}

/// The likelihood of the parameters, with a flat prior integrated over them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Solution {
    /// Mean, in the orthonormal basis.
    pub shift: [f64; 3],
    /// Covariance, in the same.
    pub covariance: Symmetric3,
    /// `ln ∫ L(θ) dθ`: the restricted likelihood of the scatter.
    pub ln_integral: f64,
    /// Whether they settled.
    pub settled: bool,
}

/// Integrates the likelihood over the parameters for given variances of scatter.
///
/// **Model** `∏_j ∫ L_j(μ) N(μ; m_j(θ), v_j) dμ`, `m_j` linear in `θ`. Where dwells are Gaussian the integral is
/// exact and its logarithm is the restricted likelihood (REML). Where they are boxes, each is replaced by the Gaussian
/// that has the same mean and variance in the company of the others (expectation propagation, T. Minka, 2001); all
/// factors are log-concave, which keeps every precision from turning negative.
///
/// `sites` holds the Gaussians and is a start for the next call.
pub(super) fn integrate(
    dwells: &[Dwell],
    variances: &[f64],
    sites: &mut [Site],
) -> Option<Solution> {
    let mut ln_gaussian = 0.0;
    let mut curves = false;
    for ((d, v), site) in dwells.iter().zip(variances).zip(sites.iter_mut()) {
        match &d.evidence {
            Evidence::Gaussian { .. } => {
                // At m = origin the marginal holds all that a Gaussian is.
                let at = d.evidence.marginal(d.origin, *v);
                *site = Site { precision: -at.curvature, pull: at.slope };
                ln_gaussian += at.value;
            }
            Evidence::Curve(_) => {
                curves = true;
                if site.precision <= 0.0 {
                    let precision = 1.0 / (d.evidence.variance() + v);
                    *site = Site { precision, pull: precision * (d.evidence.centre() - d.origin) };
                    if precision == 0.0 {
                        site.pull = 0.0;
                    }
                }
            }
        }
    }
    let mut sweeps = 0;
    let mut settled = !curves;
    let mut ln_curves = 0.0;
    while !settled && sweeps < MAX_SWEEPS {
        sweeps += 1;
        let step = if sweeps > DAMPED_FROM { 0.5 } else { 1.0 };
        let swept = sweep(dwells, variances, sites, step)?;
        settled = swept.moved < CONVERGED;
        ln_curves = swept.ln_constants;
    }
    let (covariance, pull, ln_det) = assemble(dwells, sites)?;
    let shift = covariance.times(pull);
    let ln_integral = ln_gaussian + ln_curves + 0.5 * dot3(pull, shift) - 0.5 * ln_det;
    ln_integral.is_finite().then_some(Solution { shift, covariance, ln_integral, settled })
}

/// A dwell in the company of all others: its marginal likelihood at what they say, and what they say.
pub(super) struct Company {
    /// Level relative to the origin, and its variance, LSB and LSB².
    pub at: f64,
    pub spread: f64,
}

/// What all other dwells say about each one's level.
pub(super) fn companies(dwells: &[Dwell], sites: &[Site], solution: &Solution) -> Vec<Company> {
    dwells
        .iter()
        .zip(sites)
        .map(|(d, site)| {
            let (at, spread) = cavity(d, site, &solution.covariance, solution.shift);
            Company { at, spread }
        })
        .collect()
}

/// Covariance, sum of pulls and log-determinant of the precision.
fn assemble(dwells: &[Dwell], sites: &[Site]) -> Option<(Symmetric3, [f64; 3], f64)> {
    let mut precision = Symmetric3::default();
    let mut pull = [0.0; 3];
    for (d, site) in dwells.iter().zip(sites) {
        precision.add_outer(d.row, site.precision);
        (0..3).for_each(|i| pull[i] += site.pull * d.row[i]);
    }
    let (covariance, ln_det) = precision.inverse()?;
    Some((covariance, pull, ln_det))
}

/// Mean and variance of a dwell's modelled level (about its origin) from all the others.
fn cavity(d: &Dwell, site: &Site, covariance: &Symmetric3, shift: [f64; 3]) -> (f64, f64) {
    let spread = covariance.quadratic(d.row).max(f64::MIN_POSITIVE);
    let at = dot3(d.row, shift);
    // A dwell that alone determines a direction leaves nothing to the others.
    let rest = (1.0 - site.precision * spread).max(1e-9);
    ((at - site.pull * spread) / rest, spread / rest)
}

/// What one sweep did.
struct Swept {
    /// Largest shift of a dwell's level over its standard deviation.
    moved: f64,
    /// Sum of the logarithms of what the Gaussians must be multiplied with.
    ln_constants: f64,
}

/// Renews the Gaussians of all curved dwells, one after the other.
fn sweep(dwells: &[Dwell], variances: &[f64], sites: &mut [Site], step: f64) -> Option<Swept> {
    let (mut covariance, pull, _) = assemble(dwells, sites)?;
    let mut shift = covariance.times(pull);
    let mut out = Swept { moved: 0.0, ln_constants: 0.0 };
    for ((d, v), site) in dwells.iter().zip(variances).zip(sites.iter_mut()) {
        if matches!(d.evidence, Evidence::Gaussian { .. }) {
            continue;
        }
        let old = *site;
        let (at, spread) = cavity(d, &old, &covariance, shift);
        let m = d.evidence.marginal(d.origin + at, v + spread);
        let rest = (1.0 + spread * m.curvature).max(1e-9);
        let precision = (-m.curvature / rest).max(0.0);
        let pull = (m.slope - at * m.curvature) / rest;
        let new = Site {
            precision: old.precision + step * (precision - old.precision),
            pull: old.pull + step * (pull - old.pull),
        };
        if !(new.precision.is_finite() && new.pull.is_finite()) {
            continue;
        }
        let stiff = 1.0 + new.precision * spread;
        let of_site = (new.pull * at + 0.5 * new.pull * new.pull * spread
            - 0.5 * new.precision * at * at)
            / stiff;
        out.ln_constants += m.value + 0.5 * stiff.ln() - of_site;
        // Rank-one renewal of covariance and mean (Sherman and Morrison).
        let along = covariance.times(d.row);
        let own = dot3(d.row, along);
        let stiffer = new.precision - old.precision;
        let factor = 1.0 + stiffer * own;
        if factor <= 1e-12 {
            continue;
        }
        let gain = (new.pull - old.pull - stiffer * dot3(d.row, shift)) / factor;
        covariance.add_outer(along, -stiffer / factor);
        (0..3).for_each(|i| shift[i] += gain * along[i]);
        *site = new;
        out.moved = out.moved.max(gain.abs() * own.sqrt()).max(stiffer.abs() * own * 0.3);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::super::cells::Cells;
    use super::*;
    use crate::{Code, CodeHistogram, ConverterEnds, Quantizer};

    /// Six quiet dwells: boxes and half-boxes, as a plan in an orthonormal basis would show them.
    fn quiet_dwells(sigma: f64) -> Vec<Dwell> {
        let lists: [&[(i32, u64)]; 6] = [
            &[(4, 200)],
            &[(2, 150), (3, 50)],
            &[(1, 200)],
            &[(1, 195), (2, 5)],
            &[(2, 200)],
            &[(5, 200)],
        ];
        let (a, b, c) = (6f64.sqrt(), 17.5f64.sqrt(), (448.0f64 / 12.0).sqrt());
        lists
            .iter()
            .enumerate()
            .map(|(i, list)| {
                let mut h = CodeHistogram::default();
                list.iter().for_each(|(n, k)| h.record_many(Code(*n), *k));
                let x = i as f64 - 2.5;
                let cells = Cells::of(&h, Quantizer::Floor, &ConverterEnds::default());
                Dwell {
                    row: [1.0 / a, x / b, (x * x - 35.0 / 12.0) / c],
                    origin: 2.9,
                    steepness: 1.0,
                    known_variance: 0.0,
                    evidence: Evidence::of(&cells, sigma, 1.0),
                }
            })
            .collect()
    }

    /// Brute force: mean, covariance and integral by a sum over a grid.
    fn by_summing(dwells: &[Dwell], v: f64, about: &Solution) -> ([f64; 3], [f64; 3], f64) {
        let n = 44i32;
        let sd: [f64; 3] = core::array::from_fn(|i| about.covariance.0[i][i].sqrt());
        let step = 5.5 / f64::from(n / 2);
        let (mut sum, mut first, mut second) = (0.0, [0.0; 3], [0.0; 3]);
        for index in 0..n * n * n {
            let at = [index % n, index / n % n, index / (n * n)];
            let s: [f64; 3] = core::array::from_fn(|i| {
                about.shift[i] + sd[i] * step * (f64::from(at[i]) - 0.5 * f64::from(n - 1))
            });
            let value: f64 = dwells
                .iter()
                .map(|d| d.evidence.marginal(d.origin + dot3(d.row, s), v).value)
                .sum();
            let w = (value - about.ln_integral).exp();
            sum += w;
            for i in 0..3 {
                first[i] += w * s[i];
                second[i] += w * s[i] * s[i];
            }
        }
        let mean: [f64; 3] = core::array::from_fn(|i| first[i] / sum);
        let deviation = core::array::from_fn(|i| (second[i] / sum - mean[i] * mean[i]).sqrt());
        let volume: f64 = sd.iter().map(|x| x * step).product();
        // The solution leaves out (2π)^{3/2}, the same for every scatter.
        let ln = about.ln_integral + (sum * volume).ln() - 1.5 * (2.0 * core::f64::consts::PI).ln();
        (mean, deviation, ln)
    }

    #[test]
    fn boxes_are_integrated_as_a_fine_sum_does_it() {
        let dwells = quiet_dwells(0.08);
        for tau in [0.05f64, 0.2, 1.0] {
            let v = tau * tau;
            let mut sites = vec![Site::default(); dwells.len()];
            let ours = integrate(&dwells, &vec![v; dwells.len()], &mut sites).unwrap();
            assert!(ours.settled);
            let (mean, deviation, ln) = by_summing(&dwells, v, &ours);
            for i in 0..3 {
                let sd = ours.covariance.0[i][i].sqrt();
                let off = (mean[i] - ours.shift[i]) / sd;
                let ratio = deviation[i] / sd;
                assert!(off.abs() < 0.05, "τ {tau}, {i}: mean off by {off:.3} standard deviations");
                assert!((ratio - 1.0).abs() < 0.05, "τ {tau}, {i}: standard deviation {ratio:.3}");
            }
            assert!((ln - ours.ln_integral).abs() < 0.05, "τ {tau}: {ln} {}", ours.ln_integral);
        }
    }

    #[test]
    fn gaussian_dwells_are_weighted_least_squares_and_reml() {
        let dwells: Vec<Dwell> = quiet_dwells(0.08)
            .into_iter()
            .enumerate()
            .map(|(i, d)| Dwell {
                evidence: Evidence::Gaussian {
                    centre: 2.9 + [0.3, -0.2, 0.1, 0.4, -0.1, 0.2][i],
                    variance: 0.01,
                    ln_integral: 0.0,
                },
                ..d
            })
            .collect();
        let v = 0.03;
        let mut sites = vec![Site::default(); 6];
        let ours = integrate(&dwells, &[v; 6], &mut sites).unwrap();
        // Orthonormal rows and equal variances: projections, and (n − p)/2 logarithms of the variance.
        let y = [0.3, -0.2, 0.1, 0.4, -0.1, 0.2];
        let rest: f64 = (0..3).fold(y.iter().map(|x| x * x).sum(), |rest, i| {
            let projection: f64 = dwells.iter().zip(y).map(|(d, y)| d.row[i] * y).sum();
            assert!((ours.shift[i] - projection).abs() < 1e-12);
            rest - projection * projection
        });
        let reml = -0.5 * 3.0 * (2.0 * core::f64::consts::PI * 0.04f64).ln()
            - 0.5 * rest / 0.04
            - 1.5 * (2.0 * core::f64::consts::PI).ln();
        assert!((ours.ln_integral - reml).abs() < 1e-9, "{} {reml}", ours.ln_integral);
        assert!((ours.covariance.0[0][0] - 0.04).abs() < 1e-12);
    }
}

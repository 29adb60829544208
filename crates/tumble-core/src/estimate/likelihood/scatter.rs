//! Scatter between dwells: restricted likelihood of its two components, and the parameters averaged over it.
//!
//! **Model** `v_j = τ0² + τφ² (∂m/∂φ)² + known_j`, written as a total `V` and the angle's share `w`:
//! `τ0² = V (1 − w)`, `τφ² = V w / mean (∂m/∂φ)²`.
//!
//! Past 500 lines with its tests: 415 without.

use super::integrate::{Dwell, Site, Solution, companies, integrate};
use super::search::crossing;

/// What may scatter between dwells, with the probabilities that are given to it beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Components {
    /// `τ0` and `τφ`, both from the data.
    Both(Beforehand),
    /// `τ0` alone.
    Level,
}

/// Probability of each kind of scatter before anything was measured; they add up to one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beforehand {
    /// Only angles scatter.
    pub angle: f64,
    /// Both.
    pub both: f64,
    /// Only levels do.
    pub level: f64,
}

impl Beforehand {
    /// Nobody said anything.
    pub const OPEN: Self = Self { angle: 1.0 / 3.0, both: 1.0 / 3.0, level: 1.0 / 3.0 };
    /// The experiment states an angle uncertainty: somebody has reason to expect it. Sixteen to one is outvoted by a
    /// likelihood ratio of a few, which sixty positions over the table's range give.
    pub const STATED: Self = Self { angle: 0.8, both: 0.15, level: 0.05 };
}

/// The surface, explored.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Exploration {
    /// Nodes of the integration.
    pub nodes: Vec<Node>,
    /// Its ridges' summits in the order of the share.
    pub summits: Vec<Summit>,
}

impl Exploration {
    /// Weights of groups of nodes that end at given numbers, but for a common factor.
    pub fn weights_of(&self, ends: &[usize]) -> Vec<f64> {
        let top = self.nodes.iter().map(|n| n.ln_weight).fold(f64::NEG_INFINITY, f64::max);
        let mut from = 0;
        let group = |to: &usize| {
            let sum = self.nodes[from..*to].iter().map(|n| (n.ln_weight - top).exp()).sum();
            from = *to;
            sum
        };
        ends.iter().map(group).collect()
    }
}

/// The best total for one share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Summit {
    /// `w`.
    pub share: f64,
    /// `V`, LSB².
    pub total: f64,
    /// Restricted log-likelihood.
    pub ln_integral: f64,
}

/// One point of the restricted likelihood's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    /// `V`, LSB².
    pub total: f64,
    /// `w`.
    pub share: f64,
    /// Logarithm of its weight in averages.
    pub ln_weight: f64,
    /// The parameters there.
    pub solution: Solution,
}

/// The restricted likelihood of the scatter, with the means to compute it.
pub(super) struct Surface<'a> {
    dwells: &'a [Dwell],
    mean_steepness: f64,
    /// Size of `V` below which it does not matter.
    pub floor: f64,
    variances: Vec<f64>,
    sites: Vec<Site>,
}

impl<'a> Surface<'a> {
    pub fn new(dwells: &'a [Dwell]) -> Self {
        let steep: Vec<f64> = dwells.iter().map(|d| d.steepness).filter(|s| *s > 0.0).collect();
        let precision: f64 = dwells
            .iter()
            .map(|d| (d.evidence.resolution(dwells.len()) + d.known_variance).recip().powi(2))
            .filter(|p| p.is_finite())
            .sum();
        let floor = (dwells.len() as f64 / precision).sqrt();
        Self {
            dwells,
            mean_steepness: crate::stats::mean(&steep).unwrap_or(1.0),
            floor: if floor.is_finite() && floor > 0.0 { floor } else { 1e-12 },
            variances: vec![0.0; dwells.len()],
            sites: vec![Site::default(); dwells.len()],
        }
    }

    /// `τ0²` and `τφ²`, LSB² and rad².
    pub fn components(&self, total: f64, share: f64) -> (f64, f64) {
        (total * (1.0 - share), total * share / self.mean_steepness)
    }

    /// Restricted log-likelihood of angles that scatter by a given standard deviation (rad), and nothing else.
    pub fn of_angles(&mut self, angle_rad: f64) -> Option<f64> {
        self.at(angle_rad * angle_rad * self.mean_steepness, 1.0).map(|s| s.ln_integral)
    }

    /// Solution at a point.
    pub fn at(&mut self, total: f64, share: f64) -> Option<Solution> {
        for (v, d) in self.variances.iter_mut().zip(self.dwells) {
            *v = d.known_variance
                + total * ((1.0 - share) + share * d.steepness / self.mean_steepness);
        }
        let out = integrate(self.dwells, &self.variances, &mut self.sites);
        if out.is_none_or(|s| !s.settled) {
            // A start from the last point may be a bad one.
            self.sites.fill(Site::default());
        }
        out
    }

    /// `V` of a coordinate `x = ln(V + floor)`.
    pub fn total(&self, x: f64) -> f64 {
        (x.exp() - self.floor).max(0.0)
    }

    /// Variances of scatter at the last point.
    pub fn variances(&self) -> &[f64] {
        &self.variances
    }

    /// Gaussians of the dwells at the last point.
    pub fn sites(&self) -> &[Site] {
        &self.sites
    }

    /// Coordinate of the `V` that the restricted likelihood likes best for a share, near a start.
    ///
    /// The derivative costs no second solution: `∂L/∂v = ½ (ℓ″ + ℓ′²)` of each dwell in the company of the others (the
    /// heat equation).
    pub fn best_total(&mut self, share: f64, start: Option<f64>) -> Option<f64> {
        let low = self.floor.ln();
        let start = match start {
            Some(x) => x.max(low),
            None => self.scan(share)?,
        };
        Some(crossing(start, 0.4, (low, low + 60.0), WORTH, |x| self.slope(x, share))?.0)
    }

    /// Derivative of the restricted log-likelihood by `x = ln(V + floor)`.
    fn slope(&mut self, x: f64, share: f64) -> Option<f64> {
        let solution = self.at(self.total(x), share)?;
        let around = companies(self.dwells, &self.sites, &solution);
        let by_total = |d: &Dwell| (1.0 - share) + share * d.steepness / self.mean_steepness;
        let slope: f64 = around
            .iter()
            .zip(self.dwells)
            .zip(&self.variances)
            .map(|((c, d), v)| {
                let m = d.evidence.marginal(d.origin + c.at, v + c.spread);
                0.5 * by_total(d) * (m.curvature + m.slope * m.slope)
            })
            .sum();
        Some(slope * x.exp())
    }

    /// Logarithm of the density of the prior of `V`, for `x = ln(V + floor)`: Jeffreys',
    /// `p(V) ∝ √Σ (∂v_j/∂V)² / (d_j + v_j)²`. Flat in `ln V` where the scatter dominates (which makes Student's
    /// intervals exact for one component), flat in `V` where it drowns.
    fn ln_prior(&self, total: f64, share: f64) -> f64 {
        let information: f64 = self
            .dwells
            .iter()
            .map(|d| {
                let by_total = (1.0 - share) + share * d.steepness / self.mean_steepness;
                let own = d.evidence.resolution(self.dwells.len());
                let all = own + d.known_variance + total * by_total;
                (by_total / all).powi(2)
            })
            .filter(|i| i.is_finite())
            .sum();
        0.5 * information.ln() + (total + self.floor).ln()
    }

    fn ln_density(&mut self, x: f64, share: f64) -> Option<(f64, Solution)> {
        let total = self.total(x);
        let solution = self.at(total, share)?;
        Some((solution.ln_integral + self.ln_prior(total, share), solution))
    }

    /// Maximum of a function of `x` by steps uphill and parabolas, from a start.
    fn climb(&mut self, start: f64, share: f64, step: f64) -> Option<(f64, f64)> {
        let low = self.floor.ln();
        let f = |s: &mut Self, x: f64| s.ln_density(x, share).map(|d| d.0);
        let (mut x, mut step) = (start.max(low), step);
        let mut here = f(self, x)?;
        for _ in 0..60 {
            let (left_x, right_x) = ((x - step).max(low), x + step);
            let right = f(self, right_x)?;
            if right > here {
                (x, here) = (right_x, right);
                step *= 1.6;
                continue;
            }
            let left = if left_x < x { f(self, left_x)? } else { f64::NEG_INFINITY };
            if left > here {
                (x, here) = (left_x, left);
                step *= 1.6;
                continue;
            }
            if left.is_finite() {
                // Bracketed: one parabola, then finer.
                let (a, b) = (x - left_x, right_x - x);
                let (fa, fb) = (here - left, here - right);
                let denominator = fa * b + fb * a;
                let to = if denominator > 0.0 {
                    0.5 * (fa * b * b - fb * a * a) / denominator
                } else {
                    0.0
                };
                let next = x - to;
                if next > low && to.abs() > 1e-3 {
                    let value = f(self, next)?;
                    if value > here {
                        (x, here) = (next, value);
                    }
                }
                if fa.max(fb) < 0.05 || step < 0.05 {
                    return Some((x, here));
                }
            } else if step < 0.05 {
                return Some((x, here));
            }
            step *= 0.3;
        }
        Some((x, here))
    }

    /// The surface along `x` for one share: nodes and weights of an integration over all of it that matters.
    fn ridge(
        &mut self,
        share: f64,
        prior: f64,
        start: f64,
        points: usize,
        out: &mut Exploration,
    ) -> Option<f64> {
        let low = self.floor.ln();
        let (peak, top) = self.climb(start, share, 0.5)?;
        let summit = self.summit(share, peak)?;
        out.summits.push(summit);
        let edge = |s: &mut Self, side: f64| -> Option<f64> {
            let (mut step, mut x) = (0.25, peak);
            loop {
                let next = peak + side * step;
                if next <= low {
                    return Some(low);
                }
                x = if step > 60.0 { return Some(x) } else { next };
                if s.ln_density(x, share)?.0 < top - DEPTH {
                    return Some(x);
                }
                step *= 1.5;
            }
        };
        let (from, to) = (edge(self, -1.0)?, edge(self, 1.0)?);
        for (u, weight) in gauss_legendre(points) {
            let x = from + (to - from) * 0.5 * (1.0 + u);
            let (density, solution) = self.ln_density(x, share)?;
            // What did not settle has no say.
            if !solution.settled {
                continue;
            }
            out.nodes.push(Node {
                total: self.total(x),
                share,
                ln_weight: density + (0.5 * weight * (to - from) * prior).ln(),
                solution,
            });
        }
        Some(peak)
    }

    fn summit(&mut self, share: f64, x: f64) -> Option<Summit> {
        let total = self.total(x);
        Some(Summit { share, total, ln_integral: self.at(total, share)?.ln_integral })
    }

    /// Nodes over the whole surface.
    ///
    /// Where both scatter, the share has the arcsine prior (Jeffreys' for a share).
    pub fn explore(
        &mut self,
        components: Components,
        shares: usize,
        points: usize,
        start: Option<f64>,
    ) -> Option<Exploration> {
        let start_at = |s: &mut Self, share: f64| match start {
            Some(x) => Some(x.max(s.floor.ln())),
            None => s.scan(share),
        };
        let mut out = Exploration { nodes: Vec::new(), summits: Vec::new() };
        match components {
            Components::Level => {
                let start = start_at(self, 0.0)?;
                self.ridge(0.0, 1.0, start, points, &mut out)?;
            }
            Components::Both(beforehand) => {
                let start = start_at(self, 0.5)?;
                let mut at = self.ridge(0.0, beforehand.level, start, points, &mut out)?;
                for k in 0..shares {
                    let turn = core::f64::consts::PI * (k as f64 + 0.5) / shares as f64;
                    let share = 0.5 * (1.0 - turn.cos());
                    at =
                        self.ridge(share, beforehand.both / shares as f64, at, points, &mut out)?;
                }
                self.ridge(1.0, beforehand.angle, at, points, &mut out)?;
            }
        }
        Some(out)
    }

    /// The highest summit, the share refined between its neighbours by golden sections.
    pub fn highest(&mut self, summits: &[Summit]) -> Option<Summit> {
        let best = (0..summits.len())
            .max_by(|a, b| summits[*a].ln_integral.total_cmp(&summits[*b].ln_integral))?;
        let mut top = summits[best];
        if best == 0 || best + 1 == summits.len() {
            return Some(top);
        }
        let (mut low, mut high) = (summits[best - 1].share, summits[best + 1].share);
        for _ in 0..6 {
            let wider = if high - top.share > top.share - low { high } else { low };
            let share = top.share + 0.382 * (wider - top.share);
            let x = self.climb((top.total + self.floor).ln(), share, 0.2)?.0;
            let next = self.summit(share, x)?;
            if next.ln_integral > top.ln_integral {
                if share > top.share {
                    low = top.share
                } else {
                    high = top.share
                }
                top = next;
            } else if share > top.share {
                high = share;
            } else {
                low = share;
            }
        }
        Some(top)
    }

    /// Coarse look at the whole range of `V`, so that no second summit is missed.
    fn scan(&mut self, share: f64) -> Option<f64> {
        let low = self.floor.ln();
        let mut best = (low, f64::NEG_INFINITY);
        let mut falling = 0;
        for k in 0..40 {
            let x = low + 0.9 * f64::from(k);
            let value = self.ln_density(x, share)?.0;
            if value > best.1 {
                best = (x, value);
                falling = 0;
            } else {
                falling += 1;
            }
            if falling >= 6 && value < best.1 - 5.0 {
                break;
            }
        }
        Some(best.0)
    }
}

/// Log-likelihood that the last step of a search for `V` may still be worth.
const WORTH: f64 = 0.03;

/// Depth below the summit, in log-likelihood, to which the surface is integrated: what is lower weighs 1e-6.
const DEPTH: f64 = 14.0;

/// Nodes and weights of Gauss and Legendre on −1 … 1, by Newton's method on the polynomial.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (core::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut derivative = 1.0;
            for _ in 0..8 {
                let (mut p0, mut p1) = (1.0, x);
                for k in 2..=n {
                    let k = k as f64;
                    (p0, p1) = (p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k);
                }
                derivative = n as f64 * (x * p1 - p0) / (x * x - 1.0);
                x -= p1 / derivative;
            }
            (x, 2.0 / ((1.0 - x * x) * derivative * derivative))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::cells::Cells;
    use super::super::evidence::Evidence;
    use super::*;
    use crate::{Code, CodeHistogram, ConverterEnds, Quantizer};

    fn dwells(quiet: bool) -> Vec<Dwell> {
        let n = 20;
        let a = f64::from(n).sqrt();
        let b = (0..n).map(|i| (f64::from(i) - 9.5).powi(2)).sum::<f64>().sqrt();
        (0..n)
            .map(|i| {
                let x = f64::from(i) - 9.5;
                let level = 3.0 + 0.37 * x + 0.3 * (2.3 * x).sin();
                let evidence = if quiet {
                    let mut h = CodeHistogram::default();
                    let code = level.floor();
                    h.record_many(Code(code as i32), 90 + i as u64 % 3);
                    h.record_many(Code(code as i32 + 1), if i % 3 == 0 { 7 } else { 0 });
                    let cells = Cells::of(&h, Quantizer::Floor, &ConverterEnds::default());
                    Evidence::of(&cells, 0.1, 1.0)
                } else {
                    Evidence::Gaussian { centre: level, variance: 0.002, ln_integral: 0.0 }
                };
                // The third direction is left to a weak column: a bend.
                let bend = (x * x - 33.25) / 190.0;
                Dwell {
                    row: [1.0 / a, x / b, bend],
                    origin: 3.0 + 0.37 * x,
                    steepness: 1.0 + 0.1 * x * x,
                    known_variance: 0.0,
                    evidence,
                }
            })
            .collect()
    }

    #[test]
    fn the_slope_by_the_scatter_is_that_of_the_restricted_likelihood() {
        for (quiet, h, tolerance) in [(false, 1e-3, 1e-5), (true, 0.05, 0.05)] {
            let dwells = dwells(quiet);
            let mut surface = Surface::new(&dwells);
            for total in [0.01f64, 0.05, 0.3] {
                for share in [0.0, 0.4, 1.0] {
                    let x = (total + surface.floor).ln();
                    let mut at = |x: f64| {
                        let v = surface.total(x);
                        surface.at(v, share).unwrap().ln_integral
                    };
                    let numeric = (at(x + h) - at(x - h)) / (2.0 * h);
                    let analytic = surface.slope(x, share).unwrap();
                    let off = (numeric - analytic).abs();
                    assert!(
                        off < tolerance * (1.0 + analytic.abs()) + 1e-3,
                        "{quiet} {total} {share}: {numeric} {analytic}"
                    );
                }
            }
        }
    }

    #[test]
    fn one_component_that_dominates_gives_students_distribution() {
        // Over ln V the restricted likelihood times the prior is that of χ²: E[1/V] = (n − p)/RSS.
        let mut dwells = dwells(false);
        for d in &mut dwells {
            if let Evidence::Gaussian { variance, .. } = &mut d.evidence {
                *variance = 1e-9;
            }
        }
        let mut surface = Surface::new(&dwells);
        let nodes = surface.explore(Components::Level, 1, 24, None).unwrap().nodes;
        let top = nodes.iter().map(|n| n.ln_weight).fold(f64::NEG_INFINITY, f64::max);
        let weight = |n: &Node| (n.ln_weight - top).exp();
        let sum: f64 = nodes.iter().map(weight).sum();
        let mean: f64 = nodes.iter().map(|n| weight(n) / n.total).sum::<f64>() / sum;
        let square: f64 = nodes.iter().map(|n| weight(n) / n.total.powi(2)).sum::<f64>() / sum;
        let dof = 2.0 / (square / (mean * mean) - 1.0);
        assert!((dof - 17.0).abs() < 0.01, "{dof}");
    }

    #[test]
    fn gauss_and_legendre_integrate_polynomials() {
        for n in [9, 16] {
            let sum = |power: i32| -> f64 {
                gauss_legendre(n).iter().map(|(x, w)| w * x.powi(power)).sum()
            };
            assert!((sum(0) - 2.0).abs() < 1e-13);
            assert!((sum(16) - 2.0 / 17.0).abs() < 1e-13);
        }
    }
}

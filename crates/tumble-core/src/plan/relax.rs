//! The best shares of positions, whole numbers or not, and what no plan can beat.
//!
//! **Model** `M(w) = M₀ + Σ w_j x_j x_jᵀ`, `Σ w_j = N`, `w ≥ 0`, with `M₀` the spares and upright dwells that stay. A- and
//! minimax criterion: `ψ_λ(w) = Σ λ_i (M⁻¹)_ii`, with `λ` fixed for A, and for minimax the largest over all `λ ≥ 0`, `Σ λ = 1`
//! (rows are in units of targets, so that `(M⁻¹)_ii` is the square of uncertainty over target). ψ is convex in w, so for all `w'`
//!
//! `ψ_λ(w') ≥ ψ_λ(w) − (N max_j d_j − Σ w_j d_j)`,  `d_j = x_jᵀ M⁻¹ Λ M⁻¹ x_j`:
//!
//! the equivalence theorem with what is fixed in it. It bounds every plan of N positions from below, whole numbers included;
//! for minimax at any `λ`, since the largest is not below any weighted mean. For D `−ln det M` stands for ψ and `x_jᵀ M⁻¹ x_j`
//! for d.
//!
//! **Source** Fedorov, Hackl, Model-Oriented Design of Experiments (1997), sections 2.4 and 2.7 (equivalence theorems, fixed
//! part); Silvey, Titterington, Torsney 1978 (multiplicative algorithm).

use core::ops::Range;

use super::information::{Information, MOST, Row, dot, times};
use super::problem::Criterion;

/// Iterations; each costs some microseconds.
const ITERATIONS: usize = 4000;
/// Relative distance of value and bound (variances) at which it is good: 0.03 % of an uncertainty.
pub(super) const TOLERANCE: f64 = 6e-4;
/// How fast the weights of the criterion follow the uncertainties: fast enough to arrive, slow enough not to swing.
const FOLLOW: f64 = 0.3;
/// Bounds are looked at now and then.
const LOOK: usize = 20;

/// A criterion with what it is about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Goal {
    pub criterion: Criterion,
    /// Whether a term is wanted.
    pub wanted: [bool; MOST],
}

impl Goal {
    /// Value of a plan, the smaller the better: like a variance. `None` where it tells terms not apart.
    pub fn value(&self, information: &Information) -> Option<f64> {
        let (c, log_determinant) = information.inverse()?;
        let p = information.columns;
        let wanted = || (0..p).filter(|i| self.wanted[*i]).map(|i| c[i][i]);
        Some(match self.criterion {
            Criterion::Minimax => wanted().fold(0.0, f64::max),
            Criterion::A => wanted().sum::<f64>() / wanted().count().max(1) as f64,
            Criterion::D => (-log_determinant / p as f64).exp(),
        })
    }

    fn start(&self) -> [f64; MOST] {
        let n = self.wanted.iter().filter(|w| **w).count().max(1) as f64;
        self.wanted.map(|w| if w { 1.0 / n } else { 0.0 })
    }
}

/// The best shares, and the bound.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Relaxed {
    /// `w_j`, their sum is the number of positions.
    pub weights: Vec<f64>,
    /// Value of the criterion that no plan of that many positions on these sites is below.
    pub bound: f64,
    /// `λ` of the best bound.
    pub multipliers: [f64; MOST],
}

/// Candidates that follow one another, with the number of positions that fall on them together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Group {
    pub candidates: Range<usize>,
    pub total: f64,
}

/// Shares of `total` positions over candidates beside what is fixed, to a relative distance from the bound (variances).
pub(super) fn relax(
    rows: &[Row],
    fixed: &Information,
    total: f64,
    goal: &Goal,
    tolerance: f64,
) -> Option<Relaxed> {
    relax_groups(rows, fixed, &[Group { candidates: 0..rows.len(), total }], goal, tolerance)
}

/// The same where the numbers of positions in groups of candidates are given.
pub(super) fn relax_groups(
    rows: &[Row],
    fixed: &Information,
    groups: &[Group],
    goal: &Goal,
    tolerance: f64,
) -> Option<Relaxed> {
    let mut w = vec![0.0; rows.len()];
    for g in groups {
        w[g.candidates.clone()].fill(g.total / g.candidates.len().max(1) as f64);
    }
    let mut lambda = goal.start();
    let mut best = Relaxed { weights: w.clone(), bound: 0.0, multipliers: lambda };
    let mut best_value = f64::INFINITY;
    let mut d = vec![0.0; rows.len()];
    for iteration in 0..ITERATIONS {
        let m = information(rows, &w, fixed);
        gradient(rows, &m, goal, &lambda, &mut d)?;
        if iteration % LOOK == 0 {
            let value = goal.value(&m)?;
            let bound = lower(&m, goal, &lambda, most(groups, &d) - mean_gradient(&d, &w))?;
            if bound > best.bound {
                (best.bound, best.multipliers) = (bound, lambda);
            }
            if value < best_value {
                best_value = value;
                best.weights.clone_from(&w);
            }
            if best.bound >= best_value * (1.0 - tolerance) {
                break;
            }
        }
        for (w, d) in w.iter_mut().zip(&d) {
            *w *= if goal.criterion == Criterion::D { *d } else { d.sqrt() };
        }
        for g in groups {
            let own = &mut w[g.candidates.clone()];
            let sum: f64 = own.iter().sum();
            own.iter_mut().for_each(|w| *w *= if sum > 0.0 { g.total / sum } else { 0.0 });
        }
        if goal.criterion == Criterion::Minimax {
            let (c, _) = m.inverse()?;
            let mut sum = 0.0;
            for i in 0..m.columns {
                // A weight at zero must be able to come back.
                lambda[i] =
                    if goal.wanted[i] { lambda[i].max(1e-9) * c[i][i].powf(FOLLOW) } else { 0.0 };
                sum += lambda[i];
            }
            lambda.iter_mut().for_each(|l| *l /= sum);
        }
    }
    Some(best)
}

/// What ψ is at least for numbers of positions in groups of candidates: a tangent at some shares.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tangent {
    goal: Goal,
    multipliers: [f64; MOST],
    at: Information,
    /// `Σ w d` there.
    mean: f64,
    /// Largest `d` of each group.
    largest: Vec<f64>,
}

impl Tangent {
    /// At the best shares over `chosen`, for all other candidates (all steps of the dial), in groups.
    pub fn of(
        all: &[Row],
        groups: &[Range<usize>],
        chosen: &[Row],
        relaxed: &Relaxed,
        fixed: &Information,
        goal: &Goal,
    ) -> Option<Self> {
        let at = information(chosen, &relaxed.weights, fixed);
        let mut d_all = vec![0.0; all.len()];
        let mut d = vec![0.0; chosen.len()];
        gradient(all, &at, goal, &relaxed.multipliers, &mut d_all)?;
        gradient(chosen, &at, goal, &relaxed.multipliers, &mut d)?;
        let largest = groups
            .iter()
            .map(|g| d_all[g.clone()].iter().fold(0.0, |a: f64, b| a.max(*b)))
            .collect();
        let mean = mean_gradient(&d, &relaxed.weights);
        Some(Self { goal: *goal, multipliers: relaxed.multipliers, at, mean, largest })
    }

    /// What no plan with these numbers of positions in the groups is below.
    pub fn bound(&self, totals: &[f64]) -> Option<f64> {
        let most: f64 = totals.iter().zip(&self.largest).map(|(n, d)| n * d).sum();
        lower(&self.at, &self.goal, &self.multipliers, most - self.mean)
    }
}

/// `Σ_g n_g max_{j in g} d_j`: the most that any shares gain to first order.
fn most(groups: &[Group], d: &[f64]) -> f64 {
    let largest = |g: &Group| d[g.candidates.clone()].iter().fold(0.0, |a: f64, b| a.max(*b));
    groups.iter().map(|g| g.total * largest(g)).sum()
}

fn information(rows: &[Row], w: &[f64], fixed: &Information) -> Information {
    let mut m = *fixed;
    rows.iter().zip(w).filter(|(_, w)| **w > 0.0).for_each(|(r, w)| m.add(r, *w));
    m
}

/// `d_j`.
fn gradient(
    rows: &[Row],
    m: &Information,
    goal: &Goal,
    lambda: &[f64; MOST],
    out: &mut [f64],
) -> Option<()> {
    let (c, _) = m.inverse()?;
    let p = m.columns;
    for (row, out) in rows.iter().zip(out) {
        let y = times(&c, row, p);
        *out = match goal.criterion {
            Criterion::D => dot(row, &y, p),
            Criterion::A | Criterion::Minimax => (0..p).map(|i| lambda[i] * y[i] * y[i]).sum(),
        };
    }
    Some(())
}

fn mean_gradient(d: &[f64], w: &[f64]) -> f64 {
    d.iter().zip(w).map(|(d, w)| d * w).sum()
}

/// The bound from the largest possible gain to first order.
fn lower(m: &Information, goal: &Goal, lambda: &[f64; MOST], gain: f64) -> Option<f64> {
    let (c, log_determinant) = m.inverse()?;
    Some(match goal.criterion {
        Criterion::D => (-(log_determinant + gain) / m.columns as f64).exp(),
        Criterion::A | Criterion::Minimax => {
            (0..m.columns).map(|i| lambda[i] * c[i][i]).sum::<f64>() - gain
        }
    })
}

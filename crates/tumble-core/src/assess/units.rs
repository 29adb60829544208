//! Runs as units of the joint adjustment: which common parameters each is made of, and with which covariance.

use super::{RunAssessment, SharedPair};
use crate::Orientation;
use crate::combine::Unit;
use crate::estimate::{Estimate, Parameter};
use crate::linalg::{Matrix, Symmetric3};
use crate::stats::chi_squared_p_value;

/// Largest ratio of what two plans give for the same scatter at which they count as one plan: a dwell more or less.
const ALIKE: f64 = 1.1;
/// Significance at which runs of one plan are told to scatter differently (Bartlett's test).
const DIFFERENT: f64 = 0.01;

/// A run that enters, with its place among all runs.
pub(super) struct Member<'a> {
    pub(super) index: usize,
    pub(super) estimate: &'a Estimate,
    pub(super) values: [f64; 3],
    /// Covariance that it enters with.
    pub(super) covariance: Symmetric3,
    /// Column of its misalignment.
    pub(super) seat: usize,
    /// Sign of the table's zero in its misalignment; zero where that cannot be told apart.
    pub(super) zero_sign: f64,
}

/// Columns of the joint adjustment: bias, scale error, misalignments, and the table's zero where runs tell it.
pub(super) struct Layout<'a> {
    pub(super) members: Vec<Member<'a>>,
    /// Names of the misalignments, from column 2 on.
    pub(super) seats: Vec<String>,
    pub(super) table_zero: Option<usize>,
    pub(super) columns: usize,
}

pub(super) const BIAS: usize = 0;
pub(super) const SCALE: usize = 1;
pub(super) const FIRST_SEAT: usize = 2;

/// Lays out the runs that determine all three parameters.
pub(super) fn layout(runs: &[RunAssessment]) -> Layout<'_> {
    let full: Vec<(usize, &RunAssessment, &Estimate, [f64; 3], &Matrix)> = runs
        .iter()
        .enumerate()
        .filter_map(|(i, r)| {
            let e = r.estimate.as_ref()?;
            Some((i, r, e, e.full()?, e.covariance.as_ref()?))
        })
        .collect();
    let both = |mounting: &str| {
        let turned = |wanted| {
            full.iter().any(|(_, r, ..)| r.mounting == mounting && r.orientation == wanted)
        };
        turned(Orientation::Normal) && turned(Orientation::Reversed)
    };
    let mut seats: Vec<String> = Vec::new();
    let mut members = Vec::new();
    let shared = covariances(&full.iter().map(|(_, _, e, _, c)| (*e, *c)).collect::<Vec<_>>());
    for ((index, run, estimate, values, _), covariance) in full.iter().zip(shared) {
        let separated = both(&run.mounting);
        let name = if separated { run.mounting.clone() } else { run.seating() };
        let seat = seats.iter().position(|s| *s == name).unwrap_or_else(|| {
            seats.push(name);
            seats.len() - 1
        });
        members.push(Member {
            index: *index,
            estimate,
            values: *values,
            covariance,
            seat: FIRST_SEAT + seat,
            zero_sign: if separated { run.orientation.sign() } else { 0.0 },
        });
    }
    let separated = members.iter().any(|m| m.zero_sign != 0.0);
    let columns = FIRST_SEAT + seats.len();
    Layout {
        members,
        seats,
        table_zero: separated.then_some(columns),
        columns: columns + usize::from(separated),
    }
}

impl Layout<'_> {
    /// The units: runs, then the pair.
    pub(super) fn units(&self, pair: Option<&SharedPair>) -> Vec<Unit> {
        let mut units: Vec<Unit> = self
            .members
            .iter()
            .map(|m| {
                let mut misalignment = vec![(m.seat, 1.0)];
                misalignment.extend(
                    self.table_zero.filter(|_| m.zero_sign != 0.0).map(|c| (c, m.zero_sign)),
                );
                Unit {
                    values: m.values.map(Some),
                    covariance: m.covariance,
                    design: [vec![(BIAS, 1.0)], misalignment, vec![(SCALE, 1.0)]],
                    dof: m.estimate.effective_dof,
                }
            })
            .collect();
        units.extend(pair.map(|p| {
            let mut covariance = Symmetric3::default();
            covariance.0[2][2] = p.standard_uncertainty.powi(2);
            Unit {
                values: [None, None, Some(p.scale_error)],
                covariance,
                design: [Vec::new(), Vec::new(), vec![(SCALE, 1.0)]],
                dof: [f64::INFINITY; 3],
            }
        }));
        units
    }
}

/// Covariances that the runs enter with.
///
/// Runs of one plan have one true covariance but for the size of their scatter, and estimates of it that differ by
/// chance. Weights by chance cost coverage, and correlations of −0.999 make them wild: so runs of one plan share the
/// shape, and the size too, unless Bartlett's test tells the sizes apart.
fn covariances(runs: &[(&Estimate, &Matrix)]) -> Vec<Symmetric3> {
    let own: Vec<Symmetric3> = runs
        .iter()
        .map(|(_, c)| Symmetric3(core::array::from_fn(|i| core::array::from_fn(|j| c[(i, j)]))))
        .collect();
    let shapes: Vec<Option<[f64; 3]>> = runs.iter().map(|(e, _)| shape(e)).collect();
    let mut out = own.clone();
    let mut done = vec![false; runs.len()];
    for first in 0..runs.len() {
        let Some(of_first) = shapes[first].filter(|_| !done[first]) else { continue };
        let group: Vec<usize> = (first..runs.len())
            .filter(|r| !done[*r] && shapes[*r].is_some_and(|s| alike(of_first, s)))
            .collect();
        group.iter().for_each(|r| done[*r] = true);
        let dof: Vec<f64> = group.iter().map(|r| size_dof(runs[*r].0)).collect();
        if let Some(shared) = shared(&group.iter().map(|r| own[*r]).collect::<Vec<_>>(), &dof) {
            group.iter().zip(shared).for_each(|(r, c)| out[*r] = c);
        }
    }
    out
}

/// Standard uncertainties of a plan for a scatter of one LSB.
fn shape(e: &Estimate) -> Option<[f64; 3]> {
    let scatter = e.residual_std_lsb.filter(|s| *s > 0.0)?;
    Some(e.plan_uncertainty?.map(|u| u / scatter)).filter(|s| s.iter().all(|u| *u > 0.0))
}

fn alike(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a / b < ALIKE && b / a < ALIKE)
}

/// Degrees of freedom of the size of a run's covariance: between one and a million.
pub(super) fn size_dof(e: &Estimate) -> f64 {
    crate::stats::mean(&e.effective_dof).unwrap_or(1.0).clamp(1.0, 1e6)
}

/// One shape for all, and one size where Bartlett's test does not object. `None` where a variance is not positive.
fn shared(own: &[Symmetric3], dof: &[f64]) -> Option<Vec<Symmetric3>> {
    let total: f64 = dof.iter().sum();
    let mut mean = Symmetric3::default();
    for (c, n) in own.iter().zip(dof) {
        for i in 0..3 {
            for j in 0..3 {
                mean.0[i][j] += c.0[i][j] * n / total;
            }
        }
    }
    let ln_sizes: Vec<f64> = own
        .iter()
        .map(|c| (0..3).map(|i| (c.0[i][i] / mean.0[i][i]).ln()).sum::<f64>() / 3.0)
        .collect();
    if ln_sizes.iter().any(|s| !s.is_finite()) {
        return None;
    }
    if !differ(&ln_sizes, dof) {
        return Some(vec![mean; own.len()]);
    }
    let sized = |s: &f64| Symmetric3(mean.0.map(|row| row.map(|c| c * s.exp())));
    Some(ln_sizes.iter().map(sized).collect())
}

/// Bartlett's test of equal variances (Proc. R. Soc. A 160 (1937) 268).
fn differ(ln_variances: &[f64], dof: &[f64]) -> bool {
    let (k, total) = (dof.len() as f64, dof.iter().sum::<f64>());
    let pooled: f64 = ln_variances.iter().zip(dof).map(|(s, n)| n * s.exp()).sum::<f64>() / total;
    let misfit: f64 = ln_variances.iter().zip(dof).map(|(s, n)| n * (pooled.ln() - s)).sum();
    let correction =
        1.0 + (dof.iter().map(|n| 1.0 / n).sum::<f64>() - 1.0 / total) / (3.0 * (k - 1.0).max(1.0));
    k > 1.0 && chi_squared_p_value(misfit / correction, k - 1.0).is_some_and(|p| p < DIFFERENT)
}

/// Name of a misalignment for people, where there are several.
pub(super) fn seat_name(
    layout: &Layout<'_>,
    parameter: Parameter,
    column: usize,
) -> Option<String> {
    (parameter == Parameter::Misalignment && layout.seats.len() > 1)
        .then(|| layout.seats.get(column.checked_sub(FIRST_SEAT)?).cloned())
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_that_differ_by_chance_are_one_and_others_are_not() {
        // scipy 1.17.1 stats.bartlett on samples with these variances: p = 0.0194 and 0.00068.
        let dof = [9.0, 9.0, 9.0];
        assert!(!differ(&[1.0f64.ln(), 5.6f64.ln(), 1.3f64.ln()], &dof));
        assert!(differ(&[1.0f64.ln(), 9.0f64.ln(), 1.0f64.ln()], &dof));
        assert!(!differ(&[0.3], &[9.0]));
    }

    #[test]
    fn shared_covariances_keep_shape_and_size() {
        let c = |s: f64| Symmetric3([[s, -0.9 * s, 0.0], [-0.9 * s, s, 0.0], [0.0, 0.0, s]]);
        let one = shared(&[c(0.8), c(1.2)], &[57.0, 57.0]).unwrap();
        assert!((one[0].0[0][1] + 0.9).abs() < 1e-12 && one[0] == one[1]);
        let two = shared(&[c(1.0), c(9.0)], &[57.0, 57.0]).unwrap();
        assert!((two[1].0[0][1] / two[0].0[0][1] - 9.0).abs() < 1e-9);
        assert!(shared(&[c(0.0), c(1.0)], &[57.0, 57.0]).is_none());
    }
}

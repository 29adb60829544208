//! Errors of the positions that repeat from run to run.
//!
//! The divisions of a dial and the steps of a converter that noise does not dither err alike in every run. The runs
//! then agree better than they are right, and their mean averages nothing out.

use super::RunAssessment;
use crate::{Finding, FindingKind};

/// Significance of "they repeat", in standard deviations of the correlation: one false alarm in two thousand.
pub(crate) const LIMIT: f64 = 3.3;

/// Share `ρ` of the positions' variance that all runs have in common: mean correlation of their residuals at the same
/// positions. `None` where the runs have different plans, or the correlation is not significant.
#[must_use]
pub fn repeated_share(runs: &[RunAssessment]) -> Option<f64> {
    let rows: Vec<Vec<f64>> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref())
        .filter(|e| e.covariance.is_some())
        .map(|e| e.weighted_rows.iter().map(|w| w.residual).collect())
        .collect();
    let angles: Vec<Vec<f64>> =
        runs.iter().map(|r| r.residuals().iter().map(|x| x.angle_deg).collect()).collect();
    let k = rows.len();
    if k < 2 || rows.len() != runs.len() || angles.windows(2).any(|w| w[0] != w[1]) {
        return None;
    }
    let dof = rows[0].len().checked_sub(3).filter(|d| *d > 0)? as f64;
    let pairs = (k * (k - 1)) as f64 / 2.0;
    let sum: f64 = (0..k)
        .flat_map(|i| (i + 1..k).map(move |j| (i, j)))
        .map(|(i, j)| {
            let product =
                |a: usize, b: usize| rows[a].iter().zip(&rows[b]).map(|(x, y)| x * y).sum::<f64>();
            let scale = (product(i, i) * product(j, j)).sqrt();
            if scale > 0.0 { product(i, j) / scale } else { 0.0 }
        })
        .sum();
    let share = sum / pairs;
    (share * (pairs * dof).sqrt() > LIMIT).then_some(share.min(1.0))
}

/// Worth knowing: it is in the uncertainty, but more runs do not help.
pub(super) fn finding(share: f64) -> Finding {
    Finding {
        kind: FindingKind::ErrorsRepeat,
        place: String::new(),
        observed: format!("{:.0} % of the positions' variance is the same in all runs", share * 100.0),
        limit: "errors that differ from run to run".into(),
        remedy: "more runs at the same angles do not help: it is in the uncertainty; measure other angles in the next run (half a step on), or add noise where the converter has too little".into(),
    }
}

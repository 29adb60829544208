//! Errors of the positions that repeat from run to run.
//!
//! The divisions of a dial and the steps of a converter that noise does not dither err alike in every run. The runs
//! then agree better than they are right, and their mean averages nothing out.

use super::RunAssessment;
use crate::{Finding, FindingKind};

/// Significance of "they repeat", in standard deviations of the correlation: one false alarm in two thousand.
pub(crate) const LIMIT: f64 = 3.3;
/// Share of the longest run's positions that all runs must have for their plans to be one.
const COMMON_SHARE: f64 = 0.8;

/// Share `ρ` of the positions' variance that all runs have in common: mean correlation of their residuals at the same
/// positions. `None` where the runs have different plans, or the correlation is not significant. Plans that differ by a
/// few positions (left out of one run) are one: else leaving out would make what repeats disappear.
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
    if k < 2 || rows.len() != runs.len() {
        return None;
    }
    let rows = at_common_angles(&rows, &angles)?;
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

/// The residuals at the angles that all runs have, in one order; `None` where those are too few of a run's.
fn at_common_angles(rows: &[Vec<f64>], angles: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let mut common = angles.first()?.clone();
    for other in &angles[1..] {
        let mut rest = other.as_slice();
        common.retain(|a| {
            let found = rest.iter().position(|b| a == b);
            found.inspect(|i| rest = &rest[i + 1..]).is_some()
        });
    }
    let longest = angles.iter().map(Vec::len).max()?;
    if (common.len() as f64) < COMMON_SHARE * longest as f64 {
        return None;
    }
    let of = |(rows, angles): (&Vec<f64>, &Vec<f64>)| {
        let mut wanted = common.iter().peekable();
        let pairs = rows.iter().zip(angles);
        pairs.filter(|(_, a)| wanted.next_if(|w| w == a).is_some()).map(|(r, _)| *r).collect()
    };
    Some(rows.iter().zip(angles).map(of).collect())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_that_is_missing_in_one_run_is_taken_from_none() {
        let angles = vec![vec![-2.0, -1.0, 0.0, 1.0, 2.0, 3.0], vec![-2.0, -1.0, 1.0, 2.0, 3.0]];
        let rows = vec![vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], vec![10.0, 20.0, 40.0, 50.0, 60.0]];
        let common = at_common_angles(&rows, &angles).unwrap();
        assert_eq!(common, [vec![1.0, 2.0, 4.0, 5.0, 6.0], vec![10.0, 20.0, 40.0, 50.0, 60.0]]);
        // The same plan the other way round is another one.
        let turned = vec![angles[0].clone(), angles[0].iter().rev().copied().collect()];
        assert_eq!(at_common_angles(&[rows[0].clone(), rows[0].clone()], &turned), None);
    }
}

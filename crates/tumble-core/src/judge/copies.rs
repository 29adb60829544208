//! Runs that are copies of one another, whole or with some rows changed.

use crate::{Finding, FindingKind, Position, Readings, Run};

/// Share of equal readings from which two runs are one: honest noise never repeats a dwell to the last digit.
pub(crate) const COPIED_SHARE: f64 = 0.5;
/// Fewest equal dwells that count as a copy with changes.
pub(crate) const FEWEST_COPIED: usize = 5;
/// Averages to so many parts of an LSB repeat by chance in less than one dwell of a hundred.
const PARTS: f64 = 100.0;

/// Runs whose readings are equal to the last digit, in all dwells or in half of them. A quiet converter on a good table
/// repeats its codes honestly: only noise never repeats, so a copy must hold some.
#[must_use]
pub fn identical_runs(runs: &[Run]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (i, a) in runs.iter().enumerate() {
        let copied = runs[i + 1..].iter().find_map(|b| copied(a, b).map(|equal| (b, equal)));
        if let Some((b, equal)) = copied {
            findings.push(Finding {
                kind: FindingKind::RunsIdentical,
                place: format!("{} and {}", a.name, b.name),
                observed: match equal == a.positions.len() {
                    true => "every reading of both runs is the same".into(),
                    false => format!(
                        "{equal} of {} readings are the same to the last digit",
                        a.positions.len()
                    ),
                },
                limit: "runs of their own power-ups".into(),
                remedy: "remove the copy from experiment.toml, or measure the run again".into(),
            });
        }
    }
    findings
}

/// Number of equal dwells, where they make one run a copy of the other.
fn copied(a: &Run, b: &Run) -> Option<usize> {
    let pairs = || a.positions.iter().zip(&b.positions);
    let equal = |(p, q): &(&Position, &Position)| p.angle == q.angle && p.readings == q.readings;
    let n = a.positions.len();
    if n == 0 || n != b.positions.len() {
        return None;
    }
    let same = pairs().filter(equal).count();
    if same == n {
        return a.positions.iter().any(|p| p.readings.only_code().is_none()).then_some(n);
    }
    let telling = pairs().filter(equal).filter(|(p, _)| tells(&p.readings)).count();
    (telling >= FEWEST_COPIED && telling as f64 >= COPIED_SHARE * n as f64).then_some(same)
}

/// Whether readings are such that chance does not repeat them.
fn tells(readings: &Readings) -> bool {
    match readings {
        // Block sums in time order are compared, too.
        Readings::Codes { histogram, .. } => {
            histogram.samples() >= 10 && readings.only_code().is_none()
        }
        Readings::Values { moments, .. } => moments.samples() > 1 && moments.std() > Some(0.0),
        Readings::Averaged { mean, .. } => {
            let parts = mean * PARTS;
            (parts - parts.round()).abs() > 1e-6 * PARTS
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Angle, Record, Seat};

    fn run(name: &str, means: &[f64]) -> Run {
        let position = |(i, mean): (usize, &f64)| Position {
            angle: Angle::from_deg(i as f64),
            seat: Seat::Table,
            readings: Readings::Averaged { mean: *mean, samples: 100, std: Some(1.0) },
            temperature_degc: None,
            place: String::new(),
            record: Record::default(),
        };
        let positions = means.iter().enumerate().map(position).collect();
        Run {
            name: name.into(),
            mounting: "A".into(),
            positions,
            date: None,
            orientation: crate::Orientation::Normal,
        }
    }

    #[test]
    fn half_of_the_rows_make_a_copy() {
        let first: Vec<f64> = (0..12).map(|i| 10.0 * f64::from(i) + 0.123_45).collect();
        let changed = |k: usize| -> Vec<f64> {
            first.iter().enumerate().map(|(i, m)| if i < k { m + 0.01 } else { *m }).collect()
        };
        let found = |means: &[f64]| identical_runs(&[run("a", &first), run("b", means)]);
        assert!(found(&changed(0))[0].observed.starts_with("every reading"));
        assert!(found(&changed(1))[0].observed.starts_with("11 of 12 readings"));
        assert_eq!(found(&changed(6)).len(), 1);
        assert!(found(&changed(7)).is_empty());
    }

    #[test]
    fn coarse_averages_repeat_honestly() {
        let a: Vec<f64> = (0..12).map(|i| 10.0 * f64::from(i)).collect();
        let b: Vec<f64> =
            a.iter().enumerate().map(|(i, m)| m + f64::from(u8::from(i == 3))).collect();
        assert!(identical_runs(&[run("a", &a), run("b", &b)]).is_empty());
    }
}

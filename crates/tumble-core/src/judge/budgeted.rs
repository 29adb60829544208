//! The budget: what of it is assumed, and whether its intervals hold.

use crate::assess::{BudgetLine, Drawn};
use crate::{Finding, FindingKind};

/// Share of a parameter's variance from which an assumed quantity is worth stating.
pub(crate) const ASSUMED_SHARE: f64 = 0.25;

/// Defaults that make up a good part of an uncertainty, in one finding.
#[must_use]
pub fn assumed(budget: &[BudgetLine]) -> Vec<Finding> {
    let mut named: Vec<(&BudgetLine, f64)> = Vec::new();
    for line in budget.iter().filter(|l| l.source.starts_with("default")) {
        match named.iter_mut().find(|(l, _)| l.quantity == line.quantity) {
            Some((_, share)) => *share = share.max(line.share),
            None => named.push((line, line.share)),
        }
    }
    named.retain(|(_, share)| *share >= ASSUMED_SHARE);
    named.sort_by(|a, b| b.1.total_cmp(&a.1));
    if named.is_empty() {
        return Vec::new();
    }
    let words: Vec<String> = named
        .iter()
        .map(|(l, share)| {
            let reason = l.source.trim_start_matches("default: ");
            format!("{} ({reason}): up to {:.0} % of a variance", l.quantity, 100.0 * share)
        })
        .collect();
    vec![Finding {
        kind: FindingKind::BudgetAssumed,
        place: "budget".into(),
        observed: words.join("; "),
        limit: format!("less than {:.0} % of a variance by default", 100.0 * ASSUMED_SHARE),
        remedy: "state what you know of the bench in [bench] (dial_scale_uncertainty_ppm, eccentricity_arcmin, axis_tilt_arcmin, \
                 sensor_lean_arcmin): check the dial against a reference, or measure with the body turned round"
            .into(),
    }]
}

/// Distance of the ends of two intervals, over half of the width, from which it is worth saying. The passport tells of less.
pub(crate) const DIFFERS_BY: f64 = 0.1;

/// Where Monte Carlo gives an interval that is plainly another. JCGM 101, clause 8.
#[must_use]
pub fn intervals_differ(drawn: &[Drawn]) -> Vec<Finding> {
    let plainly = |d: &&Drawn| {
        let half = 0.5 * (d.output.symmetric.high - d.output.symmetric.low);
        d.validation.d_low.max(d.validation.d_high) > DIFFERS_BY * half
    };
    let off: Vec<&Drawn> = drawn.iter().filter(|d| !d.validation.holds()).filter(plainly).collect();
    if off.is_empty() {
        return Vec::new();
    }
    let words: Vec<String> = off
        .iter()
        .map(|d| {
            let worst = d.validation.d_low.max(d.validation.d_high);
            let place = d.mounting.as_ref().map(|m| format!(", mounting {m}")).unwrap_or_default();
            format!(
                "{}{place}: ends {} apart, tolerance {}",
                d.parameter.words(),
                d.parameter.shown(worst),
                d.parameter.shown(d.validation.tolerance)
            )
        })
        .collect();
    vec![Finding {
        kind: FindingKind::IntervalsDiffer,
        place: "budget".into(),
        observed: words.join("; "),
        limit: "both intervals agree within the tolerance".into(),
        remedy: "nothing is wrong with the data: where the last digit of U matters, take the interval by Monte Carlo, which \
                 stands beside it"
            .into(),
    }]
}

//! Positions that do not belong, what each does to every result, and those that the user leaves out.
//!
//! Nothing is left out unless the user says so. Effects are those of real re-fits.

mod study;
mod words;

use super::{AssessError, PooledParameter, RunAssessment, SharedPair};
use crate::estimate::{
    Estimate, EstimateOptions, Parameter, Setting, TermSet, estimate_with_terms,
};
use crate::judge::{Belonging, limits};
use crate::{Experiment, Finding, FindingKind, Position, Run};
use study::Study;

/// Positions of a run that may be left out: one in so many, and always one.
pub(crate) const LEAVABLE_SHARE: usize = 10;
/// Most positions of a run whose effect is worked out: each costs a re-fit.
const MOST: usize = 12;
/// Most positions of an experiment whose effect on the pooled values is worked out: each puts all runs together anew.
const MOST_POOLED: usize = 100;

/// A position that the user leaves out of the adjustment.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct LeftOut {
    /// Name of the run.
    pub run: String,
    /// Its number in measured order, from one.
    pub position: usize,
}

/// What a position does to one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Value without the position minus value with it, in the parameter's unit.
    pub change: f64,
    /// The same over the expanded uncertainty of the value with it; absent without uncertainty.
    pub over_u: Option<f64>,
    /// Expanded uncertainty without the position over that with it.
    pub uncertainty_ratio: Option<f64>,
}

/// A position that does not belong, or that the user left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlier {
    /// Name of the run.
    pub run: String,
    /// Number in measured order, from one.
    pub position: usize,
    /// Where it was recorded, for people.
    pub place: String,
    /// Table angle, degrees.
    pub angle_deg: f64,
    /// What the others say of it; absent where they cannot.
    pub belonging: Option<Belonging>,
    /// p-value of the farthest position of the whole experiment; small: it does not belong.
    pub p_value: Option<f64>,
    /// The finding that names it; absent where only the user does.
    pub named_by: Option<FindingKind>,
    /// Whether the user left it out: the result is without it.
    pub left_out: bool,
    /// Effect on the values of its run, in the order of [`Parameter::ALL`]; absent where the rest determines nothing.
    pub effect: Option<[Change; 3]>,
    /// Effect on the pooled values, of its mounting where there are several; with two runs and more.
    pub pooled_effect: Option<[Change; 3]>,
}

/// A pooled value with all positions and as it is reported, without those left out.
#[derive(Debug, Clone, PartialEq)]
pub struct WithAndWithout {
    /// Which.
    pub parameter: Parameter,
    /// Mounting, where there are several.
    pub mounting: Option<String>,
    /// Value and expanded uncertainty with all positions.
    pub with: (f64, f64),
    /// Value and expanded uncertainty as reported.
    pub without: (f64, f64),
}

/// All positions that do not belong or were left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outliers {
    /// In the order of the runs, measured order within.
    pub positions: Vec<Outlier>,
    /// The result with and without what the user left out; empty where nothing was.
    pub comparison: Vec<WithAndWithout>,
}

/// A run's positions with their numbers in measured order; up/down dwells of `[scale]` have none.
#[derive(Debug, Clone, Default)]
pub(super) struct Material<'a> {
    /// Those of the adjustment.
    pub used: Vec<(Option<usize>, &'a Position)>,
    /// Those that the user left out.
    pub left_out: Vec<(usize, &'a Position)>,
    /// What was noticed at single dwells before the adjustment.
    pub noticed: Vec<(usize, FindingKind)>,
}

/// How to estimate and to pool again.
pub(super) struct Again<'f> {
    pub fit: &'f dyn Fn(&[&Position]) -> Option<Estimate>,
    pub pool: &'f dyn Fn(&[RunAssessment]) -> Vec<PooledParameter>,
    /// Level of confidence.
    pub level: f64,
    /// Least scatter that is believed, LSB.
    pub least_sd_lsb: f64,
}

/// Positions of a run with their numbers: those to adjust, and those left out.
pub(super) fn split<'a>(
    run: &Run,
    candidates: Vec<&'a Position>,
    left_out: &[LeftOut],
) -> Material<'a> {
    let before = candidates.len().saturating_sub(run.positions.len());
    let is_out = |n: usize| left_out.iter().any(|l| l.run == run.name && l.position == n);
    let mut material = Material::default();
    for (i, p) in candidates.into_iter().enumerate() {
        match (i + 1).checked_sub(before).filter(|n| *n > 0) {
            Some(n) if is_out(n) => material.left_out.push((n, p)),
            number => material.used.push((number, p)),
        }
    }
    material
}

/// The numbers of positions that were chosen among numbered ones, in the same order.
pub(super) fn numbered<'a>(
    all: &[(Option<usize>, &'a Position)],
    chosen: &[&'a Position],
) -> Vec<(Option<usize>, &'a Position)> {
    let mut next = chosen.iter().peekable();
    all.iter().filter(|(_, p)| next.next_if(|c| std::ptr::eq(**c, *p)).is_some()).copied().collect()
}

/// Finds what does not belong, and what it and everything left out do to the results.
///
/// **Model** a run's farthest position in externally studentized residuals is named where its p-value times the
/// positions of the experiment is below [`FALSE_ALARM`](crate::judge::FALSE_ALARM); then the next, without it. Positions that do not fit by the
/// hygiene of the data start named. `names` says whether any are sought: data that contradict the model have none.
fn outliers(
    materials: &[Material<'_>],
    runs: &[RunAssessment],
    pooled: &[PooledParameter],
    again: &Again<'_>,
    names: Seek,
) -> Outliers {
    let fitted = runs.iter().filter_map(|r| r.estimate.as_ref()).filter(|e| e.covariance.is_some());
    let tests: usize = fitted.map(|e| e.weighted_rows.len()).sum();
    let mut positions = Vec::new();
    for (index, material) in materials.iter().enumerate() {
        let Some(estimate) = runs[index].estimate.as_ref().filter(|e| e.covariance.is_some())
        else {
            continue;
        };
        let pools = positions.len() < MOST_POOLED;
        let study = Study { material, index, runs, pooled, estimate, again, tests, pools };
        positions.extend(study.positions(names));
    }
    Outliers { positions, comparison: comparison(materials, runs, pooled, again) }
}

/// Whether positions that do not belong are sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seek {
    /// Yes.
    All,
    /// Only what is named already is followed up.
    Named,
}

fn changed(with: (f64, Option<f64>), without: (f64, Option<f64>)) -> Change {
    let change = without.0 - with.0;
    let usable = |u: Option<f64>| u.filter(|u| u.is_finite() && *u > 0.0);
    Change {
        change,
        over_u: usable(with.1).map(|u| change / u),
        uncertainty_ratio: usable(with.1).zip(usable(without.1)).map(|(a, b)| b / a),
    }
}

/// The pooled values with everything that was left out, beside those that are reported.
fn comparison(
    materials: &[Material<'_>],
    runs: &[RunAssessment],
    pooled: &[PooledParameter],
    again: &Again<'_>,
) -> Vec<WithAndWithout> {
    if materials.iter().all(|m| m.left_out.is_empty()) {
        return Vec::new();
    }
    let whole: Vec<RunAssessment> = runs
        .iter()
        .zip(materials)
        .map(|(run, m)| {
            let all: Vec<&Position> =
                m.used.iter().map(|(_, p)| *p).chain(m.left_out.iter().map(|(_, p)| *p)).collect();
            let estimate =
                if m.left_out.is_empty() { run.estimate.clone() } else { (again.fit)(&all) };
            RunAssessment { estimate, ..run.clone() }
        })
        .collect();
    let with = (again.pool)(&whole);
    pooled
        .iter()
        .filter_map(|p| {
            let all =
                with.iter().find(|w| w.parameter == p.parameter && w.mounting == p.mounting)?;
            Some(WithAndWithout {
                parameter: p.parameter,
                mounting: p.mounting.clone(),
                with: (all.value, all.expanded_uncertainty),
                without: (p.value, p.expanded_uncertainty),
            })
        })
        .collect()
}

/// Everything that is to be left out must be there.
pub(super) fn all_there(experiment: &Experiment, left_out: &[LeftOut]) -> Result<(), AssessError> {
    for asked in left_out {
        let run = experiment.runs.iter().find(|r| r.name == asked.run).ok_or_else(|| {
            let known = experiment.runs.iter().map(|r| r.name.clone()).collect();
            AssessError::NoSuchRun { run: asked.run.clone(), known }
        })?;
        if !(1..=run.positions.len()).contains(&asked.position) {
            let positions = run.positions.len();
            return Err(AssessError::NoSuchPosition { asked: asked.clone(), positions });
        }
    }
    Ok(())
}

/// How the runs were fitted: options and the terms that entered.
#[derive(Clone, Copy)]
pub(super) struct Fitted<'a> {
    pub options: &'a EstimateOptions,
    pub set: TermSet,
    pub reference_degc: Option<f64>,
    /// What else goes into the pooled values.
    pub pair: Option<&'a SharedPair>,
}

/// Positions that do not belong or were left out, with what they do to the results.
pub(super) fn judge(
    materials: &[Material<'_>],
    runs: &[RunAssessment],
    pooled: &[PooledParameter],
    (setting, fitted): (&Setting<'_>, Fitted<'_>),
    findings: &mut Vec<Finding>,
) -> Outliers {
    let Fitted { options, set, reference_degc, pair } = fitted;
    let g = &setting.bench.gravity;
    let again = Again {
        fit: &|positions| {
            estimate_with_terms(positions, setting, options, set, reference_degc).ok()
        },
        pool: &|runs| super::budget::pooled(runs, pair, options.level),
        level: options.level,
        least_sd_lsb: limits::LEAST_SCATTER_RAD * g.value_m_s2 / setting.nominal_scale_m_s2_per_lsb,
    };
    // Data that contradict the model as a whole have no single position to blame.
    let contradicted = findings.iter().any(|f| {
        f.kind.severity() == crate::Severity::Reject && f.kind != FindingKind::MistypedAngle
    });
    let seek = if contradicted { Seek::Named } else { Seek::All };
    let found = outliers(materials, runs, pooled, &again, seek);
    let more = words::findings(&found, materials, runs, findings);
    findings.extend(more);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_without_minus_with() {
        let c = changed((1.0, Some(0.5)), (1.25, Some(0.4)));
        assert_eq!((c.change, c.over_u), (0.25, Some(0.5)));
        assert!((c.uncertainty_ratio.unwrap() - 0.8).abs() < 1e-15);
        assert_eq!(changed((1.0, None), (2.0, Some(0.0))).over_u, None);
    }
}

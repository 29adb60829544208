//! Reproducibility: do the runs agree?

use crate::assess::PooledParameter;
use crate::{Finding, FindingKind, Run};

/// Runs below which intervals are dominated by the Student factor.
pub(crate) const FEW: usize = 4;

/// What the number and the agreement of the runs say.
#[must_use]
pub fn reproducible(runs: &[Run], pooled: &[PooledParameter]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let say = |kind, place: String, observed: String, limit: &str, remedy: &str| Finding {
        kind,
        place,
        observed,
        limit: limit.to_owned(),
        remedy: remedy.to_owned(),
    };
    match runs.len() {
        0 => findings.push(say(
            FindingKind::NoRuns,
            String::new(),
            "no [[run]]".into(),
            "at least two runs on the table",
            "add dwells on the table at several angles as a run: without them there is no misalignment, and nothing shows that the model fits",
        )),
        1 => findings.push(say(
            FindingKind::OneRun,
            runs[0].name.clone(),
            "one run".into(),
            "two runs; five are good",
            "switch the sensor off and on and repeat the run: only that shows how far the bias repeats from power-up to power-up",
        )),
        k if k < FEW => findings.push(say(
            FindingKind::FewRuns,
            String::new(),
            format!("{k} runs"),
            "four runs",
            "more runs narrow the intervals quickly: the Student factor is 12.7 for two runs, 4.3 for three, 2.8 for five",
        )),
        _ => {}
    }
    for p in pooled.iter().filter(|p| p.runs > 1 && p.intersection.is_none()) {
        findings.push(say(
            FindingKind::EmptyIntersection,
            p.parameter.words().to_owned(),
            "the runs differ by more than their own uncertainties".into(),
            "intervals that overlap",
            "the spread between power-ups is in the result; to find its cause, compare temperature, mounting and warm-up of the runs",
        ));
    }
    findings
}

//! Stabilization: does the estimate settle as positions are added?

use crate::estimate::Estimate;
use crate::{Finding, FindingKind};

/// Largest step in standard deviations. With the hundred-odd steps of 60 positions chance alone passes five in
/// one run of a thousand.
pub(crate) const STEP_LIMIT: f64 = 5.0;

/// Whether the estimate moved more, late in the run, than chance allows.
#[must_use]
pub fn settled(run: &str, estimate: &Estimate) -> Option<Finding> {
    let step = estimate.stabilization.largest_step.filter(|s| *s > STEP_LIMIT)?;
    Some(Finding {
        kind: FindingKind::NotSettled,
        place: run.to_owned(),
        observed: format!("a step of {step:.1} standard deviations in the second half of the run"),
        limit: format!("{STEP_LIMIT} standard deviations"),
        remedy: "look at the residuals against the order of measurement: warm-up, a moved table, or one wrong angle; let the sensor warm up and repeat the run".into(),
    })
}

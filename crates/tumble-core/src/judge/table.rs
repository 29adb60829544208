//! What the scatter says about the table, and the codes about the noise.

use crate::estimate::{Estimate, Method};
use crate::{Finding, FindingKind, Output, Position, Quantizer};

/// Significance of "the table is not as good as stated". One finding in a thousand honest runs.
pub(crate) const SIGNIFICANCE: f64 = 0.0005;
/// Factor of scatter below which a significant disagreement is not worth a word.
pub(crate) const NOTEWORTHY_FACTOR: f64 = 1.3;
/// Scatter, as an angle at 0°, that no table has: the readings do not follow the angles.
pub(crate) const HOPELESS_DEG: f64 = 1.0;
/// Variance of codes within dwells, pooled, below which averages keep a part of the quantization error:
/// what noise of 0.3 LSB shows on average over all phases.
pub(crate) const LITTLE_DITHER_LSB2: f64 = 0.2;

/// Scatter of the positions against the stated angle uncertainty.
#[must_use]
pub fn table(
    run: &str,
    estimate: &Estimate,
    stated_arcmin: Option<f64>,
    full_scale_lsb: f64,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let finding = |kind, observed: String, limit: String, remedy: &str| Finding {
        kind,
        place: run.to_owned(),
        observed,
        limit,
        remedy: remedy.to_owned(),
    };
    let Some(scatter) = estimate.residual_std_lsb else { return findings };
    let hopeless_lsb = (HOPELESS_DEG.to_radians() * full_scale_lsb).max(1.0);
    if scatter > hopeless_lsb {
        findings.push(finding(
            FindingKind::ScatterHopeless,
            format!(
                "scatter of {scatter:.1} LSB, as if angles were set to {:.1}°",
                (scatter / full_scale_lsb).to_degrees()
            ),
            format!("{hopeless_lsb:.1} LSB ({HOPELESS_DEG}°)"),
            "check that the angle column holds the table's angles in degrees, in the order of the readings, and that the table stood still",
        ));
        return findings;
    }
    let (Some(against), Some(stated)) = (estimate.against_stated, stated_arcmin) else {
        return findings;
    };
    let ratio = against.ratio;
    let seen = format!("positions scatter {ratio:.2} times what {stated}′ gives");
    let limit = format!("p ≥ {SIGNIFICANCE}, or a factor of {NOTEWORTHY_FACTOR}");
    if against.p_value >= SIGNIFICANCE {
        return findings;
    }
    if ratio > NOTEWORTHY_FACTOR {
        findings.push(finding(
            FindingKind::TableWorse,
            seen,
            limit,
            "your table repeats worse than stated, or something drifts: the uncertainties follow the scatter; state what the table does",
        ));
    } else if ratio * NOTEWORTHY_FACTOR < 1.0 {
        findings.push(finding(
            FindingKind::TableBetter,
            seen,
            limit,
            "your table repeats better than stated: the uncertainties follow the scatter",
        ));
    }
    findings
}

/// Inflation of a mean's variance by slow noise from which it is worth a word.
pub(crate) const SLOW_NOISE: f64 = 1.5;

/// Noise within dwells that averaging does not reduce as it should.
#[must_use]
pub fn slow_noise(run: &str, estimate: &Estimate) -> Option<Finding> {
    let inflation = estimate.scatter?.inflation;
    (inflation > SLOW_NOISE).then(|| Finding {
        kind: FindingKind::SlowNoise,
        place: run.to_owned(),
        observed: format!("variance of a dwell's mean {inflation:.1} times that of white noise"),
        limit: format!("{SLOW_NOISE}"),
        remedy: "it is in the uncertainty; shorter dwells at more angles, or a longer warm-up, use the time better".into(),
    })
}

/// What the codes say about noise and quantization.
#[must_use]
pub fn noise(run: &str, positions: &[&Position], output: &Output, method: Method) -> Vec<Finding> {
    if output.quantizer == Quantizer::None {
        return Vec::new();
    }
    let mut findings = Vec::new();
    let total = positions.len();
    let one_code = positions.iter().filter(|p| p.readings.only_code().is_some()).count();
    if one_code > 0 {
        findings.push(Finding {
            kind: FindingKind::OneCodeDwell,
            place: run.to_owned(),
            observed: format!("{one_code} of {total} dwells show a single code"),
            limit: "two codes or more".into(),
            remedy: "normal in a quiet dwell; the mean is known to the width of the code only"
                .into(),
        });
    }
    if method == Method::Likelihood {
        // It takes codes as intervals: neither little noise nor code zero is a trap for it.
        return findings;
    }
    let variances: Vec<f64> =
        positions.iter().filter_map(|p| p.readings.std()).map(|s| s * s).collect();
    if let Some(pooled) = crate::stats::mean(&variances).filter(|v| *v < LITTLE_DITHER_LSB2) {
        findings.push(Finding {
            kind: FindingKind::LittleDither,
            place: run.to_owned(),
            observed: format!("codes scatter by {:.2} LSB within dwells", pooled.sqrt()),
            limit: format!("{:.2} LSB", LITTLE_DITHER_LSB2.sqrt()),
            remedy: "averages are off by up to half an LSB, differently at every angle: use --method likelihood, or add noise (raise the bandwidth)".into(),
        });
    }
    let near = |p: &&&Position| {
        let sigma = p.readings.std().unwrap_or(0.0);
        p.readings.mean().is_some_and(|m| m.abs() <= 1.0 + 4.0 * sigma)
    };
    let near_zero = positions.iter().filter(near).count();
    if output.quantizer == Quantizer::Truncate && near_zero > 0 {
        findings.push(Finding {
            kind: FindingKind::NearCodeZero,
            place: run.to_owned(),
            observed: format!("{near_zero} of {total} dwells within 1 + 4σ of code zero"),
            limit: "|mean code| > 1 + 4σ".into(),
            remedy: "the sign rule is off there by up to half an LSB: use --method likelihood, or shift the angles by a degree".into(),
        });
    }
    findings
}

//! Residual structure over angle: data that are not linear are not accepted as linear.

use crate::estimate::{Estimate, WeightedRow};
use crate::term::{TermTest, test_term};
use crate::{Finding, FindingKind};

/// Significance at which a left-over curvature counts.
pub(crate) const SIGNIFICANCE: f64 = 0.001;
/// Peak of a significant curvature, over the scatter of the positions, below which it only warns. With 60
/// positions nothing smaller than 0.9 becomes significant; with thousands, curvature far below the scatter does.
pub(crate) const MATERIAL_SHARE: f64 = 0.5;

/// Curvature left over in the residuals of all runs together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Structure {
    /// `sin²φ`: K2 of IEEE 1293.
    pub quadratic: Option<TermTest>,
    /// `sin³φ`: K3.
    pub cubic: Option<TermTest>,
}

/// Tests the residuals for a quadratic and a cubic in the applied acceleration.
#[must_use]
pub fn structure(
    estimates: &[(&str, &Estimate)],
    significance_tests: usize,
) -> (Structure, Vec<Finding>) {
    let runs: Vec<&[WeightedRow]> =
        estimates.iter().map(|(_, e)| e.weighted_rows.as_slice()).collect();
    let level = |power: i32| -> Vec<Vec<f64>> {
        estimates
            .iter()
            .map(|(_, e)| {
                let dphi = e.values[1].unwrap_or(0.0);
                e.residuals
                    .iter()
                    .map(|r| (r.angle_deg.to_radians() + dphi).sin().powi(power))
                    .collect()
            })
            .collect()
    };
    let structure =
        Structure { quadratic: test_term(&runs, &level(2)), cubic: test_term(&runs, &level(3)) };
    let scatter = estimates.iter().filter_map(|(_, e)| e.residual_std_lsb).fold(0.0, f64::max);
    let place = match estimates {
        [(name, _)] => (*name).to_owned(),
        _ => "all runs".to_owned(),
    };
    let threshold = SIGNIFICANCE / significance_tests.max(1) as f64;
    let strongest = [
        (FindingKind::QuadraticResidual, "quadratic", structure.quadratic),
        (FindingKind::CubicResidual, "cubic", structure.cubic),
    ]
    .into_iter()
    .filter_map(|(kind, name, test)| test.map(|t| (kind, name, t)))
    .filter(|(_, _, t)| t.p_value < threshold)
    .max_by(|a, b| a.2.peak_lsb.total_cmp(&b.2.peak_lsb));
    let findings = strongest
        .map(|(kind, name, t)| Finding {
            kind: if t.peak_lsb > MATERIAL_SHARE * scatter { kind } else { FindingKind::SmallStructure },
            place,
            observed: format!("{name}, {:.2} LSB at its peak, p = {:.1e}", t.peak_lsb, t.p_value),
            limit: format!("p ≥ {threshold:.1e} (scatter of the positions {scatter:.2} LSB)"),
            remedy: if name == "cubic" {
                "the sensor's K3, or the dial's eccentricity or scale: check the table with another sensor, or restrict the range".into()
            } else {
                "the sensor's K2, or a table angle that is wrong at one end: check the angles, or restrict the range".into()
            },
        })
        .into_iter()
        .collect();
    (structure, findings)
}

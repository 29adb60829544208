//! Influence of temperature and signal level: effect, interval, p-value, and what could have been seen.

use super::RunAssessment;
use crate::estimate::{Estimate, Parameter, Term, WeightedRow};
use crate::stats::mean;
use crate::term::{TermTest, test_term};
use crate::{Finding, FindingKind};

/// Significance at which an influence is worth a warning: one false alarm in a thousand, as for structure.
pub(crate) const SIGNIFICANCE: f64 = 0.001;

/// What was tested, and what could not be.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Influence {
    /// Temperature on the bias, m/s² per kelvin, within runs.
    pub temperature: Option<InfluenceTest>,
    /// Signal level: error per g of |a|, m/s² per g.
    pub signal_level: Option<InfluenceTest>,
    /// Temperatures recorded, lowest and highest.
    pub temperature_range_degc: Option<(f64, f64)>,
}

/// One influence.
#[derive(Debug, Clone, PartialEq)]
pub struct InfluenceTest {
    /// Effect in [`Self::unit`].
    pub effect: f64,
    /// Half-width of its interval at the level asked for.
    pub expanded_uncertainty: f64,
    /// Two-sided p-value of "no effect".
    pub p_value: f64,
    /// Smallest true effect that would have been found with a probability of 80 % (test at 5 %).
    pub smallest_detectable: f64,
    /// Unit of the effect.
    pub unit: &'static str,
}

impl Influence {
    /// A temperature effect that stands in the model is shown as it was estimated, not as what is left of it.
    pub(super) fn take_entered(&mut self, terms: &super::Terms, level: f64) {
        let term = terms.tried.iter().find(|t| t.entered && t.term == Term::TempBias);
        let Some(test) = term.and_then(|t| t.test) else { return };
        self.temperature = test.expanded_lsb(level).zip(test.smallest_detectable_lsb()).map(
            |(expanded_uncertainty, smallest_detectable)| InfluenceTest {
                effect: test.effect_lsb,
                expanded_uncertainty,
                p_value: test.p_value,
                smallest_detectable,
                unit: "m/s² per K",
            },
        );
    }

    /// Influences that matter.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let say = |kind, test: &Option<InfluenceTest>, remedy: &str| {
            test.as_ref().filter(|t| t.p_value < SIGNIFICANCE).map(|t| Finding {
                kind,
                place: String::new(),
                observed: format!(
                    "{:+.2e} ± {:.1e} {}, p = {:.1e}",
                    t.effect, t.expanded_uncertainty, t.unit, t.p_value
                ),
                limit: format!("p ≥ {SIGNIFICANCE}"),
                remedy: remedy.to_owned(),
            })
        };
        [
            say(
                FindingKind::TemperatureEffect,
                &self.temperature,
                "let the sensor warm up and hold the temperature; use the passport near the temperature that it was made at",
            ),
            say(
                FindingKind::SignalLevelEffect,
                &self.signal_level,
                "the scale factor may differ by sign, or a table angle be wrong: compare the residuals on both sides of 0°",
            ),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

/// Tests both influences over all runs that determine all parameters.
#[must_use]
pub fn influence(runs: &[RunAssessment], nominal_scale_m_s2_per_lsb: f64, level: f64) -> Influence {
    let full: Vec<(&RunAssessment, &Estimate)> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref().map(|e| (r, e)))
        .filter(|(_, e)| e.covariance.is_some())
        .collect();
    let recorded: Vec<f64> =
        runs.iter().flat_map(|r| r.temperatures_degc.iter().flatten().copied()).collect();
    let temperature_range_degc = recorded.iter().fold(None, |r: Option<(f64, f64)>, t| {
        Some(r.map_or((*t, *t), |(lo, hi)| (lo.min(*t), hi.max(*t))))
    });
    let rows: Vec<&[WeightedRow]> = full.iter().map(|(_, e)| e.weighted_rows.as_slice()).collect();
    let k = |e: &Estimate| {
        let dk = e.values[Parameter::ScaleError.index()].unwrap_or(0.0);
        nominal_scale_m_s2_per_lsb * (1.0 + dk)
    };
    // Columns in LSB per unit of the influence; the sign makes the coefficient a change of bias.
    let temperature: Option<Vec<Vec<f64>>> = full
        .iter()
        .map(|(r, e)| {
            let temperatures: Option<Vec<f64>> = r.temperatures_degc.iter().copied().collect();
            let temperatures = temperatures?;
            let middle = mean(&temperatures)?;
            Some(temperatures.iter().map(|t| (t - middle) / k(e)).collect())
        })
        .collect();
    let signal: Vec<Vec<f64>> = full
        .iter()
        .map(|(_, e)| {
            let dphi = e.values[Parameter::Misalignment.index()].unwrap_or(0.0);
            e.residuals
                .iter()
                .map(|r| (r.angle_deg.to_radians() + dphi).sin().abs() / k(e))
                .collect()
        })
        .collect();
    let present = |t: TermTest, unit| {
        Some(InfluenceTest {
            effect: t.effect_lsb,
            expanded_uncertainty: t.expanded_lsb(level)?,
            p_value: t.p_value,
            smallest_detectable: t.smallest_detectable_lsb()?,
            unit,
        })
    };
    Influence {
        temperature: temperature
            .filter(|c| !c.is_empty())
            .and_then(|c| test_term(&rows, &c))
            .and_then(|t| present(t, "m/s² per K")),
        signal_level: test_term(&rows, &signal).and_then(|t| present(t, "m/s² per g")),
        temperature_range_degc,
    }
}

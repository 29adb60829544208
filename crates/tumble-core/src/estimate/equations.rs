//! One equation a position: what was read, and how well it is known against the others.

use super::{Setting, Weights};
use crate::{Position, Seat};

/// One position as an equation of the adjustment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equation {
    /// Table angle, rad.
    pub angle_rad: f64,
    /// On the table or stood upright.
    pub seat: Seat,
    /// `N* = N̂ + c(N̂)`, LSB.
    pub analogue_lsb: f64,
    /// `σ²`: variance of the dwell's mean, LSB², as the dwell itself tells it; 1 with equal weights.
    pub dwell_variance: f64,
    /// `σφ`, rad; zero with equal weights.
    pub angle_uncertainty_rad: f64,
    /// `u(δ)`, rad: standard uncertainty of the lean; zero on the table.
    pub lean_uncertainty_rad: f64,
}

impl Equation {
    /// Variance whose size comes from the residuals, LSB²: `σ² + (R cos(φ+Δφ) σφ)²` with `R = g/k*`.
    #[must_use]
    pub fn scatter_variance(&self, full_scale_lsb: f64, misalignment_rad: f64) -> f64 {
        let slope = match self.seat {
            Seat::Table => full_scale_lsb * (self.angle_rad + misalignment_rad).cos(),
            Seat::Up | Seat::Down => 0.0,
        };
        self.dwell_variance + (slope * self.angle_uncertainty_rad).powi(2)
    }

    /// What leaning costs on average, LSB: `R E[δ²]/2 = R u(δ)²/2`. Always toward zero.
    #[must_use]
    pub fn lean_expectation(&self, full_scale_lsb: f64) -> f64 {
        let sign = self.seat.vertical_sign().unwrap_or(0.0);
        sign * full_scale_lsb * self.lean_uncertainty_rad.powi(2) / 2.0
    }

    /// Variance of what leaning costs, LSB²: for a Gaussian lean `var(R δ²/2) = R² u(δ)⁴/2`. Not scaled by
    /// the residuals: they say nothing about it.
    #[must_use]
    pub fn lean_variance(&self, full_scale_lsb: f64) -> f64 {
        full_scale_lsb.powi(2) * self.lean_uncertainty_rad.powi(4) / 2.0
    }
}

/// Positions as equations, in measured order.
#[must_use]
pub fn equations(
    positions: &[&Position],
    setting: &Setting<'_>,
    weights: Weights,
) -> Vec<Equation> {
    let sigma_phi = setting.bench.angle_uncertainty.map_or(0.0, |a| a.rad());
    let variances: Vec<f64> =
        positions.iter().filter_map(|p| p.readings.std()).map(|s| s * s).collect();
    let code_variance = crate::stats::mean(&variances).unwrap_or(0.0);
    let mut eqs: Vec<Equation> = positions
        .iter()
        .filter_map(|p| {
            let mean = p.readings.mean()?;
            let upright = p.seat.vertical_sign().is_some();
            Some(Equation {
                angle_rad: p.angle.rad(),
                seat: p.seat,
                analogue_lsb: setting.quantizer.analogue_lsb(mean),
                dwell_variance: match weights {
                    Weights::Equal => 1.0,
                    Weights::Angle | Weights::Stated => {
                        p.readings.variance_of_mean(setting.quantizer, code_variance)
                    }
                },
                angle_uncertainty_rad: match weights {
                    Weights::Equal => 0.0,
                    Weights::Angle | Weights::Stated => sigma_phi,
                },
                lean_uncertainty_rad: if upright { setting.bench.vertical_lean.rad() } else { 0.0 },
            })
        })
        .collect();
    lift_unknown_variances(&mut eqs);
    eqs
}

/// Dwells that say nothing about their own scatter (no standard deviation, one sample) get the largest variance
/// of the others; if none says anything, all weigh the same.
fn lift_unknown_variances(eqs: &mut [Equation]) {
    let largest = eqs.iter().map(|e| e.dwell_variance).fold(0.0, f64::max);
    let substitute = if largest > 0.0 { largest } else { 1.0 };
    eqs.iter_mut().filter(|e| e.dwell_variance <= 0.0).for_each(|e| e.dwell_variance = substitute);
}

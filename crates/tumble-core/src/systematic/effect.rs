//! What each systematic error does to the parameters of one run.

use super::quantity::{Quantity, Shape};
use super::{ExtraColumn, Input, Inputs, Linearized, Sites, pattern, resolution};
use crate::Position;
use crate::estimate::{Estimate, Setting, ToParameters};

/// One quantity with its effect on a run's parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct SystematicEffect {
    /// Which.
    pub quantity: Quantity,
    /// Standard uncertainty, in [`Quantity::unit`].
    pub standard_uncertainty: f64,
    /// Distribution.
    pub shape: Shape,
    /// `stated`, or where the default comes from.
    pub source: String,
    /// What one unit of it, there and not corrected, changes the estimates by: bias (m/s²), misalignment (rad), scale error
    /// (relative). Signed, but for [`Quantity::Resolution`]: roots of sums of squares.
    pub sensitivity: [f64; 3],
    /// The same for the coefficients of the extra columns.
    pub terms: Vec<f64>,
}

impl SystematicEffect {
    /// Signed contributions to the three standard uncertainties, `c_i u`.
    #[must_use]
    pub fn contribution(&self) -> [f64; 3] {
        self.sensitivity.map(|c| c * self.standard_uncertainty)
    }
}

/// Effects of all quantities on one run, by differentiation through its own weighted equations.
///
/// Errors of one bench are common to all its runs: a pooled value `Σ w_r θ_r` has the sensitivity `Σ w_r c_r`.
///
/// **Model** [`pattern`] gives what a unit of the quantity adds to the readings, [`Linearized::shift`] what the fit makes of it.
/// Gravity: `k*` and `Δa` are proportional to it ([`ToParameters::Exact`]); in the paper's form `Δφ` and `1 − δk` are to its inverse.
/// Reference: in use `k*` is larger by its change.
///
/// `positions` are those of the estimate, in measured order. `extra`: columns fitted beside the parameters; a quantity that
/// one of them replaces is left out.
///
/// `None` below full rank, or where numbers of positions differ.
///
/// **Source** method section 10; `docs/budget.md`.
#[must_use]
pub fn effects(
    estimate: &Estimate,
    positions: &[&Position],
    setting: &Setting<'_>,
    inputs: &Inputs,
    extra: &[ExtraColumn],
) -> Option<Vec<SystematicEffect>> {
    let linearized =
        Linearized::new(estimate, extra).filter(|l| l.positions() == positions.len())?;
    let sites = Sites::of(estimate, positions, setting, inputs.temperature_spread_k)?;
    let values = estimate.full()?;
    let effect = |input: &Input| {
        let quantity = input.quantity;
        let mut terms = vec![0.0; extra.len()];
        let sensitivity = match pattern(quantity, &sites) {
            Some(lsb) => {
                let shift = linearized.shift(&lsb);
                terms = shift.terms;
                shift.parameters
            }
            None => match quantity {
                Quantity::Gravity => gravity(estimate.to_parameters, values, setting),
                Quantity::Resolution => {
                    let step = input.standard_uncertainty * 12f64.sqrt();
                    resolution::sensitivity(&linearized, estimate, positions, setting, step)
                }
                _ => [0.0, 0.0, 1.0 + values[2]],
            },
        };
        SystematicEffect {
            quantity,
            standard_uncertainty: input.standard_uncertainty,
            shape: input.shape,
            source: input.source.clone(),
            sensitivity,
            terms,
        }
    };
    let fitted = |q: Quantity| extra.iter().any(|c| c.replaces == Some(q));
    Some(inputs.lines.iter().filter(|l| !fitted(l.quantity)).map(effect).collect())
}

fn gravity(to: ToParameters, values: [f64; 3], setting: &Setting<'_>) -> [f64; 3] {
    let g = setting.bench.gravity.value_m_s2;
    let [bias, misalignment, scale_error] = values;
    match to {
        ToParameters::Exact { .. } => [bias / g, 0.0, (1.0 + scale_error) / g],
        ToParameters::Identity => [0.0, -misalignment / g, (1.0 - scale_error) / g],
    }
}

/// Standard uncertainties of the parameters from the lean of upright dwells alone: the share of it in the statistical
/// covariance. Not to be added to that.
///
/// **Model** `var(R δ²/2) = R² u(δ)⁴/2` each, `R = g/k*`. `None` below full rank.
#[must_use]
pub fn upright_lean(
    estimate: &Estimate,
    positions: &[&Position],
    setting: &Setting<'_>,
) -> Option<[f64; 3]> {
    let linearized = Linearized::new(estimate, &[]).filter(|l| l.positions() == positions.len())?;
    let [_, _, scale_error] = estimate.full()?;
    let k = setting.nominal_scale_m_s2_per_lsb * (1.0 + scale_error);
    let r = setting.bench.gravity.value_m_s2 / k;
    let u_lsb = r * setting.bench.vertical_lean.rad().powi(2) / 2f64.sqrt();
    let mut squares = [0.0; 3];
    for j in (0..positions.len()).filter(|j| positions[*j].seat.vertical_sign().is_some()) {
        let mut lsb = vec![0.0; positions.len()];
        lsb[j] = u_lsb;
        let shift = linearized.shift(&lsb).parameters;
        squares.iter_mut().zip(shift).for_each(|(to, s)| *to += s * s);
    }
    Some(squares.map(f64::sqrt))
}

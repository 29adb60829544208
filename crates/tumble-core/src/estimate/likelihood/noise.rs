//! The noise `σ` of a quiet converter: where codes hardly change, it hangs together with the scatter between dwells.
//!
//! `ln σ` is found where the derivative of the restricted likelihood vanishes, the scatter following it to its own
//! maximum. Both derivatives come from the same solution: at a fixed point of [`integrate`](super::integrate) nothing
//! but the dwells' own marginals depends on `σ` and `V` to first order.

use super::evidence::Evidence;
use super::integrate::{Dwell, companies};
use super::material::{Material, Materials, SMALLEST_SIGMA};
use super::scatter::Surface;
use super::search::crossing;

/// Loudest noise for which codes are kept apart, LSB; beyond, averages say the same.
const LARGEST_SIGMA: f64 = 3.0;
/// Noise from which the scatter between dwells has no part in it, LSB: every dwell shows three codes and more.
const OWN_NOISE_LSB: f64 = 0.3;
/// Log-likelihood that the last step of a search may still be worth.
const WORTH: f64 = 0.03;
/// Step of the derivative by `ln σ`: wide enough that the pieces of the curves, which differ from one `σ` to the next by
/// hundredths, do not show in it.
const LN_STEP: f64 = 0.08;

/// `σ` with what is known about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Noise {
    /// LSB.
    pub sigma: f64,
    /// Standard deviation of `ln σ`; infinite where only a bound is known.
    pub ln_sd: f64,
    /// `ln V` where it was found, for the next search.
    pub start: Option<f64>,
    /// Evaluations of the restricted likelihood.
    pub evaluations: usize,
}

/// `σ` from each dwell by itself, its level unknown: `Σ ln ∫ e^{ℓ_j(μ; σ)} dμ` at its maximum.
fn from_dwells_alone(materials: &Materials) -> Option<(f64, f64)> {
    let value = |ln: f64| -> f64 {
        let one = |m: &Material| match m {
            Material::Codes(cells) if !cells.one_sided() => {
                let e = Evidence::of(cells, ln.exp(), materials.inflation);
                e.marginal(e.centre(), 1e4).value
            }
            _ => 0.0,
        };
        materials.dwells.iter().map(one).sum()
    };
    let slope = |ln: f64| Some((value(ln + LN_STEP) - value(ln - LN_STEP)) / (2.0 * LN_STEP));
    let start = materials.sigma_start.clamp(SMALLEST_SIGMA, LARGEST_SIGMA).ln();
    crossing(start, 0.15, (SMALLEST_SIGMA.ln(), LARGEST_SIGMA.ln()), WORTH, slope)
}

/// `σ` of a run.
///
/// `dwells` makes the dwells for a given `σ`; `share` is the share of the angle in the scatter meanwhile.
pub(super) fn settle(
    materials: &Materials,
    share: f64,
    dwells: impl Fn(f64) -> Vec<Dwell>,
) -> Option<Noise> {
    if materials.sigma_is_known() {
        let ln_sd = (2.0 * materials.noise_dof / materials.inflation).sqrt().recip();
        return Some(Noise { sigma: materials.sigma_start, ln_sd, start: None, evaluations: 0 });
    }
    let (ln, curvature) = from_dwells_alone(materials)?;
    let alone = Noise {
        sigma: ln.exp(),
        ln_sd: if curvature < 0.0 { (-curvature).sqrt().recip() } else { f64::INFINITY },
        start: None,
        evaluations: 0,
    };
    if alone.sigma > OWN_NOISE_LSB {
        return Some(alone);
    }
    let mut evaluations = 0;
    let mut follow: Option<f64> = None;
    let found = crossing(ln, 0.1, (SMALLEST_SIGMA.ln(), LARGEST_SIGMA.ln()), WORTH, |ln| {
        let here = dwells(ln.exp());
        let mut surface = Surface::new(&here);
        let x = surface.best_total(share, follow)?;
        follow = Some(x);
        let total = surface.total(x);
        let solution = surface.at(total, share)?;
        evaluations += surface.evaluations;
        let around = companies(&here, surface.sites(), &solution);
        let shifted = |ln: f64| -> f64 {
            dwells(ln.exp())
                .iter()
                .zip(&around)
                .zip(surface.variances())
                .map(|((d, c), v)| d.evidence.marginal(d.origin + c.at, v + c.spread).value)
                .sum()
        };
        Some((shifted(ln + LN_STEP) - shifted(ln - LN_STEP)) / (2.0 * LN_STEP))
    });
    let (ln, curvature) = found?;
    Some(Noise {
        sigma: ln.exp(),
        ln_sd: if curvature < 0.0 { (-curvature).sqrt().recip() } else { f64::INFINITY },
        start: follow,
        evaluations,
    })
}

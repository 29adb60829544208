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
use crate::stats::normal_quantile;

/// Loudest noise that is looked for, LSB: more than any converter has codes.
const LARGEST_SIGMA: f64 = 1e6;
/// Noise from which the scatter between dwells has no part in it, LSB: every dwell shows three codes and more.
const OWN_NOISE_LSB: f64 = 0.3;
/// Log-likelihood that the last step of a search may still be worth.
const WORTH: f64 = 0.03;
/// Step of the derivative by `ln σ`: wide enough that the pieces of the curves, which differ from one `σ` to the next by
/// hundredths, do not show in it.
const LN_STEP: f64 = 0.08;

/// `σ` with what is known about it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Noise {
    /// LSB.
    pub sigma: f64,
    /// Standard deviation of `ln σ`; infinite where only a bound is known.
    pub ln_sd: f64,
    /// `ln V` where it was found, for the next search.
    pub start: Option<f64>,
    /// Further values of `σ` that the codes leave possible, each with the width of `ln σ` that it stands for; empty where
    /// `sigma` serves alone. Its own width comes first.
    pub others: Vec<Possible>,
    /// Width of `ln σ` that `sigma` itself stands for.
    pub own_width: f64,
}

/// One more `σ` of an integration over `ln σ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Possible {
    /// LSB.
    pub sigma: f64,
    /// Width of `ln σ`.
    pub width: f64,
    /// Coordinate of the best `V` there.
    pub start: f64,
}

impl Noise {
    /// Spreads `ln σ` over all values that were integrated over. `weights`: what each holds of the surface, its own first.
    pub fn spread_over(&mut self, weights: &[f64]) {
        let own = if self.ln_sd.is_finite() { self.ln_sd } else { LN_GRID / 12f64.sqrt() };
        let all = || {
            let grid = self.others.iter().map(|o| (o.sigma.ln(), o.width / 12f64.sqrt()));
            std::iter::once((self.sigma.ln(), own)).chain(grid).zip(weights)
        };
        let sum: f64 = weights.iter().sum();
        let mean = all().map(|((ln, _), w)| w * ln).sum::<f64>() / sum;
        let variance =
            all().map(|((ln, sd), w)| w * ((ln - mean).powi(2) + sd * sd)).sum::<f64>() / sum;
        // A bound stays one.
        if self.ln_sd.is_finite() {
            self.ln_sd = variance.sqrt().max(self.ln_sd);
        }
    }

    fn alone(sigma: f64, ln_sd: f64, start: Option<f64>) -> Self {
        Self { sigma, ln_sd, start, others: Vec::new(), own_width: 1.0 }
    }
}

/// Distance in `ln σ` of the values that are looked at where a single one does not do.
const LN_GRID: f64 = 0.35;
/// Values below and above.
const GRID: std::ops::RangeInclusive<i32> = -4..=3;
/// Standard deviation of `ln σ`, as the dwells alone tell it, up to which a single value serves; its shift of the
/// parameters is added then. With a single value 60 dwells at 0.02 LSB cover 92 to 93 %, 12 at 0.05 LSB 87 to 88 %.
const ONE_SERVES: f64 = 0.28;
/// Standard deviation of `ln σ` below which a summit slips through the grid.
const SHARP: f64 = 0.12;
/// Log-likelihood below the best at which a value of `σ` is out of the question.
const OUT: f64 = 7.0;

/// What the dwells say of `ln σ`, each by itself, its level unknown: `Σ ln ∫ e^{ℓ_j(μ; σ)} dμ`, but for a constant.
fn of_dwells_alone(materials: &Materials, ln: f64) -> f64 {
    let one = |m: &Material| match m {
        Material::Codes(cells) if !cells.one_sided() => {
            let e = Evidence::of(cells, ln.exp(), materials.inflation);
            e.marginal(e.centre(), 1e4).value
        }
        _ => 0.0,
    };
    materials.dwells.iter().map(one).sum()
}

/// Upper end of `σ` where only a bound is known: where the likelihood of the dwells alone, which falls from the smallest
/// `σ` on, has fallen by what a one-sided interval of the level allows.
pub(super) fn upper_bound(materials: &Materials, level: f64) -> f64 {
    let allowed = 0.5 * normal_quantile(level).powi(2);
    let (mut low, mut high) = (SMALLEST_SIGMA.ln(), LARGEST_SIGMA.ln());
    let top = of_dwells_alone(materials, low);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if top - of_dwells_alone(materials, middle) > allowed {
            high = middle
        } else {
            low = middle
        }
    }
    high.exp()
}

/// `σ` where that is largest, with its second derivative there.
fn from_dwells_alone(materials: &Materials) -> Option<(f64, f64)> {
    let value = |ln: f64| of_dwells_alone(materials, ln);
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
    if materials.sigma_is_known {
        let ln_sd = (2.0 * materials.noise_dof / materials.inflation).sqrt().recip();
        return Some(Noise::alone(materials.sigma_start, ln_sd, None));
    }
    let (ln, curvature) = from_dwells_alone(materials)?;
    let ln_sd = deviation(curvature);
    if ln.exp() > OWN_NOISE_LSB {
        return Some(Noise::alone(ln.exp(), ln_sd, None));
    }
    let (ln_alone, ln_sd_alone) = (ln, ln_sd);
    let mut follow: Option<f64> = None;
    let found = crossing(ln, 0.1, (SMALLEST_SIGMA.ln(), LARGEST_SIGMA.ln()), WORTH, |ln| {
        let here = dwells(ln.exp());
        let mut surface = Surface::new(&here);
        let x = surface.best_total(share, follow)?;
        follow = Some(x);
        let total = surface.total(x);
        let solution = surface.at(total, share)?;
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
    let mut noise = Noise::alone(ln.exp(), deviation(curvature), follow);
    let agrees = (ln - ln_alone).abs() < 3.0 * ln_sd_alone;
    if !(noise.ln_sd < ONE_SERVES && ln_sd_alone < ONE_SERVES && agrees) {
        spread_out(&mut noise, ln_alone, share, &dwells)?;
    }
    Some(noise)
}

/// Standard deviation that belongs to a second derivative.
fn deviation(curvature: f64) -> f64 {
    if curvature < 0.0 { (-curvature).sqrt().recip() } else { f64::INFINITY }
}

/// Other values of `σ` that are possible too: where few dwells show two codes, noise and scatter stand for each other, and
/// the surface may have a second summit.
///
/// A sharp summit keeps a width of its own beside the grid; a wide one is a point of it.
fn spread_out(
    noise: &mut Noise,
    ln_alone: f64,
    share: f64,
    dwells: &impl Fn(f64) -> Vec<Dwell>,
) -> Option<()> {
    let own = noise.sigma.ln();
    let sharp = noise.ln_sd < SHARP;
    noise.own_width =
        if sharp { (2.0 * core::f64::consts::PI).sqrt() * noise.ln_sd } else { LN_GRID };
    let centre = if sharp { ln_alone } else { own };
    let height = |ln: f64, start: Option<f64>| -> Option<(f64, f64)> {
        let here = dwells(ln.exp());
        let mut surface = Surface::new(&here);
        let x = surface.best_total(share, start)?;
        let total = surface.total(x);
        Some((surface.at(total, share)?.ln_integral, x))
    };
    let mut best = height(own, noise.start)?.0;
    let mut looked_at = Vec::new();
    for k in GRID {
        let ln = centre + LN_GRID * f64::from(k);
        // What lies within the summit's own width is counted there.
        let covered = if sharp { 0.5 * LN_GRID } else { 0.1 * LN_GRID };
        if (ln - own).abs() < covered || !(SMALLEST_SIGMA.ln()..LARGEST_SIGMA.ln()).contains(&ln) {
            continue;
        }
        // From scratch: the best scatter may be far from that of the summit.
        let (ln_integral, start) = height(ln, None)?;
        best = best.max(ln_integral);
        looked_at.push((ln_integral, Possible { sigma: ln.exp(), width: LN_GRID, start }));
    }
    noise.others = looked_at.into_iter().filter(|(h, _)| *h > best - OUT).map(|(_, p)| p).collect();
    Some(())
}

#[cfg(test)]
mod tests {
    use rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::super::cells::Cells;
    use super::*;
    use crate::{CodeHistogram, ConverterEnds, Quantizer};

    /// Sixty dwells at levels that nobody knows.
    fn materials(sigma: f64, seed: u64) -> Materials {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
        let dwell = |j: i32| {
            let level = 100.0 + f64::from(j) * 0.618_033_988 * 7.0;
            let mut h = CodeHistogram::default();
            for _ in 0..1500 {
                let z: f64 = StandardNormal.sample(&mut rng);
                Quantizer::Truncate.code(level + sigma * z).into_iter().for_each(|c| h.record(c));
            }
            Material::Codes(Cells::of(&h, Quantizer::Truncate, &ConverterEnds::default()))
        };
        Materials {
            dwells: (0..60).map(dwell).collect(),
            sigma_start: 2.0 * sigma,
            sigma_is_known: false,
            noise_dof: 60.0 * 1499.0,
            inflation: 1.0,
        }
    }

    /// `ln ∫ e^ℓ dμ` by the trapezoidal rule.
    fn by_summing(cells: &Cells, sigma: f64) -> f64 {
        let (lo, hi) = cells.extent();
        let (n, a, b) = (20_000, lo - 1.0, hi + 1.0);
        let h = (b - a) / f64::from(n);
        let values: Vec<f64> =
            (0..=n).map(|i| cells.jet(a + h * f64::from(i), sigma, 1.0).value).collect();
        let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        top + (values.iter().map(|v| (v - top).exp()).sum::<f64>() * h).ln()
    }

    #[test]
    fn curves_keep_their_integrals_for_any_noise() {
        for sigma in [0.03, 0.06, 0.08, 0.09, 0.1, 0.13, 0.2] {
            let (mut ours, mut theirs) = (0.0, 0.0);
            for m in &materials(0.1, 1).dwells {
                let Material::Codes(cells) = m else { panic!("codes were made") };
                let e = Evidence::of(cells, sigma, 1.0);
                let wide: f64 = 1e4;
                ours += e.marginal(e.centre(), wide).value
                    + 0.5 * (2.0 * core::f64::consts::PI * wide).ln();
                theirs += by_summing(cells, sigma);
            }
            // Two thousandths a dwell: what is taken for a Gaussian may be off by that.
            assert!((ours - theirs).abs() < 0.12, "{sigma}: {ours} {theirs}");
        }
    }

    #[test]
    fn dwells_alone_find_the_noise() {
        for sigma in [0.05, 0.1, 0.3, 0.6] {
            let off: Vec<f64> = (0..8)
                .map(|seed| {
                    let (ln, curvature) = from_dwells_alone(&materials(sigma, seed)).unwrap();
                    (ln - sigma.ln()) / deviation(curvature)
                })
                .collect();
            let mean = off.iter().sum::<f64>() / 8.0;
            assert!(mean.abs() < 1.5, "σ {sigma}: off by {off:?} standard deviations");
            assert!(off.iter().all(|x| x.abs() < 4.0), "σ {sigma}: {off:?}");
        }
    }
}

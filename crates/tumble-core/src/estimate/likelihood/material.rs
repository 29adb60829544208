//! What each dwell brings to the likelihood, and the noise that all dwells of a run share.

use super::cells::Cells;
use super::evidence::Evidence;
use crate::estimate::Setting;
use crate::{Code, Position, Quantizer, Readings, ValueMoments};

/// Noise (LSB) from which averages lose nothing to the likelihood of single codes: what quantization leaves in a mean
/// is `e^{−2π²σ²}/π` = 5e-6 LSB there.
const DITHERED_LSB: f64 = 0.75;

/// What one dwell brings.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Material {
    /// Codes as intervals.
    Codes(Cells),
    /// A mean that stands for the analogue level: everything else about it is its variance.
    Mean {
        /// Level, LSB.
        centre: f64,
        /// Variance of the mean, LSB².
        variance: f64,
    },
}

/// A run's dwells, read for the likelihood.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Materials {
    /// In the order of the positions.
    pub dwells: Vec<Material>,
    /// `σ` to start from, LSB.
    pub sigma_start: f64,
    /// Whether `σ` stands already: real numbers, or codes that noise dithers.
    pub sigma_is_known: bool,
    /// Degrees of freedom behind a `σ` that comes from the codes' variance.
    pub noise_dof: f64,
    /// `f ≥ 1`: variance of a dwell's mean over that of as many independent samples.
    pub inflation: f64,
}

impl Material {
    /// The dwell's curve for a given noise.
    pub fn evidence(&self, sigma: f64, inflation: f64) -> Evidence {
        match self {
            Self::Codes(cells) => Evidence::of(cells, sigma, inflation),
            Self::Mean { centre, variance } => {
                Evidence::Gaussian { centre: *centre, variance: *variance, ln_integral: 0.0 }
            }
        }
    }
}

/// One dwell's plain figures.
struct Plain {
    mean: f64,
    samples: f64,
    /// n − 1.
    variance: Option<f64>,
    /// Clear of code zero of a truncating converter, and of the converter's ends.
    clear: bool,
}

impl Materials {
    /// Reads the positions of a run.
    pub fn of(positions: &[&Position], setting: &Setting<'_>) -> Self {
        let plain: Vec<Plain> = positions.iter().map(|p| plain(&p.readings, setting)).collect();
        let inflation = inflation(positions);
        let quantized = setting.quantizer != Quantizer::None;
        let clear = pooled_variance(&plain, true);
        let pooled = clear.or_else(|| pooled_variance(&plain, false));
        let (code_variance, noise_dof) = pooled.unwrap_or((0.0, 0.0));
        let sheppard = if quantized { 1.0 / 12.0 } else { 0.0 };
        let sigma = (code_variance - sheppard).max(0.0).sqrt();
        let loud = !quantized || sigma >= DITHERED_LSB;
        // One sample a dwell, or averages alone: nothing tells noise from scatter, so all of it is scatter.
        let silent = quantized && pooled.is_none();
        let dwells: Vec<Material> = positions
            .iter()
            .zip(&plain)
            .map(|(p, own)| match &p.readings {
                Readings::Codes { histogram, .. } if !(loud && own.clear) => {
                    Material::Codes(Cells::of(histogram, setting.quantizer, &setting.ends))
                }
                Readings::Averaged { .. } if quantized && !loud && own.is_of_few_codes(silent) => {
                    Material::Codes(rebuilt_cells(own, setting))
                }
                _ => mean_material(
                    own,
                    own.code_variance(code_variance),
                    sigma,
                    inflation,
                    setting.quantizer,
                ),
            })
            .collect();
        let any_codes = dwells.iter().any(|d| matches!(d, Material::Codes(_)));
        // Where no dwell is clear of code zero and of the ends, their variance is no measure of the noise.
        let sigma_is_known = silent || !any_codes || (loud && clear.is_some());
        let sigma_start = match (silent, loud) {
            (true, _) => SMALLEST_SIGMA,
            (_, true) => sigma,
            _ => quiet_sigma(code_variance),
        };
        Self { dwells, sigma_start, sigma_is_known, noise_dof, inflation }
    }
}

/// Standard errors by which a dwell's own variance must differ from the pooled one to be believed.
const OWN_VARIANCE_FROM: f64 = 4.0;

impl Plain {
    /// Variance of this dwell's samples: the pooled one, unless the dwell is clearly louder or quieter.
    fn code_variance(&self, pooled: f64) -> f64 {
        match self.variance {
            Some(own) if own > 0.0 && pooled > 0.0 => {
                let error = (2.0 / (self.samples - 1.0)).sqrt();
                if (own / pooled).ln().abs() > OWN_VARIANCE_FROM * error { own } else { pooled }
            }
            _ => pooled,
        }
    }

    /// Whether an average is taken apart into its codes. Where nothing is known of the noise, only a whole number is:
    /// one code, or as good as one.
    fn is_of_few_codes(&self, silent: bool) -> bool {
        !silent || (self.mean - self.mean.round()).abs() < 1e-9
    }
}

fn plain(readings: &Readings, setting: &Setting<'_>) -> Plain {
    let mean = readings.mean().unwrap_or(0.0);
    let std = readings.std();
    let away =
        setting.quantizer != Quantizer::Truncate || mean.abs() > 1.5 + 5.0 * std.unwrap_or(0.0);
    Plain {
        mean,
        samples: readings.samples().max(1) as f64,
        variance: std.map(|s| s * s),
        clear: away && readings.censored(&setting.ends) == 0,
    }
}

/// Variance within dwells over all of them, with its degrees of freedom.
fn pooled_variance(plain: &[Plain], clear_only: bool) -> Option<(f64, f64)> {
    let (sum, dof) = plain
        .iter()
        .filter(|p| p.clear || !clear_only)
        .filter_map(|p| p.variance.map(|v| ((p.samples - 1.0) * v, p.samples - 1.0)))
        .fold((0.0, 0.0), |(s, n), (a, b)| (s + a, n + b));
    (dof > 0.0).then(|| (sum / dof, dof))
}

/// Inverse of the codes' variance over all phases, roughly: `σ/√π` when quiet, `σ² + 1/12` when not.
fn quiet_sigma(code_variance: f64) -> f64 {
    let quiet = code_variance * core::f64::consts::PI.sqrt();
    let loud = (code_variance - 1.0 / 12.0).max(0.0).sqrt();
    if quiet < 0.3 { quiet.max(SMALLEST_SIGMA) } else { loud.max(0.3) }
}

/// Least noise that is distinguished, LSB: below, codes change at edges that are sharp for all purposes.
pub(super) const SMALLEST_SIGMA: f64 = 0.002;

fn mean_material(
    own: &Plain,
    code_variance: f64,
    sigma: f64,
    inflation: f64,
    quantizer: Quantizer,
) -> Material {
    let variance = inflation * code_variance / own.samples;
    if quantizer == Quantizer::Truncate && !own.clear && sigma > 0.0 {
        let (centre, steepness) = truncated_level(own.mean, sigma);
        return Material::Mean { centre, variance: variance / (steepness * steepness) };
    }
    Material::Mean { centre: quantizer.analogue_lsb(own.mean), variance }
}

/// The level whose codes have a given mean, `E[Q(x)] = N̂` for a truncating converter, and the slope of that mean.
fn truncated_level(mean: f64, sigma: f64) -> (f64, f64) {
    let mut level = mean + 0.5 * crate::stats::normal_cdf(mean / sigma).mul_add(2.0, -1.0);
    let mut steepness = 1.0;
    for _ in 0..50 {
        let value = truncated_mean(level, sigma);
        let h = 1e-4 * sigma;
        steepness = ((truncated_mean(level + h, sigma) - truncated_mean(level - h, sigma))
            / (2.0 * h))
            .max(1e-3);
        let step = (mean - value) / steepness;
        level += step.clamp(-sigma, sigma);
        if step.abs() < 1e-12 * (1.0 + level.abs()) {
            break;
        }
    }
    (level, steepness)
}

/// `E[trunc(x)]` for `x ~ N(μ, σ²)`.
fn truncated_mean(level: f64, sigma: f64) -> f64 {
    use crate::stats::normal_cdf;
    if sigma > 3.0 {
        // Euler and Maclaurin: what the sum over codes and the integral differ by cancels between both signs.
        return level - 0.5 * (2.0 * normal_cdf(level / sigma) - 1.0);
    }
    let reach = (level.abs() + 9.0 * sigma).ceil() as i32 + 1;
    (1..=reach)
        .map(|k| {
            let k = f64::from(k);
            normal_cdf((level - k) / sigma) - normal_cdf((-k - level) / sigma)
        })
        .sum()
}

/// Codes of an averaged dwell in little noise: the three around its mean, in the numbers that give its mean and
/// standard deviation (two, where the deviation is not known).
fn rebuilt_cells(own: &Plain, setting: &Setting<'_>) -> Cells {
    let n = own.samples;
    let below = own.mean.floor();
    let rest = own.mean - below;
    let two = [0.0, 1.0 - rest, rest];
    let (first, shares) = match own.variance {
        Some(v) if v > 0.0 => {
            let middle = own.mean.round();
            let off = own.mean - middle;
            // p₊ − p₋ = off, p₊ + p₋ = E(n − middle)².
            let square = (v * (n - 1.0) / n + off * off).min(1.0);
            let (up, down) = (0.5 * (square + off), 0.5 * (square - off));
            if up >= 0.0 && down >= 0.0 {
                (middle - 1.0, [down, 1.0 - up - down, up])
            } else {
                (below - 1.0, two)
            }
        }
        _ => (below - 1.0, two),
    };
    let counts: Vec<(Code, f64)> = shares
        .iter()
        .enumerate()
        .map(|(i, share)| (Code((first + i as f64) as i32), share * n))
        // Rounded figures leave crumbs that are no sample.
        .filter(|(_, count)| *count > 0.3)
        .collect();
    Cells::of_counts(&counts, setting.quantizer, &setting.ends)
}

/// How much worse a dwell's mean is than independent samples would make it, from block means pooled over the run.
///
/// One where that is not significant (two standard errors): the estimate itself scatters.
fn inflation(positions: &[&Position]) -> f64 {
    let (mut seen, mut white, mut variance) = (0.0, 0.0, 0.0);
    for p in positions {
        let (blocks, unit) = match &p.readings {
            Readings::Codes { blocks, .. } => (blocks, 1.0),
            Readings::Values { blocks, .. } => (blocks, ValueMoments::RESOLUTION.powi(2)),
            Readings::Averaged { .. } => continue,
        };
        let (Some(of_mean), Some(std)) = (blocks.variance_of_mean(), p.readings.std()) else {
            continue;
        };
        let independent = std * std / p.readings.samples() as f64;
        seen += of_mean * unit;
        white += independent;
        variance += 2.0 * independent * independent / (blocks.means().len() as f64 - 1.0);
    }
    if white <= 0.0 {
        return 1.0;
    }
    let ratio = seen / white;
    if ratio - 1.0 > 2.0 * variance.sqrt() / white { ratio } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_truncated_codes_is_inverted() {
        for sigma in [0.8, 1.25, 2.9, 3.1, 40.0] {
            for level in [-3.0 * sigma, -0.4, 0.0, 0.3, 1.0, 2.2 * sigma] {
                let (back, steepness) = truncated_level(truncated_mean(level, sigma), sigma);
                assert!((back - level).abs() < 1e-9, "{level} {sigma}: {back}");
                assert!(steepness > 0.5 && steepness < 1.2);
            }
        }
        // Both formulas meet where one takes over.
        assert!((truncated_mean(0.7, 3.0) - truncated_mean(0.7, 3.000_001)).abs() < 1e-5);
    }

    #[test]
    fn averages_of_few_codes_are_told_apart_again() {
        let bench = crate::Bench {
            gravity: crate::Gravity {
                value_m_s2: 9.81,
                standard_uncertainty_m_s2: 0.0,
                source: crate::GravitySource::Stated,
            },
            angle_uncertainty: None,
            range: None,
            vertical_lean: crate::Angle::from_rad(0.0),
            systematics: crate::systematic::Systematics::default(),
        };
        let setting = Setting {
            bench: &bench,
            quantizer: Quantizer::Floor,
            ends: crate::ConverterEnds::default(),
            nominal_scale_m_s2_per_lsb: 0.01,
        };
        let mut h = crate::CodeHistogram::default();
        [(41, 30), (42, 900), (43, 70)].iter().for_each(|(n, k)| h.record_many(Code(*n), *k));
        let own = Plain {
            mean: h.mean().unwrap(),
            samples: 1000.0,
            variance: h.std().map(|s| s * s),
            clear: true,
        };
        let rebuilt = rebuilt_cells(&own, &setting);
        let direct = Cells::of(&h, Quantizer::Floor, &setting.ends);
        for (a, b) in rebuilt.cells.iter().zip(&direct.cells) {
            assert!(
                (a.count - b.count).abs() < 1e-6 && a.lo == b.lo && a.hi == b.hi,
                "{a:?} {b:?}"
            );
        }
    }
}

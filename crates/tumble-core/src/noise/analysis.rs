//! From the variances of a record to what they say: bands, coefficients, converter, the dwell that serves best.

use super::record::{Look, Pooled};
use super::{
    Coefficients, Deviation, NoiseError, NoiseFit, NoiseKind, NoiseRecord, Times, Variance, band,
    degrees_of_freedom, fit, unfiltered,
};

/// What is asked of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseOptions {
    /// Distance of the readings, s.
    pub interval_s: f64,
    /// What a unit of the readings is in the unit of the results (m/s² per LSB); 1 where the results stay in it.
    pub scale: f64,
    /// Level of the bands of the curves. 68.3 % is the custom of this field.
    pub level: f64,
    /// Level of the intervals of the coefficients.
    pub fit_level: f64,
    /// Step of the converter in readings where it is known; else whole readings are codes.
    pub step: Option<f64>,
}

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoisePoint {
    /// Averaging factor, time, number of differences, variance.
    pub variance: Variance,
    /// Kind of noise there.
    pub kind: Option<NoiseKind>,
    /// The kind was taken from the last shorter time that shows one: fewer than 30 averages are left.
    pub kind_is_carried: bool,
    /// Equivalent degrees of freedom.
    pub edf: Option<f64>,
    /// Band of the deviation.
    pub band: Option<[f64; 2]>,
}

/// A deviation against the averaging time.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseCurve {
    /// Which.
    pub deviation: Deviation,
    /// Its points, in order of time.
    pub points: Vec<NoisePoint>,
}

/// What the converter alone does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConverterFloor {
    /// Step `q`, in the unit of the results.
    pub step: f64,
    /// `q/√12`: rounding as noise of single readings.
    pub of_a_reading: f64,
    /// `q/√12·√τ0`: the N that rounding alone gives, where noise spreads the readings over several steps.
    pub n: f64,
    /// Noise of single readings over the step, from neighbours.
    pub noise_in_steps: f64,
    /// Whether noise spreads the readings enough: half a step. Else averages follow the steps, not the sensor.
    pub dithered: bool,
}

/// The averaging time, and dwell, that serves best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BestDwell {
    /// Shortest time whose deviation is within a tenth of the least.
    pub tau_s: f64,
    /// Deviation there.
    pub deviation: f64,
    /// The least deviation, and its time.
    pub least: f64,
    /// See above.
    pub least_tau_s: f64,
    /// Part of the fitted variance at the best time, Q, N, B, K, R.
    pub shares: Option<[f64; 5]>,
    /// The least deviation is that of the longest time: the record is too short to show where longer dwells stop to gain.
    pub still_falling: bool,
}

/// What is worth knowing of a record beside its curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoiseRemark {
    /// One value for longer than chance allows.
    Stuck {
        /// First reading of the run, counted from one.
        from: u64,
        /// Readings.
        readings: u64,
        /// The value, as read.
        value: f64,
    },
    /// Many readings at an extreme value: the converter's end?
    AtAnEnd {
        /// Readings.
        readings: u64,
        /// The value, as read.
        value: f64,
    },
    /// Noise below half a step: the curve is the converter's.
    Undithered,
    /// The model does not describe the curve.
    PoorFit {
        /// Probability of a `χ²` as large.
        p: f64,
        /// Relative discrepancy of the variances that the intervals allow for.
        discrepancy: f64,
    },
    /// A low-pass filter shapes the curve up to a time; shorter ones are not in the fit.
    Filtered {
        /// The time, s.
        until_s: f64,
    },
    /// No fit: too few points, or a variance of zero.
    NoFit,
}

/// Everything about the noise of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseAnalysis {
    /// Readings.
    pub readings: u64,
    /// Readings of the pieces between gaps.
    pub pieces: Vec<u64>,
    /// Distance of the readings, s.
    pub interval_s: f64,
    /// Mean, in the unit of the results.
    pub mean: f64,
    /// Standard deviation of all readings.
    pub standard_deviation: f64,
    /// Least and greatest reading, as read.
    pub extremes: [f64; 2],
    /// Whether all readings are whole numbers.
    pub whole: bool,
    /// Curves; overlapping Allan is the first.
    pub curves: Vec<NoiseCurve>,
    /// Q, N, B, K, R.
    pub fit: Option<NoiseFit>,
    /// Probability of a `χ²` as large as the fit's.
    pub fit_p: Option<f64>,
    /// The converter.
    pub floor: Option<ConverterFloor>,
    /// The best dwell.
    pub dwell: Option<BestDwell>,
    /// Remarks.
    pub remarks: Vec<NoiseRemark>,
}

/// How far above the least deviation a dwell still serves as well.
const AS_GOOD: f64 = 1.1;
/// Readings of one extreme value that make one think of the converter's end.
const SHARE_AT_END: f64 = 0.01;
/// Fewer are chance: in a short record two or three readings share the extreme value.
const FEWEST_AT_END: u64 = 10;
/// Steps between the extremes from which an end can be told from noise of a few steps.
const STEPS_APART: f64 = 8.0;
/// Noise, in steps, from which rounding is white noise of its own to 1 % (`metrology`: half a step).
const DITHER: f64 = 0.5;
/// Probability below which the model is said not to describe the curve.
const POOR: f64 = 1e-3;

impl NoiseRecord {
    /// Ends the record and judges its variances.
    ///
    /// **Model** pieces between gaps are pooled by their numbers of differences; the degrees of freedom of a pooled
    /// variance are `M²/Σ(M_p²/ν_p)`. The fit takes the pooled variances as those of one record with as many differences.
    ///
    /// **Errors** [`NoiseError::TooShort`], [`NoiseError::Constant`].
    pub fn finish(mut self, options: &NoiseOptions) -> Result<NoiseAnalysis, NoiseError> {
        let pooled = self.end()?;
        let curves: Vec<NoiseCurve> = self
            .deviations()
            .iter()
            .zip(&pooled)
            .map(|(d, rows)| NoiseCurve {
                deviation: *d,
                points: points(*d, rows, &self.pieces, options),
            })
            .filter(|c| !c.points.is_empty())
            .collect();
        let allan: Vec<Variance> = curves.first().map_or(Vec::new(), |c| {
            let octaves = |v: &Variance| self.times != Times::All || v.factor.is_power_of_two();
            c.points.iter().map(|p| p.variance).filter(octaves).collect()
        });
        let (free, filter_s) = unfiltered(&allan);
        let fit = fit(free, options.interval_s, options.fit_level);
        let fit_p = fit.as_ref().and_then(|f| {
            crate::stats::chi_squared_p_value(f.chi_squared, f.degrees_of_freedom as f64)
        });
        let floor = floor(&self.look, &allan, options);
        let dwell = best_dwell(&allan, fit.as_ref());
        let mut remarks = remarks(&self.look, floor.as_ref(), fit.as_ref(), fit_p);
        remarks.extend(filter_s.map(|until_s| NoiseRemark::Filtered { until_s }));
        // Below it the deviation is small because the filter holds the readings together.
        let dwell = best_dwell(free, fit.as_ref()).or(dwell);
        Ok(NoiseAnalysis {
            readings: self.look.count,
            interval_s: options.interval_s,
            mean: self.look.mean * options.scale,
            standard_deviation: self.look.standard_deviation() * options.scale,
            extremes: [self.look.least, self.look.greatest],
            whole: self.look.whole,
            pieces: self.pieces,
            curves,
            fit,
            fit_p,
            floor,
            dwell,
            remarks,
        })
    }
}

/// Points with bands, in the unit of the results.
fn points(d: Deviation, rows: &[Pooled], pieces: &[u64], o: &NoiseOptions) -> Vec<NoisePoint> {
    let mut last = None;
    rows.iter()
        .map(|row| {
            let v = Variance {
                tau_s: row.variance.factor as f64 * o.interval_s,
                variance: row.variance.variance * o.scale * o.scale,
                ..row.variance
            };
            last = row.kind.or(last);
            let edf = last.and_then(|kind| pooled_edf(d, kind, pieces, v.factor));
            let band = edf.and_then(|edf| band(v.variance.sqrt(), edf, o.level));
            let kind_is_carried = row.kind.is_none() && last.is_some();
            NoisePoint { variance: v, kind: last, kind_is_carried, edf, band }
        })
        .collect()
}

/// `M²/Σ(M_p²/ν_p)` over the pieces that are long enough.
fn pooled_edf(d: Deviation, kind: NoiseKind, pieces: &[u64], factor: usize) -> Option<f64> {
    let (mut terms, mut spread) = (0.0, 0.0);
    for piece in pieces {
        let points = *piece as usize + 1;
        let own = d.terms(points, factor) as f64;
        if own > 0.0 {
            terms += own;
            spread += own * own / degrees_of_freedom(d, kind, points, factor, 1)?;
        }
    }
    (spread > 0.0).then(|| terms * terms / spread)
}

fn floor(look: &Look, allan: &[Variance], o: &NoiseOptions) -> Option<ConverterFloor> {
    let step = match o.step {
        Some(step) => step,
        None if look.whole => 1.0,
        None => return None,
    } * o.scale;
    let of_a_reading = step / 12f64.sqrt();
    let shortest = allan.first().filter(|v| v.factor == 1)?;
    let noise_in_steps = shortest.variance.sqrt() / step;
    Some(ConverterFloor {
        step,
        of_a_reading,
        n: of_a_reading * o.interval_s.sqrt(),
        noise_in_steps,
        dithered: noise_in_steps >= DITHER,
    })
}

/// **Model** on the measured curve: the shortest time whose deviation is at most 1.1 of the least.
fn best_dwell(allan: &[Variance], fit: Option<&NoiseFit>) -> Option<BestDwell> {
    let least = allan.iter().min_by(|a, b| a.variance.total_cmp(&b.variance))?;
    let enough = least.variance * AS_GOOD * AS_GOOD;
    let best = allan.iter().find(|v| v.variance <= enough)?;
    let shares = fit.map(|f| {
        let parts = f.squares.parts(best.tau_s);
        let sum: f64 = parts.iter().sum();
        parts.map(|p| p / sum)
    });
    Some(BestDwell {
        tau_s: best.tau_s,
        deviation: best.variance.sqrt(),
        least: least.variance.sqrt(),
        least_tau_s: least.tau_s,
        shares,
        still_falling: allan.last().is_some_and(|v| v.factor == best.factor),
    })
}

fn remarks(
    look: &Look,
    floor: Option<&ConverterFloor>,
    fit: Option<&NoiseFit>,
    fit_p: Option<f64>,
) -> Vec<NoiseRemark> {
    let mut out = Vec::new();
    if look.is_stuck() {
        let (readings, from) = look.longest_run;
        out.push(NoiseRemark::Stuck { from, readings, value: look.longest_value });
    }
    // In codes; elsewhere a step is not known, and any value may be rare.
    if look.whole && look.greatest - look.least >= STEPS_APART {
        let ends = [(look.at_least, look.least), (look.at_greatest, look.greatest)];
        for (readings, value) in ends {
            if readings >= FEWEST_AT_END && readings as f64 > SHARE_AT_END * look.count as f64 {
                out.push(NoiseRemark::AtAnEnd { readings, value });
            }
        }
    }
    if floor.is_some_and(|f| !f.dithered) {
        out.push(NoiseRemark::Undithered);
    }
    match (fit, fit_p) {
        (None, _) => out.push(NoiseRemark::NoFit),
        (Some(fit), Some(p)) if p < POOR => {
            out.push(NoiseRemark::PoorFit { p, discrepancy: fit.discrepancy });
        }
        _ => {}
    }
    out
}

impl ConverterFloor {
    /// Allan deviation of the rounding alone at an averaging time, where noise spreads the readings over steps.
    #[must_use]
    pub fn at(&self, tau_s: f64) -> f64 {
        self.n / tau_s.sqrt()
    }
}

/// A coefficient in another unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheetUnit {
    /// Place in Q, N, B, K, R.
    pub coefficient: usize,
    /// What a value in SI is multiplied by.
    pub factor: f64,
    /// Unit.
    pub unit: &'static str,
    /// What is meant, where it is not the coefficient itself.
    pub meaning: &'static str,
}

/// Micro-gn in m/s².
const MICRO_G: f64 = 1e-6 * crate::STANDARD_GRAVITY_M_S2;
/// √3600: seconds to hours under a root.
const ROOT_HOUR: f64 = 60.0;

/// Units that data sheets use, for coefficients in m/s² and s. A sheet's noise density is one-sided: `n = √2 N`.
pub const SHEET_UNITS: [SheetUnit; 8] = [
    SheetUnit {
        coefficient: 1,
        factor: core::f64::consts::SQRT_2 / MICRO_G,
        unit: "ug/rtHz",
        meaning: "one-sided noise density n = sqrt(2) N",
    },
    SheetUnit { coefficient: 1, factor: 1.0 / MICRO_G, unit: "ug rts", meaning: "" },
    SheetUnit {
        coefficient: 1,
        factor: ROOT_HOUR,
        unit: "m/s/rth",
        meaning: "velocity random walk",
    },
    SheetUnit { coefficient: 2, factor: 1.0 / MICRO_G, unit: "ug", meaning: "" },
    SheetUnit {
        coefficient: 2,
        // √(2 ln2/π)
        factor: 0.664_281_626_951_352_7 / MICRO_G,
        unit: "ug",
        meaning: "bottom of the curve, 0.664 B: what many sheets call bias instability",
    },
    SheetUnit { coefficient: 3, factor: 1.0 / MICRO_G, unit: "ug/rts", meaning: "" },
    SheetUnit { coefficient: 3, factor: ROOT_HOUR / MICRO_G, unit: "ug/rth", meaning: "" },
    SheetUnit { coefficient: 4, factor: 3600.0 / MICRO_G, unit: "ug/h", meaning: "" },
];

impl SheetUnit {
    /// A value in SI in this unit.
    #[must_use]
    pub fn of(&self, si: f64) -> f64 {
        si * self.factor
    }
}

impl NoiseFit {
    /// The fitted deviation at times spread evenly on a logarithmic scale, with what each coefficient adds to it.
    #[must_use]
    pub fn curve(&self, from_s: f64, to_s: f64, count: usize) -> Vec<(f64, f64, [f64; 5])> {
        let steps = count.max(2) - 1;
        let at = |k: usize| from_s * (to_s / from_s).powf(k as f64 / steps as f64);
        (0..=steps)
            .map(|k| {
                let parts = self.squares.parts(at(k));
                (at(k), parts.iter().sum::<f64>().sqrt(), parts.map(f64::sqrt))
            })
            .collect()
    }
}

impl Coefficients {
    /// What each coefficient adds to `σ²(τ)`.
    #[must_use]
    pub fn parts(&self, tau_s: f64) -> [f64; 5] {
        let (f, c) = (super::model::columns(tau_s), self.in_order());
        core::array::from_fn(|i| f[i] * c[i])
    }
}

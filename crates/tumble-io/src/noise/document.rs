//! The document `tumble-noise/1`. Within `/1` fields are only added.

use serde::{Deserialize, Serialize};

/// Everything that is said about the noise of a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NoiseDocument {
    /// `tumble-noise/1`.
    pub schema: String,
    /// The file.
    pub input: NoiseInput,
    /// Unit of all results: `m/s2`, `LSB` (whole readings), or `unit` (readings that are not whole).
    pub unit: String,
    /// What a unit of the readings was taken for; absent where results stay in it.
    pub scale: Option<NoiseScale>,
    /// Mean of the readings.
    pub mean: f64,
    /// Standard deviation of all readings.
    pub standard_deviation: f64,
    /// Least and greatest reading, as read.
    pub extremes: [f64; 2],
    /// Level of the bands.
    pub level: f64,
    /// Curves; the first is the overlapping Allan deviation.
    pub curves: Vec<CurveEntry>,
    /// Coefficients; absent where there was nothing to fit.
    pub fit: Option<FitEntry>,
    /// What the converter alone does; absent where its step is not known.
    pub converter: Option<ConverterEntry>,
    /// The best dwell.
    pub dwell: Option<DwellEntry>,
    /// What else is worth knowing.
    pub remarks: Vec<String>,
    /// The program.
    pub software: NoiseSoftware,
}

/// The file and what was read of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NoiseInput {
    /// As it was named.
    pub file: String,
    /// Digest as it is stored.
    pub sha256: String,
    /// Column of the readings; absent for bare numbers.
    pub column: Option<String>,
    /// Readings.
    pub readings: u64,
    /// Readings a second.
    pub rate_hz: f64,
    /// `rate` (given) or `times`.
    pub rate_from: String,
    /// Column of the times; absent where they are not used.
    #[serde(default)]
    pub time_column: Option<String>,
    /// Standard deviation of the steps of time over the step; absent without times.
    pub jitter: Option<f64>,
    /// Readings of the pieces between gaps.
    pub pieces: Vec<u64>,
    /// Readings that times show to be missing.
    pub missing: u64,
    /// Rows without a reading.
    pub rows_without_reading: u64,
}

/// What a unit of the readings was taken for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NoiseScale {
    /// m/s² a unit.
    pub m_s2_per_unit: f64,
    /// Who says so.
    pub source: String,
}

/// A deviation against the averaging time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurveEntry {
    /// `oadev`, `mdev`, `hdev`, `totdev` or `adev`.
    pub deviation: String,
    /// Its points.
    pub points: Vec<PointEntry>,
}

/// A point of a curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointEntry {
    /// Averaging time, s.
    pub tau_s: f64,
    /// Readings averaged.
    pub factor: u64,
    /// Number of differences.
    pub terms: u64,
    /// The deviation.
    pub deviation: f64,
    /// Kind of noise: `random walk`, `flicker`, `white`, `flicker of the velocity`, `white velocity`.
    pub kind: Option<String>,
    /// The kind is that of a shorter time.
    pub kind_is_carried: bool,
    /// Equivalent degrees of freedom.
    pub edf: Option<f64>,
    /// Band at [`NoiseDocument::level`].
    pub band: Option<[f64; 2]>,
}

/// The fitted model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FitEntry {
    /// Level of the intervals.
    pub level: f64,
    /// Q, N, B, K, R.
    pub coefficients: Vec<CoefficientEntry>,
    /// `χ²` about the model.
    pub chi_squared: f64,
    /// Relative discrepancy of the variances from the model that the intervals allow for; zero where `χ²` may be chance.
    pub discrepancy: f64,
    /// Variances less coefficients.
    pub degrees_of_freedom: u64,
    /// Probability of a `χ²` as large.
    pub p: Option<f64>,
    /// The fitted curve.
    pub curve: Vec<ModelEntry>,
}

/// A coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoefficientEntry {
    /// `Q`, `N`, `B`, `K` or `R`.
    pub symbol: String,
    /// In words.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Value; zero where the fit is best without it.
    pub value: f64,
    /// Standard uncertainty; absent at zero.
    pub standard_uncertainty: Option<f64>,
    /// Interval; an upper end that is absent is not bounded.
    pub interval: (f64, Option<f64>),
    /// The same in units of data sheets; empty without a scale.
    pub sheet: Vec<SheetEntry>,
}

/// A coefficient in a unit of data sheets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SheetEntry {
    /// Unit.
    pub unit: String,
    /// What is meant, where it is not the coefficient itself.
    pub meaning: String,
    /// Value.
    pub value: f64,
    /// Interval.
    pub interval: (f64, Option<f64>),
}

/// A point of the fitted curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelEntry {
    /// Averaging time, s.
    pub tau_s: f64,
    /// Deviation.
    pub deviation: f64,
    /// What Q, N, B, K, R alone would give.
    pub parts: [f64; 5],
}

/// The converter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConverterEntry {
    /// Its step.
    pub step: f64,
    /// `q/√12`.
    pub of_a_reading: f64,
    /// `q/√12·√τ0`: the N of rounding alone.
    pub n: f64,
    /// Noise of single readings over the step.
    pub noise_in_steps: f64,
    /// Whether noise spreads the readings over steps.
    pub dithered: bool,
    /// Time and deviation of rounding alone, at the shortest and the longest time; empty where noise does not spread the
    /// readings.
    #[serde(default)]
    pub line: Vec<[f64; 2]>,
}

/// The best dwell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DwellEntry {
    /// Shortest averaging time whose deviation is within a tenth of the least.
    pub tau_s: f64,
    /// Deviation there.
    pub deviation: f64,
    /// The least deviation.
    pub least: f64,
    /// Its time.
    pub least_tau_s: f64,
    /// Parts of the fitted variance there, Q, N, B, K, R.
    pub shares: Option<[f64; 5]>,
    /// The record is too short to show where longer dwells stop to gain.
    pub still_falling: bool,
    /// Why, for people.
    pub why: String,
}

/// The program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct NoiseSoftware {
    /// Name.
    pub name: String,
    /// Version.
    pub version: String,
    /// Formula of the degrees of freedom.
    pub edf: String,
}

impl NoiseDocument {
    /// As JSON, with a line end.
    ///
    /// **Errors** what the serializer says; numbers that are not finite do not occur.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|json| json + "\n")
    }
}

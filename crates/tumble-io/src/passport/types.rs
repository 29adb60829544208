//! Shapes of `passport.json`. What a field means is written in `docs/passport.md`.
//!
//! Past 500 lines: one wire format, read from top to bottom beside its schema.
#![allow(missing_docs)] // Field names are the documentation of the schema; see docs/passport.md.

use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Passport {
    pub schema: String,
    #[serde(default)]
    pub id: String,
    #[serde(default)]
    pub issued: Option<String>,
    pub verdict: String,
    #[serde(default)]
    pub reasons: Vec<String>,
    #[serde(default)]
    pub missing: Vec<String>,
    pub conformity: Conformity,
    pub sensor: Sensor,
    pub output: Output,
    pub bench: Bench,
    pub method: String,
    pub nominal_scale_m_s2_per_lsb: f64,
    pub nominal_scale_source: String,
    pub validity: Validity,
    pub parameters: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result: Option<ResultSection>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compensation: Option<Compensation>,
    pub runs: Vec<Run>,
    pub error_level_lsb: Option<ErrorLevel>,
    #[serde(default)]
    pub structure: Option<Structure>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub terms: Vec<Term>,
    #[serde(default)]
    pub influence: Influence,
    /// Positions that do not belong, and those left out on request.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outliers: Vec<Outlier>,
    /// The result with and without what was left out on request.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out_comparison: Vec<LeftOutComparison>,
    #[serde(default)]
    pub budget: Vec<BudgetLine>,
    #[serde(default)]
    pub findings: Vec<Finding>,
    #[serde(default)]
    pub inputs: Vec<Input>,
    pub options: Options,
    pub software: Software,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Conformity {
    pub status: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specification: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rule: Option<String>,
    /// In multiples of U.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guard_band: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statement: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<ParameterConformity>,
}

/// One quantity against its limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterConformity {
    pub parameter: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mounting: Option<String>,
    pub unit: String,
    pub value: f64,
    pub standard_uncertainty: f64,
    pub expanded_uncertainty: f64,
    /// `null`: infinite.
    pub degrees_of_freedom: Option<f64>,
    /// Lower and upper; `null`: open.
    pub limits: [Option<f64>; 2],
    /// `null`: the guard bands leave no room.
    pub acceptance_limits: Option<[Option<f64>; 2]>,
    pub status: String,
    pub probability_of_conformity: f64,
    /// `null`: not assessed.
    pub risk: Option<f64>,
    pub distribution: String,
    pub worst_case_risk: WorstCaseRisk,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub test_uncertainty_ratio: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub production: Option<Production>,
}

/// Largest specific risks of the rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstCaseRisk {
    /// `null`: nothing could pass.
    pub consumer: Option<f64>,
    pub producer: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conditional: Option<f64>,
}

/// Global risks over a production with a stated spread.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Production {
    pub mean: f64,
    pub standard_deviation: f64,
    pub global_consumer_risk: f64,
    pub global_producer_risk: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    pub model: String,
    pub serial: String,
    pub axis: String,
    #[serde(default, rename = "type", skip_serializing_if = "Option::is_none")]
    pub kind: Option<SensorType>,
}

/// The catalogue's entry that the unit was held against.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SensorType {
    pub model: String,
    pub catalogue: String,
    pub source: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Output {
    pub quantizer: String,
    pub unit: String,
    pub rate_hz: Option<f64>,
    pub min_code: Option<i32>,
    pub max_code: Option<i32>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bench {
    pub gravity_m_s2: Gravity,
    pub angle_uncertainty_arcmin: Option<f64>,
    pub angle_range_deg: Option<[f64; 2]>,
    pub updown_lean_arcmin: f64,
    /// Errors that no scatter shows, common to all runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub systematics: Vec<Systematic>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature_spread_k: Option<f64>,
}

/// A systematic error as it was stated, or with its default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Systematic {
    pub quantity: String,
    pub standard_uncertainty: f64,
    pub unit: String,
    pub distribution: String,
    pub source: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gravity {
    pub value: f64,
    pub standard_uncertainty: f64,
    #[serde(default)]
    pub source: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Validity {
    pub temperature_degc: Option<[f64; 2]>,
    pub dates: Vec<String>,
}

/// One estimate with the fields that apply to it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    pub value: f64,
    pub unit: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lsb: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_uncertainty: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u_statistical: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u_budget: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expanded_uncertainty: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coverage_factor: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prediction_interval: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prediction_true_interval: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_run_sd: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_runs: Option<BetweenRuns>,
    /// What the runs' intervals have in common: a picture of agreement, never the result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub intersection_of_runs: Option<[f64; 2]>,
    /// The same by drawing all inputs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<MonteCarlo>,
}

/// A value's distribution by Monte Carlo (JCGM 101), and whether it confirms `value ± U`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MonteCarlo {
    pub draws: usize,
    /// Whether the draws stood still before they ran out.
    pub stabilized: bool,
    pub value: f64,
    pub standard_uncertainty: f64,
    /// Probabilistically symmetric.
    pub interval: [f64; 2],
    pub shortest_interval: [f64; 2],
    pub d_low: f64,
    pub d_high: f64,
    pub tolerance: f64,
    /// `d_low` and `d_high` within `tolerance`.
    pub validated: bool,
}

/// Spread between power-ups beyond the runs' own uncertainties.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BetweenRuns {
    /// `null`: no two runs share the parameter.
    pub omega: Option<f64>,
    pub omega_mandel_paule: f64,
    /// The upper end is `null` where the runs set none.
    pub omega_interval: (f64, Option<f64>),
    pub cochran_q: f64,
    pub degrees_of_freedom: f64,
    pub p_value: f64,
    pub i_squared: f64,
}

/// An up/down pair in the joint adjustment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SharedPair {
    pub scale_error: f64,
    pub standard_uncertainty: f64,
    pub lean_correction: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResultSection {
    pub bias: Estimate,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub misalignment: Option<Estimate>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mountings: Vec<Mounting>,
    /// Where reversal tells it from the misalignment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table_zero: Option<Estimate>,
    /// Where a pair entered the joint adjustment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shared_pair: Option<SharedPair>,
    pub scale_error: Estimate,
    pub scale_factor: Estimate,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covariance: Option<[[f64; 3]; 3]>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mounting {
    pub name: String,
    pub misalignment: Estimate,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Compensation {
    pub scale_factor: f64,
    pub bias: f64,
    pub quantizer_offset: String,
    pub valid_range_lsb: [f64; 2],
    /// Of (scale factor, bias).
    pub covariance: [[f64; 2]; 2],
    /// Standard deviation of a single reading within a dwell, LSB.
    #[serde(default)]
    pub reading_std_lsb: Option<f64>,
    /// Further terms of the model; absent without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terms: Option<CompensationTerms>,
    pub example: Example,
}

/// Further terms that a compensation must undo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CompensationTerms {
    pub coefficients: Vec<Coefficient>,
    /// Absent without terms on temperature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_temperature_degc: Option<f64>,
    /// Of (scale factor, bias, coefficients in order).
    pub covariance: Vec<Vec<f64>>,
    /// What a program that ignores the terms is wrong by, at most.
    pub terms_peak_m_s2: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coefficient {
    pub name: String,
    pub value: f64,
    pub unit: String,
}

/// A further term that was tried or named.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Term {
    pub name: String,
    pub entered: bool,
    /// `null`: the plan cannot tell the term from the parameters, or temperatures are missing.
    pub value: Option<f64>,
    pub unit: String,
    pub standard_uncertainty: Option<f64>,
    pub degrees_of_freedom: Option<f64>,
    pub expanded_uncertainty: Option<f64>,
    pub interval: Option<[f64; 2]>,
    pub p_value: Option<f64>,
    /// Of Schwarz' criterion: without the term minus with it.
    pub criterion_difference: Option<f64>,
    pub identifiable: bool,
    pub bound: Option<f64>,
    /// Largest size with which it enters by itself.
    pub plausible: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<String>,
    pub in_usual_unit: UsualUnit,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct UsualUnit {
    pub unit: String,
    pub value: Option<f64>,
    pub expanded_uncertainty: Option<f64>,
    pub bound: Option<f64>,
    pub plausible: f64,
}

/// A further term in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunTerm {
    pub name: String,
    pub value: f64,
    pub unit: String,
    pub standard_uncertainty: Option<f64>,
    pub degrees_of_freedom: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Example {
    pub code: i32,
    pub acceleration_m_s2: f64,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RunEstimates {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bias: Option<Estimate>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub misalignment: Option<Estimate>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale_error: Option<Estimate>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    pub name: String,
    pub mounting: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operator: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    pub positions: usize,
    pub distinct_angles: usize,
    pub estimates: RunEstimates,
    /// Statistical, in the order of `parameters`.
    pub covariance: Option<[[f64; 3]; 3]>,
    /// Further terms, where any were entered.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub terms: Vec<RunTerm>,
    /// Of (parameters, further terms).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub full_covariance: Vec<Vec<f64>>,
    pub residual_std_lsb: Option<f64>,
    pub reading_std_lsb: Option<f64>,
    /// `null`: infinite, a parameter is not determined.
    pub condition_number: Option<f64>,
    /// Absent where the method does not tell noise and scatter apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scatter: Option<Scatter>,
    pub correlations: Vec<Correlation>,
    pub settled_at: Option<usize>,
    pub sequential: Vec<Sequential>,
    pub residuals: Vec<Residual>,
    pub error_level_lsb: Option<RunErrorLevel>,
}

/// A value with its interval, at the level of `options`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ranged {
    pub value: f64,
    pub interval: [f64; 2],
}

/// Noise within dwells and scatter between them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scatter {
    /// `null`: one sample a dwell, nothing tells noise from scatter.
    pub noise_lsb: Option<Ranged>,
    pub noise_is_bound: bool,
    pub level_lsb: Ranged,
    pub angle_arcmin: Ranged,
    pub total_lsb: Ranged,
    pub total_arcmin: Ranged,
    pub correlation: Option<f64>,
    /// `undetermined`, `level`, `angle`, `both`, or `not_asked`.
    pub split: String,
    pub inflation: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Correlation {
    pub between: [String; 2],
    pub value: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sequential {
    pub positions: usize,
    pub bias: f64,
    pub misalignment: f64,
    pub scale_error: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    pub angle_deg: f64,
    pub lsb: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunErrorLevel {
    pub before: f64,
    pub after: f64,
    pub after_held_out: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorLevel {
    pub before: f64,
    pub after: f64,
    pub after_held_out: Option<f64>,
}

/// A curvature left over in the residuals of all runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StructureTerm {
    pub peak_lsb: f64,
    pub p_value: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    pub quadratic: Option<StructureTerm>,
    pub cubic: Option<StructureTerm>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InfluenceTest {
    pub effect: f64,
    pub unit: String,
    pub expanded_uncertainty: f64,
    pub p_value: f64,
    pub smallest_detectable: f64,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Influence {
    /// `null`: no temperature was recorded, or it did not vary within the runs.
    pub temperature: Option<InfluenceTest>,
    /// `null`: the plan cannot tell it from the parameters.
    pub signal_level: Option<InfluenceTest>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BudgetLine {
    pub parameter: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mounting: Option<String>,
    pub quantity: String,
    /// `these data`, `stated`, or the reason of a default; empty in passports of older versions.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    pub standard_uncertainty: f64,
    pub unit: String,
    pub distribution: String,
    /// `null`: infinite.
    pub degrees_of_freedom: Option<f64>,
    pub sensitivity: f64,
    pub contribution: f64,
    pub share: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    pub id: String,
    pub severity: String,
    pub title: String,
    #[serde(rename = "where")]
    pub place: String,
    pub observed: String,
    pub limit: String,
    pub todo: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Input {
    pub file: String,
    pub sha256: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Options {
    pub method: String,
    pub weights: String,
    pub level: f64,
    /// Digits of the uncertainty that the draws were to settle; zero: none were made.
    #[serde(default)]
    pub monte_carlo_digits: u32,
    /// `auto`, `none`, or names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terms: Option<String>,
    pub targets: Targets,
    /// Positions that were left out on request.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
}

/// Positions of a run that were left out on request, by their numbers in measured order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    pub run: String,
    pub positions: Vec<usize>,
}

/// A position that does not belong to its run, or was left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outlier {
    pub run: String,
    pub position: usize,
    pub angle_deg: f64,
    pub residual_lsb: Option<f64>,
    pub studentized: Option<f64>,
    pub p_value: Option<f64>,
    /// Id of the finding that names it; `null`: only the user does.
    pub named_by: Option<String>,
    pub left_out: bool,
    /// Without the position minus with it, on the run.
    pub effect: Option<PerParameter>,
    pub effect_over_u: Option<PerParameter>,
    pub uncertainty_ratio: Option<PerParameter>,
    /// The same on the pooled values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pooled_effect: Option<PerParameter>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pooled_effect_over_u: Option<PerParameter>,
}

/// A number a parameter.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PerParameter {
    pub bias: Option<f64>,
    pub misalignment: Option<f64>,
    pub scale_error: Option<f64>,
}

/// A pooled value with all positions, and as it is reported.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOutComparison {
    pub parameter: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mounting: Option<String>,
    pub with: ValueAndUncertainty,
    pub without: ValueAndUncertainty,
}

/// A value with its expanded uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValueAndUncertainty {
    pub value: f64,
    pub expanded_uncertainty: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Targets {
    pub bias_m_s2: f64,
    pub misalignment_rad: f64,
    pub scale_error: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Software {
    pub name: String,
    pub version: String,
    pub target: String,
}

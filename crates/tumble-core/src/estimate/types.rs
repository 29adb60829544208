//! What goes into an estimation and what comes out.

use super::terms::{Term, TermChoice};
use super::{Stabilization, ToParameters, WeightedRow};
use crate::linalg::Matrix;
use crate::stats::student_factor;

/// The estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Linear in the small unknowns, ordinary least squares (method section 4). The baseline.
    Paper,
    /// Exactly linear in three other unknowns (method section 6): right for any size of error.
    Exact,
    /// Codes within a dwell and scatter between dwells, each by its own likelihood (method section 8). The default.
    Likelihood,
}

/// How positions weigh against each other. Their common size always comes from the residuals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weights {
    /// All the same.
    Equal,
    /// `1/(σ² + ((g/k*) cos(φ+Δφ) σφ)²)`: angle errors count less where the table is steep. [`Method::Likelihood`]
    /// finds both kinds of scatter itself, and takes a stated angle uncertainty as a reason to expect that kind.
    Angle,
    /// The stated angle uncertainty is taken as known; what scatters beyond it is the same at all positions. Only for
    /// [`Method::Likelihood`]; the others take it for [`Weights::Angle`].
    Stated,
}

/// Options of [`super::estimate`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EstimateOptions {
    /// Estimator.
    pub method: Method,
    /// Weights; [`Method::Paper`] is unweighted by definition and ignores them.
    pub weights: Weights,
    /// Level of confidence of intervals.
    pub level: f64,
    /// Significant digits of the uncertainty that Monte Carlo is to settle (JCGM 101, 7.9.2), 1 or 2; zero: no draws, as here by default:
    /// they take longer than all the rest. `tumble certify` asks for two.
    pub monte_carlo_digits: u32,
    /// Further terms of the model. [`Method::Paper`] has none. One run alone takes [`TermChoice::Auto`] for none: the
    /// choice needs all runs.
    pub terms: TermChoice,
}

impl Default for EstimateOptions {
    /// Likelihood, both kinds of scatter, 95 % (JCGM 100: the level for expanded uncertainties), terms as the data ask
    /// for them.
    fn default() -> Self {
        Self {
            method: Method::Likelihood,
            weights: Weights::Angle,
            level: 0.95,
            monte_carlo_digits: 0,
            terms: TermChoice::default(),
        }
    }
}

/// The parameters, in the order of every vector and matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// `Δa`, m/s² (K0 of IEEE 1293).
    Bias,
    /// `Δφ`, rad.
    Misalignment,
    /// `δk`, relative.
    ScaleError,
}

impl Parameter {
    /// In order.
    pub const ALL: [Self; 3] = [Self::Bias, Self::Misalignment, Self::ScaleError];

    /// Name in the passport.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bias => "bias",
            Self::Misalignment => "misalignment",
            Self::ScaleError => "scale_error",
        }
    }

    /// Name for people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::ScaleError => "scale error",
            _ => self.name(),
        }
    }

    /// Unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Bias => "m/s2",
            Self::Misalignment => "rad",
            Self::ScaleError => "1",
        }
    }

    /// An uncertainty of this parameter for people: m/s², mrad or ppm, three digits.
    ///
    /// ```
    /// use tumble_core::estimate::Parameter;
    /// assert_eq!(Parameter::ScaleError.shown(0.02576), "25800 ppm");
    /// assert_eq!(Parameter::Misalignment.shown(0.003), "3.00 mrad");
    /// assert_eq!(Parameter::Bias.shown(0.0347), "0.0347 m/s²");
    /// ```
    #[must_use]
    pub fn shown(self, value: f64) -> String {
        let (factor, unit) = match self {
            Self::Bias => (1.0, "m/s²"),
            Self::Misalignment => (1e3, "mrad"),
            Self::ScaleError => (1e6, "ppm"),
        };
        let v = value * factor;
        let size = v.abs().log10().floor();
        if !(-4.0..=5.0).contains(&size) {
            // Zero, nothing finite, or too large to read without a power of ten.
            return format!("{v:.2e} {unit}");
        }
        let step = 10f64.powf(size - 2.0);
        format!("{:.*} {unit}", (2.0 - size).max(0.0) as usize, (v / step).round() * step)
    }

    /// Index in vectors and matrices.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }
}

/// One position's disagreement with the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Index of the position among those that were used.
    pub position: usize,
    /// Table angle, degrees.
    pub angle_deg: f64,
    /// Measured minus modelled, LSB.
    pub lsb: f64,
    /// Measured minus modelled over the standard deviation that the fit gives it; absent without redundancy.
    pub standardized: Option<f64>,
}

/// A value with the ends of its interval, at the level of [`EstimateOptions`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranged {
    /// Where the restricted likelihood is largest; may stand at the lower bound, zero.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Whether the data tell the two kinds of scatter apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Split {
    /// One kind was fixed or left out.
    NotAsked,
    /// Either kind alone would do: the likelihood-ratio tests reject neither.
    Undetermined,
    /// At least one kind is needed.
    Determined {
        /// `τ0 > 0` at 5 %.
        level: bool,
        /// `τφ > 0` at 5 %.
        angle: bool,
    },
}

/// The positions' scatter against what the stated angle uncertainty gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AgainstStated {
    /// Observed over stated, as standard deviations.
    pub ratio: f64,
    /// Probability of a ratio that far from one, or farther on the same side, were the statement true.
    pub p_value: f64,
}

/// Intervals of the three parameters from the profile likelihood, at one level of confidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileIntervals {
    /// Level of confidence.
    pub level: f64,
    /// Lower and upper ends, in the order of [`Parameter::ALL`].
    pub ends: [[f64; 2]; 3],
}

/// Noise within dwells and scatter between them: how good sensor and table are.
///
/// **Units** LSB and rad. Scatter is what remains beyond noise: setting of the angle, drift, everything that differs
/// from dwell to dwell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// `σ`: standard deviation of the analogue value of a single sample; absent where nothing tells it from scatter.
    pub noise_lsb: Option<Ranged>,
    /// Whether `σ` is only bounded from above: hardly any dwell shows more than one code.
    pub noise_is_bound: bool,
    /// `τ0`: scatter that is the same at all angles.
    pub level_lsb: Ranged,
    /// `τφ`: scatter of the angles.
    pub angle_rad: Ranged,
    /// Both together at 0°, as a level.
    pub total_lsb: Ranged,
    /// Both together at 0°, as an angle: the repeatability of the table.
    pub total_rad: Ranged,
    /// Correlation of `τ0²` and `τφ²`.
    pub correlation: Option<f64>,
    /// Whether the two are told apart.
    pub split: Split,
    /// Variance of a dwell's mean over that of independent samples, from block means; one where that is not
    /// significantly more.
    pub inflation: f64,
}

/// One further term's coefficient in one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TermEstimate {
    /// Which.
    pub term: Term,
    /// Coefficient in [`Term::unit`].
    pub value: f64,
    /// Its standard uncertainty; absent without redundancy.
    pub standard_uncertainty: Option<f64>,
    /// Effective degrees of freedom.
    pub degrees_of_freedom: f64,
    /// Largest magnitude over the positions of what the term adds, m/s².
    pub peak_m_s2: f64,
}

/// The result of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Positions that were used.
    pub positions: usize,
    /// Different angles among them.
    pub distinct_angles: usize,
    /// `n − p`, further terms among the `p`.
    pub degrees_of_freedom: usize,
    /// Effective degrees of freedom of each parameter's standard uncertainty; `n − p` where all positions scatter alike.
    pub effective_dof: [f64; 3],
    /// In the order of [`Parameter::ALL`]; absent where the positions do not determine it.
    pub values: [Option<f64>; 3],
    /// Covariance in the same order and units; absent without full rank or without redundancy.
    pub covariance: Option<Matrix>,
    /// Measured minus modelled, in measured order.
    pub residuals: Vec<Residual>,
    /// `√(Σr²/(n−p))`, LSB; absent without redundancy.
    pub residual_std_lsb: Option<f64>,
    /// The positions' scatter against the stated angle uncertainty, where one was stated and used.
    pub against_stated: Option<AgainstStated>,
    /// Condition number with unit columns; infinite where a column is missing.
    pub condition: f64,
    /// Standard uncertainties that the plan gives at zero errors with the scatter seen. Where the parameters are
    /// hardly determined, the estimate is far off and the covariance there means little; this still holds.
    pub plan_uncertainty: Option<[f64; 3]>,
    /// Intervals from the profile likelihood, where codes make boxes of the dwells' likelihood.
    pub profile: Option<ProfileIntervals>,
    /// Noise and scatter; only [`Method::Likelihood`] tells them apart.
    pub scatter: Option<Scatter>,
    /// Further terms that were entered, in order.
    pub terms: Vec<TermEstimate>,
    /// Covariance of (bias, misalignment, scale error, further terms); absent without further terms.
    pub full_covariance: Option<Matrix>,
    /// `T̄` of the terms on temperature, °C.
    pub reference_temperature_degc: Option<f64>,
    /// How the estimate settled as positions were added.
    pub stabilization: Stabilization,
    /// The equations of the adjustment, over their standard deviations; for tests of further terms.
    pub weighted_rows: Vec<WeightedRow>,
    /// From the unknowns of those equations to the parameters.
    pub to_parameters: ToParameters,
}

impl Estimate {
    /// All three values; `None` below full rank.
    #[must_use]
    pub fn full(&self) -> Option<[f64; 3]> {
        match self.values {
            [Some(b), Some(m), Some(s)] => Some([b, m, s]),
            _ => None,
        }
    }

    /// Standard uncertainty of a parameter.
    #[must_use]
    pub fn standard_uncertainty(&self, parameter: Parameter) -> Option<f64> {
        let i = parameter.index();
        self.covariance.as_ref().map(|c| c[(i, i)].sqrt())
    }

    /// Student's factor of a parameter at a level of confidence.
    #[must_use]
    pub fn coverage_factor(&self, parameter: Parameter, level: f64) -> Option<f64> {
        student_factor(level, self.effective_dof[parameter.index()])
    }

    /// From the profile likelihood where there is one at this level, else `value ± t(ν) u`, at a level of confidence, lower and upper end.
    #[must_use]
    pub fn interval(&self, parameter: Parameter, level: f64) -> Option<[f64; 2]> {
        let value = self.values[parameter.index()]?;
        if let Some(p) = self.profile.filter(|p| p.level == level) {
            return Some(p.ends[parameter.index()]);
        }
        let half =
            self.standard_uncertainty(parameter)? * self.coverage_factor(parameter, level)?;
        Some([value - half, value + half])
    }

    /// Correlation of two parameters.
    #[must_use]
    pub fn correlation(&self, a: Parameter, b: Parameter) -> Option<f64> {
        self.covariance.as_ref().and_then(|c| c.correlation(a.index(), b.index()))
    }
}

/// An estimation that could not be done.
#[derive(Debug, Clone, PartialEq)]
pub enum EstimateError {
    /// Weights and solution found no common fixed point.
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Relative change in the last one.
        last_change: f64,
    },
    /// The codes bound the parameters and do not determine them: dwells at the converter's ends, or far too few codes.
    OnlyBounds,
}

impl std::fmt::Display for EstimateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotConverged { iterations, last_change } => write!(
                f,
                "the adjustment still changed by {last_change:.1e} after {iterations} iterations"
            ),
            Self::OnlyBounds => f.write_str(
                "the codes bound the parameters but do not determine them, or do not belong to these angles",
            ),
        }
    }
}

impl std::error::Error for EstimateError {}

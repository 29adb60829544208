//! What a plan will know, by source.

use super::candidates::Rows;
use super::estimator::{Estimator, Timeline, quadratic};
use super::problem::{PlanProblem, Site, Term};
use super::shared::systematic;
use super::variance::{DwellVariance, drift_covariance};
use crate::stats::student_factor;
use crate::systematic::Quantity;

/// Where uncertainty comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// White noise of the sensor.
    Noise,
    /// Steps of the converter.
    Rounding,
    /// Setting of the angle.
    Setting,
    /// Scatter that is the same at all angles.
    Level,
    /// Flicker, random walk and steady drift of the sensor.
    Drift,
    /// Bias from power-up to power-up.
    BetweenRuns,
    /// Local gravity.
    Gravity,
    /// Scale of the dial.
    DialScale,
    /// Eccentricity of the dial.
    Eccentricity,
    /// Zero of the dial, level of the table.
    DialZero,
    /// Tilt of the table's axis with the lean of the sensor.
    TiltAndLean,
    /// Lean of upright dwells.
    UprightLean,
    /// Nonlinearity of the sensor that is not fitted.
    Nonlinearity,
    /// Nonlinearity and reference of the converter.
    Converter,
    /// Temperature on bias and scale factor that is not fitted.
    Temperature,
}

impl Source {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Noise => "noise",
            Self::Rounding => "rounding",
            Self::Setting => "setting",
            Self::Level => "level",
            Self::Drift => "drift",
            Self::BetweenRuns => "between_runs",
            Self::Gravity => "gravity",
            Self::DialScale => "dial_scale",
            Self::Eccentricity => "eccentricity",
            Self::DialZero => "dial_zero",
            Self::TiltAndLean => "tilt_and_lean",
            Self::UprightLean => "upright_lean",
            Self::Nonlinearity => "nonlinearity",
            Self::Converter => "converter",
            Self::Temperature => "temperature",
        }
    }

    /// Name for people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Noise => "noise of the sensor",
            Self::Rounding => "steps of the converter",
            Self::Setting => "setting of the angles",
            Self::Level => "scatter of the level",
            Self::Drift => "drift of the sensor",
            Self::BetweenRuns => "power-ups",
            Self::Gravity => "local gravity",
            Self::DialScale => "scale of the dial",
            Self::Eccentricity => "eccentricity of the dial",
            Self::DialZero => "zero of dial and level",
            Self::TiltAndLean => "axis tilt, sensor lean",
            Self::UprightLean => "lean of upright dwells",
            Self::Nonlinearity => "K2, K3 left out",
            Self::Converter => "the converter",
            Self::Temperature => "temperature left out",
        }
    }

    /// Where a line of the budget is counted; `None` for rounding, which scatters from angle to angle.
    #[must_use]
    pub fn of(quantity: Quantity) -> Option<Self> {
        use Quantity as Q;
        Some(match quantity {
            Q::Gravity => Self::Gravity,
            Q::DialScale => Self::DialScale,
            Q::EccentricitySine | Q::EccentricityCosine => Self::Eccentricity,
            Q::DialZero => Self::DialZero,
            Q::TiltTimesLean | Q::TiltAndLeanCosine => Self::TiltAndLean,
            Q::ConverterBow | Q::ConverterS | Q::Reference => Self::Converter,
            Q::Quadratic | Q::Cubic => Self::Nonlinearity,
            Q::BiasTempco | Q::ScaleTempco => Self::Temperature,
            Q::Resolution => return None,
        })
    }

    /// Whether more dwells and runs make it smaller.
    #[must_use]
    pub fn averages_out(self) -> bool {
        matches!(
            self,
            Self::Noise
                | Self::Rounding
                | Self::Setting
                | Self::Level
                | Self::Drift
                | Self::BetweenRuns
        )
    }
}

/// One term's uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub struct TermPrediction {
    /// The term.
    pub term: Term,
    /// Standard uncertainties by source, in the term's unit; those that are not zero.
    pub sources: Vec<(Source, f64)>,
    /// Standard uncertainty by what averages out.
    pub u_statistical: f64,
    /// Standard uncertainty, all together.
    pub u: f64,
    /// Coverage factor at the level asked for (Welch–Satterthwaite).
    pub coverage_factor: f64,
    /// Largest expanded uncertainty that still serves; `None`: not wanted.
    pub target: Option<f64>,
}

impl TermPrediction {
    /// Expanded uncertainty.
    #[must_use]
    pub fn expanded(&self) -> f64 {
        self.coverage_factor * self.u
    }

    /// Expanded uncertainty over target.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        self.target.map(|t| self.expanded() / t)
    }

    /// What contributes most.
    #[must_use]
    pub fn largest_source(&self) -> Option<(Source, f64)> {
        self.sources.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// What a plan will know.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// By term, in order.
    pub terms: Vec<TermPrediction>,
}

impl Prediction {
    /// A term.
    #[must_use]
    pub fn of(&self, term: Term) -> Option<&TermPrediction> {
        self.terms.iter().find(|t| t.term == term)
    }

    /// The wanted term that is farthest from its target, or nearest to missing it.
    #[must_use]
    pub fn limiting(&self) -> Option<&TermPrediction> {
        self.terms
            .iter()
            .filter(|t| t.target.is_some())
            .max_by(|a, b| a.ratio().unwrap_or(0.0).total_cmp(&b.ratio().unwrap_or(0.0)))
    }

    /// Largest expanded uncertainty over its target.
    #[must_use]
    pub fn worst_ratio(&self) -> f64 {
        self.limiting().and_then(TermPrediction::ratio).unwrap_or(0.0)
    }

    /// The same without what repetition cannot average out: what the choice of angles and times can change.
    #[must_use]
    pub fn worst_statistical_ratio(&self) -> f64 {
        let ratio = |t: &TermPrediction| Some(t.coverage_factor * t.u_statistical / t.target?);
        self.terms.iter().filter_map(ratio).fold(0.0, f64::max)
    }
}

/// Predicts what dwells at some sites, in this order and in each of several runs, will tell.
///
/// **Model** a run is adjusted by weighted least squares, the weights from noise and scatter; what the dwells are off by goes
/// through it: independent scatter as `Σ a²v`, drift as `aᵀVa` with its covariance in time, systematic errors as `|Σ a f|`. The
/// result is the mean of the runs: what differs between them is divided by their number, what is common is not.
///
/// **Uncertainty** statistical parts have the degrees of freedom of the runs (R − 1), of one run alone `n − p`; together by
/// Welch and Satterthwaite.
///
/// **Source** method sections 7, 9, 10; JCGM 100, G.4.
///
/// `None` where the sites do not tell the terms apart, or no degrees of freedom are left.
#[must_use]
pub fn predict_plan(
    problem: &PlanProblem,
    sites: &[Site],
    dwell_s: f64,
    runs: u32,
) -> Option<Prediction> {
    let rows = Rows::new(problem, dwell_s);
    let timeline = Timeline::of(problem, sites, dwell_s);
    let estimator = Estimator::of(&rows, sites, &timeline)?;
    let scatter = statistical(problem, sites, dwell_s);
    let drift = drift_covariance(&problem.noise, &timeline.centres_s, dwell_s);
    let systematic = systematic(&rows, sites, runs, &timeline);
    let n = f64::from(runs);
    let dof = match runs {
        0 => return None,
        1 => (sites.len().checked_sub(estimator.terms.len())? as f64).max(0.0),
        _ => n - 1.0,
    };
    let wanted = problem.wanted();
    let mut terms = Vec::new();
    for (i, term) in estimator.terms.iter().enumerate() {
        let mut sources: Vec<(Source, f64)> = scatter
            .iter()
            .map(|(source, v)| (*source, (estimator.variance(i, v) / n).sqrt()))
            .collect();
        sources.push((Source::Drift, (quadratic(&estimator.gains[i], &drift) / n).max(0.0).sqrt()));
        if let (Term::Bias, true, Some(w)) = (term, runs > 1, problem.turn_on_m_s2) {
            sources.push((Source::BetweenRuns, w / n.sqrt()));
        }
        for (source, disturbance) in &systematic {
            add(&mut sources, *source, estimator.shift(i, disturbance));
        }
        // What is nothing but rounding of the computer is nothing.
        sources.retain(|s| s.1 > 1e-12 * problem.unit(*term));
        let sum = |keep: &dyn Fn(Source) -> bool| {
            sources.iter().filter(|s| keep(s.0)).map(|s| s.1 * s.1).sum::<f64>().sqrt()
        };
        let (u, u_statistical) = (sum(&|_| true), sum(&Source::averages_out));
        let effective = if u_statistical > 0.0 { dof * (u / u_statistical).powi(4) } else { 1e9 };
        terms.push(TermPrediction {
            term: *term,
            u_statistical,
            u,
            coverage_factor: student_factor(problem.level, effective.min(1e9))?,
            target: wanted[term.index()],
            sources,
        });
    }
    Some(Prediction { terms })
}

/// Independent variances of the dwells by source.
fn statistical(problem: &PlanProblem, sites: &[Site], dwell_s: f64) -> Vec<(Source, Vec<f64>)> {
    let v: Vec<DwellVariance> =
        sites.iter().map(|s| DwellVariance::of(problem, *s, dwell_s)).collect();
    let of = |f: fn(&DwellVariance) -> f64| v.iter().map(f).collect();
    vec![
        (Source::Noise, of(|v| v.white)),
        (Source::Rounding, of(|v| v.rounding)),
        (Source::Setting, of(|v| v.setting)),
        (Source::Level, of(|v| v.level)),
    ]
}

/// Adds an independent part to a source.
fn add(sources: &mut Vec<(Source, f64)>, source: Source, u: f64) {
    match sources.iter_mut().find(|s| s.0 == source) {
        Some(there) => there.1 = there.1.hypot(u),
        None => sources.push((source, u.abs())),
    }
}

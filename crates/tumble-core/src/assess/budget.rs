//! The budget: scatter and what scatter does not show, put together parameter by parameter.

use super::{Interval, PooledParameter, PooledRuns, RunAssessment, SharedPair, pool_runs};
use crate::estimate::Parameter;
use crate::linalg::Matrix;
use crate::stats::normal_quantile;
use crate::systematic::{Quantity, Shape, SystematicEffect};
use crate::uncertainty::{Distribution, Input, Measurement, Model, Propagation, Scalar};

/// One line of the uncertainty budget (EA-4/02).
#[derive(Debug, Clone, PartialEq)]
pub struct BudgetLine {
    /// The parameter whose uncertainty it is.
    pub parameter: Parameter,
    /// Mounting, where the parameter has several.
    pub mounting: Option<String>,
    /// Input quantity.
    pub quantity: &'static str,
    /// Where its uncertainty comes from: the data, `stated`, or the reason of a default.
    pub source: String,
    /// Its standard uncertainty, in its own unit.
    pub standard_uncertainty: f64,
    /// Unit of the input.
    pub unit: &'static str,
    /// `normal`, `rectangular`, `student`, `product of normals`, `squares of normals`.
    pub distribution: &'static str,
    /// Degrees of freedom; infinite for what is known beforehand.
    pub degrees_of_freedom: f64,
    /// `∂θ/∂x`, signed.
    pub sensitivity: f64,
    /// `|∂θ/∂x| u(x)`, in the parameter's unit.
    pub contribution: f64,
    /// Share of the combined variance.
    pub share: f64,
}

/// A systematic error with its effect on pooled values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Common<'a> {
    /// One of the runs' effects: the same quantity, uncertainty and source in all.
    pub effect: &'a SystematicEffect,
    /// `∂θ/∂x` of every pooled parameter, in their order.
    pub sensitivities: Vec<f64>,
}

/// What all runs share of systematic errors.
///
/// **Model** a pooled value `Σ_r w_r·θ_r` moves by `Σ_r w_r·c_r` with an error that is common to all runs, as errors of one
/// bench are. What rounding leaves repeats at the same angles: its sizes add up. A shared up/down pair has a scale error that is
/// as proportional to gravity and to the reference as that of a run; the table does not touch it.
pub(super) fn common<'a>(together: &PooledRuns, runs: &'a [RunAssessment]) -> Vec<Common<'a>> {
    let of_run = |r: &'a RunAssessment, q: Quantity| {
        r.effects.as_ref().and_then(|all| all.iter().find(|e| e.quantity == q))
    };
    Quantity::ALL
        .into_iter()
        .filter_map(|q| {
            let effect = runs.iter().find_map(|r| of_run(r, q))?;
            let sensitivity = |p: &PooledParameter| {
                let terms = runs.iter().zip(&p.run_weights).filter_map(|(r, w)| {
                    let c = of_run(r, q)?.sensitivity;
                    let moved = |i: usize| match q {
                        Quantity::Resolution => (w[i] * c[i]).abs(),
                        _ => w[i] * c[i],
                    };
                    Some((0..3).map(moved).sum::<f64>())
                });
                let of_pair = match q {
                    Quantity::Gravity | Quantity::Reference => {
                        p.pair_weight * effect.sensitivity[Parameter::ScaleError.index()]
                    }
                    _ => 0.0,
                };
                terms.sum::<f64>() + of_pair
            };
            let sensitivities = together.parameters.iter().map(sensitivity).collect();
            Some(Common { effect, sensitivities })
        })
        .filter(|c| c.effect.standard_uncertainty > 0.0)
        .collect()
}

/// Inputs of the propagation: statistical parts of bias, misalignment and scale error, then the systematic errors.
const INPUTS: usize = 3 + Quantity::ALL.len();

/// Deviations of bias, one misalignment and scale error, in proportion to every input. Tilt times lean and the cosine of
/// both are quantities of their own here; [`super::drawn`] draws the angles.
struct Linear {
    sensitivities: [[f64; 3]; Quantity::ALL.len()],
}

impl Model<INPUTS, 3> for Linear {
    fn evaluate<T: Scalar>(&self, x: &[T; INPUTS]) -> [T; 3] {
        core::array::from_fn(|i| {
            let lines = self.sensitivities.iter().zip(&x[3..]);
            lines.fold(x[i], |sum, (c, x)| sum + T::constant(c[i]) * *x)
        })
    }
}

/// Propagates scatter and systematic errors into three pooled parameters.
fn propagated(
    together: &PooledRuns,
    common: &[Common<'_>],
    columns: [usize; 3],
) -> Propagation<INPUTS, 3> {
    let mut inputs = [Input::exact(0.0); INPUTS];
    for (input, k) in inputs.iter_mut().zip(columns) {
        let p = &together.parameters[k];
        let scatter = Distribution::Student { u: p.u_statistical, dof: p.dof_statistical };
        *input = Input::new(0.0, scatter);
    }
    let mut model = Linear { sensitivities: [[0.0; 3]; Quantity::ALL.len()] };
    for c in common {
        let at = c.effect.quantity as usize;
        model.sensitivities[at] = columns.map(|k| c.sensitivities[k]);
        let u = c.effect.standard_uncertainty;
        inputs[3 + at] = Input::new(0.0, Distribution::Normal { u });
    }
    let correlations = correlations(together, columns);
    Measurement { inputs, correlations, model }.propagate()
}

/// Correlations of the statistical parts, where they are known: of the first mounting.
pub(super) fn correlations(together: &PooledRuns, columns: [usize; 3]) -> Vec<(usize, usize, f64)> {
    let known = first_columns(together) == Some(columns);
    let scatter = together.covariance.as_ref().filter(|_| known);
    let varies = |i: usize| together.parameters[columns[i]].u_statistical > 0.0;
    [(0, 1), (0, 2), (1, 2)]
        .into_iter()
        .filter(|(i, j)| varies(*i) && varies(*j))
        .filter_map(|(i, j)| Some((i, j, scatter?.correlation(i, j)?)))
        .collect()
}

/// Puts the systematic part into the pooled values: uncertainty, degrees of freedom, intervals, and gives the covariance of
/// (bias, first misalignment, scale error).
///
/// **Model** [`Measurement::propagate`]: `u² = u_stat² + Σ (c_i u_i)²`; degrees of freedom by Welch–Satterthwaite, those of
/// scatter alone being finite. The next power-up's true value is as uncertain by the bench as this one.
///
/// **Source** JCGM 100, 5.1.2, 5.2, G.4.1; JCGM 102; method section 10.
pub(super) fn complete(
    together: &mut PooledRuns,
    common: &[Common<'_>],
    level: f64,
) -> Option<Matrix> {
    let first = first_columns(together)?;
    let mut covariance = None;
    for k in 0..together.parameters.len() {
        let place = first.iter().position(|c| *c == k);
        // Further mountings stand in the place of the first.
        let columns = if place.is_some() { first } else { [first[0], k, first[2]] };
        let all = propagated(together, common, columns);
        if place == Some(2) {
            covariance = Some(Matrix::from_rows(all.covariance));
        }
        let output = &all.outputs[place.unwrap_or(1)];
        let systematic = &output.contributions[3..];
        let largest = (0..systematic.len())
            .filter(|q| systematic[*q] != 0.0)
            .max_by(|a, b| systematic[*a].abs().total_cmp(&systematic[*b].abs()));
        let p = &mut together.parameters[k];
        p.u_budget = systematic.iter().map(|u| u * u).sum::<f64>().sqrt();
        p.dominant = largest.map(|q| Quantity::ALL[q]);
        p.standard_uncertainty = output.standard_uncertainty;
        p.degrees_of_freedom = output.degrees_of_freedom;
        // Never without: degrees of freedom are positive.
        p.coverage_factor = output.coverage_factor(level).unwrap_or(p.coverage_factor);
        p.expanded_uncertainty = p.coverage_factor * p.standard_uncertainty;
        p.interval = Interval::around(p.value, p.expanded_uncertainty);
        let by_bench = normal_quantile(0.5 * (1.0 + level)) * p.u_budget;
        p.prediction_true_interval = p
            .prediction_true_interval
            .map(|i| Interval::around(p.value, (0.5 * (i.high - i.low)).hypot(by_bench)));
    }
    covariance
}

/// Runs put together with the budget in them: what leaving something out changes.
pub(super) fn pooled(
    runs: &[RunAssessment],
    pair: Option<&SharedPair>,
    level: f64,
) -> Vec<PooledParameter> {
    let mut together = pool_runs(runs, pair, level);
    let common = common(&together, runs);
    complete(&mut together, &common, level);
    together.parameters
}

/// Where bias, the first misalignment and the scale error stand among the pooled parameters.
pub(super) fn first_columns(together: &PooledRuns) -> Option<[usize; 3]> {
    let find = |p: Parameter| together.parameters.iter().position(|x| x.parameter == p);
    Some([find(Parameter::Bias)?, find(Parameter::Misalignment)?, find(Parameter::ScaleError)?])
}

/// Budget lines of all pooled parameters: scatter first, then every systematic error that moves the parameter at all.
pub(super) fn lines(together: &PooledRuns, common: &[Common<'_>]) -> Vec<BudgetLine> {
    let mut out = Vec::new();
    for (k, p) in together.parameters.iter().enumerate() {
        // Copies of one run scatter by nothing; then nothing has a share in it.
        let share = |u: f64| if u > 0.0 { (u / p.standard_uncertainty).powi(2) } else { 0.0 };
        let scatter = BudgetLine {
            parameter: p.parameter,
            mounting: p.mounting.clone(),
            quantity: if p.runs > 1 { "spread of the runs" } else { "scatter of the positions" },
            source: "these data".into(),
            standard_uncertainty: p.u_statistical,
            unit: p.parameter.unit(),
            distribution: "student",
            degrees_of_freedom: p.dof_statistical,
            sensitivity: 1.0,
            contribution: p.u_statistical,
            share: share(p.u_statistical),
        };
        let systematic = common.iter().filter_map(|c| {
            let contribution = (c.sensitivities[k] * c.effect.standard_uncertainty).abs();
            (contribution > NEGLIGIBLE * p.standard_uncertainty).then(|| BudgetLine {
                quantity: c.effect.quantity.name(),
                source: c.effect.source.clone(),
                standard_uncertainty: c.effect.standard_uncertainty,
                unit: c.effect.quantity.unit(),
                distribution: c.effect.shape.name(),
                degrees_of_freedom: f64::INFINITY,
                sensitivity: c.sensitivities[k],
                contribution,
                share: share(contribution),
                ..scatter.clone()
            })
        });
        let systematic: Vec<BudgetLine> = systematic.collect();
        out.push(scatter);
        out.extend(systematic);
    }
    out
}

/// Contribution over the combined uncertainty below which a line says nothing: a millionth of the variance.
const NEGLIGIBLE: f64 = 1e-3;

/// The two angles of tilt and lean, where they count.
pub(super) fn tilt_and_lean(common: &[Common<'_>]) -> Option<[f64; 2]> {
    common.iter().find_map(|c| match c.effect.shape {
        Shape::Product { u_rad } | Shape::HalfSquares { u_rad } => Some(u_rad),
        _ => None,
    })
}

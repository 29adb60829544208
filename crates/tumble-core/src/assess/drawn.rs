//! The budget drawn: whether the intervals of the propagation hold (JCGM 101, clause 8).

use super::budget::{Common, correlations, first_columns, tilt_and_lean};
use super::{Interval, PooledParameter, PooledRuns};
use crate::estimate::Parameter;
use crate::systematic::{Quantity, Shape};
use crate::uncertainty::{
    Distribution, Input, Measurement, Model, MonteCarloOptions, MonteCarloOutput, Scalar,
    Validation,
};

/// Statistical parts of bias, misalignment and scale error; tilt and lean; linear quantities.
const INPUTS: usize = 5 + LINEAR;
/// Quantities that act in proportion: all but tilt times lean and the cosine of both.
const LINEAR: usize = Quantity::ALL.len() - 2;
/// Most draws: JCGM 101, 7.2.2: 10⁶ deliver one or two digits.
const MOST_DRAWS: usize = 1_000_000;
/// Where the random numbers begin: the same passport from the same data.
const SEED: u64 = 101;
/// Draws do not depend on it.
const THREADS: usize = 2;

/// One parameter's distribution by Monte Carlo.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Parameter.
    pub parameter: Parameter,
    /// Mounting, where the parameter has several.
    pub mounting: Option<String>,
    /// Draws that were made.
    pub draws: usize,
    /// Whether they stood still (JCGM 101, 7.9).
    pub stabilized: bool,
    /// Mean, standard deviation and coverage intervals.
    pub output: MonteCarloOutput,
    /// The interval of the propagation against the symmetric one.
    pub validation: Validation,
}

/// Draws every pooled parameter's distribution at its level of confidence; `digits` of the uncertainty are to stand still.
///
/// **Model** `θ = θ̂ + e + Σ c_i x_i + c_ψη ψη + c_cos (ψ² + η²)/2`: `e` multivariate Student, the `x_i` as the budget's lines say,
/// tilt `η` and lean `ψ` normal. The propagation takes the last two terms as quantities of their own.
#[must_use]
pub(super) fn draw(
    together: &PooledRuns,
    common: &[Common<'_>],
    level: f64,
    digits: u32,
) -> Vec<Drawn> {
    let Some(first) = first_columns(together).filter(|_| digits > 0) else { return Vec::new() };
    let others = (0..together.parameters.len()).filter(|k| !first.contains(k));
    let mut out = Vec::new();
    // Further mountings are drawn one at a time in the place of the first.
    for column in std::iter::once(first[1]).chain(others) {
        let columns = [first[0], column, first[2]];
        let is_first = column == first[1];
        let measurement = measurement(together, common, columns);
        let options = MonteCarloOptions {
            seed: SEED,
            digits,
            most_draws: MOST_DRAWS,
            threads: THREADS,
            ..MonteCarloOptions::default()
        };
        let drawn = measurement.draw::<3>(level, &options);
        let wanted = if is_first { 0..3 } else { 1..2 };
        out.extend(wanted.map(|i| {
            let p = &together.parameters[columns[i]];
            let output = about(drawn.outputs[i], p.value);
            Drawn {
                parameter: p.parameter,
                mounting: p.mounting.clone(),
                draws: drawn.draws,
                stabilized: drawn.stabilized,
                validation: output.validate(p.interval),
                output,
            }
        }));
    }
    out.sort_by_key(|d| d.parameter.index());
    out
}

/// Draws were about zero, so that small uncertainties of large values keep their digits.
fn about(o: MonteCarloOutput, value: f64) -> MonteCarloOutput {
    let moved = |i: Interval| Interval { low: i.low + value, high: i.high + value };
    MonteCarloOutput {
        value: o.value + value,
        symmetric: moved(o.symmetric),
        shortest: moved(o.shortest),
        ..o
    }
}

fn measurement(
    together: &PooledRuns,
    common: &[Common<'_>],
    columns: [usize; 3],
) -> Measurement<PooledModel, INPUTS> {
    let mut inputs = [Input::exact(0.0); INPUTS];
    for (input, k) in inputs.iter_mut().zip(columns) {
        let p: &PooledParameter = &together.parameters[k];
        *input = Input::new(0.0, student(p.u_statistical, p.dof_statistical));
    }
    if let Some(u) = tilt_and_lean(common) {
        inputs[3] = Input::new(0.0, normal(u[0]));
        inputs[4] = Input::new(0.0, normal(u[1]));
    }
    let mut model = PooledModel::default();
    let mut next = 0;
    for c in common {
        let s = columns.map(|k| c.sensitivities[k]);
        let u = c.effect.standard_uncertainty;
        let distribution = match c.effect.shape {
            Shape::Product { .. } => {
                model.product = s;
                continue;
            }
            Shape::HalfSquares { .. } => {
                model.half_squares = s;
                continue;
            }
            Shape::Rectangular => Distribution::Rectangular { half_width: u * 3f64.sqrt() },
            Shape::Normal => normal(u),
        };
        model.linear[next] = s;
        inputs[5 + next] = Input::new(0.0, distribution);
        next += 1;
    }
    let correlations = correlations(together, columns);
    Measurement { inputs, correlations, model }
}

fn normal(u: f64) -> Distribution {
    if u > 0.0 { Distribution::Normal { u } } else { Distribution::Exact }
}

fn student(u: f64, dof: f64) -> Distribution {
    match u > 0.0 {
        true if dof.is_finite() => Distribution::Student { u, dof },
        _ => normal(u),
    }
}

/// Deviations of bias, misalignment and scale error from their values.
#[derive(Debug, Clone, Default, PartialEq)]
struct PooledModel {
    linear: [[f64; 3]; LINEAR],
    product: [f64; 3],
    half_squares: [f64; 3],
}

impl Model<INPUTS, 3> for PooledModel {
    #[inline]
    fn evaluate<T: Scalar>(&self, x: &[T; INPUTS]) -> [T; 3] {
        let c = T::constant;
        let product = x[3] * x[4];
        let half_squares = (x[3].square() + x[4].square()) * c(0.5);
        core::array::from_fn(|i| {
            let start =
                x[i] + c(self.product[i]) * product + c(self.half_squares[i]) * half_squares;
            self.linear.iter().zip(&x[5..]).fold(start, |sum, (s, x)| sum + c(s[i]) * *x)
        })
    }
}

//! Propagation of uncertainty: JCGM 100 and, for several outputs, JCGM 102.

use super::{Distribution, Jet, Scalar};
use crate::assess::Interval;
use crate::stats::student_factor;

/// A measurement model: outputs from inputs, one formula for values and derivatives.
pub trait Model<const N: usize, const M: usize> {
    /// The outputs.
    fn evaluate<T: Scalar>(&self, inputs: &[T; N]) -> [T; M];
}

/// One input quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Best estimate.
    pub estimate: f64,
    /// What is known about it.
    pub distribution: Distribution,
    /// Degrees of freedom of its standard uncertainty where the distribution does not say: infinite for most.
    pub degrees_of_freedom: f64,
}

impl Input {
    /// A quantity with a distribution; degrees of freedom are the distribution's.
    #[must_use]
    pub fn new(estimate: f64, distribution: Distribution) -> Self {
        Self { estimate, distribution, degrees_of_freedom: distribution.degrees_of_freedom() }
    }

    /// A constant.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self::new(value, Distribution::Exact)
    }

    /// The same with degrees of freedom that stand for how well the uncertainty is known (JCGM 100, G.4.2).
    #[must_use]
    pub fn with_dof(self, degrees_of_freedom: f64) -> Self {
        Self { degrees_of_freedom, ..self }
    }
}

/// Inputs, how they hang together, and the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement<F, const N: usize> {
    /// Inputs in the order of the model.
    pub inputs: [Input; N],
    /// Correlated pairs with their coefficients, together a correlation matrix. Only of normal and Student inputs: draws of
    /// others are independent. Correlated Student inputs of the same degrees of freedom share their `χ²`.
    pub correlations: Vec<(usize, usize, f64)>,
    /// The model.
    pub model: F,
}

/// One output with its budget.
#[derive(Debug, Clone, PartialEq)]
pub struct Output<const N: usize> {
    /// Value at the estimates of the inputs.
    pub value: f64,
    /// `c_i = ∂f/∂x_i`.
    pub sensitivities: [f64; N],
    /// `c_i u(x_i)`, with sign.
    pub contributions: [f64; N],
    /// Combined standard uncertainty, first order.
    pub standard_uncertainty: f64,
    /// Variance that the second derivatives add: `½ Σ (∂²f/∂x_i∂x_j)² u_i² u_j²` over all `i`, `j`, for independent normal
    /// inputs (a rectangle squared adds less); third derivatives are left out.
    pub second_order_variance: f64,
    /// What the second derivatives move the mean by: `½ Σ ∂²f/∂x_i² u_i²`.
    pub second_order_shift: f64,
    /// Effective degrees of freedom (Welch–Satterthwaite).
    pub degrees_of_freedom: f64,
}

impl<const N: usize> Output<N> {
    /// Standard uncertainty with the second order in it.
    #[must_use]
    pub fn with_second_order(&self) -> f64 {
        self.standard_uncertainty.hypot(self.second_order_variance.sqrt())
    }

    /// `y ± k u` at a level, first order.
    #[must_use]
    pub fn interval(&self, level: f64) -> Option<Interval> {
        let k = self.coverage_factor(level)?;
        Some(Interval::around(self.value, k * self.standard_uncertainty))
    }

    /// Coverage factor at a level, from the effective degrees of freedom.
    #[must_use]
    pub fn coverage_factor(&self, level: f64) -> Option<f64> {
        student_factor(level, self.degrees_of_freedom)
    }
}

/// All outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Propagation<const N: usize, const M: usize> {
    /// One an output.
    pub outputs: [Output<N>; M],
    /// Covariance of the outputs, first order.
    pub covariance: [[f64; M]; M],
}

impl<const N: usize, const M: usize> Propagation<N, M> {
    /// Correlation of two outputs; zero where one is exact.
    #[must_use]
    pub fn correlation(&self, a: usize, b: usize) -> f64 {
        let scale = (self.covariance[a][a] * self.covariance[b][b]).sqrt();
        if scale > 0.0 { self.covariance[a][b] / scale } else { 0.0 }
    }
}

impl<F, const N: usize> Measurement<F, N> {
    /// Correlation matrix of the inputs.
    pub(super) fn correlation_matrix(&self) -> [[f64; N]; N] {
        let mut r =
            core::array::from_fn(|i| core::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
        for (i, j, c) in &self.correlations {
            r[*i][*j] = *c;
            r[*j][*i] = *c;
        }
        r
    }

    /// Law of propagation of uncertainty.
    ///
    /// **Model** `u²(y_a) = Σ_i Σ_j c_i c_j u_i u_j r_ij`, `c_i` by differentiation of the model; `cov(y_a, y_b)` alike;
    /// `ν_eff = u⁴ / Σ (c_i u_i)⁴/ν_i`, where correlated inputs count as one with the smallest `ν` among them.
    ///
    /// **Source** JCGM 100, 5.1.2, 5.2.2, G.4.1; JCGM 102, 6.2.
    pub fn propagate<const M: usize>(&self) -> Propagation<N, M>
    where
        F: Model<N, M>,
    {
        let jets: [Jet<N>; M] =
            self.model.evaluate(&Jet::inputs(core::array::from_fn(|i| self.inputs[i].estimate)));
        let u: [f64; N] =
            core::array::from_fn(|i| self.inputs[i].distribution.standard_uncertainty());
        let r = self.correlation_matrix();
        let covariance = core::array::from_fn(|a| {
            core::array::from_fn(|b| {
                let mut sum = 0.0;
                for i in 0..N {
                    for j in 0..N {
                        sum += jets[a].gradient[i] * u[i] * jets[b].gradient[j] * u[j] * r[i][j];
                    }
                }
                sum
            })
        });
        let outputs =
            core::array::from_fn(|a| self.output(&jets[a], &u, covariance_of(&covariance, a)));
        Propagation { outputs, covariance }
    }

    fn output(&self, jet: &Jet<N>, u: &[f64; N], variance: f64) -> Output<N> {
        let contributions: [f64; N] = core::array::from_fn(|i| jet.gradient[i] * u[i]);
        let (mut second_order_variance, mut second_order_shift) = (0.0, 0.0);
        for i in 0..N {
            second_order_shift += 0.5 * jet.hessian[i][i] * u[i] * u[i];
            for j in 0..N {
                second_order_variance += 0.5 * (jet.hessian[i][j] * u[i] * u[j]).powi(2);
            }
        }
        Output {
            value: jet.value,
            sensitivities: jet.gradient,
            contributions,
            standard_uncertainty: variance.max(0.0).sqrt(),
            second_order_variance,
            second_order_shift,
            degrees_of_freedom: self.effective_dof(&contributions, variance),
        }
    }

    /// Welch–Satterthwaite; correlated inputs are one component.
    fn effective_dof(&self, contributions: &[f64; N], variance: f64) -> f64 {
        let mut group: [usize; N] = core::array::from_fn(|i| i);
        for (i, j, _) in &self.correlations {
            let (old, new) = (group[*j].max(group[*i]), group[*j].min(group[*i]));
            group.iter_mut().filter(|g| **g == old).for_each(|g| *g = new);
        }
        let r = self.correlation_matrix();
        let mut sum = 0.0;
        for g in 0..N {
            let members: Vec<usize> = (0..N).filter(|i| group[*i] == g).collect();
            let mut part = 0.0;
            for i in &members {
                for j in &members {
                    part += contributions[*i] * contributions[*j] * r[*i][*j];
                }
            }
            let dof = members
                .iter()
                .filter(|i| contributions[**i] != 0.0)
                .map(|i| self.inputs[*i].degrees_of_freedom)
                .fold(f64::INFINITY, f64::min);
            sum += part * part / dof;
        }
        if sum > 0.0 { variance * variance / sum } else { f64::INFINITY }
    }
}

fn covariance_of<const M: usize>(covariance: &[[f64; M]; M], a: usize) -> f64 {
    covariance[a][a]
}

//! Terms from all runs: mean of the runs, and what compensation needs of them.

use crate::Nonlinearity;
use crate::assess::{Interval, PooledParameter, RunAssessment};
use crate::estimate::{Estimate, Parameter, Term, TermEstimate, added_m_s2};
use crate::linalg::Matrix;
use crate::stats::{chi_squared_p_value, mean, sample_std, student_factor};

/// One term from all runs that have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PooledTerm {
    /// Mean of the runs, SI.
    pub value: f64,
    /// Its standard uncertainty: `s/√k` of the runs and what repeats in all of them; with one run its own.
    pub standard_uncertainty: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: f64,
    /// At the level asked for.
    pub expanded_uncertainty: f64,
    /// `value ± expanded`.
    pub interval: Interval,
    /// Runs that went in.
    pub runs: usize,
    /// Largest magnitude over the positions of what it adds, m/s².
    pub peak_m_s2: f64,
}

fn of_runs(term: Term, runs: &[RunAssessment]) -> Vec<(&Estimate, &TermEstimate)> {
    runs.iter()
        .filter_map(|r| r.estimate.as_ref())
        .filter_map(|e| e.terms.iter().find(|t| t.term == term).map(|t| (e, t)))
        .filter(|(_, t)| t.standard_uncertainty.is_some())
        .collect()
}

/// Mean of the runs with Student's interval; with one run, that run's own.
pub(super) fn pooled(term: Term, runs: &[RunAssessment], level: f64) -> Option<PooledTerm> {
    let all = of_runs(term, runs);
    let values: Vec<f64> = all.iter().map(|(_, t)| t.value).collect();
    let own: Vec<f64> =
        all.iter().filter_map(|(_, t)| t.standard_uncertainty).map(|u| u * u).collect();
    let value = mean(&values)?;
    let k = values.len() as f64;
    let (u, dof) = match sample_std(&values) {
        Some(s) => {
            let repeats = crate::assess::repeated_share(runs).unwrap_or(0.0) * mean(&own)?;
            let spread = s * s / k;
            let total = spread + repeats;
            // Welch and Satterthwaite; what repeats is as well known as in one run, which is better.
            let dof = if spread > 0.0 { (k - 1.0) * (total / spread).powi(2) } else { k - 1.0 };
            (total.sqrt(), dof)
        }
        None => (own.first()?.sqrt(), all.first()?.1.degrees_of_freedom),
    };
    let expanded = student_factor(level, dof)? * u;
    Some(PooledTerm {
        value,
        standard_uncertainty: u,
        degrees_of_freedom: dof,
        expanded_uncertainty: expanded,
        interval: Interval::around(value, expanded),
        runs: values.len(),
        peak_m_s2: all.iter().map(|(_, t)| t.peak_m_s2).fold(0.0, f64::max),
    })
}

/// Probability that runs with one coefficient differ as much as these do (Cochran's Q); one with a single run.
pub(super) fn disagreement(term: Term, runs: &[RunAssessment]) -> f64 {
    let all = of_runs(term, runs);
    let weighted: Vec<(f64, f64)> = all
        .iter()
        .filter_map(|(_, t)| t.standard_uncertainty.map(|u| (t.value, 1.0 / (u * u))))
        .collect();
    let sum: f64 = weighted.iter().map(|(_, w)| w).sum();
    let middle = weighted.iter().map(|(x, w)| x * w).sum::<f64>() / sum;
    let q: f64 = weighted.iter().map(|(x, w)| w * (x - middle).powi(2)).sum();
    match weighted.len() {
        0 | 1 => 1.0,
        k => chi_squared_p_value(q, (k - 1) as f64).unwrap_or(1.0),
    }
}

/// What compensation needs of the terms.
#[derive(Debug, Clone, PartialEq)]
pub struct CompensationTerms {
    /// Terms with their pooled coefficients, SI.
    pub coefficients: Vec<(Term, f64)>,
    /// `T̄`, °C, where a term needs it.
    pub reference_temperature_degc: Option<f64>,
    /// Covariance of (`k*`, `Δa`, the coefficients).
    pub covariance: Matrix,
    /// Largest magnitude of what the terms add within the accelerations and temperatures that were measured, m/s²: what
    /// a program that ignores them is wrong by.
    pub peak_m_s2: f64,
}

impl CompensationTerms {
    /// As the runtime takes them.
    #[must_use]
    pub fn nonlinearity(&self) -> Nonlinearity {
        let of = |term| {
            self.coefficients.iter().find(|(t, _)| *t == term).map_or(0.0, |(_, value)| *value)
        };
        let place =
            |term: Term| self.coefficients.iter().position(|(t, _)| *t == term).map(|i| 2 + i);
        let columns: [Option<usize>; 7] = core::array::from_fn(|i| match i {
            0 | 1 => Some(i),
            _ => place(Term::ALL[i - 2]),
        });
        let c = |i: Option<usize>, j: Option<usize>| {
            i.zip(j).map_or(0.0, |(i, j)| self.covariance[(i, j)])
        };
        Nonlinearity {
            k2_per_m_s2: of(Term::K2),
            k3_per_m2_s4: of(Term::K3),
            scale_sign: of(Term::ScaleSign),
            bias_per_k_m_s2: of(Term::TempBias),
            scale_per_k: of(Term::TempScale),
            reference_temperature_degc: self.reference_temperature_degc.unwrap_or(0.0),
            covariance: core::array::from_fn(|i| {
                core::array::from_fn(|j| c(columns[2 + i], columns[j]))
            }),
        }
    }
}

/// Steps over the accelerations for the peak.
const PEAK_STEPS: u32 = 200;

/// Terms for compensation; `None` where none was entered.
pub(in crate::assess) fn compensation_terms(
    terms: &super::Terms,
    pooled: &[PooledParameter],
    runs: &[RunAssessment],
    k0: f64,
    range_m_s2: (f64, f64),
    temperatures_degc: Option<(f64, f64)>,
) -> Option<CompensationTerms> {
    let entered: Vec<(Term, PooledTerm)> =
        terms.tried.iter().filter_map(|t| t.pooled.map(|p| (t.term, p))).collect();
    if entered.is_empty() {
        return None;
    }
    let parameter = |p: Parameter| pooled.iter().find(|x| x.parameter == p);
    let (bias, scale) = (parameter(Parameter::Bias)?, parameter(Parameter::ScaleError)?);
    let q = entered.len();
    // Of k*, Δa and the terms, by their places in a run's own covariance.
    let places: Vec<usize> = [2, 0].into_iter().chain(3..3 + q).collect();
    let mut u = vec![k0 * scale.standard_uncertainty, bias.standard_uncertainty];
    u.extend(entered.iter().map(|(_, p)| p.standard_uncertainty));
    let own: Vec<&Matrix> = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref())
        .filter_map(|e| e.full_covariance.as_ref())
        .filter(|c| c.rows() == 3 + q)
        .collect();
    let mut summed = Matrix::zeros(3 + q, 3 + q);
    for c in &own {
        for i in 0..3 + q {
            for j in 0..3 + q {
                summed[(i, j)] += c[(i, j)] / own.len() as f64;
            }
        }
    }
    // The spread between power-ups is the bias's and the scale's own: it thins their correlations.
    for p in [bias, scale] {
        let i = p.parameter.index();
        summed[(i, i)] = summed[(i, i)].max(p.between_run_sd.map_or(0.0, |s| s * s));
    }
    let mut covariance = Matrix::zeros(2 + q, 2 + q);
    for i in 0..2 + q {
        for j in 0..2 + q {
            let r = match i == j {
                true => 1.0,
                false => summed.correlation(places[i], places[j]).unwrap_or(0.0),
            };
            covariance[(i, j)] = r * u[i] * u[j];
        }
    }
    let on_temperature = entered.iter().any(|(t, _)| t.needs_temperature());
    let reference = terms.reference_temperature_degc.filter(|_| on_temperature);
    let kelvins: Vec<f64> = match (reference, temperatures_degc) {
        (Some(t), Some((low, high))) => vec![low - t, high - t],
        _ => vec![0.0],
    };
    let coefficients: Vec<(Term, f64)> = entered.iter().map(|(t, p)| (*t, p.value)).collect();
    let estimates: Vec<TermEstimate> = coefficients
        .iter()
        .map(|(term, value)| TermEstimate {
            term: *term,
            value: *value,
            standard_uncertainty: None,
            degrees_of_freedom: f64::INFINITY,
            peak_m_s2: 0.0,
        })
        .collect();
    let at = |i: u32| {
        range_m_s2.0 + (range_m_s2.1 - range_m_s2.0) * f64::from(i) / f64::from(PEAK_STEPS)
    };
    let peak_m_s2 = (0..=PEAK_STEPS)
        .flat_map(|i| kelvins.iter().map(move |k| (i, *k)))
        .map(|(i, k)| added_m_s2(&estimates, at(i), k).abs())
        .fold(0.0, f64::max);
    Some(CompensationTerms {
        coefficients,
        reference_temperature_degc: reference,
        covariance,
        peak_m_s2,
    })
}

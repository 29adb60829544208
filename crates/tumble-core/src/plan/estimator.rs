//! The adjustment of a run as a matrix: from what the dwells read to the terms.

use super::candidates::Rows;
use super::information::{Information, MOST, Row, times};
use super::problem::{PlanProblem, Site, Term};

/// A run in order, with the middle of each dwell in time from the start of the first.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Timeline {
    pub centres_s: Vec<f64>,
    /// From the start of the first dwell to the end of the last, s.
    pub span_s: f64,
}

impl Timeline {
    pub fn of(problem: &PlanProblem, sites: &[Site], dwell_s: f64) -> Self {
        let t = &problem.times;
        let mut clock = 0.0;
        let mut centres_s = Vec::with_capacity(sites.len());
        let mut was_upright = false;
        for (i, site) in sites.iter().enumerate() {
            if i > 0 {
                // Taking the body off its square and onto the table is handling too.
                let handled = site.is_upright() || was_upright;
                clock += t.settle_s + if handled { t.upright_s } else { t.setting_s };
            }
            was_upright = site.is_upright();
            centres_s.push(clock + 0.5 * dwell_s);
            clock += dwell_s;
        }
        Self { centres_s, span_s: clock }
    }

    /// Start of each dwell from power-up, s.
    pub fn starts_s(&self, problem: &PlanProblem, sites: &[Site], dwell_s: f64) -> Vec<f64> {
        let t = &problem.times;
        let handled = sites.first().is_some_and(|s| s.is_upright());
        let first = t.restart_s + t.settle_s + if handled { t.upright_s } else { t.setting_s };
        self.centres_s.iter().map(|c| first + c - 0.5 * dwell_s).collect()
    }

    /// `(t − t̄)` over the whole span.
    pub fn linear(&self) -> Vec<f64> {
        let mean = self.centres_s.iter().sum::<f64>() / self.centres_s.len().max(1) as f64;
        self.centres_s.iter().map(|t| (t - mean) / self.span_s.max(1e-9)).collect()
    }

    /// A bow of height one over the span, its mean and slope taken off.
    pub fn bow(&self) -> Vec<f64> {
        let x = self.linear();
        let n = x.len().max(1) as f64;
        let mean = |f: &dyn Fn(f64) -> f64| x.iter().map(|v| f(*v)).sum::<f64>() / n;
        let (m2, m3) = (mean(&|v| v * v), mean(&|v| v.powi(3)));
        let slope = if m2 > 0.0 { m3 / m2 } else { 0.0 };
        x.iter().map(|v| 4.0 * (v * v - m2 - slope * v)).collect()
    }
}

/// The linear estimator of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Estimator {
    pub terms: Vec<Term>,
    /// A row a term: what it takes of each dwell, in the term's own unit per m/s².
    pub gains: Vec<Vec<f64>>,
}

impl Estimator {
    /// Weighted least squares, the weights being those of [`Rows`]. `None` where the sites do not tell the terms apart.
    pub fn of(rows: &Rows<'_>, sites: &[Site], timeline: &Timeline) -> Option<Self> {
        Self::fitting(rows, sites, timeline, rows.problem.terms())
    }

    /// The same with other terms than the problem asks for.
    pub fn fitting(
        rows: &Rows<'_>,
        sites: &[Site],
        timeline: &Timeline,
        terms: Vec<Term>,
    ) -> Option<Self> {
        let time = timeline.linear();
        let x: Vec<Row> =
            sites.iter().zip(&time).map(|(s, t)| Self::row(rows, &terms, *s, *t)).collect();
        let mut m = Information::new(terms.len());
        x.iter().for_each(|r| m.add(r, 1.0));
        let (c, _) = m.inverse()?;
        let mut gains = vec![Vec::with_capacity(sites.len()); terms.len()];
        for (site, row) in sites.iter().zip(&x) {
            let y = times(&c, row, terms.len());
            let sd = rows.variance(*site).sqrt();
            for (i, term) in terms.iter().enumerate() {
                gains[i].push(y[i] * rows.problem.unit(*term) / sd);
            }
        }
        Some(Self { terms, gains })
    }

    fn row(rows: &Rows<'_>, terms: &[Term], site: Site, time: f64) -> Row {
        let mut row = [0.0; MOST];
        let (g, sd) = (rows.problem.gravity.value_m_s2, rows.variance(site).sqrt());
        for (x, term) in row.iter_mut().zip(terms) {
            let column = term.column(site, g, time * rows.problem.systematics.temperature_spread_k);
            *x = column * rows.problem.unit(*term) / sd;
        }
        row
    }

    /// What a disturbance of the dwells (m/s²) does to a term.
    pub fn shift(&self, term: usize, disturbance_m_s2: &[f64]) -> f64 {
        self.gains[term].iter().zip(disturbance_m_s2).map(|(a, f)| a * f).sum()
    }

    /// Variance of a term from independent variances of the dwells.
    pub fn variance(&self, term: usize, variances: &[f64]) -> f64 {
        self.gains[term].iter().zip(variances).map(|(a, v)| a * a * v).sum()
    }
}

/// `aᵀ V a`.
pub(super) fn quadratic(a: &[f64], v: &[Vec<f64>]) -> f64 {
    a.iter().zip(v).map(|(ai, row)| ai * row.iter().zip(a).map(|(v, aj)| v * aj).sum::<f64>()).sum()
}

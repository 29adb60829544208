//! Where a dwell can be taken, and what one dwell there says.

use super::information::{Information, MOST, Row};
use super::problem::{Criterion, PlanProblem, Possible, Site, Term};
use super::relax::Goal;
use super::variance::{DwellVariance, short_term};
use crate::Angle;

/// Angles that the first look is content with; finer steps are taken up around the best of them.
const COARSE: usize = 181;

/// Rows of one length of dwell.
#[derive(Debug, Clone)]
pub(super) struct Rows<'a> {
    pub problem: &'a PlanProblem,
    pub dwell_s: f64,
    /// Terms that angles tell apart, in order.
    pub terms: Vec<Term>,
    /// What random drift does between neighbours in time, as scatter, (m/s²)².
    neighbours: f64,
}

impl<'a> Rows<'a> {
    pub fn new(problem: &'a PlanProblem, dwell_s: f64) -> Self {
        let lag_s = dwell_s + problem.times.setting_s + problem.times.settle_s;
        let terms = problem.terms().into_iter().filter(|t| !t.needs_temperature()).collect();
        let neighbours = short_term(&problem.noise, lag_s, dwell_s);
        Self { problem, dwell_s, terms, neighbours }
    }

    /// Variance of a dwell as the adjustment weighs it, (m/s²)².
    pub fn variance(&self, site: Site) -> f64 {
        let v = DwellVariance::of(self.problem, site, self.dwell_s).total();
        let lean = if site.is_upright() { upright_lean_m_s2(self.problem).powi(2) } else { 0.0 };
        // A bench without any scatter still needs finite weights: a billionth of g.
        (v + lean + self.neighbours).max(1e-16)
    }

    pub fn row(&self, site: Site) -> Row {
        let g = self.problem.gravity.value_m_s2;
        let sd = self.variance(site).sqrt();
        let mut row = [0.0; MOST];
        for (x, term) in row.iter_mut().zip(&self.terms) {
            *x = term.column(site, g, 0.0) * self.problem.unit(*term) / sd;
        }
        row
    }

    pub fn rows(&self, sites: &[Site]) -> Vec<Row> {
        sites.iter().map(|s| self.row(*s)).collect()
    }

    pub fn information(&self, sites: &[Site]) -> Information {
        let mut m = Information::new(self.terms.len());
        sites.iter().for_each(|s| m.add(&self.row(*s), 1.0));
        m
    }

    pub fn goal(&self) -> Goal {
        let wanted = self.problem.wanted();
        let mut flags = [false; MOST];
        for (flag, term) in flags.iter_mut().zip(&self.terms) {
            *flag = wanted[term.index()].is_some();
        }
        // Only temperature was asked for: everything that angles tell counts, rather than nothing.
        if !flags.contains(&true) {
            flags[..self.terms.len()].fill(true);
        }
        Goal { criterion: self.problem.criterion, wanted: flags }
    }

    /// The upright dwells of a run.
    pub fn upright(&self) -> &'static [Site] {
        match self.problem.upright {
            Possible::Yes => &Site::UPRIGHT,
            Possible::No => &[],
        }
    }
}

impl Criterion {
    /// Name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Minimax => "minimax",
            Self::A => "A",
            Self::D => "D",
        }
    }
}

/// Standard deviation of what the lean of an upright dwell costs, m/s², beside its expectation.
pub(super) fn upright_lean_m_s2(problem: &PlanProblem) -> f64 {
    let u = problem.upright_lean.rad();
    problem.gravity.value_m_s2 * u * u / 2f64.sqrt()
}

/// Angles of the table in whole steps of the dial; the ends of the range only where a step falls on them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dial {
    step_deg: f64,
    low: i64,
    high: i64,
}

impl Dial {
    pub fn of(problem: &PlanProblem) -> Self {
        let step_deg = problem.step.deg();
        // An end that a whole number of steps reaches up to rounding is reached.
        let low = (problem.range.0.deg() / step_deg - 1e-6).ceil() as i64;
        let high = (problem.range.1.deg() / step_deg + 1e-6).floor() as i64;
        Self { step_deg, low, high }
    }

    pub fn count(&self) -> usize {
        usize::try_from(self.high - self.low + 1).unwrap_or(0)
    }

    pub fn site(&self, index: i64) -> Site {
        // Angles are typed: multiples of decimal steps without a tail of binary digits.
        let deg = (index as f64 * self.step_deg * 1e6).round() / 1e6;
        Site { angle: Angle::from_deg(deg), seat: crate::Seat::Table }
    }

    pub fn index(&self, site: Site) -> i64 {
        (site.angle.deg() / self.step_deg).round() as i64
    }

    pub fn holds(&self, index: i64) -> bool {
        (self.low..=self.high).contains(&index)
    }

    /// All steps.
    pub fn all(&self) -> Vec<Site> {
        (self.low..=self.high).map(|i| self.site(i)).collect()
    }

    /// Steps between neighbours of the first look.
    fn stride(&self, most: usize) -> i64 {
        i64::try_from(self.count().div_ceil(most)).unwrap_or(1).max(1)
    }

    /// At most about `most` of them, evenly spread about zero, with both ends.
    pub fn thinned(&self, most: usize) -> Vec<Site> {
        self.thinned_indices(most).into_iter().map(|i| self.site(i)).collect()
    }

    fn thinned_indices(&self, most: usize) -> Vec<i64> {
        let stride = self.stride(most);
        let mut indices: Vec<i64> =
            (self.low..=self.high).filter(|i| i.rem_euclid(stride) == 0).collect();
        indices.extend([self.low, self.high]);
        indices.sort_unstable();
        indices.dedup();
        indices
    }

    pub fn coarse(&self) -> Vec<Site> {
        self.thinned(COARSE)
    }

    /// Where those stand among all steps.
    pub fn coarse_places(&self) -> Vec<usize> {
        let place = |i: i64| usize::try_from(i - self.low).unwrap_or(0);
        self.thinned_indices(COARSE).into_iter().map(place).collect()
    }

    /// All steps near some sites: as far as the first look left out, and at least one.
    pub fn around(&self, sites: &[Site]) -> Vec<Site> {
        let stride = self.stride(COARSE);
        let mut indices: Vec<i64> = sites
            .iter()
            .map(|s| self.index(*s))
            .flat_map(|i| i - stride..=i + stride)
            .filter(|i| self.holds(*i))
            .collect();
        indices.sort_unstable();
        indices.dedup();
        indices.into_iter().map(|i| self.site(i)).collect()
    }
}

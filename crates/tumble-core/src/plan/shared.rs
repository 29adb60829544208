//! What all runs of a plan share, as the budget has it: what no repetition averages out.

use super::candidates::{Rows, upright_lean_m_s2};
use super::estimator::{Estimator, Timeline};
use super::predict::Source;
use super::problem::{PlanProblem, Possible, Site, Term};
use crate::systematic::{Input, Planned, Quantity, Sites, pattern};

/// Independent disturbances of the dwells, m/s², one standard uncertainty each, with their source.
///
/// **Model** the patterns of the budget ([`pattern`]). Turned by 180° between runs, what is even in the dial's angle changes
/// its sign with the body: what is left is the mean over the runs of both orientations. K2 and K3 that nobody stated are
/// taken as no larger than these data will show them to be, as the budget takes them.
///
/// **Source** method section 10; `docs/budget.md`.
pub(super) fn systematic(
    rows: &Rows<'_>,
    sites: &[Site],
    runs: u32,
    timeline: &Timeline,
) -> Vec<(Source, Vec<f64>)> {
    let problem = rows.problem;
    let fitted: Vec<Quantity> = problem.terms().iter().filter_map(|t| t.replaces()).collect();
    let lines = &problem.systematics.lines;
    let patterns = Patterns::of(problem, sites, runs, timeline);
    let mut out = Vec::new();
    for line in
        lines.iter().filter(|l| l.standard_uncertainty > 0.0 && !fitted.contains(&l.quantity))
    {
        let Some((source, shape)) =
            Source::of(line.quantity).zip(patterns.of_quantity(line.quantity))
        else {
            continue;
        };
        let u =
            shown_by_data(rows, sites, runs, timeline, line).unwrap_or(line.standard_uncertainty);
        out.push((source, shape.iter().map(|f| u * f).collect()));
    }
    let g = problem.gravity.standard_uncertainty_m_s2;
    out.push((Source::Gravity, sites.iter().map(|s| g * s.sine()).collect()));
    let lean = upright_lean_m_s2(problem);
    for i in (0..sites.len()).filter(|i| sites[*i].is_upright()) {
        let mut one = vec![0.0; sites.len()];
        one[i] = lean;
        out.push((Source::UprightLean, one));
    }
    out
}

/// The sites of a run in both orientations of the body.
struct Patterns {
    sites: [Sites; 2],
    /// Share of the runs in each.
    shares: [f64; 2],
    /// m/s² a unit of the patterns.
    scale_m_s2: f64,
    /// Acceleration of each dwell, m/s².
    accelerations_m_s2: Vec<f64>,
}

impl Patterns {
    fn of(problem: &PlanProblem, sites: &[Site], runs: u32, timeline: &Timeline) -> Self {
        let g = problem.gravity.value_m_s2;
        let scale_m_s2 = problem.converter.map_or(1.0, |c| c.lsb_m_s2);
        let spread_k = problem.systematics.temperature_spread_k;
        let planned: Vec<Planned> = sites
            .iter()
            .zip(timeline.linear())
            .map(|(s, t)| Planned { angle: s.angle, seat: s.seat, warmth_k: spread_k * t })
            .collect();
        // Of an odd number of runs one more stands the first way.
        let turned = match problem.remounting {
            Possible::Yes => f64::from(runs / 2) / f64::from(runs.max(1)),
            Possible::No => 0.0,
        };
        Self {
            sites: [1.0, -1.0].map(|d| Sites::planned(&planned, d, g, scale_m_s2)),
            shares: [1.0 - turned, turned],
            scale_m_s2,
            accelerations_m_s2: sites.iter().map(|s| g * s.sine()).collect(),
        }
    }

    /// What a unit of a quantity adds to the dwells on the mean of the runs, m/s².
    fn of_quantity(&self, quantity: Quantity) -> Option<Vec<f64>> {
        match quantity {
            // Stands in the problem itself.
            Quantity::Gravity => return None,
            Quantity::Reference => return Some(self.accelerations_m_s2.clone()),
            _ => {}
        }
        let [one, other] = [0, 1].map(|i| pattern(quantity, &self.sites[i]));
        let mean = |(a, b): (f64, f64)| self.scale_m_s2 * (self.shares[0] * a + self.shares[1] * b);
        Some(one?.into_iter().zip(other?).map(mean).collect())
    }
}

/// How large K2 or K3 can be without being seen, where that is less than what is assumed of it: a test with the standard
/// uncertainty `s` finds `s` of a term that is not there, and `√(s² + s²)` is what the budget then takes.
fn shown_by_data(
    rows: &Rows<'_>,
    sites: &[Site],
    runs: u32,
    timeline: &Timeline,
    line: &Input,
) -> Option<f64> {
    let term = match line.quantity {
        Quantity::Quadratic => Term::K2,
        Quantity::Cubic => Term::K3,
        _ => return None,
    };
    if line.source == "stated" {
        return None;
    }
    let mut terms = rows.problem.terms();
    terms.push(term);
    let with = Estimator::fitting(rows, sites, timeline, terms)?;
    let variances: Vec<f64> = sites.iter().map(|s| rows.variance(*s)).collect();
    let s2 = with.variance(with.terms.len() - 1, &variances) / f64::from(runs.max(1));
    Some((2.0 * s2).sqrt()).filter(|u| *u < line.standard_uncertainty)
}

//! How many runs, how many positions, how long a dwell.

use super::candidates::{Dial, Rows};
use super::layout::{Layout, filling_dwell_s, layout, run_s};
use super::problem::{PlanProblem, Possible, Site};
use super::relax::relax;
use crate::stats::student_factor;

/// Numbers of runs that are weighed. Three show whether runs agree at all; beyond six the factor of Student falls by less
/// than a tenth a run.
const RUNS: core::ops::RangeInclusive<u32> = 3..=6;
/// Most positions of a run: what a person sets by hand without slips.
const MOST_POSITIONS: usize = 120;
/// Shortest dwell, s: below it a person writes longer than the sensor is read.
const SHORTEST_DWELL_S: f64 = 10.0;
/// Angles of the quick look.
const QUICK: usize = 31;
/// How near to its bound the quick look comes (variances): nearer than plans of neighbouring lengths are to each other.
const QUICK_TOLERANCE: f64 = 0.02;
/// Plans that are worked out in full for the best one, and where only a comparison is wanted.
const IN_FULL: usize = 6;
pub(super) const COMPARED: usize = 1;

/// A choice with its quick value.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Choice {
    ratio: f64,
    runs: u32,
    positions: usize,
    dwell_s: f64,
}

/// The best plan within a time.
pub(super) fn within(problem: &PlanProblem, total_s: f64) -> Option<Layout> {
    best_of(problem, total_s, IN_FULL)
}

/// The best plan within a time, a number of choices worked out in full.
pub(super) fn best_of(problem: &PlanProblem, total_s: f64, in_full: usize) -> Option<Layout> {
    let mut choices: Vec<Choice> = match problem.runs {
        Some(r) => choices(problem, total_s, r),
        // Turned bodies come in pairs.
        None => RUNS
            .filter(|r| problem.remounting == Possible::No || r % 2 == 0)
            .flat_map(|r| choices(problem, total_s, r))
            .collect(),
    };
    choices.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let full = |c: &Choice| layout(problem, c.dwell_s, c.positions, c.runs);
    choices.iter().take(in_full).filter_map(full).min_by(|a, b| {
        let ratio = |l: &Layout| l.prediction.worst_statistical_ratio();
        ratio(a).total_cmp(&ratio(b))
    })
}

/// Fewest positions: one more than terms, and the spares.
pub(super) fn fewest(problem: &PlanProblem) -> usize {
    problem.terms().len() + 1 + problem.spares
}

/// Least time in which anything can be planned, s.
pub(super) fn least_s(problem: &PlanProblem) -> f64 {
    let runs = f64::from(problem.runs.unwrap_or(*RUNS.start()));
    runs * run_s(problem, fewest(problem), problem.dwell_s.unwrap_or(SHORTEST_DWELL_S))
}

fn choices(problem: &PlanProblem, total_s: f64, runs: u32) -> Vec<Choice> {
    let each_s = total_s / f64::from(runs.max(1));
    let (first, last) = (fewest(problem), MOST_POSITIONS);
    let mut out = Vec::new();
    let mut n = first;
    while n <= last {
        let dwell_s = match problem.dwell_s {
            Some(t) => Some(t).filter(|t| run_s(problem, n, *t) <= each_s),
            None => filling_dwell_s(problem, n, each_s).filter(|t| *t >= SHORTEST_DWELL_S),
        };
        let Some(dwell_s) = dwell_s else { break };
        if let Some(ratio) = quick(problem, n, dwell_s, runs) {
            out.push(Choice { ratio, runs, positions: n, dwell_s });
        }
        // Every number of positions while they are few, every tenth part later.
        n += (n / 10).max(1);
    }
    out
}

/// Largest statistical uncertainty over its target, by the best shares.
fn quick(problem: &PlanProblem, positions: usize, dwell_s: f64, runs: u32) -> Option<f64> {
    let rows = Rows::new(problem, dwell_s);
    let (low, high) = problem.range;
    let spare = |i: usize| {
        let share = (i as f64 + 0.5) / problem.spares as f64;
        Site::table(low.deg() + share * (high.deg() - low.deg()))
    };
    let spares: Vec<Site> = (0..problem.spares).map(spare).collect();
    let mut fixed = rows.information(rows.upright());
    spares.iter().for_each(|s| fixed.add(&rows.row(*s), 1.0));
    let sites = Dial::of(problem).thinned(QUICK);
    let free = positions.checked_sub(problem.spares)? as f64;
    let best = relax(&rows.rows(&sites), &fixed, free, &rows.goal(), QUICK_TOLERANCE)?;
    let dof =
        if runs > 1 { f64::from(runs) - 1.0 } else { positions as f64 - rows.terms.len() as f64 };
    Some(student_factor(problem.level, dof)? * (best.bound / f64::from(runs)).sqrt())
}

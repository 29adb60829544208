//! From shares to whole numbers of positions.

use super::candidates::{Dial, Rows};
use super::information::{Information, Row};
use super::problem::Site;
use super::relax::{Goal, Relaxed};

/// Share of a position below which a candidate is no support.
const NEGLIGIBLE: f64 = 1e-3;
/// Largest number of exchanges; a plan settles within a few tens.
const EXCHANGES: usize = 200;
/// An exchange must gain this share, else two plans of equal value could be exchanged for ever.
const GAIN: f64 = 1e-9;

/// Sites with numbers of positions.
pub(super) type Counted = Vec<(Site, usize)>;

/// A plan of whole numbers near the best shares: efficient apportionment, then exchanges of single positions until none helps.
///
/// **Source** Pukelsheim, Rieder, Biometrika 79 (1992) 763 (efficient rounding); Fedorov 1972 (exchange).
pub(super) fn exact(
    rows: &Rows<'_>,
    dial: &Dial,
    sites: &[Site],
    relaxed: &Relaxed,
    fixed: &Information,
    total: usize,
    goal: &Goal,
) -> Counted {
    let clusters = clusters(&relaxed.weights);
    let counts = apportioned(&clusters.iter().map(|c| c.1).collect::<Vec<_>>(), total);
    let start: Counted =
        clusters.iter().zip(counts).map(|(c, n)| (sites[c.0], n)).filter(|s| s.1 > 0).collect();
    let plan = exchanged(rows, start, sites, fixed, goal);
    let near = dial.around(&plan.iter().map(|s| s.0).collect::<Vec<_>>());
    exchanged(rows, plan, &near, fixed, goal)
}

fn add(plan: &mut Counted, site: Site) {
    match plan.iter_mut().find(|s| s.0 == site) {
        Some(s) => s.1 += 1,
        None => plan.push((site, 1)),
    }
}

/// Neighbouring candidates share one point between them: its place (index) and weight.
fn clusters(weights: &[f64]) -> Vec<(usize, f64)> {
    let mut out = Vec::new();
    let (mut sum, mut moment) = (0.0, 0.0);
    let mut close = |sum: &mut f64, moment: &mut f64| {
        if *sum > 0.0 {
            out.push(((*moment / *sum).round() as usize, *sum));
        }
        (*sum, *moment) = (0.0, 0.0);
    };
    for (i, w) in weights.iter().enumerate() {
        if *w > NEGLIGIBLE {
            sum += w;
            moment += w * i as f64;
        } else {
            close(&mut sum, &mut moment);
        }
    }
    close(&mut sum, &mut moment);
    out
}

/// Whole numbers in proportion to weights.
fn apportioned(weights: &[f64], total: usize) -> Vec<usize> {
    let sum: f64 = weights.iter().sum();
    let multiplier = (total as f64 - 0.5 * weights.len() as f64).max(0.0);
    let mut n: Vec<usize> =
        weights.iter().map(|w| (multiplier * w / sum).ceil() as usize).collect();
    let by = |f: &dyn Fn(usize) -> f64| {
        (0..weights.len()).min_by(|a, b| f(*a).total_cmp(&f(*b))).unwrap_or(0)
    };
    while n.iter().sum::<usize>() < total && !n.is_empty() {
        let j = by(&|j| n[j] as f64 / weights[j]);
        n[j] += 1;
    }
    while n.iter().sum::<usize>() > total {
        let j = by(&|j| -(n[j] as f64 - 1.0) / weights[j]);
        n[j] = n[j].saturating_sub(1);
    }
    n
}

/// Moves single positions to whichever candidate gains most.
fn exchanged(
    rows: &Rows<'_>,
    mut plan: Counted,
    candidates: &[Site],
    fixed: &Information,
    goal: &Goal,
) -> Counted {
    let candidate_rows = rows.rows(candidates);
    let value = |m: &Information| goal.value(m).unwrap_or(f64::INFINITY);
    for _ in 0..EXCHANGES {
        let own: Vec<Row> = plan.iter().map(|s| rows.row(s.0)).collect();
        let mut m = *fixed;
        own.iter().zip(&plan).for_each(|(r, s)| m.add(r, s.1 as f64));
        let mut best = (value(&m) * (1.0 - GAIN), None);
        for (from, row) in own.iter().enumerate() {
            let without = m.with(row, -1.0);
            for (to, other) in candidate_rows.iter().enumerate() {
                let v = value(&without.with(other, 1.0));
                if v < best.0 {
                    best = (v, Some((from, to)));
                }
            }
        }
        let Some((from, to)) = best.1 else { break };
        plan[from].1 -= 1;
        add(&mut plan, candidates[to]);
        plan.retain(|s| s.1 > 0);
    }
    plan.sort_by(|a, b| a.0.angle.rad().total_cmp(&b.0.angle.rad()));
    plan
}

#[cfg(test)]
mod tests {
    use super::apportioned;

    #[test]
    fn whole_numbers_in_proportion() {
        assert_eq!(apportioned(&[0.3, 0.4, 0.3], 10), [3, 4, 3]);
        assert_eq!(apportioned(&[1.0, 1.0, 1.0], 4).iter().sum::<usize>(), 4);
        // Every support point keeps a position.
        assert_eq!(apportioned(&[0.01, 0.98, 0.01], 5), [1, 3, 1]);
    }
}

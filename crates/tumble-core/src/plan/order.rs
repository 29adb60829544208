//! An order of positions in which drift imitates no parameter.

use super::candidates::Rows;
use super::estimator::{Estimator, Timeline, quadratic};
use super::problem::{Site, Term};
use super::variance::drift_covariance;

/// Sweeps through the table that are tried.
const SWEEPS: [usize; 4] = [1, 2, 4, 8];
/// Most exchanges of two positions beside one a position; each costs a look at all pairs.
const EXCHANGES: usize = 40;
/// What a dwell that follows itself costs, as a share of the variance: more than any drift that an exchange heals.
const FOLLOWS_ITSELF: f64 = 0.05;
/// Share of the variance that drift may add before a longer way of the table is worth taking.
const WORTH_TURNING: f64 = 1e-4;

/// What drift would do to a term, with positions in the order of the dial and in the order of the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrderEffect {
    /// The term.
    pub term: Term,
    /// Shift of the term by a steady drift of 1 m/s² from start to end of the run, one sweep in rising order.
    pub linear_sorted: f64,
    /// The same in the order of the plan.
    pub linear: f64,
    /// Shift by a bow of 1 m/s² over the run, one sweep in rising order.
    pub bow_sorted: f64,
    /// The same in the order of the plan.
    pub bow: f64,
}

/// Orders the table's positions behind the upright dwells. `None` where the sites tell the terms not apart.
pub(super) fn ordered(rows: &Rows<'_>, table: &[Site]) -> Option<Vec<Site>> {
    let mut best: Option<(f64, Vec<Site>)> = None;
    let sweeps = SWEEPS.into_iter().filter(|s| *s == 1 || 2 * s <= table.len());
    let orders = sweeps.map(|s| swept(table, s)).chain([spaced(table)]);
    for order in orders {
        let sites = whole(rows, &order);
        let loss = Loss::of(rows, &sites)?.value() + FOLLOWS_ITSELF * repeats(&sites) as f64;
        // More turns only where they help: every turn back costs time and backlash.
        if best.as_ref().is_none_or(|b| loss < b.0 - WORTH_TURNING) {
            best = Some((loss, sites));
        }
    }
    let (loss, sites) = best?;
    if loss <= WORTH_TURNING { Some(sites) } else { exchanged(rows, sites) }
}

/// Dwells that follow one at the same angle.
fn repeats(sites: &[Site]) -> usize {
    sites.windows(2).filter(|w| w[0] == w[1]).count()
}

/// What exchanging two positions does to [`repeats`].
fn change_of_repeats(sites: &[Site], j: usize, k: usize) -> f64 {
    let swapped = |i: usize| match i {
        _ if i == j => sites[k],
        _ if i == k => sites[j],
        _ => sites[i],
    };
    // Pairs (i, i+1) that touch either place, each once.
    let mut pairs = [j.wrapping_sub(1), j, k.wrapping_sub(1), k];
    if k == j + 1 {
        pairs[2] = usize::MAX;
    }
    let mut change = 0.0;
    for i in pairs.into_iter().filter(|i| *i < sites.len() - 1) {
        change -= f64::from(u8::from(sites[i] == sites[i + 1]));
        change += f64::from(u8::from(swapped(i) == swapped(i + 1)));
    }
    change
}

/// Upright dwells first: once on the table, the body stays as it sits.
pub(super) fn whole(rows: &Rows<'_>, table: &[Site]) -> Vec<Site> {
    rows.upright().iter().chain(table).copied().collect()
}

/// Sweeps up and down, repeats of an angle dealt out to all of them; the directions by Thue and Morse, which cancels one more
/// power of time with every doubling.
fn swept(table: &[Site], sweeps: usize) -> Vec<Site> {
    let mut sorted = table.to_vec();
    sorted.sort_by(|a, b| a.angle.rad().total_cmp(&b.angle.rad()));
    let mut out = Vec::with_capacity(table.len());
    for sweep in 0..sweeps {
        let mut own: Vec<Site> = sorted.iter().skip(sweep).step_by(sweeps).copied().collect();
        if sweep.count_ones() % 2 == 1 {
            own.reverse();
        }
        out.extend(own);
    }
    out
}

/// Every angle evenly over the run: its repeats at the middles of as many equal parts.
fn spaced(table: &[Site]) -> Vec<Site> {
    let mut sorted = table.to_vec();
    sorted.sort_by(|a, b| a.angle.rad().total_cmp(&b.angle.rad()));
    let mut slots: Vec<(f64, Site)> = sorted
        .chunk_by(|a, b| a == b)
        .flat_map(|same| {
            let n = same.len() as f64;
            same.iter().enumerate().map(move |(i, s)| ((i as f64 + 0.5) / n, *s))
        })
        .collect();
    slots.sort_by(|a, b| a.0.total_cmp(&b.0));
    slots.into_iter().map(|s| s.1).collect()
}

/// What drift does to the terms of one order.
struct Loss {
    estimator: Estimator,
    /// Covariance of drift by place in the order.
    v: Vec<Vec<f64>>,
    /// Weight of each term: one over its variance without drift where it is wanted.
    weights: Vec<f64>,
}

impl Loss {
    fn of(rows: &Rows<'_>, sites: &[Site]) -> Option<Self> {
        let problem = rows.problem;
        let timeline = Timeline::of(problem, sites, rows.dwell_s);
        let estimator = Estimator::of(rows, sites, &timeline)?;
        let variances: Vec<f64> = sites.iter().map(|s| rows.variance(*s)).collect();
        let mut v = drift_covariance(&problem.noise, &timeline.centres_s, rows.dwell_s);
        // Beside the drift that is known, a line and a bow as large as what one dwell scatters by.
        let size = variances.iter().sum::<f64>() / variances.len() as f64;
        for shape in [timeline.linear(), timeline.bow()] {
            for i in 0..sites.len() {
                for j in 0..sites.len() {
                    v[i][j] += size * shape[i] * shape[j];
                }
            }
        }
        let wanted = problem.wanted();
        let weights = (0..estimator.terms.len())
            .map(|i| {
                let t = estimator.terms[i];
                // Temperature is meant to take the slope.
                let counts = wanted[t.index()].is_some() && t != Term::BiasPerKelvin;
                if counts { 1.0 / estimator.variance(i, &variances) } else { 0.0 }
            })
            .collect();
        Some(Self { estimator, v, weights })
    }

    fn value(&self) -> f64 {
        let gains = &self.estimator.gains;
        gains.iter().zip(&self.weights).map(|(a, w)| w * quadratic(a, &self.v)).sum()
    }
}

/// Exchanges two positions of the table at a time, the pair that gains most first.
fn exchanged(rows: &Rows<'_>, mut sites: Vec<Site>) -> Option<Vec<Site>> {
    let first = rows.upright().len();
    let mut loss = Loss::of(rows, &sites)?;
    let mut value = loss.value() + FOLLOWS_ITSELF * repeats(&sites) as f64;
    for _ in 0..sites.len() + EXCHANGES {
        let products: Vec<Vec<f64>> =
            loss.estimator.gains.iter().map(|a| times(&loss.v, a)).collect();
        let mut best = (-1e-3 * WORTH_TURNING, None);
        for j in first..sites.len() {
            for k in j + 1..sites.len() {
                if sites[j] == sites[k] {
                    continue;
                }
                let curvature = loss.v[j][j] + loss.v[k][k] - 2.0 * loss.v[j][k];
                let mut change = FOLLOWS_ITSELF * change_of_repeats(&sites, j, k);
                for ((a, va), w) in loss.estimator.gains.iter().zip(&products).zip(&loss.weights) {
                    let d = a[k] - a[j];
                    change += w * (2.0 * d * (va[j] - va[k]) + d * d * curvature);
                }
                if change < best.0 {
                    best = (change, Some((j, k)));
                }
            }
        }
        let Some((j, k)) = best.1 else { break };
        sites.swap(j, k);
        // With temperature fitted, gains depend on the order.
        loss = Loss::of(rows, &sites)?;
        let now = loss.value() + FOLLOWS_ITSELF * repeats(&sites) as f64;
        if now >= value {
            sites.swap(j, k);
            break;
        }
        value = now;
        if value <= WORTH_TURNING {
            break;
        }
    }
    Some(sites)
}

fn times(v: &[Vec<f64>], a: &[f64]) -> Vec<f64> {
    v.iter().map(|row| row.iter().zip(a).map(|(v, a)| v * a).sum()).collect()
}

/// How much the order helps.
pub(super) fn effects(rows: &Rows<'_>, sites: &[Site]) -> Option<Vec<OrderEffect>> {
    let first = rows.upright().len();
    let sorted = whole(rows, &swept(&sites[first..], 1));
    let shifts = |sites: &[Site]| {
        let timeline = Timeline::of(rows.problem, sites, rows.dwell_s);
        let e = Estimator::of(rows, sites, &timeline)?;
        let [linear, bow] = [timeline.linear(), timeline.bow()];
        let both = |i| [e.shift(i, &linear), e.shift(i, &bow)];
        Some((0..e.terms.len()).map(both).collect::<Vec<_>>())
    };
    let (before, after) = (shifts(&sorted)?, shifts(sites)?);
    let terms = rows.problem.terms();
    Some(
        terms
            .into_iter()
            .zip(before.into_iter().zip(after))
            .filter(|(t, _)| !t.needs_temperature())
            .map(|(term, (b, a))| OrderEffect {
                term,
                linear_sorted: b[0],
                linear: a[0],
                bow_sorted: b[1],
                bow: a[1],
            })
            .collect(),
    )
}

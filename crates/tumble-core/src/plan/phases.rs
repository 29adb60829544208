//! Repeats of an angle: apart in time, and spread over the step of the converter where noise does not dither it.

use super::candidates::Dial;
use super::exact::Counted;
use super::problem::{PlanProblem, Site};
use super::variance::dither_lsb;

/// Noise of a reading, LSB, from which on averaging does what rounding undid.
///
/// **Source** method section 11; the first harmonic of the rounding error is 0.2 % of one LSB there.
pub const DITHERED_LSB: f64 = 0.5;
/// How far a repeat may be moved: that costs little at a flat optimum.
const FARTHEST_DEG: f64 = 2.0;

/// Whether repeats at one angle would repeat the rounding error.
pub(super) fn needed(problem: &PlanProblem) -> bool {
    dither_lsb(problem).is_some_and(|s| s < DITHERED_LSB)
}

/// An angle that takes two fifths of a run and more would follow itself, and a dwell that follows itself is the same setting read
/// twice. It is shared with its neighbours on the dial, which at a flat optimum costs next to nothing.
pub(super) fn alternated(dial: &Dial, plan: &[(Site, usize)], positions: usize) -> Counted {
    let mut out = Counted::new();
    for (site, n) in plan.iter().copied() {
        let home = dial.index(site);
        let beside: Vec<i64> =
            [home + 1, home - 1].into_iter().filter(|k| dial.holds(*k)).collect();
        let each = if 5 * n >= 2 * positions { n / (beside.len() + 1) } else { 0 };
        out.push((site, n - each * beside.len()));
        out.extend(beside.into_iter().map(|k| (dial.site(k), each)).filter(|s| s.1 > 0));
    }
    out
}

/// Moves repeats of one angle by few steps, so that what they read falls evenly into the converter's step. What the step's
/// place is depends on bias and scale, which nobody knows yet; that the places are evenly spread does not.
pub(super) fn spread(problem: &PlanProblem, dial: &Dial, plan: &[(Site, usize)]) -> Vec<Site> {
    let Some(converter) = problem.converter.filter(|_| needed(problem)) else {
        return plan.iter().flat_map(|(s, n)| core::iter::repeat_n(*s, *n)).collect();
    };
    let lsb = |s: Site| problem.gravity.value_m_s2 * s.sine() / converter.lsb_m_s2;
    let reach = (FARTHEST_DEG / problem.step.deg()).floor() as i64;
    let mut out = Vec::new();
    for (site, n) in plan {
        let home = dial.index(*site);
        let mut taken = vec![home];
        out.push(*site);
        for i in 1..*n {
            let wanted = lsb(*site) + i as f64 / *n as f64;
            let best = (home - reach..=home + reach)
                .filter(|k| dial.holds(*k) && !taken.contains(k))
                .min_by(|a, b| {
                    let cost = |k: i64| {
                        let off = lsb(dial.site(k)) - wanted;
                        // Phase first; of phases alike to a hundredth, the nearer angle.
                        (off - off.round()).abs()
                            + 0.01 * (k - home).abs() as f64 / reach.max(1) as f64
                    };
                    cost(*a).total_cmp(&cost(*b))
                });
            let k = best.unwrap_or(home);
            taken.push(k);
            out.push(dial.site(k));
        }
    }
    out
}

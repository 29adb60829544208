//! What no plan of whole numbers can beat: where dwells are few, far above what shares could reach.
//!
//! **Model** the dial falls into sections, one about each angle that the best shares use. In every plan whole numbers `n_g` of
//! dwells fall into the sections. A tangent of ψ bounds it from below as `a − Σ n_g D_g` (`relax`: the equivalence theorem with
//! the numbers in the sections fixed), so the largest of some tangents does, and the least of that over all whole numbers is
//! below every plan. Where the least is reached, the best shares with those numbers give the next tangent, until the bound
//! grows no more: cutting planes (Kelley 1960).

use core::ops::Range;

use super::candidates::{Dial, Rows};
use super::information::{Information, Row};
use super::layout::Layout;
use super::problem::PlanProblem;
use super::relax::{Goal, Group, Relaxed, TOLERANCE, Tangent, relax, relax_groups};

/// Tangents that are taken.
const TANGENTS: usize = 60;
/// Times that sections are cut once more.
const REFINEMENTS: usize = 6;
/// Ways to share dwells out that are looked at; with more, dwells are so many that whole numbers cost little.
const MOST_WAYS: usize = 60_000;
/// Share of a dwell below which a step of the dial is no support.
const NEGLIGIBLE: f64 = 1e-3;

/// Ratio of a plan to what no plan of whole numbers beats with the same spares, upright dwells and length of dwell, less
/// one, as an uncertainty. `None` where there are too many ways, or more is not known than by shares.
pub(super) fn gap(problem: &PlanProblem, plan: &Layout) -> Option<f64> {
    let rows = Rows::new(problem, plan.dwell_s);
    let dial = Dial::of(problem);
    let goal = rows.goal();
    let mut fixed = rows.information(rows.upright());
    plan.spares.iter().for_each(|s| fixed.add(&rows.row(*s), 1.0));
    let table = plan.sites.iter().filter(|s| !s.is_upright()).count();
    let free = table.checked_sub(plan.spares.len())?;
    let value = goal.value(&rows.information(&plan.sites))?;
    let all = Steps { rows: rows.rows(&dial.all()), fixed, goal };
    let least = all.bound(&rows.rows(&dial.coarse()), &dial, free, value)?;
    Some((value / least.max(f64::MIN_POSITIVE)).sqrt() - 1.0)
}

/// All steps of the dial, beside what is fixed.
struct Steps {
    rows: Vec<Row>,
    fixed: Information,
    goal: Goal,
}

impl Steps {
    /// The bound; no better than `value`, a plan that is there, is asked for.
    fn bound(&self, coarse: &[Row], dial: &Dial, free: usize, value: f64) -> Option<f64> {
        let first = relax(coarse, &self.fixed, free as f64, &self.goal, TOLERANCE)?;
        let mut ends = section_ends(&first.weights);
        let mut shares = vec![first];
        let mut best = None;
        let places = dial.coarse_places();
        for _ in 0..REFINEMENTS {
            // The same sections in steps of the dial.
            let cut: Vec<usize> = ends.iter().map(|i| places[*i]).collect();
            let steps = between(&cut, self.rows.len());
            let sections = between(&ends, coarse.len());
            let Some(ways) = ways(free, sections.len()) else { break };
            let mut cutting = Cutting { all: self, coarse, steps, sections, ways, known: vec![] };
            let (least, last) = cutting.planes(&mut shares, value)?;
            best = Some(least.min(value));
            // Where one dwell would stand at two places, the section is cut between them.
            let more = last.map_or(vec![], |s| section_ends(&shares[s].weights));
            let before = ends.len();
            ends.extend(more);
            ends.sort_unstable();
            ends.dedup();
            if least >= value || ends.len() == before {
                break;
            }
        }
        best
    }
}

/// Sections of the dial with what tangents say of every way to fill them.
struct Cutting<'a> {
    all: &'a Steps,
    coarse: &'a [Row],
    /// Sections in all steps of the dial.
    steps: Vec<Range<usize>>,
    /// The same in the coarse candidates.
    sections: Vec<Range<usize>>,
    ways: Vec<Vec<f64>>,
    /// What no plan that fills the sections in a way is below.
    known: Vec<f64>,
}

impl Cutting<'_> {
    /// The bound, and which of the shares are best for the way that it stands at.
    fn planes(&mut self, shares: &mut Vec<Relaxed>, value: f64) -> Option<(f64, Option<usize>)> {
        self.known = vec![0.0; self.ways.len()];
        shares.iter().try_for_each(|s| self.raise(s))?;
        let mut of_way = vec![None; self.ways.len()];
        for _ in 0..TANGENTS {
            let at = self.least()?;
            if self.known[at] >= value || of_way[at].is_some() {
                break;
            }
            let groups: Vec<Group> = self
                .sections
                .iter()
                .zip(&self.ways[at])
                .map(|(c, n)| Group { candidates: c.clone(), total: *n })
                .collect();
            let goal = &self.all.goal;
            match relax_groups(self.coarse, &self.all.fixed, &groups, goal, TOLERANCE) {
                Some(s) => {
                    self.raise(&s)?;
                    of_way[at] = Some(shares.len());
                    shares.push(s);
                }
                // A way that tells terms not apart is no plan at all.
                None => self.known[at] = f64::INFINITY,
            }
        }
        let at = self.least()?;
        Some((self.known[at], of_way[at]))
    }

    fn least(&self) -> Option<usize> {
        (0..self.ways.len()).min_by(|a, b| self.known[*a].total_cmp(&self.known[*b]))
    }

    fn raise(&mut self, shares: &Relaxed) -> Option<()> {
        let Steps { rows, fixed, goal } = self.all;
        let t = Tangent::of(rows, &self.steps, self.coarse, shares, fixed, goal)?;
        for (known, way) in self.known.iter_mut().zip(&self.ways) {
            *known = known.max(t.bound(way)?);
        }
        Some(())
    }
}

/// Candidates at which one section ends and the next begins: in the middle between two that carry dwells.
fn section_ends(weights: &[f64]) -> Vec<usize> {
    let carrying: Vec<usize> = (0..weights.len()).filter(|i| weights[*i] > NEGLIGIBLE).collect();
    carrying.windows(2).filter(|w| w[1] > w[0] + 1).map(|w| (w[0] + w[1]).div_ceil(2)).collect()
}

fn between(ends: &[usize], all: usize) -> Vec<Range<usize>> {
    let starts = core::iter::once(0).chain(ends.iter().copied());
    starts.zip(ends.iter().copied().chain([all])).map(|(a, b)| a..b).collect()
}

/// All ways to share dwells out to sections; `None` where they are too many.
fn ways(dwells: usize, sections: usize) -> Option<Vec<Vec<f64>>> {
    let mut count: usize = 1;
    for k in 1..sections {
        count = count.checked_mul(dwells + k)? / k;
    }
    if sections == 0 || count > MOST_WAYS {
        return None;
    }
    let mut out = Vec::with_capacity(count);
    let mut way = vec![0.0; sections];
    fill(&mut out, &mut way, 0, dwells);
    Some(out)
}

fn fill(out: &mut Vec<Vec<f64>>, way: &mut Vec<f64>, section: usize, left: usize) {
    if section + 1 == way.len() {
        way[section] = left as f64;
        out.push(way.clone());
        return;
    }
    for n in 0..=left {
        way[section] = n as f64;
        fill(out, way, section + 1, left - n);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_are_all_and_different() {
        let all = ways(4, 3).unwrap();
        assert_eq!(all.len(), 15);
        assert!(all.iter().all(|w| w.iter().sum::<f64>() == 4.0));
        for (i, w) in all.iter().enumerate() {
            assert!(!all[..i].contains(w));
        }
        assert!(ways(120, 6).is_none());
    }

    #[test]
    fn sections_meet_between_what_carries_dwells() {
        assert_eq!(section_ends(&[0.5, 0.0, 0.0, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0]), [2, 6]);
        assert_eq!(between(&[2, 6], 9), [0..2, 2..6, 6..9]);
    }
}

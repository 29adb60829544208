//! Angles that are there only to test the model.

use super::candidates::{Dial, Rows};
use super::information::{Information, MOST, Row};
use super::problem::{Site, Term};

/// Angles among which spares are sought.
const LOOKED_AT: usize = 91;
/// Smallest distance of a spare from any other angle: a share of the range.
const APART: f64 = 1.0 / 14.0;
/// Passes of exchanges.
const PASSES: usize = 10;
/// What is known of the tested terms without spares, so that the first one can be judged: next to nothing of what all dwells
/// would say of them alone.
const RIDGE: f64 = 1e-6;

/// Spare angles where they show best what the model leaves out: K2 and K3 where those are not fitted, else the powers above.
///
/// **Model** the largest determinant of the information on the two tested terms beside the fitted ones.
pub(super) fn spares(
    rows: &Rows<'_>,
    dial: &Dial,
    plan: &[(Site, usize)],
    number: usize,
) -> Vec<Site> {
    let tests = Tests::of(rows);
    let mut base = Information::new(tests.columns());
    rows.upright().iter().for_each(|s| base.add(&tests.row(rows, *s), 1.0));
    plan.iter().for_each(|(s, n)| base.add(&tests.row(rows, *s), *n as f64));
    let fitted = rows.terms.len();
    for i in fitted..tests.columns() {
        base.add_diagonal(i, RIDGE);
    }
    let (low, high) = rows.problem.range;
    let apart = APART * (high.rad() - low.rad());
    let sites = dial.thinned(LOOKED_AT);
    let far = |a: Site, b: Site| (a.angle.rad() - b.angle.rad()).abs() >= apart;
    let free = |s: &Site, others: &[Site]| {
        plan.iter().all(|(p, _)| far(*s, *p)) && others.iter().all(|o| far(*s, *o))
    };
    let best = |others: &[Site]| {
        let mut m = base;
        others.iter().for_each(|s| m.add(&tests.row(rows, *s), 1.0));
        sites
            .iter()
            .filter(|s| free(s, others))
            .filter_map(|s| {
                let (_, log_determinant) = m.with(&tests.row(rows, *s), 1.0).inverse()?;
                Some((log_determinant, *s))
            })
            // Of equal ones the first: the same plan everywhere.
            .fold(None, |best: Option<(f64, Site)>, c| match best {
                Some(b) if b.0 >= c.0 - 1e-9 => Some(b),
                _ => Some(c),
            })
            .map(|b| b.1)
    };
    let mut chosen: Vec<Site> = Vec::new();
    while chosen.len() < number
        && let Some(s) = best(&chosen)
    {
        chosen.push(s);
    }
    for _ in 0..PASSES {
        let before = chosen.clone();
        for i in 0..chosen.len() {
            let mut others = chosen.clone();
            others.remove(i);
            if let Some(s) = best(&others) {
                chosen[i] = s;
            }
        }
        if chosen == before {
            break;
        }
    }
    chosen.sort_by(|a, b| a.angle.rad().total_cmp(&b.angle.rad()));
    chosen
}

/// The tested powers of sinφ.
struct Tests {
    fitted: usize,
    powers: Vec<i32>,
}

impl Tests {
    fn of(rows: &Rows<'_>) -> Self {
        let fitted: Vec<i32> = rows
            .terms
            .iter()
            .filter_map(|t| match t {
                Term::K2 => Some(2),
                Term::K3 => Some(3),
                _ => None,
            })
            .collect();
        let powers = (2..).filter(|p| !fitted.contains(p)).take(2).collect();
        Self { fitted: rows.terms.len(), powers }
    }

    fn columns(&self) -> usize {
        (self.fitted + self.powers.len()).min(MOST)
    }

    fn row(&self, rows: &Rows<'_>, site: Site) -> Row {
        let mut row = rows.row(site);
        let sd = rows.variance(site).sqrt();
        // In units of a hundredth of g: of the size of the others.
        let unit = 0.01 * rows.problem.gravity.value_m_s2;
        for (x, power) in row.iter_mut().skip(self.fitted).zip(&self.powers) {
            *x = unit * site.sine().powi(*power) / sd;
        }
        row
    }
}

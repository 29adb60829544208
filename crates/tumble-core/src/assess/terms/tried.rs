//! One term held against the data: test, identifiability, bound.

use super::pooled::{PooledTerm, pooled};
use super::{Choosing, limits};
use crate::assess::RunAssessment;
use crate::estimate::{Estimate, Method, Parameter, Term, TermChoice, TermSet, WeightedRow};
use crate::linalg::{Matrix, Triangular};
use crate::stats::student_factor;
use crate::term::{TermTest, test_term};

/// Share of a term's column that the others must leave: below it rounding decides.
const LEAST_SHARE: f64 = 1e-7;

/// What the data and the plan say about one term.
#[derive(Debug, Clone, PartialEq)]
pub struct TriedTerm {
    /// Which.
    pub term: Term,
    /// Whether it stands in the model.
    pub entered: bool,
    /// Whether it was named.
    pub named: bool,
    /// Test over all runs, in the term's SI unit; absent where the plan cannot tell it from the others at all, or no
    /// temperature was recorded.
    pub test: Option<TermTest>,
    /// Expanded uncertainties of bias, misalignment and scale error with the term in, from the scatter of the positions
    /// in all runs, over their targets.
    pub over_targets: Option<[f64; 3]>,
    /// Value from all runs, where it was entered.
    pub pooled: Option<PooledTerm>,
    /// Largest magnitude that the data allow, at the level of confidence.
    pub bound: Option<f64>,
    /// Largest magnitude with which it enters by itself.
    pub plausible: f64,
    /// Whether all positions have a temperature, where it needs one.
    pub has_temperatures: bool,
}

impl TriedTerm {
    /// Whether the plan bears it: something of its column is left, and the others still reach their targets.
    #[must_use]
    pub fn is_identifiable(&self) -> bool {
        self.test.is_some_and(|t| t.share_left >= LEAST_SHARE)
            && self.over_targets.is_some_and(|o| o.iter().all(|x| *x <= 1.0))
    }

    /// The parameter that misses its target by the largest factor with the term in.
    #[must_use]
    pub fn worst(&self) -> Option<(Parameter, f64)> {
        let over = self.over_targets?;
        Parameter::ALL.into_iter().map(|p| (p, over[p.index()])).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Whether its size is one that sensors have.
    #[must_use]
    pub fn is_plausible(&self) -> bool {
        self.test.is_some_and(|t| t.effect_lsb.abs() <= self.plausible)
    }

    pub(super) fn p_value(&self) -> f64 {
        self.test.map_or(1.0, |t| t.p_value)
    }

    /// `|t|`: orders p-values that are all zero to rounding.
    pub(super) fn significance(&self) -> f64 {
        self.test.map_or(0.0, |t| (t.effect_lsb / t.standard_uncertainty_lsb).abs())
    }

    /// Whether everything but significance lets it in.
    pub(super) fn may_enter(&self) -> bool {
        self.is_identifiable()
            && self.is_plausible()
            && self.term != Term::ScaleSign
            && self.test.is_some_and(|t| t.bic_gain > 0.0)
    }

    /// Why a significant term did not enter by itself, for people.
    #[must_use]
    pub fn obstacle(&self) -> Option<String> {
        if self.entered {
            return None;
        }
        let (unit, factor) = self.term.usual();
        match () {
            () if !self.has_temperatures => Some("temperatures were not recorded".into()),
            () if self.test.is_none() => {
                Some("the plan cannot tell it from bias, misalignment and scale error".into())
            }
            () if !self.is_identifiable() => Some(match self.worst() {
                Some((p, over)) => format!(
                    "with it the expanded uncertainty of the {} would be {over:.1} times its target",
                    p.words()
                ),
                None => "no uncertainty can be given with it".into(),
            }),
            () if !self.is_plausible() => Some(format!(
                "{:.0} {unit} is more than the {:.0} {unit} that a sensor may have",
                self.test.map_or(0.0, |t| t.effect_lsb * factor),
                self.plausible * factor
            )),
            // Tried: it took "floor" declared as "truncate" for a scale factor by sign, 2.4 U off in silence.
            () if self.term == Term::ScaleSign => Some(
                "it enters by name only: a converter whose rounding is declared wrongly looks the same".into(),
            ),
            () => None,
        }
    }
}

type Full<'a> = Vec<(&'a RunAssessment, &'a Estimate)>;

fn full(runs: &[RunAssessment]) -> Full<'_> {
    runs.iter()
        .filter_map(|r| r.estimate.as_ref().map(|e| (r, e)))
        .filter(|(_, e)| e.covariance.is_some())
        .collect()
}

impl Choosing<'_> {
    /// Holds a term against runs that were estimated with a set that may hold it.
    pub(super) fn tried(&self, term: Term, runs: &[RunAssessment], set: TermSet) -> TriedTerm {
        let entered = set.contains(term);
        let level = self.options.level;
        let test = self.test(term, runs);
        let over_targets = test.and_then(|_| self.over_targets(term, runs));
        let bound = test.and_then(|t| {
            let bounded = t.effect_lsb.abs() + t.expanded_lsb(level)?;
            bounded.is_finite().then_some(bounded)
        });
        TriedTerm {
            term,
            entered,
            named: matches!(self.options.terms, TermChoice::Named(s) if s.contains(term)),
            test,
            over_targets,
            pooled: if entered { pooled(term, runs, level) } else { None },
            bound,
            plausible: limits::plausible(term, &self.experiment.sensor),
            has_temperatures: !term.needs_temperature() || self.reference_degc.is_some(),
        }
    }

    /// The term's coefficient common to all runs, SI: of a joint fit with everything else that was entered. A term that
    /// is in the model is tested by what its own column adds.
    pub(super) fn test(&self, term: Term, runs: &[RunAssessment]) -> Option<TermTest> {
        let full = full(runs);
        let mut rows: Vec<Vec<WeightedRow>> = Vec::with_capacity(full.len());
        let mut columns = Vec::with_capacity(full.len());
        for (run, e) in &full {
            let column = self.column(term, run, e)?;
            rows.push(without(term, e, &column));
            columns.push(column);
        }
        let rows: Vec<&[WeightedRow]> = rows.iter().map(Vec::as_slice).collect();
        test_term(&rows, &columns)
    }

    /// LSB per SI unit of the coefficient, a position each; `None` without the temperatures that it needs.
    fn column(&self, term: Term, run: &RunAssessment, e: &Estimate) -> Option<Vec<f64>> {
        let [_, misalignment, scale_error] = e.full()?;
        let bench = self.setting.bench;
        let k = self.setting.nominal_scale_m_s2_per_lsb * (1.0 + scale_error);
        // The paper's rows are those of another scale, but their standard deviation in LSB is not.
        let k = if self.options.method == Method::Paper {
            self.setting.nominal_scale_m_s2_per_lsb
        } else {
            k
        };
        e.residuals
            .iter()
            .zip(&run.temperatures_degc)
            .map(|(r, t)| {
                let kelvin = match term.needs_temperature() {
                    true => (*t)? - self.reference_degc?,
                    false => 0.0,
                };
                let seat = bench.seat(crate::Angle::from_deg(r.angle_deg));
                let sine = seat
                    .vertical_sign()
                    .unwrap_or_else(|| (r.angle_deg.to_radians() + misalignment).sin());
                Some(term.basis(bench.gravity.value_m_s2 * sine, kelvin) / k)
            })
            .collect()
    }

    /// Expanded uncertainties of the three with the term in, all runs together, over their targets.
    fn over_targets(&self, term: Term, runs: &[RunAssessment]) -> Option<[f64; 3]> {
        let targets = self.experiment.targets.in_order();
        let full = full(runs);
        let (mut variance, mut dof) = ([0.0; 3], [0.0; 3]);
        for (run, e) in &full {
            let grown = self.growth(term, run, e)?;
            for i in 0..3 {
                let own = e.covariance.as_ref()?[(i, i)];
                variance[i] += own * grown[i];
                dof[i] += e.effective_dof[i].max(1.0);
            }
        }
        let count = full.len() as f64;
        let mut out = [0.0; 3];
        for i in 0..3 {
            let factor = student_factor(self.options.level, dof[i])?;
            out[i] = factor * variance[i].sqrt() / count / targets[i];
        }
        out.iter().all(|x| x.is_finite()).then_some(out)
    }

    /// Variances of the three with the term over those without; one where it is in already.
    fn growth(&self, term: Term, run: &RunAssessment, e: &Estimate) -> Option<[f64; 3]> {
        if e.terms.iter().any(|t| t.term == term) {
            return Some([1.0; 3]);
        }
        let column = self.column(term, run, e)?;
        let further = WeightedRow::further_columns(&e.weighted_rows);
        let mut with = Triangular::new(4 + further);
        let mut without = Triangular::new(3 + further);
        for (w, z) in e.weighted_rows.iter().zip(&column) {
            let mut row: Vec<f64> = w.row.iter().chain(&w.further[..further]).copied().collect();
            without.push(&row, 0.0);
            row.push(z / w.sd_lsb);
            with.push(&row, 0.0);
        }
        let (with, without) = (with.unit_covariance().ok()?, without.unit_covariance().ok()?);
        let (sin, cos) = e.values[1].unwrap_or(0.0).sin_cos();
        // Unknowns α, β, γ: the misalignment turns across (β, γ), the scale goes along it.
        let directions = match self.options.method {
            Method::Paper => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            _ => [[1.0, 0.0, 0.0], [0.0, -sin, cos], [0.0, cos, sin]],
        };
        Some(directions.map(|d| quadratic(&with, d) / quadratic(&without, d)))
    }
}

fn quadratic(c: &Matrix, d: [f64; 3]) -> f64 {
    (0..3).map(|i| (0..3).map(|j| d[i] * c[(i, j)] * d[j]).sum::<f64>()).sum()
}

/// Rows of a run as they are without a term that is in them: what only that term explains goes back into the residuals.
fn without(term: Term, e: &Estimate, column: &[f64]) -> Vec<WeightedRow> {
    let Some((place, t)) = e.terms.iter().enumerate().find(|(_, t)| t.term == term) else {
        return e.weighted_rows.clone();
    };
    let mut rows = e.weighted_rows.clone();
    for row in &mut rows {
        row.further[place..].rotate_left(1);
        if let Some(last) = row.further.last_mut() {
            *last = 0.0;
        }
    }
    let further = WeightedRow::further_columns(&rows);
    let full = |w: &WeightedRow| -> Vec<f64> {
        w.row.iter().chain(&w.further[..further]).copied().collect()
    };
    let mut triangle = Triangular::new(3 + further);
    for (w, z) in rows.iter().zip(column) {
        triangle.push(&full(w), z / w.sd_lsb);
    }
    let Ok(explained) = triangle.solve() else { return rows };
    for (w, z) in rows.iter_mut().zip(column) {
        let by_others: f64 = full(w).iter().zip(&explained).map(|(x, b)| x * b).sum();
        w.residual += t.value * (z / w.sd_lsb - by_others);
    }
    rows
}

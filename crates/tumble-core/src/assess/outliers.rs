//! Positions that do not belong, what each does to every result, and those that the user leaves out.
//!
//! Nothing is left out unless the user says so. Effects are those of real re-fits.

use super::{PooledParameter, RunAssessment};
use crate::estimate::{Estimate, Parameter};
use crate::judge::{Belonging, FALSE_ALARM, belonging, limits, of_farthest};
use crate::{Finding, FindingKind, Position, Run, Seat};

/// Positions of a run that may be left out: one in so many, and always one.
pub(crate) const LEAVABLE_SHARE: usize = 10;
/// Most positions of a run whose effect is worked out: each costs a re-fit.
const MOST: usize = 12;
/// Most positions of an experiment whose effect on the pooled values is worked out: each puts all runs together anew.
const MOST_POOLED: usize = 100;

/// A position that the user leaves out of the adjustment.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct LeftOut {
    /// Name of the run.
    pub run: String,
    /// Its number in measured order, from one.
    pub position: usize,
}

/// What a position does to one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Value without the position minus value with it, in the parameter's unit.
    pub change: f64,
    /// The same over the expanded uncertainty of the value with it; absent without uncertainty.
    pub over_u: Option<f64>,
    /// Expanded uncertainty without the position over that with it.
    pub uncertainty_ratio: Option<f64>,
}

/// A position that does not belong, or that the user left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlier {
    /// Name of the run.
    pub run: String,
    /// Number in measured order, from one.
    pub position: usize,
    /// Where it was recorded, for people.
    pub place: String,
    /// Table angle, degrees.
    pub angle_deg: f64,
    /// What the others say of it; absent where they cannot.
    pub belonging: Option<Belonging>,
    /// p-value of the farthest position of the whole experiment; small: it does not belong.
    pub p_value: Option<f64>,
    /// The finding that names it; absent where only the user does.
    pub named_by: Option<FindingKind>,
    /// Whether the user left it out: the result is without it.
    pub left_out: bool,
    /// Effect on the values of its run, in the order of [`Parameter::ALL`]; absent where the rest determines nothing.
    pub effect: Option<[Change; 3]>,
    /// Effect on the pooled values, of its mounting where there are several; with two runs and more.
    pub pooled_effect: Option<[Change; 3]>,
}

/// A pooled value with all positions and as it is reported, without those left out.
#[derive(Debug, Clone, PartialEq)]
pub struct WithAndWithout {
    /// Which.
    pub parameter: Parameter,
    /// Mounting, where there are several.
    pub mounting: Option<String>,
    /// Value and expanded uncertainty with all positions.
    pub with: (f64, f64),
    /// Value and expanded uncertainty as reported.
    pub without: (f64, f64),
}

/// All positions that do not belong or were left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outliers {
    /// In the order of the runs, measured order within.
    pub positions: Vec<Outlier>,
    /// The result with and without what the user left out; empty where nothing was.
    pub comparison: Vec<WithAndWithout>,
}

/// A run's positions with their numbers in measured order; up/down dwells of `[scale]` have none.
#[derive(Debug, Clone, Default)]
pub(super) struct Material<'a> {
    /// Those of the adjustment.
    pub used: Vec<(Option<usize>, &'a Position)>,
    /// Those that the user left out.
    pub left_out: Vec<(usize, &'a Position)>,
    /// What was noticed at single dwells before the adjustment.
    pub noticed: Vec<(usize, FindingKind)>,
}

/// How to estimate and to pool again.
pub(super) struct Again<'f> {
    pub fit: &'f dyn Fn(&[&Position]) -> Option<Estimate>,
    pub pool: &'f dyn Fn(&[RunAssessment]) -> Vec<PooledParameter>,
    /// Level of confidence.
    pub level: f64,
    /// Least scatter that is believed, LSB.
    pub least_sd_lsb: f64,
}

/// Positions of a run with their numbers: those to adjust, and those left out.
pub(super) fn split<'a>(
    run: &Run,
    candidates: Vec<&'a Position>,
    left_out: &[LeftOut],
) -> Material<'a> {
    let before = candidates.len().saturating_sub(run.positions.len());
    let is_out = |n: usize| left_out.iter().any(|l| l.run == run.name && l.position == n);
    let mut material = Material::default();
    for (i, p) in candidates.into_iter().enumerate() {
        match (i + 1).checked_sub(before).filter(|n| *n > 0) {
            Some(n) if is_out(n) => material.left_out.push((n, p)),
            number => material.used.push((number, p)),
        }
    }
    material
}

/// The numbers of positions that were chosen among numbered ones, in the same order.
pub(super) fn numbered<'a>(
    all: &[(Option<usize>, &'a Position)],
    chosen: &[&'a Position],
) -> Vec<(Option<usize>, &'a Position)> {
    let mut next = chosen.iter().peekable();
    all.iter().filter(|(_, p)| next.next_if(|c| std::ptr::eq(**c, *p)).is_some()).copied().collect()
}

/// Finds what does not belong, and what it and everything left out do to the results.
///
/// **Model** a run's farthest position in externally studentized residuals is named where its p-value times the
/// positions of the experiment is below [`FALSE_ALARM`]; then the next, without it. Positions that do not fit by the
/// hygiene of the data start named. `names` says whether any are sought: data that contradict the model have none.
pub(super) fn outliers(
    materials: &[Material<'_>],
    runs: &[RunAssessment],
    pooled: &[PooledParameter],
    again: &Again<'_>,
    names: Seek,
) -> Outliers {
    let fitted = runs.iter().filter_map(|r| r.estimate.as_ref()).filter(|e| e.covariance.is_some());
    let tests: usize = fitted.map(|e| e.weighted_rows.len()).sum();
    let mut positions = Vec::new();
    for (index, material) in materials.iter().enumerate() {
        let Some(estimate) = runs[index].estimate.as_ref().filter(|e| e.covariance.is_some())
        else {
            continue;
        };
        let pools = positions.len() < MOST_POOLED;
        let study = Study { material, index, runs, pooled, estimate, again, tests, pools };
        positions.extend(study.positions(names));
    }
    Outliers { positions, comparison: comparison(materials, runs, pooled, again) }
}

/// Whether positions that do not belong are sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seek {
    /// Yes.
    All,
    /// Only what is named already is followed up.
    Named,
}

/// One run, looked at for what does not belong.
struct Study<'s> {
    material: &'s Material<'s>,
    index: usize,
    runs: &'s [RunAssessment],
    pooled: &'s [PooledParameter],
    estimate: &'s Estimate,
    again: &'s Again<'s>,
    tests: usize,
    /// Whether the pooled values are worked out, too.
    pools: bool,
}

impl Study<'_> {
    fn positions(&self, seek: Seek) -> Vec<Outlier> {
        let mut named = self.named_before();
        if seek == Seek::All {
            self.seek(&mut named);
        }
        let mut out: Vec<Outlier> =
            named.iter().map(|(i, by)| self.named(*i, *by, &named)).collect();
        out.extend(self.material.left_out.iter().take(MOST).map(|(n, p)| self.left_out(*n, p)));
        out.sort_by_key(|o| o.position);
        out
    }

    /// Indices among the used positions that hygiene found not to fit.
    fn named_before(&self) -> Vec<(usize, FindingKind)> {
        let not_fitting = |n: Option<usize>| {
            let kinds = self.material.noticed.iter().filter(|(m, _)| Some(*m) == n);
            kinds
                .map(|(_, k)| *k)
                .find(|k| matches!(k, FindingKind::DwellDoesNotFit | FindingKind::MistypedAngle))
        };
        let used = self.material.used.iter().enumerate();
        used.filter_map(|(i, (n, _))| not_fitting(*n).map(|k| (i, k))).take(MOST).collect()
    }

    /// Adds what does not belong, the farthest first.
    fn seek(&self, named: &mut Vec<(usize, FindingKind)>) {
        let used = &self.material.used;
        let most = (used.len() / limits::WRONG_SHARE).min(MOST);
        if used.len() < limits::FEWEST_DWELLS {
            return;
        }
        while named.len() < most {
            let kept: Vec<usize> =
                (0..used.len()).filter(|i| !named.iter().any(|(j, _)| j == i)).collect();
            let refitted = (!named.is_empty()).then(|| self.fit_of(&kept));
            let estimate = match &refitted {
                None => self.estimate,
                Some(Some(e)) => e,
                Some(None) => return,
            };
            let held = belonging(&estimate.weighted_rows, self.again.least_sd_lsb);
            let farthest = kept
                .iter()
                .zip(held)
                .filter(|(i, _)| used[**i].0.is_some() && used[**i].1.seat == Seat::Table)
                .filter_map(|(i, b)| b.map(|b| (*i, b.p_value)))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            match farthest {
                Some((i, p)) if of_farthest(p, self.tests) < FALSE_ALARM => {
                    named.push((i, self.noticed_at(i).unwrap_or(FindingKind::DoesNotBelong)));
                }
                _ => return,
            }
        }
    }

    fn noticed_at(&self, i: usize) -> Option<FindingKind> {
        let number = self.material.used[i].0;
        self.material.noticed.iter().find(|(n, _)| Some(*n) == number).map(|(_, k)| *k)
    }

    fn fit_of(&self, indices: &[usize]) -> Option<Estimate> {
        let positions: Vec<&Position> = indices.iter().map(|i| self.material.used[*i].1).collect();
        (self.again.fit)(&positions)
    }

    fn named(&self, i: usize, by: FindingKind, named: &[(usize, FindingKind)]) -> Outlier {
        let all = 0..self.material.used.len();
        // Held against those that belong, without the other suspects.
        let company: Vec<usize> =
            all.clone().filter(|k| *k == i || !named.iter().any(|(j, _)| j == k)).collect();
        let at = company.iter().position(|k| *k == i).unwrap_or(0);
        let held = match company.len() == self.material.used.len() {
            true => self.held(&self.estimate.weighted_rows, at),
            false => self.fit_of(&company).and_then(|e| self.held(&e.weighted_rows, at)),
        };
        let others: Vec<usize> = all.filter(|k| *k != i).collect();
        let without = self.fit_of(&others);
        let (number, position) = self.material.used[i];
        Outlier {
            named_by: Some(by),
            effect: without.as_ref().and_then(|e| self.change(self.estimate, e)),
            pooled_effect: without.filter(|_| self.pools).and_then(|e| {
                self.pooled_change(self.pooled, &(self.again.pool)(&self.with_estimate(e)))
            }),
            ..self.outlier(number.unwrap_or(0), position, held)
        }
    }

    fn left_out(&self, number: usize, position: &Position) -> Outlier {
        let mut company: Vec<&Position> = self.material.used.iter().map(|(_, p)| *p).collect();
        company.push(position);
        let with = (self.again.fit)(&company);
        let held = with.as_ref().and_then(|e| self.held(&e.weighted_rows, company.len() - 1));
        Outlier {
            left_out: true,
            effect: with.as_ref().and_then(|e| self.change(e, self.estimate)),
            pooled_effect: with.filter(|_| self.pools).and_then(|e| {
                self.pooled_change(&(self.again.pool)(&self.with_estimate(e)), self.pooled)
            }),
            ..self.outlier(number, position, held)
        }
    }

    fn outlier(&self, number: usize, position: &Position, held: Option<Belonging>) -> Outlier {
        Outlier {
            run: self.runs[self.index].name.clone(),
            position: number,
            place: position.place.clone(),
            angle_deg: position.angle.deg(),
            p_value: held.map(|b| of_farthest(b.p_value, self.tests)),
            belonging: held,
            named_by: None,
            left_out: false,
            effect: None,
            pooled_effect: None,
        }
    }

    fn held(&self, rows: &[crate::estimate::WeightedRow], at: usize) -> Option<Belonging> {
        belonging(rows, self.again.least_sd_lsb).get(at).copied().flatten()
    }

    /// The runs with another estimate of this one.
    fn with_estimate(&self, estimate: Estimate) -> Vec<RunAssessment> {
        let mut runs = self.runs.to_vec();
        runs[self.index].estimate = Some(estimate);
        runs
    }

    fn change(&self, with: &Estimate, without: &Estimate) -> Option<[Change; 3]> {
        let expanded =
            |e: &Estimate, p| e.interval(p, self.again.level).map(|[a, b]| 0.5 * (b - a));
        let [a, b] = [with.full()?, without.full()?];
        Some(Parameter::ALL.map(|p| {
            let i = p.index();
            changed((a[i], expanded(with, p)), (b[i], expanded(without, p)))
        }))
    }

    fn pooled_change(
        &self,
        with: &[PooledParameter],
        without: &[PooledParameter],
    ) -> Option<[Change; 3]> {
        let mounting = &self.runs[self.index].mounting;
        let mut out = [None; 3];
        for parameter in Parameter::ALL {
            let of = |all: &[PooledParameter]| {
                all.iter()
                    .find(|p| {
                        p.parameter == parameter
                            && p.mounting.as_ref().is_none_or(|m| m == mounting)
                    })
                    .filter(|p| p.runs > 1)
                    .map(|p| (p.value, Some(p.expanded_uncertainty)))
            };
            out[parameter.index()] = of(with).zip(of(without)).map(|(a, b)| changed(a, b));
        }
        match out {
            [Some(a), Some(b), Some(c)] => Some([a, b, c]),
            _ => None,
        }
    }
}

fn changed(with: (f64, Option<f64>), without: (f64, Option<f64>)) -> Change {
    let change = without.0 - with.0;
    let usable = |u: Option<f64>| u.filter(|u| u.is_finite() && *u > 0.0);
    Change {
        change,
        over_u: usable(with.1).map(|u| change / u),
        uncertainty_ratio: usable(with.1).zip(usable(without.1)).map(|(a, b)| b / a),
    }
}

/// The pooled values with everything that was left out, beside those that are reported.
fn comparison(
    materials: &[Material<'_>],
    runs: &[RunAssessment],
    pooled: &[PooledParameter],
    again: &Again<'_>,
) -> Vec<WithAndWithout> {
    if materials.iter().all(|m| m.left_out.is_empty()) {
        return Vec::new();
    }
    let whole: Vec<RunAssessment> = runs
        .iter()
        .zip(materials)
        .map(|(run, m)| {
            let all: Vec<&Position> =
                m.used.iter().map(|(_, p)| *p).chain(m.left_out.iter().map(|(_, p)| *p)).collect();
            let estimate =
                if m.left_out.is_empty() { run.estimate.clone() } else { (again.fit)(&all) };
            RunAssessment { estimate, ..run.clone() }
        })
        .collect();
    let with = (again.pool)(&whole);
    pooled
        .iter()
        .filter_map(|p| {
            let all =
                with.iter().find(|w| w.parameter == p.parameter && w.mounting == p.mounting)?;
            Some(WithAndWithout {
                parameter: p.parameter,
                mounting: p.mounting.clone(),
                with: (all.value, all.expanded_uncertainty),
                without: (p.value, p.expanded_uncertainty),
            })
        })
        .collect()
}

/// A change for people, with its sign.
fn shown(parameter: Parameter, c: &Change) -> String {
    let sign = if c.change > 0.0 { "+" } else { "" };
    let u = c.over_u.map_or_else(String::new, |u| format!(" ({u:+.1} U)"));
    format!("{} {sign}{}{u}", parameter.words(), parameter.shown(c.change))
}

impl Outlier {
    /// Largest effect on the run's values, in expanded uncertainties.
    #[must_use]
    pub fn largest_effect(&self) -> Option<f64> {
        self.effect?.iter().filter_map(|c| c.over_u).map(f64::abs).reduce(f64::max)
    }

    /// The effect in words.
    fn effect_in_words(&self) -> Option<String> {
        let e = self.effect.as_ref()?;
        let all: Vec<String> = Parameter::ALL.iter().zip(e).map(|(p, c)| shown(*p, c)).collect();
        let moves = match self.largest_effect() {
            Some(u) if u > 1.0 => "; that is more than the run's own uncertainty",
            _ => "",
        };
        Some(format!("without it {}{moves}", all.join(", ")))
    }

    /// How far off and how unlikely, in words.
    fn distance_in_words(&self) -> String {
        let Some(b) = &self.belonging else { return "nothing to hold it against".into() };
        format!(
            "{:+.2} LSB off what the others expect, t = {:.1} with {:.0} degrees of freedom, p = {:.1e}",
            b.residual_lsb,
            b.studentized,
            b.degrees_of_freedom,
            self.p_value.unwrap_or(1.0)
        )
    }
}

/// What is worth saying; the findings that name a position already get its effect added.
pub(super) fn findings(
    outliers: &Outliers,
    materials: &[Material<'_>],
    runs: &[RunAssessment],
    existing: &mut [Finding],
) -> Vec<Finding> {
    let mut out = Vec::new();
    for o in &outliers.positions {
        let effect = o.effect_in_words();
        match o.named_by {
            Some(FindingKind::DoesNotBelong) => out.push(does_not_belong(o, effect)),
            Some(by) => {
                let said = existing.iter_mut().find(|f| f.kind == by && f.place == o.place);
                if let (Some(f), Some(effect)) = (said, effect) {
                    f.observed = format!("{}; {effect}", f.observed);
                }
            }
            None => {}
        }
    }
    for (m, run) in materials.iter().zip(runs).filter(|(m, _)| !m.left_out.is_empty()) {
        let total = m.used.len() + m.left_out.len();
        out.push(left_out(m, run, total, outliers));
        let allowed = leavable(total);
        if m.left_out.len() > allowed {
            out.push(Finding {
                kind: FindingKind::TooManyLeftOut,
                place: run.name.clone(),
                observed: format!("{} of {total} positions left out", m.left_out.len()),
                limit: format!("one in {LEAVABLE_SHARE}: {allowed}"),
                remedy: "measure the run again; what remains after choosing proves nothing".into(),
            });
        }
    }
    out
}

/// Positions of a run that may be left out.
fn leavable(positions: usize) -> usize {
    (positions / LEAVABLE_SHARE).max(1)
}

fn does_not_belong(o: &Outlier, effect: Option<String>) -> Finding {
    let effect = effect.map_or_else(String::new, |e| format!("; {e}"));
    Finding {
        kind: FindingKind::DoesNotBelong,
        place: o.place.clone(),
        observed: format!(
            "position {} of {}: {}{effect}",
            o.position,
            o.run,
            o.distance_in_words()
        ),
        limit: format!("p ≥ {FALSE_ALARM}, over all positions of the experiment"),
        remedy: format!(
            "it is in the result; measure it again, or if the notes say why it is wrong, leave it out with --leave-out {}:{}",
            o.run, o.position
        ),
    }
}

fn left_out(m: &Material<'_>, run: &RunAssessment, total: usize, all: &Outliers) -> Finding {
    const SHOWN: usize = 8;
    let listed: Vec<String> = m.left_out.iter().take(SHOWN).map(|(n, _)| n.to_string()).collect();
    let more = if m.left_out.len() > SHOWN { ", …" } else { "" };
    let fits: Vec<String> = all
        .positions
        .iter()
        .filter(|o| o.left_out && o.run == run.name && o.p_value.is_none_or(|p| p >= FALSE_ALARM))
        .take(SHOWN)
        .map(|o| o.position.to_string())
        .collect();
    let fits = match fits.as_slice() {
        [] => String::new(),
        some => format!("; nothing in the data speaks against {}", some.join(", ")),
    };
    let both: Vec<String> = all
        .comparison
        .iter()
        .filter(|c| c.mounting.as_ref().is_none_or(|x| *x == run.mounting))
        .map(|c| {
            let shown =
                |(v, u): (f64, f64)| format!("{} ± {}", c.parameter.shown(v), c.parameter.shown(u));
            format!("{} {} (with all {})", c.parameter.words(), shown(c.without), shown(c.with))
        })
        .collect();
    let both = if both.is_empty() { String::new() } else { format!("; {}", both.join(", ")) };
    Finding {
        kind: FindingKind::LeftOutByUser,
        place: run.name.clone(),
        observed: format!("position {}{more} of {total} left out{fits}{both}", listed.join(", ")),
        limit: "every position that was measured".into(),
        remedy: "say why in `note`; where a position was chosen for looking wrong, the intervals are too short: measure it again".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_in_ten_may_go_and_always_one() {
        assert_eq!([4, 12, 19, 20, 60].map(leavable), [1, 1, 1, 2, 6]);
    }

    #[test]
    fn changes_are_without_minus_with() {
        let c = changed((1.0, Some(0.5)), (1.25, Some(0.4)));
        assert_eq!((c.change, c.over_u), (0.25, Some(0.5)));
        assert!((c.uncertainty_ratio.unwrap() - 0.8).abs() < 1e-15);
        assert_eq!(changed((1.0, None), (2.0, Some(0.0))).over_u, None);
        assert_eq!(shown(Parameter::Misalignment, &c), "misalignment +250 mrad (+0.5 U)");
    }
}

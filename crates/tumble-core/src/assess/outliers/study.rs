//! One run, looked at for positions that do not belong.

use super::{Again, Change, MOST, Material, Outlier, Seek, changed};
use crate::assess::{PooledParameter, RunAssessment};
use crate::estimate::{Estimate, Parameter};
use crate::judge::{Belonging, FALSE_ALARM, belonging, limits, of_farthest};
use crate::{FindingKind, Position, Seat};

/// One run, looked at for what does not belong.
pub(super) struct Study<'s> {
    pub material: &'s Material<'s>,
    pub index: usize,
    pub runs: &'s [RunAssessment],
    pub pooled: &'s [PooledParameter],
    pub estimate: &'s Estimate,
    pub again: &'s Again<'s>,
    pub tests: usize,
    /// Whether the pooled values are worked out, too.
    pub pools: bool,
}

impl Study<'_> {
    pub fn positions(&self, seek: Seek) -> Vec<Outlier> {
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

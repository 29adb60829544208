//! Further terms: tried by themselves or named, entered or bounded, pooled over the runs.
//!
//! **Rule of entry** (`auto`). All terms that can be tested are one family. The most significant one enters if its p-value
//! is below [`FAMILY_LEVEL`] over the number of tests that are left (Holm), Schwarz' criterion favours it, the plan bears
//! it (expanded uncertainties with it reach their targets), its size is plausible for a sensor, and the runs agree on it;
//! then the rest is tried again beside it. Where the most significant one may not enter, none of its kind does: a second
//! best would only imitate it.
//!
//! **Source** method section 8 (end); `docs/terms.md` for measured rates.

mod findings;
mod limits;
mod pooled;
mod tried;

pub use pooled::{CompensationTerms, PooledTerm};
pub use tried::TriedTerm;

pub(super) use findings::{explain_structure, term_findings};
pub(super) use pooled::compensation_terms;

pub(crate) use limits::DEFAULT_K2_UG_G2;

use super::RunAssessment;
use crate::estimate::{EstimateOptions, Method, Setting, Term, TermChoice, TermSet};
use crate::systematic::Quantity;
use crate::{Experiment, Finding, FindingKind, Severity};

/// Probability that any term enters an experiment that has none, over all terms tried together.
pub(crate) const FAMILY_LEVEL: f64 = 0.01;
/// p-value of "all runs have the same coefficient" below which a term does not enter by itself: it is then no property
/// of the sensor but of what happened in some runs.
const AGREE_LEVEL: f64 = 0.001;

/// What was tried, and what came of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Terms {
    /// Every term, in order.
    pub tried: Vec<TriedTerm>,
    /// Terms in the model of every run.
    pub entered: TermSet,
    /// `T̄` of the terms on temperature, °C: mean of all positions; absent where a temperature is missing.
    pub reference_temperature_degc: Option<f64>,
}

/// Runs estimated with a set of terms, and what was found on the way.
pub(super) type Estimated = (Vec<RunAssessment>, Vec<Finding>);

/// What the choice of terms needs to know.
pub(super) struct Choosing<'a> {
    pub experiment: &'a Experiment,
    pub setting: &'a Setting<'a>,
    pub options: &'a EstimateOptions,
    pub reference_degc: Option<f64>,
}

/// `T̄`: mean temperature of all positions on the table; absent where one was not recorded.
pub(super) fn reference_temperature(experiment: &Experiment) -> Option<f64> {
    let all: Option<Vec<f64>> =
        experiment.runs.iter().flat_map(|r| &r.positions).map(|p| p.temperature_degc).collect();
    crate::stats::mean(&all?)
}

/// The systematic error that a fitted term takes the place of.
pub(super) fn replaced(term: Term) -> Option<Quantity> {
    match term {
        Term::K2 => Some(Quantity::Quadratic),
        Term::K3 => Some(Quantity::Cubic),
        Term::TempBias => Some(Quantity::BiasTempco),
        Term::TempScale => Some(Quantity::ScaleTempco),
        Term::ScaleSign => None,
    }
}

impl Choosing<'_> {
    /// Estimates all runs with the terms that were named or that the data ask for.
    pub fn choose(&self, estimate: impl Fn(TermSet) -> Estimated) -> (Estimated, Terms) {
        let plain = estimate(TermSet::EMPTY);
        let (estimated, entered) = match self.options.terms {
            _ if self.options.method == Method::Paper => (plain, TermSet::EMPTY),
            TermChoice::Named(set) => self.named(set, plain, estimate),
            TermChoice::Auto => self.by_themselves(plain, estimate),
        };
        let tried = Term::ALL.into_iter().map(|t| self.tried(t, &estimated.0, entered)).collect();
        let terms = Terms { tried, entered, reference_temperature_degc: self.reference_degc };
        (estimated, terms)
    }

    /// Those of a set that the plan bears, whether significant or not.
    fn named(
        &self,
        set: TermSet,
        mut at: Estimated,
        estimate: impl Fn(TermSet) -> Estimated,
    ) -> (Estimated, TermSet) {
        let mut entered = TermSet::EMPTY;
        for term in set.iter() {
            if self.tried(term, &at.0, entered).is_identifiable() {
                let next = estimate(entered.with(term));
                // All runs have the same terms, or none has.
                if in_all(&next.0, term) {
                    entered = entered.with(term);
                    at = next;
                }
            }
        }
        (at, entered)
    }

    fn by_themselves(
        &self,
        mut at: Estimated,
        estimate: impl Fn(TermSet) -> Estimated,
    ) -> (Estimated, TermSet) {
        let mut entered = TermSet::EMPTY;
        if explained_otherwise(&at.1) {
            return (at, entered);
        }
        let family =
            Term::ALL.iter().filter(|t| self.tried(**t, &at.0, entered).test.is_some()).count();
        let mut closed = [false; 2];
        while !(closed[0] && closed[1]) {
            let threshold = FAMILY_LEVEL / (family - entered.len()).max(1) as f64;
            let best = Term::ALL
                .into_iter()
                .filter(|t| !entered.contains(*t) && !closed[kind(*t)])
                .map(|t| self.tried(t, &at.0, entered))
                .filter(|t| t.p_value() < threshold)
                .min_by(|a, b| a.significance().total_cmp(&b.significance()).reverse());
            let Some(best) = best else { break };
            let kind = kind(best.term);
            if !best.may_enter() {
                closed[kind] = true;
                continue;
            }
            let next = estimate(entered.with(best.term));
            let after = self.tried(best.term, &next.0, entered.with(best.term));
            if in_all(&next.0, best.term) && self.holds_up(&after, &next.0, threshold) {
                entered = entered.with(best.term);
                at = next;
            } else {
                closed[kind] = true;
            }
        }
        (at, entered)
    }

    /// Whether a term, once entered, is the sensor's: the runs agree on it, and where errors of the positions repeat from
    /// run to run (then runs are no independent evidence) each run shows it alone.
    fn holds_up(&self, after: &TriedTerm, runs: &[RunAssessment], threshold: f64) -> bool {
        if !after.may_enter() || pooled::disagreement(after.term, runs) < AGREE_LEVEL {
            return false;
        }
        super::repeated_share(runs).is_none()
            || (0..runs.len())
                .all(|i| self.test(after.term, &runs[i..=i]).is_none_or(|t| t.p_value < threshold))
    }
}

/// Terms in the angle, and terms in the temperature.
fn kind(term: Term) -> usize {
    usize::from(term.needs_temperature())
}

fn in_all(runs: &[RunAssessment], term: Term) -> bool {
    let mut full = runs
        .iter()
        .filter_map(|r| r.estimate.as_ref())
        .filter(|e| e.covariance.is_some())
        .peekable();
    full.peek().is_some() && full.all(|e| e.terms.iter().any(|t| t.term == term))
}

/// Whether the data have another fault, that a term would only hide.
fn explained_otherwise(findings: &[Finding]) -> bool {
    findings.iter().any(|f| {
        f.kind.severity() == Severity::Reject
            || matches!(f.kind, FindingKind::DwellDoesNotFit | FindingKind::MistypedAngle)
    })
}

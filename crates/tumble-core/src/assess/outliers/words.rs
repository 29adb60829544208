//! What is said of positions that do not belong, and of those that were left out.

use super::{Change, LEAVABLE_SHARE, Material, Outlier, Outliers};
use crate::assess::RunAssessment;
use crate::estimate::Parameter;
use crate::judge::FALSE_ALARM;
use crate::{Finding, FindingKind};

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
pub(in crate::assess) fn findings(
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
    let position = if m.left_out.len() == 1 { "position" } else { "positions" };
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
        observed: format!("{position} {}{more} of {total} left out{fits}{both}", listed.join(", ")),
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
    fn changes_have_their_sign() {
        let c = Change { change: 0.25, over_u: Some(0.5), uncertainty_ratio: None };
        assert_eq!(shown(Parameter::Misalignment, &c), "misalignment +250 mrad (+0.5 U)");
    }
}

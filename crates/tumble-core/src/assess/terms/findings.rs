//! What is worth saying about further terms.

use super::{FAMILY_LEVEL, Terms, TriedTerm};
use crate::estimate::Term;
use crate::{ARCMIN_RAD, Finding, FindingKind};

/// Terms that entered by themselves, and named ones that could not.
pub(in crate::assess) fn term_findings(terms: &Terms, gravity_m_s2: f64) -> Vec<Finding> {
    terms
        .tried
        .iter()
        .filter_map(|t| match (t.entered, t.named) {
            (true, false) => Some(entered(t, gravity_m_s2)),
            (false, true) if !t.has_temperatures => Some(no_temperatures(t)),
            (false, true) => Some(not_identifiable(t)),
            _ => None,
        })
        .collect()
}

fn entered(t: &TriedTerm, gravity_m_s2: f64) -> Finding {
    let (unit, factor) = t.term.usual();
    let value = t.pooled.map_or(0.0, |p| p.value);
    let size = t.pooled.map_or_else(String::new, |p| {
        format!("{:+.4} ± {:.2} {unit}", p.value * factor, p.expanded_uncertainty * factor)
    });
    let (p, gain) = t.test.map_or((1.0, 0.0), |x| (x.p_value, x.bic_gain));
    Finding {
        kind: FindingKind::TermEntered,
        place: t.term.name().into(),
        observed: format!("{}: {size}, p = {p:.1e}, BIC smaller by {gain:.0}", t.term.words()),
        limit: format!(
            "entered where significant at {:.0} % over all terms tried, identifiable, and not above {:.0} {unit}",
            100.0 * FAMILY_LEVEL,
            t.plausible * factor
        ),
        remedy: format!(
            "{}; to leave it out, certify with --terms none",
            same_look(t.term, value, gravity_m_s2)
        ),
    }
}

/// What in the bench would look the same, with its size.
fn same_look(term: Term, value: f64, gravity_m_s2: f64) -> String {
    let arcmin = |rad: f64| rad.abs() / ARCMIN_RAD;
    match term {
        // e g cosφ sin(φ + 90°) = e g (1 − sin²φ).
        Term::K2 => format!(
            "a dial that is eccentric by {:.1}′ would look the same: have up and down dwells (±90°) in the same power-up, or check the dial",
            arcmin(value * gravity_m_s2)
        ),
        // e g cosφ sinφ = e g (sinφ − sin³φ/2 − …).
        Term::K3 => format!(
            "a dial that is eccentric by about {:.1}′ would look nearly the same: check the dial with another sensor or against a reference",
            arcmin(2.0 * value * gravity_m_s2 * gravity_m_s2)
        ),
        Term::ScaleSign => format!(
            "a dial whose degrees differ by {:.0} ppm on the two sides of 0° would look nearly the same: check it with another sensor",
            (1e6 * value).abs()
        ),
        Term::TempBias | Term::TempScale => {
            "anything that drifts as the temperature does would look the same: repeat a run with the temperature going the other way".into()
        }
    }
}

fn no_temperatures(t: &TriedTerm) -> Finding {
    Finding {
        kind: FindingKind::TermNeedsTemperature,
        place: t.term.name().into(),
        observed: "positions without a temperature".into(),
        limit: "a temperature at every position".into(),
        remedy: format!(
            "record temperature_degc with every dwell, or leave {} out of --terms",
            t.term.name()
        ),
    }
}

fn not_identifiable(t: &TriedTerm) -> Finding {
    Finding {
        kind: FindingKind::TermNotIdentifiable,
        place: t.term.name().into(),
        observed: t.obstacle().unwrap_or_else(|| "the runs do not all determine it".into()),
        limit: "expanded uncertainties within their targets, with the term in".into(),
        remedy: format!("{}; or leave {} out of --terms", to_measure(t.term), t.term.name()),
    }
}

/// What would make a term identifiable.
pub(super) fn to_measure(term: Term) -> &'static str {
    match term {
        Term::K2 | Term::ScaleSign => {
            "add one dwell with the axis up and one with it down (±90°) to the run, in the same power-up, and use the table's whole range"
        }
        Term::K3 => {
            "use the table's whole range (±65° rather than ±30°), with more positions near its ends"
        }
        Term::TempBias | Term::TempScale => {
            "let the temperature change within the run by several kelvin, not in step with the angle, about the same in all runs"
        }
    }
}

/// Adds to findings of left-over structure which term would explain it, and why it did not enter.
pub(in crate::assess) fn explain_structure(findings: &mut [Finding], terms: &Terms) {
    for f in findings {
        let term = match f.kind {
            FindingKind::QuadraticResidual => Term::K2,
            FindingKind::CubicResidual => Term::K3,
            _ => continue,
        };
        let Some(tried) = terms.tried.iter().find(|t| t.term == term && !t.entered) else {
            continue;
        };
        let (unit, factor) = term.usual();
        let size = tried.test.map(|t| format!(" of {:+.0} {unit}", t.effect_lsb * factor));
        let why = match tried.obstacle() {
            Some(why) if !tried.is_identifiable() => format!("{why}: {}", to_measure(term)),
            Some(why) => format!(
                "{why}; if it is the sensor's all the same, name it: --terms {}",
                term.name()
            ),
            None => format!("if it is the sensor's, name it: --terms {}", term.name()),
        };
        f.remedy.push_str(&format!(
            "; the term {}{} would explain it, and it did not enter by itself: {why}",
            term.name(),
            size.unwrap_or_default()
        ));
    }
}

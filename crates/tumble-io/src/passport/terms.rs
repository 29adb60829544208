//! Further terms in the passport: names and shapes, no arithmetic.

use tumble_core::assess::{Assessment, CompensationTerms, TriedTerm};
use tumble_core::estimate::{Estimate, EstimateOptions, Method, TermChoice};
use tumble_core::linalg::Matrix;

use super::types as wire;

/// The choice as it is typed.
pub(super) fn terms_option(options: &EstimateOptions) -> String {
    match (options.method, options.terms) {
        (Method::Paper, _) => "none".into(),
        (_, TermChoice::Auto) => "auto".into(),
        (_, TermChoice::Named(set)) if set.is_empty() => "none".into(),
        (_, TermChoice::Named(set)) => set.iter().map(|t| t.name()).collect::<Vec<_>>().join(","),
    }
}

/// Every term that was tried.
pub(super) fn terms(a: &Assessment, level: f64) -> Vec<wire::Term> {
    a.terms.tried.iter().map(|t| term(t, level)).collect()
}

fn finite(v: f64) -> Option<f64> {
    v.is_finite().then_some(v)
}

fn term(t: &TriedTerm, level: f64) -> wire::Term {
    let test = t.test.filter(|x| x.effect_lsb.is_finite());
    let value = t.pooled.map(|p| p.value).or(test.map(|x| x.effect_lsb));
    let expanded = t
        .pooled
        .map(|p| p.expanded_uncertainty)
        .or(test.and_then(|x| x.expanded_lsb(level)))
        .and_then(finite);
    let around = |v: f64, u: f64| tumble_core::assess::Interval::around(v, u);
    let (unit, _) = t.term.usual();
    let usual = |v: f64| t.term.in_usual_unit(v);
    wire::Term {
        name: t.term.name().into(),
        entered: t.entered,
        value,
        unit: t.term.unit().into(),
        standard_uncertainty: t
            .pooled
            .map(|p| p.standard_uncertainty)
            .or(test.map(|x| x.standard_uncertainty_lsb))
            .and_then(finite),
        degrees_of_freedom: t
            .pooled
            .map(|p| p.degrees_of_freedom)
            .or(test.map(|x| x.degrees_of_freedom))
            .and_then(finite),
        expanded_uncertainty: expanded,
        interval: value.zip(expanded).map(|(v, u)| around(v, u)).map(|i| [i.low, i.high]),
        p_value: test.map(|x| x.p_value),
        criterion_difference: test.and_then(|x| finite(x.bic_gain)),
        identifiable: t.is_identifiable(),
        bound: t.bound,
        plausible: t.plausible,
        obstacle: t.obstacle(),
        in_usual_unit: wire::UsualUnit {
            unit: unit.into(),
            value: value.map(usual),
            expanded_uncertainty: expanded.map(usual),
            bound: t.bound.map(usual),
            plausible: usual(t.plausible),
        },
    }
}

pub(super) fn compensation_terms(c: &CompensationTerms) -> wire::CompensationTerms {
    wire::CompensationTerms {
        coefficients: c
            .coefficients
            .iter()
            .map(|(t, value)| wire::Coefficient {
                name: t.name().into(),
                value: *value,
                unit: t.unit().into(),
            })
            .collect(),
        reference_temperature_degc: c.reference_temperature_degc,
        covariance: square(&c.covariance),
        terms_peak_m_s2: c.peak_m_s2,
    }
}

pub(super) fn run_terms(e: &Estimate) -> Vec<wire::RunTerm> {
    e.terms
        .iter()
        .map(|t| wire::RunTerm {
            name: t.term.name().into(),
            value: t.value,
            unit: t.term.unit().into(),
            standard_uncertainty: t.standard_uncertainty,
            degrees_of_freedom: finite(t.degrees_of_freedom),
        })
        .collect()
}

/// A square matrix of any size.
pub(super) fn square(m: &Matrix) -> Vec<Vec<f64>> {
    (0..m.rows()).map(|i| (0..m.columns()).map(|j| m[(i, j)]).collect()).collect()
}

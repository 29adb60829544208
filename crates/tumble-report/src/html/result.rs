//! The result table: values, uncertainties, prediction, correlations in words.

use maud::{Markup, html};
use tumble_io::passport::{Estimate, Passport, ResultSection};

use super::parts::{degrees_of_freedom, maybe, number, numbers, table, text, units};
use super::{Page, section};
use crate::numbers::{
    NONE, Rounded, correlation, interval, own_digits, power_of_ten, rounded_to, typographic,
    value_with_uncertainty,
};
use crate::standing;
use crate::summary::level;
use crate::units::{Parameter, Unit};
use crate::words::{parameter, shortened, tie};

/// A line of the result: name, estimate, unit, second unit.
struct Line<'p> {
    name: String,
    estimate: &'p Estimate,
    unit: Unit,
    second: Option<Unit>,
}

pub(super) fn result(page: &Page<'_>) -> Markup {
    let Some(result) = standing::result(page.passport) else { return html! {} };
    let lines = lines(page, result);
    let level = level(page.passport);
    let main: Vec<Vec<String>> = lines.iter().map(row).collect();
    let parts: Vec<Vec<String>> = lines.iter().map(parts_row).collect();
    let body = html! {
        (table(
            "main",
            &format!("u: standard uncertainty. U = k·u: expanded uncertainty at {level}. ν: effective degrees of freedom."),
            &[text("Parameter"), numbers("Value"), numbers("± U"), numbers("u"), numbers("k"), numbers("ν"), units("Unit"),
              units("In other units (± U)")],
            &main,
        ))
        (table(
            "",
            &format!("What the uncertainty is made of, and what the next power-up may bring ({level}). s: standard deviation between runs; ω: \
                 of the true value between power-ups."),
            &[text("Parameter"), numbers("u, scatter"), numbers("u, budget"), numbers("s"),
              numbers("ω"), numbers("Next estimate"), numbers("Next true value"), units("Unit")],
            &parts,
        ))
        (prediction_note(result))
        (correlations(page.passport))
    };
    section("Result", &body)
}

fn lines<'p>(page: &Page<'p>, result: &'p ResultSection) -> Vec<Line<'p>> {
    let line = |name: String, estimate, p: Parameter| Line {
        name,
        estimate,
        unit: page.units.parameter(p).clone(),
        second: page.units.second(p, page.passport.nominal_scale_m_s2_per_lsb),
    };
    let mut out = vec![line("Bias Δa".into(), &result.bias, Parameter::Bias)];
    if let Some(m) = &result.misalignment {
        out.push(line("Misalignment Δφ".into(), m, Parameter::Misalignment));
    }
    for m in &result.mountings {
        let name = format!("Misalignment Δφ ({})", shortened(&m.name, 16));
        out.push(line(name, &m.misalignment, Parameter::Misalignment));
    }
    if let Some(zero) = &result.table_zero {
        out.push(line("Table zero ε".into(), zero, Parameter::Misalignment));
    }
    out.push(line("Scale error δk".into(), &result.scale_error, Parameter::ScaleError));
    out.push(Line {
        name: "Scale factor k*".into(),
        estimate: &result.scale_factor,
        unit: page.units.scale_factor.clone(),
        second: None,
    });
    out
}

/// Value, U and u in one unit, and the unit's name with their power of ten: value to the place of U, u to its own
/// two digits.
fn in_unit(e: &Estimate, unit: &Unit) -> ([String; 3], String) {
    let value = unit.of(e.value);
    let (expanded, u) =
        (e.expanded_uncertainty.map(|v| unit.of(v)), e.standard_uncertainty.map(|v| unit.of(v)));
    let together = expanded.and_then(|expanded| rounded_to(&[value, expanded], expanded));
    let Some(Rounded { texts, exponent }) = together else {
        return ([number(value, 6), maybe(expanded, 2), maybe(u, 2)], unit.name.clone());
    };
    let u = u.map_or_else(|| NONE.to_owned(), |u| typographic(&own_digits(u, exponent)));
    let mut texts = texts.iter().map(|t| typographic(t));
    let cells = [texts.next().unwrap_or_default(), texts.next().unwrap_or_default(), u];
    let name = if exponent == 0 {
        unit.name.clone()
    } else {
        format!("{} {}", power_of_ten(exponent), unit.name)
    };
    (cells, name)
}

fn row(l: &Line<'_>) -> Vec<String> {
    let e = l.estimate;
    let (cells, unit) = in_unit(e, &l.unit);
    let second = l.second.as_ref().zip(e.expanded_uncertainty).map(|(unit, u)| {
        format!(
            "{} {}",
            typographic(&value_with_uncertainty(unit.of(e.value), unit.of(u))),
            unit.name
        )
    });
    let mut row = vec![l.name.clone()];
    row.extend(cells);
    row.push(maybe(e.coverage_factor, 3));
    row.push(if e.standard_uncertainty.is_some() {
        degrees_of_freedom(e.degrees_of_freedom)
    } else {
        NONE.into()
    });
    row.push(unit);
    row.push(second.unwrap_or_default());
    row
}

fn parts_row(l: &Line<'_>) -> Vec<String> {
    let e = l.estimate;
    let short = |v: Option<f64>| maybe(v.map(|v| l.unit.of(v)), 2);
    let next = |ends: Option<[f64; 2]>| {
        ends.map(|[lo, hi]| typographic(&interval(l.unit.of(lo), l.unit.of(hi))))
            .unwrap_or_else(|| NONE.into())
    };
    vec![
        l.name.clone(),
        short(e.u_statistical),
        short(e.u_budget),
        short(e.between_run_sd),
        short(e.between_runs.as_ref().and_then(|b| b.omega)),
        next(e.prediction_interval),
        next(e.prediction_true_interval),
        l.unit.name.clone(),
    ]
}

fn prediction_note(result: &ResultSection) -> Markup {
    html! {
        @if result.bias.prediction_interval.is_some() {
            p .small {
                "“Next estimate” is the prediction interval for the next estimate: what another power-up, measured and \
                 adjusted like these runs, will give. "
                @if result.bias.prediction_true_interval.is_some() {
                    "“Next true value” is for the sensor's true value in the next power-up: the spread between power-ups (ω) \
                     without a run's own uncertainty. It is the one to start a navigation filter with; where ω is small against \
                     a run's own uncertainty it is on the safe side. "
                }
                "± U holds for the mean over power-ups. The next estimate has the errors of the bench in common with these runs, so it \
                 may be narrower than ± U."
            }
        } @else {
            p .small {
                "There is no interval for the next power-up: one run does not show how much the sensor changes between \
                 power-ups."
            }
        }
    }
}

/// Correlations and condition numbers of the runs, in words.
fn correlations(p: &Passport) -> Markup {
    let pairs = || p.runs.iter().flat_map(|r| &r.correlations).filter(|c| c.value.is_finite());
    let strongest =
        pairs().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs())).map(|strongest| {
            let of_pair = || pairs().filter(|c| c.between == strongest.between).map(|c| c.value);
            (
                &strongest.between,
                of_pair().fold(f64::INFINITY, f64::min),
                of_pair().fold(f64::NEG_INFINITY, f64::max),
            )
        });
    let conditions = p.runs.iter().filter_map(|r| r.condition_number);
    let condition =
        span(conditions.clone().reduce(f64::min), conditions.reduce(f64::max), |v| number(v, 2));
    html! {
        @if let Some(([a, b], lo, hi)) = strongest {
            @let r = span(Some(lo), Some(hi), |v| typographic(&correlation(v))).unwrap_or_default();
            p {
                "Correlations: " (shortened(parameter(a), 24)) " and " (shortened(parameter(b), 24)) " are " (tie(lo.abs().max(hi.abs())))
                " (r = " (r) " within a run). "
                @if lo.abs().max(hi.abs()) >= 0.9 {
                    "An error in the one is made up for by the other: over the angles that were measured the compensated \
                     acceleration is known better than either alone. Take both from this passport, never one of them, and \
                     carry the covariance along; beyond those angles this does not hold. "
                }
                @if let Some(condition) = condition {
                    "Condition number of the adjustment (columns of unit length): " (condition) "."
                }
            }
        }
    }
}

/// `0.1`, or `0.1 to 0.2` where both ends read differently.
fn span(lo: Option<f64>, hi: Option<f64>, shown: impl Fn(f64) -> String) -> Option<String> {
    let (lo, hi) = (shown(lo?), shown(hi?));
    Some(if lo == hi { lo } else { format!("{lo} to {hi}") })
}

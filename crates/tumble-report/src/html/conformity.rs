//! The unit against its specification: limits, decision, probability and risk, and the statement.

use maud::{Markup, html};
use tumble_io::passport::ParameterConformity;

use super::parts::{number, numbers, table, text, units};
use super::{Page, section};
use crate::conformity::{Line, judged, percent, rule, status};
use crate::numbers::{NONE, typographic};
use crate::words::{as_sentence, one_line, parameter, shortened};

pub(super) fn conformity(page: &Page<'_>) -> Markup {
    let c = &page.passport.conformity;
    let judged = judged(page.passport);
    if judged.is_empty() {
        let Some(reason) = &c.reason else { return html! {} };
        return section(
            "Conformity",
            &html! { p { "Not assessed against the limits of [spec]: " (as_sentence(reason)) } },
        );
    }
    let rows: Vec<Vec<String>> = judged.iter().map(|q| row(Line::of(q, &page.units))).collect();
    let body = html! {
        p { b { (status(&c.status).to_uppercase()) } ": " (rule(c)) "." }
        (table(
            "",
            "p: probability that the value conforms. Risk: probability that the decision is wrong. Rule, at most: largest \
             probability that a value which the rule passes does not conform. Ratio: tolerance over 2U.",
            &[text("Quantity"), units("Limits"), units("Acceptance limits"), numbers("Value ± U"), units("Unit"),
              units("Decision"), numbers("p"), numbers("Risk"), numbers("Rule, at most"), numbers("Ratio")],
            &rows,
        ))
        @if let Some(statement) = &c.statement { p { (one_line(statement)) } }
        (production(judged))
        p .small {
            "The decision is about the unit, the verdict about its calibration: a unit out of its limits keeps its \
             coefficients. Probabilities are taken from a " (distributions(judged)) " distribution, without knowledge from \
             before the measurement."
        }
    };
    section("Conformity", &body)
}

fn row(l: Line) -> Vec<String> {
    let shown = |t: &str| typographic(t);
    vec![
        l.name,
        shown(&l.limits),
        shown(&l.acceptance),
        shown(&l.value),
        l.unit,
        l.status,
        l.conforms,
        l.risk.map_or_else(|| NONE.into(), |r| shown(&r)),
        shown(&l.worst_case),
        l.ratio,
    ]
}

/// `Student`, `normal`, or both.
fn distributions(judged: &[ParameterConformity]) -> String {
    let mut names: Vec<String> = judged.iter().map(|q| shortened(&q.distribution, 16)).collect();
    names.sort();
    names.dedup();
    names.join(" or ").replace("student", "Student")
}

/// Global risks, where the production is known.
fn production(judged: &[ParameterConformity]) -> Markup {
    html! {
        @for (q, p) in judged.iter().filter_map(|q| q.production.as_ref().map(|p| (q, p))) {
            p {
                "Over a production of mean " (number(p.mean, 4)) " and standard deviation " (number(p.standard_deviation, 3))
                " (" (shortened(parameter(&q.parameter), 24)) ", " (shortened(&crate::words::unit(&q.unit), 16)) "): "
                (typographic(&percent(p.global_consumer_risk))) " of all units pass and do not conform, "
                (typographic(&percent(p.global_producer_risk))) " conform and do not pass."
            }
        }
    }
}

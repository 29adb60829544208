//! Further terms: what was tried, with which test, and what came of it.

use maud::{Markup, html};
use tumble_io::passport::Term;

use super::parts::{number, numbers, table, text, units};
use super::{Page, section};
use crate::numbers::{NONE, p_value, typographic, value_with_uncertainty};
use crate::words::{one_line, shortened, unit};

/// Most terms that are shown; a passport of ours has five.
const MOST: usize = 12;

pub(super) fn terms(page: &Page<'_>) -> Markup {
    let p = page.passport;
    if p.terms.is_empty() || !page.standing.has_coefficients() {
        return html! {};
    }
    let rows: Vec<Vec<String>> = p.terms.iter().take(MOST).map(row).collect();
    let level = crate::summary::level(p);
    let how = match p.options.terms.as_deref() {
        Some("auto") => "Entered by themselves where the data ask for it",
        Some("none") => "None asked for; tried for the bound",
        _ => "Named, the others tried for the bound",
    };
    let peak = p.compensation.as_ref().and_then(|c| c.terms.as_ref()).map(|t| t.terms_peak_m_s2);
    let body = html! {
        (table(
            "",
            &format!(
                "{how}. Value ± expanded uncertainty ({level}) from all runs, with the other parameters free. p: \
                 probability of such a value by chance. BIC: by how much Schwarz' criterion is smaller with the term. \
                 Bound: largest magnitude that the data allow ({level})."
            ),
            &[
                text("Term"),
                text("In the model"),
                numbers("Value"),
                units("Unit"),
                numbers("p"),
                numbers("BIC"),
                numbers("Bound"),
                text("Remark"),
            ],
            &rows,
        ))
        @if let Some(peak) = peak {
            p { "A program that ignores the terms is wrong by up to " (number(peak, 2)) " m/s² within the measured range." }
        }
    };
    section("Further terms", &body)
}

fn row(t: &Term) -> Vec<String> {
    let usual = &t.in_usual_unit;
    let value = match (usual.value, usual.expanded_uncertainty) {
        (Some(v), Some(u)) => typographic(&value_with_uncertainty(v, u)),
        (Some(v), None) => number(v, 3),
        _ => NONE.to_owned(),
    };
    let maybe = |v: Option<f64>| v.map_or_else(|| NONE.to_owned(), |v| number(v, 3));
    vec![
        shortened(&t.name, 16),
        if t.entered { "yes".into() } else { "no".into() },
        value,
        one_line(&unit(&usual.unit)),
        t.p_value.map_or_else(
            || NONE.to_owned(),
            |p| typographic(&p_value(p)).trim_start_matches("= ").to_owned(),
        ),
        maybe(t.criterion_difference),
        maybe(usual.bound),
        t.obstacle.as_deref().map(one_line).unwrap_or_default(),
    ]
}

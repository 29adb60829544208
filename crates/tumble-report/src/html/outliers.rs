//! Positions that do not belong, and those left out on request, with what they do to the values.

use maud::{Markup, html};
use tumble_io::passport::{LeftOutComparison, Outlier, PerParameter};

use super::parts::{maybe, number, numbers, table, text};
use super::{Page, section};
use crate::numbers::{NONE, p_value, typographic, value_with_uncertainty};
use crate::units::Parameter;
use crate::words::{parameter, shortened};

/// Most positions that are shown.
const MOST: usize = 40;

/// The tables; nothing where every position belongs and none was left out.
pub(super) fn section_of(page: &Page<'_>) -> Markup {
    let p = page.passport;
    if p.outliers.is_empty() || !page.standing.has_estimates() {
        return html! {};
    }
    let caption = format!(
        "Off: measured minus what the other positions of the run expect, {}. t: the same over its standard deviation. p: \
         probability that chance puts one position of the experiment so far out. Change of the values of the run, and of \
         the pooled result, when the position is left out, in their expanded uncertainties ({}): bias / misalignment / scale error.",
        page.units.reading,
        crate::summary::level(p),
    );
    let columns = [
        text("Run"),
        numbers("No."),
        numbers("Angle"),
        numbers("Off"),
        numbers("t"),
        numbers("p"),
        numbers("Run changes by"),
        numbers("Result changes by"),
        text("In the result"),
    ];
    let rows: Vec<Vec<String>> = p.outliers.iter().take(MOST).map(row).collect();
    let compared: Vec<Vec<String>> =
        p.left_out_comparison.iter().filter_map(|c| compared(page, c)).collect();
    let body = html! {
        (table("", &caption, &columns, &rows))
        @if p.outliers.len() > MOST {
            p .small { "The first " (MOST) " of " (p.outliers.len()) "; passport.json has all." }
        }
        @if !compared.is_empty() {
            (table(
                "narrow",
                "The result with all positions, and without those that were left out on request.",
                &[text("Parameter"), numbers("With all"), numbers("Without"), text("Unit")],
                &compared,
            ))
        }
    };
    section("Positions that do not belong, or were left out", &body)
}

fn row(o: &Outlier) -> Vec<String> {
    vec![
        shortened(&o.run, 20),
        o.position.to_string(),
        format!("{}°", number(o.angle_deg, 4)),
        maybe(o.residual_lsb, 3),
        maybe(o.studentized, 2),
        o.p_value.map_or_else(
            || NONE.to_owned(),
            |p| typographic(&p_value(p)).trim_start_matches("= ").to_owned(),
        ),
        in_uncertainties(o.effect_over_u.as_ref()),
        in_uncertainties(o.pooled_effect_over_u.as_ref()),
        if o.left_out { "left out on request".into() } else { "yes".into() },
    ]
}

/// Three changes in expanded uncertainties.
fn in_uncertainties(three: Option<&PerParameter>) -> String {
    three.map_or_else(|| NONE.to_owned(), |t| typographic(&crate::outliers::three(t)))
}

/// A value both ways; `None` for a parameter of another version.
fn compared(page: &Page<'_>, c: &LeftOutComparison) -> Option<Vec<String>> {
    let which = match c.parameter.as_str() {
        "bias" => Parameter::Bias,
        "misalignment" => Parameter::Misalignment,
        "scale_error" => Parameter::ScaleError,
        _ => return None,
    };
    let unit = page.units.parameter(which);
    let shown = |v: &tumble_io::passport::ValueAndUncertainty| {
        typographic(&value_with_uncertainty(unit.of(v.value), unit.of(v.expanded_uncertainty)))
    };
    let name = match &c.mounting {
        Some(m) => format!("{} ({})", shortened(parameter(&c.parameter), 24), shortened(m, 16)),
        None => shortened(parameter(&c.parameter), 24),
    };
    Some(vec![name, shown(&c.with), shown(&c.without), unit.name.clone()])
}

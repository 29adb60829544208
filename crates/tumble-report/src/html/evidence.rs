//! Evidence: figures, error level, influences, budget, runs.

use maud::{Markup, PreEscaped, html};
use tumble_io::passport::{BudgetLine, InfluenceTest, Run};

use super::parts::{degrees_of_freedom, maybe, number, numbers, table, text, units};
use super::{Page, section};
use crate::numbers::{NONE, p_value, typographic, value_with_uncertainty};
use crate::runs::MOST_RUNS;
use crate::units::Parameter;
use crate::words::{one_line, parameter, shortened, unit};

pub(super) fn figures(page: &Page<'_>) -> Markup {
    let figures = crate::figure::of_sanitized(page.passport);
    let body = html! {
        @for (i, f) in figures.iter().enumerate() {
            figure {
                // Markup of our own making, escaped when it was built.
                (PreEscaped(&f.svg))
                figcaption { b { "Figure " (i + 1) ". " (f.title) "." } " " (f.caption) }
            }
        }
    };
    section(if figures.len() == 1 { "Figure" } else { "Figures" }, &body)
}

pub(super) fn error_level(page: &Page<'_>) -> Markup {
    if !page.standing.has_coefficients() {
        return html! {};
    }
    let row = |name: &str, before, after, held_out| {
        vec![shortened(name, 24), number(before, 2), number(after, 2), maybe(held_out, 2)]
    };
    let runs = page.passport.runs.iter().take(MOST_RUNS);
    let mut rows: Vec<Vec<String>> = runs
        .filter_map(|r| {
            r.error_level_lsb.as_ref().map(|e| row(&r.name, e.before, e.after, e.after_held_out))
        })
        .collect();
    if let Some(e) = page.passport.error_level_lsb.as_ref().filter(|_| rows.len() != 1) {
        rows.push(row("all runs", e.before, e.after, e.after_held_out));
    }
    let body = html! {
        @if !rows.is_empty() {
            (table(
                "narrow",
                &format!(
                    "Root mean square error in {}. Held out: with the coefficients of the other runs, the honest level.",
                    page.units.reading
                ),
                &[text("Run"), numbers("Before"), numbers("After"), numbers("After, held out")],
                &rows,
            ))
        }
    };
    section("Error before and after compensation", &body)
}

pub(super) fn influence(page: &Page<'_>) -> Markup {
    if !page.standing.has_coefficients() {
        return html! {};
    }
    let influence = &page.passport.influence;
    let level = crate::summary::level(page.passport);
    let row = |name: &str, test: &Option<InfluenceTest>, why: &str| match test {
        None => (name.to_owned(), Err(format!("not assessed: {why}"))),
        Some(t) => {
            let cells = vec![
                typographic(&value_with_uncertainty(t.effect, t.expanded_uncertainty)),
                one_line(&unit(&t.unit)),
                typographic(&p_value(t.p_value)).trim_start_matches("= ").to_owned(),
                number(t.smallest_detectable, 2),
            ];
            (name.to_owned(), Ok(cells))
        }
    };
    let rows = [
        row(
            "Temperature",
            &influence.temperature,
            "no temperature was recorded, or it did not vary within the runs",
        ),
        row("Signal level", &influence.signal_level, "the plan cannot tell it from the parameters"),
    ];
    let body = html! {
        div .scroll {
            table .whole {
                caption {
                    "Effect ± expanded uncertainty (" (level) "). p: probability of an effect of this size by chance. Detectable: \
                     the smallest true effect that these data would have shown with a probability of 80 %."
                }
                thead { tr {
                    th scope="col" { "Influence" }
                    th scope="col" .n { "Effect" }
                    th scope="col" { "Unit" }
                    th scope="col" .n { "p" }
                    th scope="col" .n { "Detectable" }
                } }
                tbody {
                    @for (name, cells) in &rows { tr {
                        th scope="row" { (name) }
                        @match cells {
                            Ok(cells) => {
                                @for (i, cell) in cells.iter().enumerate() { td .n[i != 1] { (cell) } }
                            }
                            Err(why) => { td colspan="4" { (why) } }
                        }
                    } }
                }
            }
        }
    };
    section("Influence of temperature and signal level", &body)
}

pub(super) fn budget(page: &Page<'_>) -> Markup {
    if !page.standing.has_coefficients() || page.passport.budget.is_empty() {
        return html! {};
    }
    let row = |b: &BudgetLine| {
        let name = match &b.mounting {
            Some(m) => format!("{} ({})", shortened(parameter(&b.parameter), 24), shortened(m, 16)),
            None => shortened(parameter(&b.parameter), 24),
        };
        vec![
            name,
            one_line(&b.quantity),
            number(b.standard_uncertainty, 2),
            shortened(&unit(&b.unit), 16),
            shortened(&b.distribution, 16),
            degrees_of_freedom(b.degrees_of_freedom),
            number(b.sensitivity, 3),
            number(b.contribution, 2),
            typographic(&crate::numbers::fixed(100.0 * b.share, 1)),
        ]
    };
    let body = table(
        "",
        "Contributions in the parameter's SI unit: bias in m/s², misalignment in rad, scale error relative (1).",
        &[
            text("Parameter"),
            text("Quantity"),
            numbers("u"),
            units("Unit"),
            units("Distribution"),
            numbers("ν"),
            numbers("Sensitivity"),
            numbers("Contribution"),
            numbers("Share, %"),
        ],
        &page.passport.budget.iter().map(row).collect::<Vec<_>>(),
    );
    let body = html! { (body) (sources(page)) (draws(page)) };
    section("Uncertainty budget", &body)
}

/// Where the uncertainties of the budget come from, a line a quantity.
fn sources(page: &Page<'_>) -> Markup {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for b in page.passport.budget.iter().filter(|b| !b.source.is_empty()) {
        let quantity = one_line(&b.quantity);
        if !rows.iter().any(|r| r[0] == quantity) {
            rows.push(vec![quantity, one_line(&b.source)]);
        }
    }
    if rows.is_empty() {
        return html! {};
    }
    let columns = [text("Quantity"), text("Where its uncertainty comes from")];
    table("", "Stated in experiment.toml, or a default with its reason.", &columns, &rows)
}

/// The same by Monte Carlo.
fn draws(page: &Page<'_>) -> Markup {
    let Some(result) = &page.passport.result else { return html! {} };
    let mut all = vec![("Bias".to_owned(), &result.bias)];
    all.extend(result.misalignment.iter().map(|m| ("Misalignment".to_owned(), m)));
    all.extend(
        result
            .mountings
            .iter()
            .map(|m| (format!("Misalignment ({})", shortened(&m.name, 16)), &m.misalignment)),
    );
    all.push(("Scale error".to_owned(), &result.scale_error));
    let rows: Vec<Vec<String>> = all
        .into_iter()
        .filter_map(|(name, e)| {
            let (m, [low, high]) = (e.monte_carlo.as_ref()?, e.interval?);
            let digits = |v: f64| number(v, 4);
            Some(vec![
                name,
                digits(low),
                digits(high),
                digits(m.interval[0]),
                digits(m.interval[1]),
                digits(m.shortest_interval[0]),
                digits(m.shortest_interval[1]),
                m.draws.to_string(),
                if m.validated { "yes".into() } else { "no".into() },
            ])
        })
        .collect();
    if rows.is_empty() {
        return html! {};
    }
    table(
        "",
        "By Monte Carlo (JCGM 101), in the parameter's SI unit: value ± U, the probabilistically symmetric and the shortest interval \
         of the draws; whether value ± U agrees with the symmetric one within half of the second digit of u (clause 8).",
        &[
            text("Parameter"),
            numbers("value − U"),
            numbers("value + U"),
            numbers("symmetric from"),
            numbers("to"),
            numbers("shortest from"),
            numbers("to"),
            numbers("Draws"),
            units("Agrees"),
        ],
        &rows,
    )
}

pub(super) fn runs(page: &Page<'_>) -> Markup {
    let p = page.passport;
    if p.runs.is_empty() {
        return html! {};
    }
    let mut columns = vec![text("Run"), text("Mounting"), numbers("n"), numbers("Angles")];
    let estimates = page.standing.has_estimates();
    if estimates {
        columns.extend([numbers("Bias"), numbers("Misalignment"), numbers("Scale error")]);
    }
    columns.extend([numbers("s"), numbers("Cond."), numbers("Settled")]);
    let rows: Vec<Vec<String>> =
        p.runs.iter().take(MOST_RUNS).map(|r| run_row(page, r, estimates)).collect();
    let mut caption = if estimates {
        format!(
            "Estimate ± standard uncertainty (statistical): bias in {}, misalignment in {}, scale error in {}. ",
            page.units.bias.name, page.units.misalignment.name, page.units.scale_error.name
        )
    } else {
        String::new()
    };
    caption.push_str(&format!(
        "n: positions. s: residual standard deviation in {}. Cond.: condition number with columns of unit length. \
         Settled: positions after which the estimate stayed.",
        page.units.reading
    ));
    if !page.standing.has_coefficients() && estimates {
        caption.push_str(" Evidence, not a result: not for use.");
    }
    let remarks: Vec<String> = p.runs.iter().take(MOST_RUNS).filter_map(remark).collect();
    let body = html! {
        (table("", &caption, &columns, &rows))
        @if p.runs.len() > MOST_RUNS {
            p .small { "The first " (MOST_RUNS) " of " (p.runs.len()) " runs; passport.json has all." }
        }
        @if !remarks.is_empty() {
            ul .small { @for r in &remarks { li { (r) } } }
        }
    };
    section("Runs", &body)
}

fn run_row(page: &Page<'_>, r: &Run, estimates: bool) -> Vec<String> {
    let mut row = vec![
        shortened(&r.name, 20),
        shortened(&r.mounting, 16),
        r.positions.to_string(),
        r.distinct_angles.to_string(),
    ];
    if estimates {
        row.extend(Parameter::ALL.map(|p| {
            let unit = page.units.parameter(p);
            p.in_run(&r.estimates).map_or_else(
                || NONE.to_owned(),
                |e| match e.standard_uncertainty {
                    Some(u) => typographic(&value_with_uncertainty(unit.of(e.value), unit.of(u))),
                    None => number(unit.of(e.value), 4),
                },
            )
        }));
    }
    row.push(maybe(r.residual_std_lsb, 2));
    row.push(r.condition_number.map_or_else(|| "∞".into(), |c| number(c, 2)));
    row.push(r.settled_at.map_or_else(|| NONE.into(), |n| n.to_string()));
    row
}

/// Date, operator and note of a run, where there are any.
fn remark(r: &Run) -> Option<String> {
    let parts: Vec<String> =
        [&r.date, &r.operator, &r.note].into_iter().flatten().map(|t| one_line(t)).collect();
    (!parts.is_empty()).then(|| format!("{}: {}", shortened(&r.name, 40), parts.join("; ")))
}

//! The page of a record's noise: one self-contained file, no script, nothing from outside.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use tumble_io::noise::{CurveEntry, NoiseDocument};

use super::{deviation_name, duration, printed_unit, short_name, stated, with_interval};
use crate::html::{head, report_style};
use crate::numbers::{p_value, significant, typographic};
use crate::sanitize::clean_text;

/// Rows of a table; all points stand in the JSON.
const LISTED: usize = 100;

/// The noise of a record as one page.
#[must_use]
pub fn noise_page(d: &NoiseDocument) -> String {
    let name = short_name(&d.input.file);
    let figure = super::noise_figure(d);
    html! {
        (DOCTYPE)
        html lang="en" {
            (head(&format!("Noise of {name}"), "light dark", &report_style(&name)))
            body {
                h1 { "Noise of " (name) }
                p .lead { (lead(d)) }
                main {
                    @if let Some(best) = &d.dwell {
                        section {
                            h2 { "Best dwell: " (duration(best.tau_s)) }
                            p { "Deviation " (n(best.deviation, 3)) " " (unit(d)) "; the least is "
                                (n(best.least, 3)) " " (unit(d)) " at " (duration(best.least_tau_s)) ". Reason: " (best.why) "." }
                        }
                    }
                    @if let Some(f) = &figure {
                        figure {
                            (PreEscaped(&f.svg))
                            figcaption { b { (f.title) "." } " " (f.caption) }
                        }
                    }
                    (coefficients(d))
                    @if let Some(c) = &d.converter {
                        section {
                            h2 { "Converter" }
                            p { "Step " (stated(c.step)) " " (unit(d)) ". The noise is " (n(c.noise_in_steps, 3)) " steps a reading"
                                @if c.dithered { ", which spreads the readings over steps: rounding is white noise of "
                                    (n(c.of_a_reading, 3)) " " (unit(d)) " a reading (step/√12), N = " (n(c.n, 3)) " " (unit(d))
                                    "·√s, part of the N above." }
                                @else { ": too little, averages follow the steps." } }
                        }
                    }
                    @if !d.remarks.is_empty() {
                        section { h2 { "Notes" } ul { @for r in &d.remarks { li { (clean_text(r)) } } } }
                    }
                    @for curve in &d.curves { (table(d, curve)) }
                    section {
                        h2 { "Provenance" }
                        dl {
                            dt { "file" } dd { (clean_text(&d.input.file))
                                @if let Some(column) = &d.input.column { ", column " (clean_text(column)) } }
                            dt { "rate" } dd { (rate(d)) }
                            @if d.input.pieces.len() > 1 { dt { "pieces" } dd { (pieces(&d.input.pieces)) } }
                            dt { "SHA-256" } dd .digest { (clean_text(&d.input.sha256)) }
                            dt { "degrees of freedom" } dd { (clean_text(&d.software.edf)) }
                            dt { "software" } dd { (clean_text(&d.software.name)) " " (clean_text(&d.software.version)) }
                        }
                    }
                }
            }
        }
    }
    .into_string()
}

fn n(v: f64, digits: i32) -> String {
    typographic(&significant(v, digits))
}

fn unit(d: &NoiseDocument) -> &str {
    if d.unit == "m/s2" { "m/s²" } else { &d.unit }
}

fn lead(d: &NoiseDocument) -> String {
    let i = &d.input;
    let scale = match &d.scale {
        Some(s) => {
            format!(
                " Scale: {} m/s² a unit, {}.",
                typographic(&stated(s.m_s2_per_unit)),
                clean_text(&s.source)
            )
        }
        None => format!(" No scale was given: results are in {}.", d.unit),
    };
    format!(
        "{} readings at {} Hz, {}. Mean {} {u}, standard deviation {} {u}.{scale}",
        i.readings,
        typographic(&stated(i.rate_hz)),
        duration(i.readings as f64 / i.rate_hz),
        n(d.mean, 6),
        n(d.standard_deviation, 3),
        u = unit(d)
    )
}

/// Where the rate comes from.
fn rate(d: &NoiseDocument) -> String {
    let i = &d.input;
    let hz = typographic(&stated(i.rate_hz));
    match (&i.time_column, i.jitter) {
        (Some(column), Some(jitter)) => format!(
            "{hz} Hz, from column {}; steps scatter by {} %",
            clean_text(column),
            n(100.0 * jitter, 2)
        ),
        _ => format!("{hz} Hz, as given"),
    }
}

/// Lengths of the pieces between gaps.
fn pieces(pieces: &[u64]) -> String {
    const SHOWN: usize = 20;
    let shown: Vec<String> = pieces.iter().take(SHOWN).map(u64::to_string).collect();
    let more = if pieces.len() > SHOWN { ", …" } else { "" };
    format!("{}, of {}{more} readings", pieces.len(), shown.join(", "))
}

fn coefficients(d: &NoiseDocument) -> Markup {
    let Some(fit) = &d.fit else { return html! {} };
    html! {
        section {
            h2 { "Coefficients" }
            div .scroll { table .whole {
                caption { "Intervals of " (stated(100.0 * fit.level)) " %. χ² " (n(fit.chi_squared, 3)) ", "
                    (fit.degrees_of_freedom) " degrees of freedom"
                    @if let Some(p) = fit.p { ", p " (p_value(p)) }
                    @if d.unit == "m/s2" { ". Data sheets give the one-sided noise density, n = √2·N: µg/√Hz there are not µg·√s of N" }
                    "." }
                thead { tr { th scope="col" { "" } th scope="col" { "Noise" } th scope="col" { "Value" }
                    th scope="col" { "As data sheets write it" } } }
                tbody { @for e in &fit.coefficients { tr {
                    th scope="row" { (e.symbol) }
                    td { (e.name) }
                    td { (sized(e.value, &e.unit, e.interval)) }
                    td { @for s in e.sheet.iter().filter(|_| e.value > 0.0) {
                        div { (sized(s.value, &s.unit, s.interval)) @if !s.meaning.is_empty() { ": " (printed_unit(&s.meaning)) } }
                    } }
                } } }
            } }
        }
    }
}

/// A size with its interval, numbers and unit as printed.
fn sized(value: f64, unit: &str, (low, high): (f64, Option<f64>)) -> String {
    let unit = printed_unit(unit);
    let numbers = with_interval(value, &unit, (low, high));
    // Powers of ten stand in single numbers.
    let words: Vec<String> = numbers
        .split(' ')
        .map(|word| {
            let (number, tail) = word.strip_suffix(')').map_or((word, ""), |number| (number, ")"));
            typographic(number) + tail
        })
        .collect();
    words.join(" ")
}

fn table(d: &NoiseDocument, curve: &CurveEntry) -> Markup {
    let step = curve.points.len().div_ceil(LISTED).max(1);
    html! {
        section {
            h2 { (crate::words::capitalized(deviation_name(&curve.deviation))) }
            div .scroll { table {
                caption { (unit(d)) "; band of " (stated(100.0 * d.level)) " %"
                    @if step > 1 { "; one time in " (step) " is listed" } }
                thead { tr { th scope="col" { "τ, s" } th .n scope="col" { "m" } th .n scope="col" { "Deviation" }
                    th .n scope="col" { "Low" } th .n scope="col" { "High" } th .n scope="col" { "edf" }
                    th scope="col" { "Kind of noise" } } }
                tbody { @for p in curve.points.iter().step_by(step) { tr {
                    th scope="row" { (n(p.tau_s, 5)) }
                    td .n { (p.factor) }
                    td .n { (n(p.deviation, 4)) }
                    @for k in 0..2 { td .n { (p.band.map_or("–".to_owned(), |b| n(b[k], 4))) } }
                    td .n { (p.edf.map_or("–".to_owned(), |e| n(e, 3))) }
                    td { (p.kind.as_deref().unwrap_or("–")) @if p.kind_is_carried { " (as at shorter times)" } }
                } } }
            } }
        }
    }
}

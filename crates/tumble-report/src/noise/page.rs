//! The page of a record's noise: one self-contained file, no script, nothing from outside.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use tumble_io::noise::{CurveEntry, NoiseDocument};

use super::{deviation_name, duration, short_name, stated, with_interval};
use crate::numbers::{significant, typographic};
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
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Noise of " (name) }
                style { (PreEscaped(crate::html::report_style(&name))) }
            }
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
                            p { "Step " (stated(c.step)) " " (unit(d)) ". Rounding alone is white noise of "
                                (n(c.of_a_reading, 3)) " " (unit(d)) " a reading (step/√12), N = " (n(c.n, 3)) " " (unit(d))
                                " √s. The noise is " (n(c.noise_in_steps, 3)) " steps a reading"
                                @if c.dithered { ", which spreads the readings over steps." }
                                @else { ": too little, and averages follow the steps." } }
                        }
                    }
                    @if !d.remarks.is_empty() {
                        section { h2 { "Notes" } ul { @for r in &d.remarks { li { (clean_text(r)) } } } }
                    }
                    @for curve in &d.curves { (table(d, curve)) }
                    section {
                        h2 { "Provenance" }
                        dl {
                            dt { "file" } dd { (clean_text(&d.input.file)) }
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

fn coefficients(d: &NoiseDocument) -> Markup {
    let Some(fit) = &d.fit else { return html! {} };
    html! {
        section {
            h2 { "Coefficients" }
            div .scroll { table .whole {
                caption { "Intervals of " (stated(100.0 * fit.level)) " %. χ² " (n(fit.chi_squared, 3)) " with "
                    (fit.degrees_of_freedom) " degrees of freedom." }
                thead { tr { th scope="col" { "" } th scope="col" { "Noise" } th scope="col" { "Value" }
                    th scope="col" { "As data sheets write it" } } }
                tbody { @for e in &fit.coefficients { tr {
                    th scope="row" { (e.symbol) }
                    td { (e.name) }
                    td { (typographic(&with_interval(e.value, &e.unit, e.interval))) }
                    td { @for s in e.sheet.iter().filter(|_| e.value > 0.0) {
                        div { (n(s.value, 4)) " " (s.unit) @if !s.meaning.is_empty() { " (" (s.meaning) ")" } }
                    } }
                } } }
            } }
        }
    }
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

//! Top of the page: what it is, of which sensor, and the verdict.

use maud::{Markup, html};
use tumble_io::passport::{Finding, Passport};

use super::Page;
use super::parts::{definitions, stated};
use crate::merge::merged;
use crate::runs::mountings;
use crate::standing::{self, Standing};
use crate::words::{as_sentence, capitalized, counted, method, one_line, quantizer};

pub(super) fn front(page: &Page<'_>) -> Markup {
    let p = page.passport;
    html! {
        header {
            h1 { (page.standing.heading()) }
            p .lead { (page.standing.what_it_is()) }
            div .pair {
                (definitions(&[
                    ("Model", one_line(&p.sensor.model)),
                    ("Type", p.sensor.kind.as_ref().map(|k| {
                        one_line(&format!("{} of the catalogue ({})", k.model, k.catalogue))
                    }).unwrap_or_default()),
                    ("Serial number", one_line(&p.sensor.serial)),
                    ("Axis", one_line(&p.sensor.axis)),
                    ("Passport number", if p.id.is_empty() { "none given".into() } else { one_line(&p.id) }),
                    ("Issued", p.issued.as_deref().map_or_else(|| "no date given".into(), one_line)),
                    ("Measured", measured(p)),
                    ("Temperature", temperature(p)),
                    ("Runs", runs(p)),
                ]))
                (definitions(&[
                    ("Gravity", gravity(p)),
                    ("Table setting", p.bench.angle_uncertainty_arcmin.map_or_else(
                        || "no uncertainty stated".into(),
                        |u| format!("standard uncertainty {} arcmin", stated(u)),
                    )),
                    ("Table range", p.bench.angle_range_deg.map(|[lo, hi]| {
                        format!("{}° to {}°", stated(lo), stated(hi))
                    }).unwrap_or_default()),
                    ("Nominal scale", format!(
                        "{} {} ({})",
                        stated(p.nominal_scale_m_s2_per_lsb),
                        page.units.scale_factor.name,
                        match p.nominal_scale_source.as_str() {
                            "up_down" => "from dwells with the axis up and down",
                            other => other,
                        }
                    )),
                    ("Converter", converter(p)),
                    ("Method", one_line(method(&p.method))),
                    ("Conformity", one_line(&p.conformity.status.replace('_', " "))),
                ]))
            }
        }
        (banner(page))
    }
}

fn measured(p: &Passport) -> String {
    match &p.validity.dates[..] {
        [] => "no dates recorded".into(),
        [day] => one_line(day),
        [first, .., last] => format!("{} to {}", one_line(first), one_line(last)),
    }
}

fn temperature(p: &Passport) -> String {
    match p.validity.temperature_degc {
        Some([lo, hi]) if lo == hi => format!("{} °C", stated(lo)),
        Some([lo, hi]) => {
            let short = |v| super::parts::number(v, 3);
            format!("{} °C to {} °C", short(lo), short(hi))
        }
        None => "not recorded".into(),
    }
}

fn runs(p: &Passport) -> String {
    let mut text = counted(p.runs.len(), "run");
    if !p.runs.is_empty() {
        text.push_str(&format!(" in {}", counted(mountings(p).len(), "mounting")));
    }
    text
}

fn gravity(p: &Passport) -> String {
    let g = &p.bench.gravity_m_s2;
    let u = if g.standard_uncertainty > 0.0 {
        format!(", standard uncertainty {} m/s²", stated(g.standard_uncertainty))
    } else {
        ", taken as exact".into()
    };
    let source = match g.source.as_str() {
        "" | "stated" | "stated without uncertainty" => String::new(),
        other => format!(" ({})", one_line(other)),
    };
    format!("{} m/s²{u}{source}", stated(g.value))
}

fn converter(p: &Passport) -> String {
    let mut text = one_line(quantizer(&p.output.quantizer));
    if let (Some(lo), Some(hi)) = (p.output.min_code, p.output.max_code) {
        text.push_str(&format!(", codes {} to {}", stated(f64::from(lo)), stated(f64::from(hi))));
    }
    if let Some(rate) = p.output.rate_hz {
        text.push_str(&format!(", {} readings per second", stated(rate)));
    }
    text
}

fn banner(page: &Page<'_>) -> Markup {
    let class = match page.standing {
        Standing::Accepted => "accepted",
        Standing::Rejected | Standing::Unknown => "rejected",
        Standing::Unproven { .. } | Standing::Incomplete => "open",
    };
    let warnings = merged(page.passport.findings.iter().filter(|f| f.severity == "warning")).len();
    html! {
        section class={ "banner " (class) } {
            p .verdict { (page.standing.word()) " — " (page.standing.meaning()) }
            @if let Some(loud) = page.standing.loud() { p .loud { (loud) } }
            (causes(page.passport, "reject", "Reasons"))
            (causes(page.passport, "missing", "Missing"))
            @if warnings > 0 && page.standing == Standing::Accepted {
                p { "With " (counted(warnings, "warning")) ": see the findings." }
            }
        }
    }
}

fn causes(p: &Passport, severity: &str, heading: &str) -> Markup {
    let found: Vec<&Finding> = p.findings.iter().filter(|f| f.severity == severity).collect();
    let bare = standing::bare_sentences(p, severity);
    html! {
        @if !found.is_empty() || !bare.is_empty() {
            h3 { (heading) }
            ul {
                @for m in merged(found) {
                    li {
                        b { (capitalized(&m.finding.title)) }
                        @let places = m.places();
                        @if !places.is_empty() { " (" (places) ")" }
                        ": " (m.observed().join("; ")) ". What to do: " (as_sentence(&m.finding.todo))
                    }
                }
                @for s in bare { li { (as_sentence(s)) } }
            }
        }
    }
}

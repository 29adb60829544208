//! The terminal summary: verdict in words first, 80 columns, plain text.

use std::fmt::Write as _;

use tumble_core::FindingKind;
use tumble_io::passport::{Estimate, Finding, Passport, Scatter, Term};

use crate::merge::merged;
use crate::numbers::{interval, significant, value_with_uncertainty};
use crate::runs::mountings;
use crate::standing::{GROUPS, Standing, bare_sentences, compensation, result};
use crate::units::{Parameter, Unit, Units};
use crate::words::{as_sentence, counted, one_line, shortened, wrapped};

const WIDTH: usize = 80;
/// Column at which values start.
const VALUES: usize = 16;

/// A short summary for the terminal.
///
/// Verdict in words first, then the numbers that the verdict allows, then what to know and what to do. ASCII signs,
/// so that numbers can be copied. A rejected passport shows reasons only.
#[must_use]
pub fn summary(passport: &Passport) -> String {
    let p = crate::sanitized(passport);
    let standing = Standing::of(&p);
    let mut out = String::new();
    out.push_str(&wrapped(
        &format!("{} - ", standing.word()),
        standing.meaning(),
        standing.word().len() + 3,
        WIDTH,
    ));
    if let Some(loud) = standing.loud() {
        let _ = writeln!(out, "\n  *** {} ***", loud.to_uppercase());
    }
    out.push('\n');
    subject(&mut out, &p);
    numbers(&mut out, &p);
    conformity(&mut out, &p);
    if standing.has_estimates() {
        crate::outliers::table(&mut out, &p);
    }
    findings(&mut out, &p);
    // Ids of another version are not explained by this one.
    if let Some(kind) = p.findings.first().and_then(|f| FindingKind::from_id(&f.id)) {
        let _ = writeln!(out, "\n`tumble explain {}` tells more", kind.id());
    }
    out
}

fn row(out: &mut String, name: &str, value: &str) {
    let _ = writeln!(out, "  {name:<width$}{value}", width = VALUES - 2);
}

/// Model, serial and axis in one line; what nobody said is said to be missing.
pub(crate) fn sensor([model, serial, axis]: [&str; 3]) -> String {
    let said = |text: &str, longest| {
        if text.trim().is_empty() { "not stated".into() } else { shortened(text, longest) }
    };
    if [model, serial, axis].iter().all(|t| t.trim().is_empty()) {
        return "not stated: write model, serial and axis into [sensor]".into();
    }
    format!("{}, serial {}, axis {}", said(model, 24), said(serial, 24), said(axis, 8))
}

fn subject(out: &mut String, p: &Passport) {
    row(out, "sensor", &sensor([&p.sensor.model, &p.sensor.serial, &p.sensor.axis]));
    let positions: Vec<usize> = p.runs.iter().map(|r| r.positions).collect();
    let each = match (positions.iter().min(), positions.iter().max()) {
        (Some(a), Some(b)) if a == b => format!(" of {}", counted(*a, "position")),
        (Some(a), Some(b)) => format!(" of {a} to {b} positions"),
        _ => String::new(),
    };
    let mounted = mountings(p).len();
    let mounted = if mounted > 1 { format!(", {mounted} mountings") } else { String::new() };
    row(
        out,
        "measured",
        &format!(
            "{}{each}{mounted}; method {}",
            counted(p.runs.len(), "run"),
            shortened(&p.method, 12)
        ),
    );
}

/// The level of confidence in per cent: `95 %`.
pub(crate) fn level(p: &Passport) -> String {
    let text = significant(p.options.level * 100.0, 5);
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text} %")
}

/// A value with its expanded uncertainty, in a unit of display.
fn value(estimate: &Estimate, unit: &Unit) -> String {
    let shown = match estimate.expanded_uncertainty {
        Some(u) => value_with_uncertainty(unit.of(estimate.value), unit.of(u)),
        None => significant(unit.of(estimate.value), 6),
    };
    format!("{shown} {}", unit.name)
}

fn numbers(out: &mut String, p: &Passport) {
    let Some(r) = result(p) else { return };
    let units = Units::of(p);
    let _ = writeln!(out, "\n  value ± expanded uncertainty ({})", level(p));
    let line = |out: &mut String, name: &str, parameter: Parameter, e: &Estimate| {
        let second = units
            .second(parameter, p.nominal_scale_m_s2_per_lsb)
            .map_or_else(String::new, |u| format!("   = {}", value(e, &u)));
        row(out, name, &format!("{:<31}{second}", value(e, units.parameter(parameter))));
    };
    line(out, "bias", Parameter::Bias, &r.bias);
    if let Some(m) = &r.misalignment {
        line(out, "misalignment", Parameter::Misalignment, m);
    }
    for m in &r.mountings {
        let misalignment = value(&m.misalignment, units.parameter(Parameter::Misalignment));
        row(
            out,
            "misalignment",
            &format!("{misalignment:<31}   (mounting {})", shortened(&m.name, 16)),
        );
    }
    if let Some(zero) = &r.table_zero {
        line(out, "table zero", Parameter::Misalignment, zero);
    }
    line(out, "scale error", Parameter::ScaleError, &r.scale_error);
    row(out, "scale factor", &value(&r.scale_factor, &units.scale_factor));
    if let Some([low, high]) = r.bias.prediction_interval {
        row(
            out,
            "next power-up",
            &format!("bias estimate between {} m/s²", interval(low, high).replace(" to ", " and ")),
        );
    }
    if let Some([low, high]) = r.bias.prediction_true_interval {
        row(
            out,
            "",
            &format!("true bias between {} m/s²", interval(low, high).replace(" to ", " and ")),
        );
    }
    if let Some(e) = &p.error_level_lsb {
        let (after, how) = match e.after_held_out {
            Some(held_out) => (held_out, "compensated with the other runs' passport"),
            None => (e.after, "in sample: optimistic"),
        };
        let text = format!(
            "{} -> {} {} rms ({how})",
            significant(e.before, 2),
            significant(after, 2),
            units.reading
        );
        row(out, "error level", &text);
    }
    further_terms(out, p);
    table_repeats(out, p);
    let settled: Vec<String> =
        p.runs.iter().filter_map(|r| r.settled_at.map(|n| n.to_string())).collect();
    if !settled.is_empty() && settled.len() <= 12 {
        row(out, "settled", &format!("after {} positions", settled.join(", ")));
    }
    if let Some(c) = compensation(p) {
        row(
            out,
            "example",
            &format!(
                "{} is {} m/s²",
                match p.output.quantizer.as_str() {
                    // Real numbers are no codes.
                    "none" => format!("reading {} {}", c.example.code, units.reading),
                    _ => format!("code {}", c.example.code),
                },
                significant(c.example.acceleration_m_s2, 6)
            ),
        );
    }
}

/// Terms of the model beside the three, or what the data say against the usual one.
fn further_terms(out: &mut String, p: &Passport) {
    let named = |t: &Term| shortened(&t.name, 12);
    for t in p.terms.iter().filter(|t| t.entered).take(5) {
        let (usual, unit) = (&t.in_usual_unit, shortened(&t.in_usual_unit.unit, 12));
        if let (Some(v), Some(u)) = (usual.value, usual.expanded_uncertainty) {
            row(out, &named(t), &format!("{} {unit}", value_with_uncertainty(v, u)));
        }
    }
    if p.terms.iter().any(|t| t.entered) {
        return;
    }
    let bound = p.terms.first().and_then(|t| t.in_usual_unit.bound.map(|b| (t, b)));
    if let Some((t, bound)) = bound {
        let unit = shortened(&t.in_usual_unit.unit, 12);
        let text =
            format!("none; {} at most {} {unit} ({})", named(t), significant(bound, 2), level(p));
        row(out, "further terms", &text);
    }
}

/// How good the table is, a figure a run.
fn table_repeats(out: &mut String, p: &Passport) {
    let runs: Vec<&Scatter> = p.runs.iter().filter_map(|r| r.scatter.as_ref()).collect();
    let text = match runs.as_slice() {
        [] => return,
        [one] => {
            let [low, high] = one.total_arcmin.interval;
            format!(
                "to {} arcmin at 0° ({})",
                significant(one.total_arcmin.value, 2),
                interval(low, high)
            )
        }
        many if many.len() <= 12 => {
            let each: Vec<String> =
                many.iter().map(|s| significant(s.total_arcmin.value, 2)).collect();
            format!("to {} arcmin at 0°", each.join(", "))
        }
        _ => return,
    };
    row(out, "table repeats", &text);
}

/// The decision on the unit, where limits were given: the whole, then each quantity.
fn conformity(out: &mut String, p: &Passport) {
    let c = &p.conformity;
    let judged = crate::conformity::judged(p);
    if let Some(reason) = c.reason.as_deref().filter(|_| judged.is_empty()) {
        let lead = format!("\n  {:<width$}", "conformity", width = VALUES - 2);
        out.push_str(&wrapped(
            &lead,
            &format!("not assessed: {}", one_line(reason)),
            VALUES,
            WIDTH,
        ));
    }
    if judged.is_empty() {
        return;
    }
    let lead = format!("\n  {:<width$}", "conformity", width = VALUES - 2);
    let whole = format!(
        "{} - {}",
        crate::conformity::status(&c.status).to_uppercase(),
        crate::conformity::rule(c)
    );
    out.push_str(&wrapped(&lead, &whole, VALUES, WIDTH));
    let units = Units::of(p);
    for q in judged {
        let line = crate::conformity::Line::of(q, &units);
        let risk = line.risk.map_or_else(String::new, |r| format!("; risk {r}"));
        let text =
            format!("{}: {} {}, limits {}{risk}", line.status, line.value, line.unit, line.limits);
        let lead = format!("  {:<width$}", line.short_name, width = VALUES - 2);
        out.push_str(&wrapped(&lead, &text, VALUES, WIDTH));
    }
}

fn findings(out: &mut String, p: &Passport) {
    for group in GROUPS {
        let of_group: Vec<&Finding> =
            p.findings.iter().filter(|f| f.severity == group.severity).collect();
        let bare = bare_sentences(p, group.severity);
        if of_group.is_empty() && bare.is_empty() {
            continue;
        }
        let _ = writeln!(out, "\n{}", group.heading);
        for sentence in bare {
            out.push_str(&wrapped("  ", sentence, 8, WIDTH));
        }
        for m in merged(of_group) {
            let (f, places) = (m.finding, m.places());
            let place = if places.is_empty() {
                String::new()
            } else {
                format!(" ({})", shortened(&places, 48))
            };
            if group.severity == "note" {
                out.push_str(&wrapped(
                    "  ",
                    &format!("{} {}{place}", f.id, one_line(&f.title)),
                    8,
                    WIDTH,
                ));
                continue;
            }
            out.push_str(&wrapped(
                "  ",
                &format!("{} {}{place}: {}", f.id, one_line(&f.title), f.observed),
                8,
                WIDTH,
            ));
            out.push_str(&wrapped("        -> ", &as_sentence(&f.todo), 11, WIDTH));
        }
    }
}

//! What the survey says about sensor, files and bench.

use super::InitFacts;
use super::draft::{Draft, Kind, quoted};
use super::roles::{Roles, angle_unit, time_unit, unread_times};
use super::survey::{Column, Survey};
use crate::csv::{AngleUnit, Delimiter, HeaderUnit, TimeUnit};

/// Whether two files can be read by one `[csv]`.
pub(super) fn alike(a: &Survey, b: &Survey) -> bool {
    let (x, y) = (&a.sketch, &b.sketch);
    x.delimiter == y.delimiter && x.names == y.names && (x.header_line > 0) == (y.header_line > 0)
}

pub(super) fn sensor(draft: &mut Draft, facts: &InitFacts, survey: &Survey, roles: &Roles) {
    let said = |fact: &Option<String>| fact.as_ref().map(|f| quoted(f));
    match said(&facts.model) {
        Some(model) => draft.set("sensor", "model", model, "", Kind::Said),
        None => draft.set(
            "sensor",
            "model",
            quoted(""),
            "write it down: it stands on the passport",
            Kind::Seen,
        ),
    }
    let several = roles.sensor.map(|i| &survey.columns[i]);
    match (said(&facts.serial), several) {
        (Some(serial), _) => draft.set("sensor", "serial", serial, "", Kind::Said),
        (None, Some(c)) => {
            let first = c.texts.iter().next().cloned().unwrap_or_default();
            draft.set(
                "sensor",
                "serial",
                quoted(&first),
                "the first of several in the files",
                Kind::Assumed,
            );
        }
        (None, None) => draft.set("sensor", "serial", quoted(""), "", Kind::Seen),
    }
    if let Some(c) = several {
        let wanted = facts.serial.clone().filter(|s| c.texts.contains(s));
        let first = wanted.unwrap_or_else(|| c.texts.iter().next().cloned().unwrap_or_default());
        let others: Vec<&str> =
            c.texts.iter().map(String::as_str).filter(|t| *t != first).collect();
        let why = format!("rows of one sensor; the others are {}", others.join(", "));
        draft.set(
            "csv",
            "rows",
            format!("{{{} = {}}}", key(&c.name), quoted(&first)),
            why,
            Kind::Assumed,
        );
    }
}

/// A bare key where TOML allows it.
fn key(name: &str) -> String {
    let bare = !name.is_empty()
        && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare { name.to_owned() } else { quoted(name) }
}

/// The known name of a column with the reader's reference to it, where it needs one.
pub(super) fn reference(survey: &Survey, known: &str, index: usize) -> Option<String> {
    let names = &survey.sketch.names;
    let name = &names[index];
    let unique = names.iter().filter(|n| n.to_lowercase() == name.to_lowercase()).count() == 1;
    if survey.sketch.header_line == 0 || !unique || name.is_empty() {
        return Some(format!("{known} = {}", index + 1));
    }
    // Unused columns of known names would be taken for what they say.
    (name.to_lowercase() != known).then(|| format!("{known} = {}", quoted(name)))
}

/// Writes `columns` for a choice of the reading.
pub(super) fn map(draft: &mut Draft, survey: &Survey, roles: &Roles, reading: Option<usize>) {
    let real = reading.is_some_and(|i| survey.columns[i].is_real());
    let reading_name = if real { "output" } else { "code" };
    let pairs = [
        ("angle_deg", roles.angle),
        (reading_name, reading.filter(|_| roles.mean.is_none())),
        ("mean_code", roles.mean),
        ("samples", roles.samples.filter(|_| roles.mean.is_some())),
        ("std_code", roles.std.filter(|_| roles.mean.is_some())),
        ("t_s", roles.time),
        ("temperature_degc", roles.temperature),
        ("position", roles.position),
    ];
    let mapped: Vec<String> =
        pairs.into_iter().filter_map(|(known, i)| reference(survey, known, i?)).collect();
    draft.remove("csv", "columns");
    if !mapped.is_empty() {
        draft.set("csv", "columns", format!("{{{}}}", mapped.join(", ")), "", Kind::Seen);
    }
}

pub(super) fn csv(draft: &mut Draft, surveys: &[Survey], roles: &Roles) {
    let (survey, s) = (&surveys[0], &surveys[0].sketch);
    if s.header_line == 0 {
        draft.set(
            "csv",
            "header_line",
            0,
            "no header: columns are known by their numbers",
            Kind::Seen,
        );
        if s.data_line > 1 {
            draft.set("csv", "data_line", s.data_line, "", Kind::Seen);
        }
    } else {
        if !s.header_is_first {
            draft.set("csv", "header_line", s.header_line, "", Kind::Seen);
        }
        if !s.data_is_next {
            draft.set(
                "csv",
                "data_line",
                s.data_line,
                "something stands between header and data",
                Kind::Seen,
            );
        }
    }
    if s.delimiter == Delimiter::Blanks
        || (s.header_line == 0 && s.delimiter != Delimiter::Byte(b','))
    {
        draft.set("csv", "delimiter", quoted(s.delimiter.name()), "", Kind::Seen);
    }
    if s.decimal_comma {
        draft.set("csv", "decimal", quoted(","), "", Kind::Seen);
    }
    if let Some(mark) = s.comment {
        draft.set("csv", "comment", quoted(mark), "", Kind::Seen);
    }
    if let Some(i) = roles.time {
        let (unit, why) = time_unit(&survey.columns[i]);
        if unit != TimeUnit::Seconds {
            let kind = if why == "by the header" || unit == TimeUnit::Date {
                Kind::Seen
            } else {
                Kind::Assumed
            };
            draft.set("csv", "time_unit", quoted(unit.name()), why, kind);
        }
    }
}

/// Says which column of times cannot be read: without it gaps and rates are not seen.
pub(super) fn times(survey: &Survey, roles: &Roles, missing: &mut Vec<String>) {
    let Some(column) = unread_times(survey, roles).map(|i| &survey.columns[i]) else { return };
    let example = column.texts.iter().next().map_or("", String::as_str);
    missing.push(format!(
        "the times: column `{}` holds `{example}`, which is not read. Times are seconds or parts of them, times of day, or dates such as \
         2026-11-20T10:15:30 or 20.11.2026 10:15:30; in 11/20 and 20/11 month and day cannot be told apart",
        column.name
    ));
}

/// Whether rows of a column are empty in any file.
pub(super) fn has_gaps(surveys: &[Survey], index: usize) -> bool {
    surveys.iter().any(|s| s.columns.get(index).is_some_and(|c: &Column| c.missing > 0))
}

pub(super) fn bench(
    draft: &mut Draft,
    facts: &InitFacts,
    survey: &Survey,
    roles: &Roles,
    missing: &mut Vec<String>,
) {
    match (facts.gravity_m_s2, facts.site) {
        (_, Some((latitude, height))) => {
            draft.set("bench", "latitude_deg", format!("{latitude:?}"), "", Kind::Said);
            draft.set("bench", "height_m", format!("{height:?}"), "", Kind::Said);
        }
        (Some(g), None) => draft.set("bench", "gravity", format!("{g:?}"), "m/s²", Kind::Said),
        (None, None) => {
            // Normal gravity at sea level runs from 9.7803 to 9.8322 m/s²: the middle, and the half width over √3.
            let why =
                "m/s²: somewhere on Earth; better latitude_deg and height_m instead of both lines";
            draft.set("bench", "gravity", "9.806", why, Kind::Assumed);
            draft.set(
                "bench",
                "gravity_uncertainty",
                "0.015",
                "what not knowing the place costs (0.15 %)",
                Kind::Assumed,
            );
            draft.set("bench", "latitude_deg", "50.0", "", Kind::Example);
            draft.set("bench", "height_m", "150.0", "", Kind::Example);
            missing.push(
                "where the bench stands: give --latitude and --height (or latitude_deg and height_m in [bench]); \
                 without them the scale factor is known to 0.3 % at best"
                    .into(),
            );
        }
    }
    match facts.angle_uncertainty {
        Some(u) => draft.set(
            "bench",
            "angle_uncertainty_arcmin",
            format!("{:?}", u.arcmin()),
            "",
            Kind::Said,
        ),
        None => draft.set(
            "bench",
            "angle_uncertainty_arcmin",
            "3.0",
            "random error of setting an angle, standard, if you know it",
            Kind::Example,
        ),
    }
    if roles.angle.is_some_and(|i| survey.columns[i].unit == Some(HeaderUnit::Grad)) {
        let why = "Grad: degrees in German, gon elsewhere";
        draft.set("bench", "angle_unit", quoted(AngleUnit::Degrees.name()), why, Kind::Assumed);
    }
    if let Some(unit) = roles.angle.and_then(|i| angle_unit(&survey.columns[i]))
        && unit != AngleUnit::Degrees
    {
        draft.set("bench", "angle_unit", quoted(unit.name()), "", Kind::Seen);
    }
}

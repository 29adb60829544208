//! Which column is which: by name and unit first, by what it holds where the name says nothing.

use super::survey::{Column, Survey};
use crate::csv::{AngleUnit, HeaderUnit, Role, TimeUnit};

/// Columns by their place in the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Roles {
    pub(super) time: Option<usize>,
    pub(super) angle: Option<usize>,
    /// Candidates, likeliest first.
    pub(super) readings: Vec<usize>,
    pub(super) mean: Option<usize>,
    pub(super) samples: Option<usize>,
    pub(super) std: Option<usize>,
    pub(super) temperature: Option<usize>,
    pub(super) position: Option<usize>,
    /// Which sensor a row belongs to, where there are several.
    pub(super) sensor: Option<usize>,
}

/// Decides on the roles of a file's columns.
pub(super) fn roles(survey: &Survey) -> Roles {
    let columns = &survey.columns;
    let named = |role: Role, fits: &dyn Fn(&Column) -> bool| {
        columns.iter().position(|c| c.role == Some(role) && fits(c))
    };
    let mut found = Roles {
        time: named(Role::Time, &is_time)
            .or_else(|| columns.iter().position(|c| c.dates > 0 && c.dates == c.filled))
            .or_else(|| {
                columns.iter().position(|c| {
                    c.is_numeric() && c.always_rises() && c.role.is_none() && !is_row_number(c)
                })
            }),
        // An inclinometer beside the dial changes from row to row; the dial stands for a dwell.
        angle: named(Role::Angle, &|c| is_angle(c) && c.stays())
            .or_else(|| named(Role::Angle, &is_angle)),
        mean: named(Role::Mean, &Column::is_numeric),
        samples: named(Role::Samples, &|c| c.is_codes() && c.least >= 1.0),
        std: named(Role::Std, &Column::is_numeric),
        // `T` is a time where it goes up, else a temperature.
        temperature: named(Role::Temperature, &|c| {
            let other = matches!(c.unit, Some(HeaderUnit::Fahrenheit | HeaderUnit::Kelvin));
            c.is_numeric() && !other
        })
        .or_else(|| named(Role::Time, &|c| c.name.trim() == "T" && c.is_numeric() && !c.goes_up())),
        // A number of rows is no number of dwells.
        position: named(Role::Position, &|c| c.filled > 0 && c.stays()),
        sensor: named(Role::Sensor, &|c| (2..24).contains(&c.texts.len()) && c.changes > 0),
        readings: Vec::new(),
    };
    // A mean without a count is a reading like others.
    if found.mean.is_some() && found.samples.is_none() {
        found.mean = None;
    }
    let taken = |f: &Roles, i: usize| {
        [f.time, f.angle, f.mean, f.samples, f.std, f.temperature, f.position, f.sensor]
            .contains(&Some(i))
    };
    if found.angle.is_none() {
        found.angle = (0..columns.len()).find(|i| {
            let c = &columns[*i];
            !taken(&found, *i)
                && !matches!(c.role, Some(Role::Reading | Role::Mean | Role::Samples | Role::Std))
                && (c.numbers + c.dms == c.filled && c.filled > 0)
                && (c.dms > 0 || c.largest.max(-c.least) <= 400.0)
                && c.texts.len() > 2
                && c.stays()
        });
    }
    let number = |c: &Column| (c.is_numeric() || c.is_codes()) && !is_row_number(c);
    let mut readings: Vec<usize> = (0..columns.len())
        .filter(|i| !taken(&found, *i) && number(&columns[*i]) && columns[*i].texts.len() > 1)
        .collect();
    let named_reading = |i: &usize| {
        columns[*i].role == Some(Role::Reading)
            || columns[*i].unit.is_some_and(|u| u.of_readings().is_some())
    };
    if readings.iter().any(named_reading) {
        readings.retain(named_reading);
    }
    // Where a name says nothing, what moves most is the likeliest.
    readings.sort_by_key(|i| (!named_reading(i), std::cmp::Reverse(columns[*i].changes.min(1000))));
    if readings.is_empty() {
        // Cells that are no numbers, under a name of readings: reading them will tell what they are.
        readings = (0..columns.len())
            .filter(|i| !taken(&found, *i) && columns[*i].filled > 0 && named_reading(i))
            .collect();
    }
    found.readings = readings;
    found
}

fn is_angle(c: &Column) -> bool {
    c.numbers + c.dms == c.filled && c.filled > 0
}

fn is_time(c: &Column) -> bool {
    c.numbers + c.dates == c.filled && c.goes_up() && c.unit != Some(HeaderUnit::LongTime)
}

/// Whether a column counts the rows.
fn is_row_number(c: &Column) -> bool {
    let rows = c.filled.saturating_sub(1) as f64;
    c.whole == c.filled && c.filled > 8 && c.rising == c.filled - 1 && c.largest - c.least == rows
}

/// A column that is named as times are and that holds none that can be read.
pub(super) fn unread_times(survey: &Survey, roles: &Roles) -> Option<usize> {
    let unread = |c: &Column| {
        let long = c.unit == Some(HeaderUnit::LongTime);
        c.role == Some(Role::Time) && c.filled > 0 && (long || c.numbers + c.dates < c.filled)
    };
    if roles.time.is_some() { None } else { survey.columns.iter().position(unread) }
}

/// The unit of a column of times, and why.
pub(super) fn time_unit(c: &Column) -> (TimeUnit, &'static str) {
    match c.unit {
        _ if c.dates > 0 => return (TimeUnit::Date, "dates or times of day"),
        Some(HeaderUnit::Milliseconds) => return (TimeUnit::Milliseconds, "by the header"),
        Some(HeaderUnit::Microseconds) => return (TimeUnit::Microseconds, "by the header"),
        Some(HeaderUnit::Nanoseconds) => return (TimeUnit::Nanoseconds, "by the header"),
        Some(HeaderUnit::Seconds) => return (TimeUnit::Seconds, "by the header"),
        _ => {}
    }
    let lower = c.name.to_lowercase();
    if lower.contains("milli") {
        return (TimeUnit::Milliseconds, "by the header");
    }
    if lower.contains("micro") {
        return (TimeUnit::Microseconds, "by the header");
    }
    // Seconds since 1970 passed 1e9 in 2001.
    let epoch = "the size of times since 1970";
    match c.largest {
        t if t > 1e17 => return (TimeUnit::Nanoseconds, epoch),
        t if t > 1e14 => return (TimeUnit::Microseconds, epoch),
        t if t > 1e11 => return (TimeUnit::Milliseconds, epoch),
        t if t > 1e9 => return (TimeUnit::Seconds, epoch),
        _ => {}
    }
    match c.typical_step().unwrap_or_default() {
        s if c.whole == c.filled && s >= 900.0 => {
            (TimeUnit::Microseconds, "whole numbers with steps near a thousand and more")
        }
        s if c.whole == c.filled && s >= 1.5 => {
            (TimeUnit::Milliseconds, "whole numbers with steps of some units")
        }
        _ => (TimeUnit::Seconds, "the size of its steps"),
    }
}

/// The unit of a column of angles, where the header says it.
pub(super) fn angle_unit(c: &Column) -> Option<AngleUnit> {
    match c.unit {
        _ if c.dms > 0 => Some(AngleUnit::DegreesMinutesSeconds),
        Some(HeaderUnit::Gon) => Some(AngleUnit::Gon),
        Some(HeaderUnit::Radians) => Some(AngleUnit::Radians),
        Some(HeaderUnit::Degrees) => Some(AngleUnit::Degrees),
        _ => None,
    }
}

//! Which columns of a record hold the readings and their times.

use super::NoiseSettings;
use crate::csv::{
    Columns, DecimalSign, Delimiter, Dialect, HeaderUnit, Mapping, Role, TimeUnit, decoded, real,
    role, split_unit, trimmed,
};
use crate::error::{Place, Problem, ReadError};

/// Where the fields of a row stand.
#[derive(Debug)]
pub(super) struct Layout {
    pub columns: Columns,
    pub reading: usize,
    pub time: Option<usize>,
    /// Unit of the times, where `--time-unit` or the header says it.
    pub time_unit: Option<TimeUnit>,
    /// It was `--time-unit`: also dates are then what it says.
    pub unit_is_given: bool,
    /// The dial, where it was recorded: it must not move.
    pub angle: Option<usize>,
    /// The line was a header, and no row.
    pub header: bool,
}

impl Layout {
    /// Name of a column that looks like times, where none is used.
    pub fn likely_times(&self) -> Option<&str> {
        let names = self.columns.names.iter().enumerate();
        let mut times = names.filter(|(i, n)| *i != self.reading && role(n) == Some(Role::Time));
        times.next().map(|(_, n)| n.as_str()).filter(|_| self.time.is_none())
    }

    /// Unit that the header of the readings names.
    pub fn unit_of_readings(&self) -> Option<HeaderUnit> {
        split_unit(self.columns.name(self.reading)).1.filter(|u| u.of_readings().is_some())
    }
}

/// What the first line says; `None` for bare numbers.
pub(super) fn layout(
    line: &[u8],
    place: &Place,
    settings: &NoiseSettings,
) -> Result<Option<Layout>, ReadError> {
    let column = settings.column.as_deref();
    let bare = real(trimmed(line), DecimalSign::CommaOrPoint).is_some();
    if bare && column.is_none() && settings.time.is_none() {
        return Ok(None);
    }
    match Columns::parse(line, place, &Dialect::default(), &Mapping::new()) {
        Ok(columns) => named(columns, place, settings).map(Some),
        Err(ReadError { problem: Problem::NoHeader { columns: width, .. }, .. }) => {
            numbered(line, width, place, settings).map(Some)
        }
        Err(e) => Err(e),
    }
}

/// A file with a header.
fn named(columns: Columns, place: &Place, settings: &NoiseSettings) -> Result<Layout, ReadError> {
    let reading = match settings.column.as_deref() {
        None => columns.get("code").or_else(|| columns.get("output")),
        Some(column) => found(&columns, column, place),
    };
    let Some(reading) = reading else {
        return Err(unknown(place, &columns.names, settings.column.as_deref(), "--column"));
    };
    let time = match settings.time.as_deref() {
        None => columns.get("t_s"),
        Some(column) => match found(&columns, column, place) {
            None => return Err(unknown(place, &columns.names, Some(column), "--time")),
            found => found,
        },
    };
    let time_unit = match (settings.time_unit, time) {
        (None, Some(i)) => header_unit(columns.name(i), place)?,
        (given, _) => given,
    };
    let angle = columns.get("angle_deg").filter(|i| *i != reading);
    let unit_is_given = settings.time_unit.is_some();
    Ok(Layout { columns, reading, time, time_unit, unit_is_given, angle, header: true })
}

/// A file of several columns without a header.
fn numbered(
    line: &[u8],
    width: usize,
    place: &Place,
    settings: &NoiseSettings,
) -> Result<Layout, ReadError> {
    // As a header it would show the same separator.
    let delimiter = Some(Delimiter::of_header(&decoded(line)));
    let dialect = Dialect { delimiter, ..Dialect::default() };
    let columns = Columns::numbered(width, place, &dialect, &Mapping::new())?;
    let number = |column: &str| number_of(column).filter(|i| *i < width);
    let seen = match width {
        1 => "1 number a line and no names".to_owned(),
        _ => format!("{width} numbers a line and no names"),
    };
    let fail = |what: String, remedy| ReadError {
        place: place.clone(),
        problem: Problem::Document { what, remedy },
    };
    let reading = match settings.column.as_deref() {
        None => {
            return Err(fail(
                seen,
                "name the columns in a first line, or give the number of the readings' column: --column 2",
            ));
        }
        Some(column) => number(column).ok_or_else(|| {
            fail(format!("{seen}, no column `{column}`"), "give its number: --column 1")
        })?,
    };
    let time = match settings.time.as_deref() {
        None => None,
        Some(column) => Some(number(column).ok_or_else(|| {
            fail(format!("{seen}, no column `{column}`"), "give its number: --time 1")
        })?),
    };
    let (time_unit, unit_is_given) = (settings.time_unit, settings.time_unit.is_some());
    Ok(Layout { columns, reading, time, time_unit, unit_is_given, angle: None, header: false })
}

/// Index of a column by its name, else by its number.
fn found(columns: &Columns, column: &str, place: &Place) -> Option<usize> {
    let named = columns.find(column, place).ok();
    named.or_else(|| number_of(column)).filter(|i| *i < columns.names.len())
}

/// A column's number, counted from one, as an index.
fn number_of(column: &str) -> Option<usize> {
    column.parse::<usize>().ok().and_then(|n| n.checked_sub(1))
}

/// The unit that a header of times names.
fn header_unit(name: &str, place: &Place) -> Result<Option<TimeUnit>, ReadError> {
    Ok(match split_unit(name).1 {
        Some(HeaderUnit::Seconds) => Some(TimeUnit::Seconds),
        Some(HeaderUnit::Milliseconds) => Some(TimeUnit::Milliseconds),
        Some(HeaderUnit::Microseconds) => Some(TimeUnit::Microseconds),
        Some(HeaderUnit::Nanoseconds) => Some(TimeUnit::Nanoseconds),
        Some(HeaderUnit::LongTime) => {
            return Err(ReadError {
                place: Place { column: Some(name.to_owned()), ..place.clone() },
                problem: Problem::HeaderUnit {
                    unit: HeaderUnit::LongTime.text(),
                    remedy: "times are read in s, ms, us and ns, or as dates: convert the column, or give --rate HZ"
                        .into(),
                },
            });
        }
        _ => None,
    })
}

fn unknown(place: &Place, names: &[String], column: Option<&str>, option: &str) -> ReadError {
    let what = match column {
        Some(c) => format!("no column `{c}`"),
        None => "no column `code` or `output`".to_owned(),
    };
    let holds = if option == "--time" { "times" } else { "readings" };
    let likely = names.iter().find(|n| match option {
        "--time" => role(n) == Some(Role::Time),
        _ => role(n) == Some(Role::Reading),
    });
    // A name with blanks wants quotes, a number never does.
    let example = match likely.filter(|n| n.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_'))
    {
        Some(name) => format!("{option} {name}"),
        None => format!("{option} NAME, or {option} 2"),
    };
    let remedy = format!("say which one holds the {holds}: {example}");
    let problem = Problem::Columns { seen: names.to_vec(), what, remedy };
    ReadError { place: place.clone(), problem }
}

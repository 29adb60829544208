//! A record's noise: terminal text, figure, page.

mod figure;
mod page;
mod text;

pub use page::noise_page;
pub use text::noise_table;

use tumble_io::noise::NoiseDocument;

use crate::Figure;
use crate::numbers::significant;
use crate::sanitize::clean_text;

/// The log-log figure: deviation, band, what was fitted, the best dwell.
#[must_use]
pub fn noise_figure(document: &NoiseDocument) -> Option<Figure> {
    figure::figure(document)
}

/// Words for a deviation.
fn deviation_name(name: &str) -> &'static str {
    match name {
        "oadev" => "overlapping Allan deviation",
        "mdev" => "modified Allan deviation",
        "hdev" => "overlapping Hadamard deviation",
        "totdev" => "total deviation",
        "adev" => "Allan deviation without overlap",
        _ => "deviation",
    }
}

/// Digits that an interval lets a value have.
fn digits_of(value: f64, (low, high): (f64, Option<f64>)) -> i32 {
    match high.map(|h| (h - low) / value) {
        Some(width) if low > 0.0 && width < 0.05 => 4,
        Some(_) if low > 0.0 => 3,
        _ => 2,
    }
}

/// `value unit (from low to high)`.
fn with_interval(value: f64, unit: &str, interval: (f64, Option<f64>)) -> String {
    let (low, high) = interval;
    let digits = digits_of(value, interval).max(3);
    let high = high.map_or("no bound".to_owned(), |h| significant(h, digits));
    if value == 0.0 {
        return format!("not seen; at most {high} {unit}");
    }
    let value = significant(value, digits_of(value, interval));
    format!("{value} {unit} (from {} to {high})", significant(low, digits))
}

/// A unit as printed: `µg/√Hz` for `ug/rtHz`.
fn printed_unit(ascii: &str) -> String {
    ascii
        .replace("rtHz", "√Hz")
        .replace("rts", "√s")
        .replace("rth", "√h")
        .replace("ug", "µg")
        .replace("m/s2", "m/s²")
        .replace("m/s3", "m/s³")
        .replace("sqrt(2) ", "√2·")
}

/// A time for people.
fn duration(seconds: f64) -> String {
    let s = |v: f64| significant(v, 3);
    match seconds {
        t if t < 120.0 => format!("{} s", s(t)),
        t if t < 3600.0 => format!("{} min", s(t / 60.0)),
        t if t < 172_800.0 => format!("{} h", s(t / 3600.0)),
        t => format!("{} d", s(t / 86_400.0)),
    }
}

/// A file's name without its folder, safe to print.
fn short_name(file: &str) -> String {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    crate::words::shortened(&clean_text(name), 40)
}

/// A number as it was read or given, without zeros that say nothing.
fn stated(v: f64) -> String {
    let text = significant(v, 10);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

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

/// `value unit (from low to high)`.
fn with_interval(value: f64, unit: &str, (low, high): (f64, Option<f64>)) -> String {
    let high = high.map_or("no bound".to_owned(), |h| significant(h, 3));
    if value == 0.0 {
        return format!("not seen; at most {high} {unit}");
    }
    format!("{} {unit} (from {} to {high})", significant(value, 4), significant(low, 3))
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

//! The catalogue of sensor types on a terminal: 80 columns, and ASCII where the catalogue's texts are.

use std::fmt::Write as _;

use tumble_core::{LimitOf, Mark, SensorMode, TypeLimit};
use tumble_io::{Catalogue, CatalogueEntry, Converter};

use crate::sanitize::clean_text;
use crate::words::{one_line, shortened, wrapped};

const WIDTH: usize = 80;
/// Column at which values start on the page of an entry.
const VALUES: usize = 16;

/// All entries, a line each.
#[must_use]
pub fn catalogue(catalogue: &Catalogue) -> String {
    let mut out = String::from(
        "Marks: v verified in the maker's document, p partly, r recalled (not verified).\n\n",
    );
    let _ =
        writeln!(out, "{:<12} {:<30} {:<15} noise, ug/rtHz", "sensor", "sensitivity", "zero-g, mg");
    for e in catalogue.sensors() {
        let first = e.modes().first();
        let more = e.modes().len().saturating_sub(1);
        let more = if more > 0 { format!(" (+{more})") } else { String::new() };
        let sensitivity = first.map(sensitivity_short).unwrap_or_default() + &more;
        let row = format!(
            "{:<12} {:<30} {:<15} {:<15}",
            shown(e.model(), 12),
            sensitivity,
            limits_short(e, LimitOf::ZeroG),
            limits_short(e, LimitOf::NoiseDensity)
        );
        let _ = writeln!(out, "{}", row.trim_end());
    }
    if !catalogue.converters().is_empty() {
        let _ = writeln!(out, "\n{:<12} {:<30} samples/s (bits)", "converter", "reference");
    }
    for c in catalogue.converters() {
        let rates: Vec<String> =
            c.modes.iter().map(|m| format!("{} ({})", number(m.rate_hz), m.bits)).collect();
        let row = format!(
            "{:<12} {:<30} {}",
            shown(&c.model, 12),
            reference(c),
            shortened(&rates.join(", "), 36)
        );
        let _ = writeln!(out, "{}", row.trim_end());
    }
    out.push_str("\nOne in full: tumble catalogue MODEL. Your own: docs/catalogue.md.\n");
    out
}

/// One sensor in full, with its source and what is verified of it.
#[must_use]
pub fn catalogue_entry(e: &CatalogueEntry) -> String {
    let t = &e.sensor_type;
    let mut out = String::new();
    head(&mut out, e.model(), &e.maker, &e.aliases);
    for m in &t.modes {
        let digital = m
            .nominal_scale_m_s2_per_lsb()
            .map_or_else(String::new, |k| format!(" = {k:.6e} m/s2 per LSB"));
        let tolerance = match m.tolerance {
            Some((tolerance, mark)) => {
                format!("; tolerance +-{} % ({})", number(100.0 * tolerance), mark.name())
            }
            None => "; tolerance not known".into(),
        };
        let text = format!(
            "{}: {} {} ({}){digital}{tolerance}",
            shown(&m.name, 40),
            number(m.sensitivity),
            m.unit.name(),
            m.mark.name()
        );
        row(&mut out, if std::ptr::eq(m, &t.modes[0]) { "sensitivity" } else { "" }, &text);
    }
    if t.ratiometric {
        row(&mut out, "supply", "ratiometric: sensitivity and zero follow the supply");
    }
    for of in LimitOf::ALL {
        let mut name = of.name();
        for l in t.limits.iter().filter(|l| l.of == of) {
            row(&mut out, name, &limit_full(l));
            name = "";
        }
    }
    tail(&mut out, &e.note, &t.source, &t.catalogue);
    out.push_str(&wrapped(
        "\n  ",
        "Limits warn (T0125) and never reject. A misalignment is not held against cross-axis sensitivity or \
         alignment: on a tilt table it holds the seat and the dial's zero as well.",
        2,
        WIDTH,
    ));
    out
}

/// One converter in full.
#[must_use]
pub fn catalogue_converter(c: &Converter) -> String {
    let mut out = String::new();
    head(&mut out, &c.model, &c.maker, &c.aliases);
    let gains: Vec<String> = c.gains.iter().map(|g| number(*g)).collect();
    row(&mut out, "reference", &format!("{} ({})", reference(c), c.mark.name()));
    if !gains.is_empty() {
        row(&mut out, "gains", &format!("{} ({})", gains.join(", "), c.mark.name()));
    }
    let mut name = "rates";
    for m in &c.modes {
        let lsb = m
            .volt_per_lsb(c, 1.0)
            .map_or_else(String::new, |v| format!("; {} uV per LSB at gain 1", number(v * 1e6)));
        let text = format!(
            "{} samples/s, {} bit: min_code {}, max_code {} ({}){lsb}",
            number(m.rate_hz),
            m.bits,
            m.min_code,
            m.max_code,
            m.mark.name()
        );
        row(&mut out, name, &text);
        name = "";
    }
    tail(&mut out, &c.note, &c.source, &c.catalogue);
    out
}

fn head(out: &mut String, model: &str, maker: &str, aliases: &[String]) {
    let _ = writeln!(out, "{}", shown(model, WIDTH));
    if !maker.is_empty() {
        row(out, "maker", maker);
    }
    if !aliases.is_empty() {
        row(out, "also", &aliases.join(", "));
    }
}

fn tail(out: &mut String, note: &str, source: &str, catalogue: &str) {
    if !note.is_empty() {
        row(out, "note", note);
    }
    row(out, "source", source);
    row(out, "catalogue", catalogue);
}

fn row(out: &mut String, name: &str, value: &str) {
    let lead = format!("  {name:<width$}", width = VALUES - 2);
    out.push_str(&wrapped(&lead, &one_line(&clean_text(value)), VALUES + 2, WIDTH));
}

/// A text from a file, harmless and short.
fn shown(text: &str, longest: usize) -> String {
    shortened(&clean_text(text), longest)
}

/// The shortest text that stands for the number to ten digits.
fn number(v: f64) -> String {
    let rounded: f64 = format!("{v:.9e}").parse().unwrap_or(v);
    rounded.to_string()
}

fn letter(mark: Mark) -> char {
    match mark {
        Mark::Verified => 'v',
        Mark::Partly => 'p',
        Mark::Recalled => 'r',
    }
}

fn sensitivity_short(m: &SensorMode) -> String {
    let tolerance = m
        .tolerance
        .map_or_else(String::new, |(t, mark)| format!(" +-{:.1} % {}", 100.0 * t, letter(mark)));
    format!("{} {} {}{tolerance}", number(m.sensitivity), m.unit.name(), letter(m.mark))
}

/// Sizes of one kind of limit: the maximum, else the typical one; axes with a slash between.
fn limits_short(e: &CatalogueEntry, of: LimitOf) -> String {
    let limits: Vec<&TypeLimit> = e.sensor_type.limits.iter().filter(|l| l.of == of).collect();
    let Some(mark) = limits.iter().map(|l| l.mark).min() else { return "-".into() };
    let sizes: Vec<String> = limits
        .iter()
        .filter_map(|l| match (l.maximum, l.typical) {
            (Some(m), _) => Some(format!("{} max", number(m))),
            (None, t) => t.map(number),
        })
        .collect();
    let all_max = sizes.iter().all(|s| s.ends_with(" max"));
    let text = if all_max {
        format!("{} max", sizes.join("/").replace(" max", ""))
    } else {
        sizes.join("/")
    };
    format!("{} {}", shortened(&text, 13), letter(mark))
}

fn limit_full(l: &TypeLimit) -> String {
    let mut parts = Vec::new();
    // A density, a share of full scale and a number of bits have no sign.
    let sign = match l.of {
        LimitOf::NoiseDensity | LimitOf::Resolution => "",
        _ => "+-",
    };
    let unit = l.of.unit();
    if let Some(t) = l.typical {
        let word = if l.of == LimitOf::Resolution { "" } else { " typical" };
        parts.push(format!("{sign}{} {unit}{word}", number(t)));
    }
    if let Some(m) = l.maximum {
        parts.push(format!("{sign}{} {unit} at most", number(m)));
    }
    let scope: Vec<String> = l
        .axes
        .iter()
        .map(|a| format!("axes {a}"))
        .chain(l.mode.iter().map(|m| shown(m, 40)))
        .collect();
    let scope = if scope.is_empty() { String::new() } else { format!("{}: ", scope.join(", ")) };
    let note = if l.note.is_empty() { String::new() } else { format!("; {}", l.note) };
    format!("{scope}{} ({}){note}", parts.join(", "), l.mark.name())
}

fn reference(c: &Converter) -> String {
    match (c.reference_v, c.ratiometric) {
        (Some(v), _) => format!("{} V", number(v)),
        (None, true) => "the supply".into(),
        (None, false) => "not known".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_built_in_fits_a_plain_terminal() {
        let all = Catalogue::builtin();
        let mut pages = vec![catalogue(all)];
        pages.extend(all.sensors().iter().map(catalogue_entry));
        pages.extend(all.converters().iter().map(catalogue_converter));
        for page in pages {
            assert!(page.is_ascii(), "{page}");
            assert!(page.lines().all(|l| l.len() <= WIDTH), "{page}");
            assert!(page.lines().all(|l| l.trim_end() == l), "{page}");
        }
    }

    #[test]
    fn texts_of_strangers_are_harmless() {
        let text = "[[sensor]]\nmodel = \"A\\u001b[2J\"\nsource = \"s\\u001b[31m\"\nmaker = \"m\\nn\"\n\
                    [[sensor.mode]]\nname = \"n\\u202e\"\nsensitivity = 1e-300\nunit = \"mV/g\"\n";
        let own = Catalogue::parse(text, "x").unwrap();
        for page in [catalogue(&own), catalogue_entry(&own.sensors()[0])] {
            assert!(!page.contains(['\u{1b}', '\u{202e}']), "{page:?}");
        }
    }

    #[test]
    fn marks_are_shown_beside_every_number() {
        let page = catalogue_entry(Catalogue::builtin().find("ADXL203").unwrap());
        for words in [
            "5 V: 1000 mV/g (verified); tolerance +-4 % (recalled)",
            "+-25 mg typical, +-100 mg at most (recalled)",
            "5 V: 110 ug/rtHz typical (verified)",
            "source",
            "ratiometric",
        ] {
            assert!(page.contains(words), "{words}\n{page}");
        }
    }
}

//! How good sensor and table are: noise within dwells, scatter between them.

use maud::{Markup, html};
use tumble_io::passport::{Ranged, Run, Scatter};

use super::parts::{number, numbers, table, text};
use super::{Page, section};
use crate::numbers::{NONE, interval, typographic};
use crate::runs::MOST_RUNS;
use crate::words::shortened;

/// The table of noise and scatter; nothing where no run has them.
pub(super) fn section_of(page: &Page<'_>) -> Markup {
    let rows: Vec<Vec<String>> = page
        .passport
        .runs
        .iter()
        .take(MOST_RUNS)
        .filter_map(|r| r.scatter.as_ref().map(|s| row(r, s)))
        .collect();
    if rows.is_empty() {
        return html! {};
    }
    let caption = format!(
        "Value and interval ({}). σ: noise of a single reading, {unit}. Scatter: between dwells at 0°, in {unit} and in minutes of \
         arc; the latter is how well the table repeats. Made of: τ0, the same at all angles, and τφ, in the angles, \
         where the data tell them apart.",
        crate::summary::level(page.passport),
        unit = page.units.reading
    );
    let columns =
        [text("Run"), numbers("σ"), numbers("Scatter"), numbers("Scatter, ′"), text("Made of")];
    section("Noise and scatter", &table("", &caption, &columns, &rows))
}

fn row(run: &Run, s: &Scatter) -> Vec<String> {
    let noise = match &s.noise_lsb {
        None => NONE.to_owned(),
        Some(r) if s.noise_is_bound => format!("< {}", number(r.interval[1], 2)),
        Some(r) => shown(r),
    };
    vec![shortened(&run.name, 20), noise, shown(&s.total_lsb), shown(&s.total_arcmin), made_of(s)]
}

fn shown(r: &Ranged) -> String {
    let [low, high] = r.interval;
    format!("{} ({})", number(r.value, 2), typographic(&interval(low, high)))
}

/// What the scatter is made of, as far as the data say.
fn made_of(s: &Scatter) -> String {
    let level = || format!("τ0 {}", shown(&s.level_lsb));
    let angle = || format!("τφ {}′", shown(&s.angle_arcmin));
    match s.split.as_str() {
        "level" => format!("levels: {}", level()),
        "angle" => format!("angles: {}", angle()),
        "both" => format!("{}, {}", level(), angle()),
        "undetermined" => "not determined: either would do".into(),
        _ => "not asked".into(),
    }
}

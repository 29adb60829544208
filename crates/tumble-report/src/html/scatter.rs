//! How good sensor and table are: noise within dwells, scatter between them.

use maud::{Markup, html};
use tumble_io::passport::{Ranged, Run, Scatter};

use super::parts::{number, numbers, table, text};
use super::{Page, section};
use crate::numbers::{interval, typographic};
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
        "Value and interval ({}). σ: noise of a sample, {unit}. Total: scatter between dwells at 0°, in {unit} and in minutes of arc: \
         the repeatability of the table. τ0: its part that is the same at all angles, {unit}. τφ: its part in the angles, ′. \
         Split: which of the two the data ask for.",
        crate::summary::level(page.passport),
        unit = page.units.reading
    );
    let columns = [
        text("Run"),
        numbers("σ"),
        numbers("Total"),
        numbers("Total, ′"),
        numbers("τ0"),
        numbers("τφ, ′"),
        text("Split"),
    ];
    section("Noise and scatter", &table("", &caption, &columns, &rows))
}

fn row(run: &Run, s: &Scatter) -> Vec<String> {
    let shown = |r: &Ranged| {
        let [low, high] = r.interval;
        format!("{} ({})", number(r.value, 2), typographic(&interval(low, high)))
    };
    let noise = if s.noise_is_bound {
        format!("< {}", number(s.noise_lsb.interval[1], 2))
    } else {
        shown(&s.noise_lsb)
    };
    vec![
        shortened(&run.name, 20),
        noise,
        shown(&s.total_lsb),
        shown(&s.total_arcmin),
        shown(&s.level_lsb),
        shown(&s.angle_arcmin),
        s.split.replace('_', " "),
    ]
}

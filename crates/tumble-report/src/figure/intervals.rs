//! Figure 3: one interval a run, what they have in common, the result and the next power-up.

use maud::{Markup, html};
use tumble_io::passport::Passport;

use super::Figure;
use super::axis::{Axis, drawable, range};
use super::canvas::{WIDTH, c, document, label};
use super::mark::{colour, interval, marker};
use crate::numbers::{self, typographic, value_with_uncertainty};
use crate::runs::{Panel, panels};
use crate::standing::Standing;
use crate::units::Units;
use crate::words::shortened;

const LEFT: f64 = 132.0;
/// Room at the right for the numbers.
const NUMBERS: f64 = 168.0;
const ROW: f64 = 19.0;
const HEAD: f64 = 26.0;
const FOOT: f64 = 46.0;

/// What stands on one line of a panel.
struct Row {
    name: String,
    class: String,
    ends: [f64; 2],
    /// Marker's shape and value; none for a prediction.
    centre: Option<(usize, f64)>,
    numbers: String,
    /// A run of its own, as against the runs together.
    is_run: bool,
}

/// Absent without an interval, or where estimates may not be shown.
pub(super) fn figure(passport: &Passport) -> Option<Figure> {
    if !Standing::of(passport).has_estimates() {
        return None;
    }
    let units = Units::of(passport);
    let mut drawn: Vec<Markup> = Vec::new();
    let mut top = 4.0;
    for p in panels(passport, &units) {
        if let Some((markup, height)) = panel(&p, top) {
            drawn.push(markup);
            top += height;
        }
    }
    if drawn.is_empty() {
        return None;
    }
    let body = html! { @for d in &drawn { (d) } };
    let title = "Intervals of the runs, the result and the next power-up".to_owned();
    let caption = format!(
        "Each run's estimate with its own {} interval (statistical), and the result with its expanded uncertainty. The \
         intersection of the runs' intervals is a picture of agreement, not the result. The interval for the \
         next power-up holds the next estimate of a run like these.",
        crate::summary::level(passport)
    );
    let svg = document("intervals", &title, &caption, top, &body);
    Some(Figure { name: "intervals", title, caption, svg })
}

fn rows(p: &Panel<'_>) -> Vec<Row> {
    let shown = |ends: [f64; 2]| ends.map(|v| p.unit.of(v));
    let mut rows: Vec<Row> = p
        .runs
        .iter()
        .filter_map(|(i, run, e)| {
            let (value, ends) = (p.unit.of(e.value), shown(e.interval?));
            Some(Row {
                name: shortened(&run.name, 17),
                class: colour(*i),
                ends,
                centre: Some((*i, value)),
                numbers: value_with_uncertainty(value, (ends[1] - ends[0]) / 2.0),
                is_run: true,
            })
        })
        .collect();
    let Some(result) = p.result else { return rows };
    if let Some(ends) = result.interval.map(shown) {
        let value = p.unit.of(result.value);
        rows.push(Row {
            name: "result".into(),
            class: "ink".into(),
            ends,
            centre: Some((3, value)),
            numbers: value_with_uncertainty(
                value,
                p.unit.of(result.expanded_uncertainty.unwrap_or(0.0)),
            ),
            is_run: false,
        });
    }
    if let Some(ends) = result.prediction_interval.map(shown) {
        rows.push(Row {
            name: "next power-up".into(),
            class: "ink".into(),
            ends,
            centre: None,
            numbers: numbers::interval(ends[0], ends[1]),
            is_run: false,
        });
    }
    rows
}

fn panel(p: &Panel<'_>, top: f64) -> Option<(Markup, f64)> {
    let rows: Vec<Row> =
        rows(p).into_iter().filter(|r| r.ends.iter().all(|v| drawable(*v))).collect();
    let right = WIDTH - NUMBERS;
    let x = Axis::with_margin(range(rows.iter().flat_map(|r| r.ends))?, 0.06, (LEFT, right), 6.0)?;
    let (first, bottom) = (top + HEAD, top + HEAD + rows.len() as f64 * ROW + 4.0);
    let runs = rows.iter().filter(|r| r.is_run).count();
    let common = p
        .result
        .filter(|_| runs > 1)
        .map(|r| r.intersection_of_runs.map(|i| i.map(|v| p.unit.of(v))));
    let remark = match common {
        Some(Some(_)) => "shaded: common to all runs' intervals",
        Some(None) => "the runs' intervals have nothing in common (intersection: empty)",
        None => "",
    };
    let markup = html! {
        (label(10.0, top + 16.0, "panel", &p.title))
        (label(right, top + 16.0, "quiet end", remark))
        (label(WIDTH - 12.0, top + 16.0, "quiet end", &p.unit.name))
        (x.bottom(bottom, first, Some(&x.title(p.parameter.name(), &p.unit.name))))
        @if let Some(Some([lo, hi])) = common {
            rect class="band s2" x=(c(x.at(lo))) width=(c((x.at(hi) - x.at(lo)).max(1.0)))
                y=(c(first)) height=(c(runs as f64 * ROW)) {}
            @for end in [lo, hi] {
                // Edges show a band that is too narrow to see.
                line class="edge s2" x1=(c(x.at(end))) x2=(c(x.at(end)))
                    y1=(c(first)) y2=(c(first + runs as f64 * ROW)) {}
            }
        }
        @for (i, row) in rows.iter().enumerate() {
            @let y = first + (i as f64 + 0.5) * ROW;
            @if i == runs && runs > 0 {
                line .axis x1=(c(10.0)) x2=(c(WIDTH - 12.0)) y1=(c(y - ROW / 2.0)) y2=(c(y - ROW / 2.0)) {}
            }
            (label(LEFT - 10.0, y + 3.8, "end", &row.name))
            g class=(row.class) {
                @let stroke = if row.centre.is_some() { "bar" } else { "bar dashed" };
                path class=(stroke) d=(interval(x.at(row.ends[0]), x.at(row.ends[1]), y, 4.0)) {}
                @if let Some((shape, value)) = row.centre {
                    path .dot d=(marker(shape, x.at(value), y, 4.0)) {}
                }
            }
            (label(WIDTH - 12.0, y + 3.8, "end", &typographic(&row.numbers)))
        }
    };
    Some((markup, bottom - top + FOOT))
}

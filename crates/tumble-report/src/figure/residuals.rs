//! Figure 2: residuals, measured − modelled, against the table angle.

use maud::html;
use tumble_io::passport::{Passport, Run};

use super::Figure;
use super::axis::{Axis, drawable, range};
use super::canvas::{WIDTH, c, document};
use super::legend::{Sample, legend};
use super::mark::{colour, marker};
use crate::numbers::significant;
use crate::runs::MOST_RUNS;
use crate::units::Units;
use crate::words::shortened;

const LEFT: f64 = 84.0;
const HEIGHT: f64 = 230.0;

/// Absent without residuals.
pub(super) fn figure(passport: &Passport) -> Option<Figure> {
    let units = Units::of(passport);
    let shown: Vec<(usize, &Run)> = passport
        .runs
        .iter()
        .enumerate()
        .take(MOST_RUNS)
        .filter(|(_, r)| !r.residuals.is_empty())
        .collect();
    let all = || shown.iter().flat_map(|(_, r)| &r.residuals);
    // One band for all runs: the widest, said so in words.
    let widest = shown
        .iter()
        .filter_map(|(_, r)| r.residual_std_lsb)
        .filter(|s| drawable(*s))
        .fold(None, |m: Option<f64>, s| Some(m.map_or(s, |m| m.max(s))));

    let largest = range(all().map(|r| r.lsb.abs()).chain(widest))?.1;
    let x =
        Axis::with_margin(range(all().map(|r| r.angle_deg))?, 0.03, (LEFT, WIDTH - 16.0), 10.0)?;
    let mut entries: Vec<(Sample, String)> =
        shown.iter().map(|(i, r)| (Sample::Marker(*i), shortened(&r.name, 18))).collect();
    if let Some(s) = widest {
        let which =
            if shown.len() > 1 { "± largest residual std of a run" } else { "± residual std" };
        entries
            .push((Sample::Band(0), format!("{which}, {} {}", significant(s, 2), units.reading)));
    }
    let (keys, top) = legend(&entries, (LEFT - 10.0, WIDTH - 10.0), 6.0);
    let (top, bottom) = (top + 14.0, top + 14.0 + HEIGHT);
    let y = Axis::with_margin((-largest, largest), 0.06, (bottom, top), 6.0)?;
    let path = |i: usize, run: &Run| -> String {
        run.residuals
            .iter()
            .filter(|r| drawable(r.angle_deg) && drawable(r.lsb))
            .map(|r| marker(i, x.at(r.angle_deg), y.at(r.lsb), 2.9))
            .collect()
    };
    let right = WIDTH - 16.0;
    let body = html! {
        (keys)
        (x.bottom(bottom, top, Some("Table angle, degrees")))
        (y.left(LEFT, right, &y.title("Measured − modelled", &units.reading)))
        @if let Some(s) = widest {
            rect class="band s0" x=(c(LEFT)) width=(c(right - LEFT))
                y=(c(y.at(s))) height=(c((y.at(-s) - y.at(s)).max(0.5))) {}
        }
        line .zero x1=(c(LEFT)) x2=(c(right)) y1=(c(y.at(0.0))) y2=(c(y.at(0.0))) {}
        @for (i, run) in &shown {
            path class={ "dot " (colour(*i)) } d=(path(*i, run)) {}
        }
    };
    let title = "Residuals".to_owned();
    let caption = caption(&shown, passport.runs.len(), &units);
    let svg = document("residuals", &title, &caption, bottom + 44.0, &body);
    Some(Figure { name: "residuals", title, caption, svg })
}

fn caption(shown: &[(usize, &Run)], all: usize, units: &Units) -> String {
    let stds: Vec<String> = shown
        .iter()
        .filter_map(|(_, r)| {
            r.residual_std_lsb.map(|s| format!("{} {}", shortened(&r.name, 18), significant(s, 2)))
        })
        .collect();
    let mut text = format!(
        "Measured minus modelled reading of every position against the table angle, in {}. A curve or a point far off \
         would say that the model or an angle is wrong.",
        units.reading
    );
    if !stds.is_empty() {
        text.push_str(&format!(" Standard deviations: {}.", stds.join(", ")));
    }
    if shown.len() < all {
        text.push_str(&format!(" Shown: {} of {all} runs.", shown.len()));
    }
    text
}

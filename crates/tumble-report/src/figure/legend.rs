//! Legends: samples with words, flowing over as many lines as they need.

use maud::{Markup, html};

use super::canvas::{c, label};
use super::mark::{colour, marker};

/// What stands before the words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sample {
    /// A run's line.
    Line(usize),
    /// A line without markers.
    Plain(usize),
    /// A fine dashed line.
    Edge(usize),
    /// A dashed line.
    Dashed(usize),
    /// A run's marker.
    Marker(usize),
    /// A shaded band in a series colour.
    Band(usize),
    /// A filled box in a series colour.
    Box(usize),
    /// A vertical interval.
    Interval,
    /// Marker of a place on a line.
    Place,
}

/// Height of a line of the legend.
const LINE: f64 = 18.0;
/// Width of a sample with the gap behind it.
const SAMPLE: f64 = 26.0;

/// Entries from (`x`, `y`) to the right edge; gives the markup and its height.
pub(crate) fn legend(
    entries: &[(Sample, String)],
    (left, right): (f64, f64),
    y: f64,
) -> (Markup, f64) {
    let (mut x, mut row) = (left, 0.0);
    let mut placed = Vec::new();
    for (sample, words) in entries {
        let width = SAMPLE + text_width(words) + 16.0;
        if x > left && x + width > right {
            (x, row) = (left, row + 1.0);
        }
        placed.push((*sample, words, x, y + row * LINE + LINE / 2.0));
        x += width;
    }
    let markup = html! {
        @for (sample, words, x, y) in &placed {
            (draw(*sample, *x, *y))
            (label(x + SAMPLE, y + 3.8, "key", words))
        }
    };
    let height = if entries.is_empty() { 0.0 } else { (row + 1.0) * LINE };
    (markup, height)
}

fn draw(sample: Sample, x: f64, y: f64) -> Markup {
    let horizontal = format!("M{} {}h20", c(x), c(y));
    html! {
        @match sample {
            Sample::Line(run) => {
                g class=(colour(run)) {
                    path .line d=(horizontal) {}
                    path .dot d=(marker(run, x + 10.0, y, 3.6)) {}
                }
            }
            Sample::Plain(series) => { path class={ "line " (colour(series)) } d=(horizontal) {} }
            Sample::Edge(series) => { path class={ "edge " (colour(series)) } d=(horizontal) {} }
            Sample::Dashed(series) => { path class={ "line dashed " (colour(series)) } d=(horizontal) {} }
            Sample::Marker(run) => {
                path class={ "dot " (colour(run)) } d=(marker(run, x + 10.0, y, 3.6)) {}
            }
            Sample::Band(series) => {
                rect class={ "band " (colour(series)) } x=(c(x)) y=(c(y - 6.0)) width="20" height="12" {}
            }
            Sample::Box(series) => {
                rect class={ "solid " (colour(series)) } x=(c(x)) y=(c(y - 5.0)) width="20" height="10" {}
            }
            Sample::Interval => {
                path class="bar ink" d=(super::mark::upright(x + 10.0, y - 6.0, y + 6.0, 3.0)) {}
            }
            Sample::Place => {
                path class="line ink" d=(horizontal) {}
                path class="dot ink" d=(marker(0, x + 10.0, y, 3.6)) {}
            }
        }
    }
}

/// An upper estimate: there are no font metrics here.
pub(super) fn text_width(text: &str) -> f64 {
    text.chars().map(|c| if u32::from(c) >= 0x2e80 { 12.0 } else { 6.3 }).sum()
}

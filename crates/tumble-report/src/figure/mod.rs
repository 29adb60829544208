//! Figures of a passport as standalone SVG: how the estimates settle, residuals, intervals, error level.

mod axis;
mod canvas;
mod error_level;
mod intervals;
mod legend;
mod mark;
mod residuals;
mod settling;
mod style;

/// What figures outside of this module are made of.
pub(crate) mod parts {
    pub(crate) use super::axis::drawable;
    pub(crate) use super::canvas::{WIDTH, c, document, label};
    pub(crate) use super::legend::{Sample, legend};
    pub(crate) use super::mark::{colour, marker, upright};
}

use tumble_io::passport::Passport;

/// A figure: SVG with its own style for light and dark, and words for it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// File stem: `settling`, `residuals`, `intervals`, `error-level` or `noise`.
    pub name: &'static str,
    /// Title, plain text.
    pub title: String,
    /// What is seen and how to read it, plain text.
    pub caption: String,
    /// The file: a well-formed SVG document without script, external resources or foreign content.
    pub svg: String,
}

/// The figures that the passport has data for, in the order of the paper.
///
/// * `settling`: estimates from the first positions alone, per run, with the final expanded uncertainty;
/// * `residuals`: measured − modelled against the table angle;
/// * `intervals`: one interval a run, what they have in common, the result, the next power-up;
/// * `error-level`: error before and after compensation.
///
/// A figure without data is left out. A rejected passport keeps the residuals alone: the others would show
/// coefficients.
#[must_use]
pub fn figures(passport: &Passport) -> Vec<Figure> {
    of_sanitized(&crate::sanitized(passport))
}

/// [`figures`] of a passport that is sanitized already.
pub(crate) fn of_sanitized(passport: &Passport) -> Vec<Figure> {
    [
        settling::figure(passport),
        residuals::figure(passport),
        intervals::figure(passport),
        error_level::figure(passport),
    ]
    .into_iter()
    .flatten()
    .collect()
}

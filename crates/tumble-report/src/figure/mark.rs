//! Markers that tell runs apart by shape as well as by colour, as SVG path data.

use super::canvas::c;
use super::style::COLOURS;

/// Number of shapes before they repeat.
const SHAPES: usize = 5;

/// Class of a run's colour.
pub(crate) fn colour(run: usize) -> String {
    format!("s{}", run % COLOURS)
}

/// Path of a run's marker around a point.
pub(crate) fn marker(run: usize, x: f64, y: f64, r: f64) -> String {
    // Six colours and five shapes: no two of the first thirty runs look alike.
    match run % SHAPES {
        0 => format!(
            "M{} {}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0z",
            c(x - r),
            c(y),
            r = c(r),
            d = c(2.0 * r)
        ),
        1 => polygon(x, y, &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)], r),
        2 => polygon(x, y, &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)], r),
        3 => polygon(x, y, &[(0.0, -1.3), (1.1, 0.0), (0.0, 1.3), (-1.1, 0.0)], r),
        _ => polygon(x, y, &[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)], r),
    }
}

fn polygon(x: f64, y: f64, corners: &[(f64, f64)], r: f64) -> String {
    let mut path = String::new();
    for (i, (dx, dy)) in corners.iter().enumerate() {
        path.push(if i == 0 { 'M' } else { 'L' });
        path.push_str(&format!("{} {}", c(x + dx * r), c(y + dy * r)));
    }
    path.push('z');
    path
}

/// A horizontal interval with end caps.
pub(super) fn interval(x1: f64, x2: f64, y: f64, cap: f64) -> String {
    let (x1, x2, y1, y2) = (c(x1), c(x2), c(y - cap), c(y + cap));
    format!("M{x1} {y1}V{y2}M{x2} {y1}V{y2}M{x1} {y}H{x2}", y = c(y))
}

/// A vertical interval with end caps.
pub(crate) fn upright(x: f64, y1: f64, y2: f64, cap: f64) -> String {
    let (y1, y2, x1, x2) = (c(y1), c(y2), c(x - cap), c(x + cap));
    format!("M{x1} {y1}H{x2}M{x1} {y2}H{x2}M{x} {y1}V{y2}", x = c(x))
}

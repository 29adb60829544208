//! A linear axis: where a value lies, and ticks at round numbers.

use maud::{Markup, html};

use super::canvas::{c, label};
use crate::numbers::{fixed, power_of_ten, typographic};

/// Largest number that is drawn; beyond it differences could overflow.
const LARGEST: f64 = 1e200;

/// Whether a number can be drawn.
pub(crate) fn drawable(v: f64) -> bool {
    v.is_finite() && v.abs() < LARGEST
}

/// The smallest range that holds all drawable `values`.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values.into_iter().filter(|v| drawable(*v)).fold(None, |r: Option<(f64, f64)>, v| {
        Some(r.map_or((v, v), |(lo, hi)| (lo.min(v), hi.max(v))))
    })
}

/// Maps values from `lo` to `hi` onto coordinates from `from` to `to`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    lo: f64,
    hi: f64,
    from: f64,
    to: f64,
    /// Ticks, ascending.
    pub ticks: Vec<f64>,
    /// Power of ten of the tick's last digit.
    place: i32,
    /// Power of ten taken out of the labels.
    exponent: i32,
}

impl Axis {
    /// About `count` ticks between `lo` and `hi`. An empty range is widened. `None` where nothing can be drawn.
    pub fn new((lo, hi): (f64, f64), (from, to): (f64, f64), count: f64) -> Option<Self> {
        if !drawable(lo) || !drawable(hi) || lo > hi {
            return None;
        }
        let size = lo.abs().max(hi.abs());
        let (lo, hi) = if hi - lo > 1e-9 * size {
            (lo, hi)
        } else {
            let half = if size > 0.0 { 0.1 * size } else { 1.0 };
            (lo - half, hi + half)
        };
        let (step, place) = nice_step((hi - lo) / count.max(1.0))?;
        let first = (lo / step).ceil();
        let ticks = (0..)
            .map(|i| (first + f64::from(i)) * step)
            .take_while(|t| *t <= hi + 1e-9 * step)
            .take(50)
            .collect();
        let size = lo.abs().max(hi.abs()).log10().floor() as i32;
        let exponent = if (-3..5).contains(&size) { 0 } else { size.div_euclid(3) * 3 };
        Some(Self { lo, hi, from, to, ticks, place, exponent })
    }

    /// With a margin of a part of the range on both sides.
    pub fn with_margin(range: (f64, f64), part: f64, span: (f64, f64), count: f64) -> Option<Self> {
        let margin = part * (range.1 - range.0);
        Self::new((range.0 - margin, range.1 + margin), span, count)
    }

    /// Coordinate of a value. Values far outside stay within one length of the axis.
    pub fn at(&self, v: f64) -> f64 {
        let part = ((v - self.lo) / (self.hi - self.lo)).clamp(-1.0, 2.0);
        self.from + part * (self.to - self.from)
    }

    /// Whether a value lies on the axis.
    pub fn holds(&self, v: f64) -> bool {
        (self.lo..=self.hi).contains(&v)
    }

    /// Label of a tick.
    pub fn label(&self, tick: f64) -> String {
        let scaled = tick / 10f64.powi(self.exponent);
        typographic(&fixed(scaled, self.exponent - self.place))
    }

    /// `name, unit`, with the power of ten that the labels leave out.
    pub fn title(&self, name: &str, unit: &str) -> String {
        if self.exponent == 0 {
            format!("{name}, {unit}")
        } else {
            format!("{name}, {} {unit}", power_of_ten(self.exponent))
        }
    }

    /// Horizontal axis below a plot at `y`, with grid lines up to `top`.
    pub fn bottom(&self, y: f64, top: f64, title: Option<&str>) -> Markup {
        html! {
            @for t in &self.ticks {
                @let x = self.at(*t);
                line .grid x1=(c(x)) x2=(c(x)) y1=(c(top)) y2=(c(y)) {}
                line .axis x1=(c(x)) x2=(c(x)) y1=(c(y)) y2=(c(y + 4.0)) {}
                (label(x, y + 16.0, "tick middle", &self.label(*t)))
            }
            line .axis x1=(c(self.from)) x2=(c(self.to)) y1=(c(y)) y2=(c(y)) {}
            @if let Some(title) = title {
                (label((self.from + self.to) / 2.0, y + 33.0, "name middle", title))
            }
        }
    }

    /// Vertical axis left of a plot at `x`, with grid lines to `right` and the title turned.
    pub fn left(&self, x: f64, right: f64, title: &str) -> Markup {
        let (tx, ty) = (x - 62.0, (self.from + self.to) / 2.0);
        html! {
            @for t in &self.ticks {
                @let y = self.at(*t);
                line .grid x1=(c(x)) x2=(c(right)) y1=(c(y)) y2=(c(y)) {}
                line .axis x1=(c(x - 4.0)) x2=(c(x)) y1=(c(y)) y2=(c(y)) {}
                (label(x - 7.0, y + 3.8, "tick end", &self.label(*t)))
            }
            line .axis x1=(c(x)) x2=(c(x)) y1=(c(self.from)) y2=(c(self.to)) {}
            text class="name middle" x=(c(tx)) y=(c(ty)) transform={ "rotate(-90 " (c(tx)) " " (c(ty)) ")" } {
                (title)
            }
        }
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `rough`, and that power.
fn nice_step(rough: f64) -> Option<(f64, i32)> {
    if !(rough.is_finite() && rough > 1e-290) {
        return None;
    }
    let place = rough.log10().floor() as i32;
    let unit = 10f64.powi(place);
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|m| (m * unit, place))
        .find(|(step, _)| *step >= rough * (1.0 - 1e-9))
        .or(Some((10.0 * unit, place + 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(lo: f64, hi: f64) -> Vec<String> {
        let axis = Axis::new((lo, hi), (0.0, 100.0), 5.0).unwrap();
        axis.ticks.iter().map(|t| axis.label(*t)).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(0.0, 60.0), ["0", "20", "40", "60"]);
        assert_eq!(labels(-0.45, 0.52), ["−0.4", "−0.2", "0.0", "0.2", "0.4"]);
        assert_eq!(labels(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-0.00012, 0.00003), ["−100", "−50", "0"]);
        assert_eq!(labels(1.2e7, 2.1e7), ["12", "14", "16", "18", "20"]);
        assert_eq!(labels(996.0, 1003.0), ["996", "998", "1000", "1002"]);
    }

    #[test]
    fn powers_of_ten_stand_in_the_title() {
        let axis = Axis::new((-1.2e-4, 3e-5), (0.0, 1.0), 5.0).unwrap();
        assert_eq!(axis.title("Bias", "m/s²"), "Bias, 10⁻⁶ m/s²");
    }

    #[test]
    fn poor_ranges() {
        assert!(Axis::new((0.0, f64::NAN), (0.0, 1.0), 5.0).is_none());
        assert!(Axis::new((1.0, 0.0), (0.0, 1.0), 5.0).is_none());
        assert!(Axis::new((-1e300, 1e300), (0.0, 1.0), 5.0).is_none());
        let point = Axis::new((5.0, 5.0), (0.0, 100.0), 5.0).unwrap();
        assert!((point.at(5.0) - 50.0).abs() < 1e-9);
        assert!(Axis::new((1e-300, 1e-300), (0.0, 1.0), 5.0).is_none());
        let wide = Axis::new((0.0, 1.0), (0.0, 100.0), 5.0).unwrap();
        assert_eq!(wide.at(1e199), 200.0);
    }

    #[test]
    fn ranges_skip_what_cannot_be_drawn() {
        assert_eq!(range([1.0, f64::INFINITY, -2.0]), Some((-2.0, 1.0)));
        assert_eq!(range([f64::NAN]), None);
    }
}

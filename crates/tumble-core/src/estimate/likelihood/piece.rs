//! One parabola of a dwell's curve, times the Gaussian of the scatter: integrals in closed form.

use core::f64::consts::PI;

use crate::stats::erfcx;

/// `ℓ(x) = value + slope t + ½ curvature t²` for `0 ≤ t = side·x − from ≤ width`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    /// −1 for the piece that goes to the left without end.
    pub side: f64,
    pub from: f64,
    pub width: f64,
    pub value: f64,
    pub slope: f64,
    pub curvature: f64,
}

/// Below the highest point by this much, a piece adds less than 1e-11.
pub(super) const NEGLIGIBLE: f64 = 25.0;

/// `start + slope t − ½ precision t²` on `0 ≤ t ≤ width`: a piece times the scatter's Gaussian.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weighted {
    pub start: f64,
    pub slope: f64,
    pub precision: f64,
    pub width: f64,
}

impl Weighted {
    #[inline]
    pub fn of(p: &Piece, m: f64, w: f64) -> Self {
        let off = p.from - p.side * m;
        Self {
            start: p.value - 0.5 * w * off * off,
            slope: p.slope - w * off,
            precision: w - p.curvature,
            width: p.width,
        }
    }

    #[inline]
    pub fn at(&self, t: f64) -> f64 {
        self.start + t * (self.slope - 0.5 * self.precision * t)
    }

    #[inline]
    fn peaks_inside(&self) -> bool {
        self.slope > 0.0 && self.slope < self.precision * self.width
    }

    #[inline]
    pub fn highest(&self) -> f64 {
        if self.peaks_inside() {
            self.start + 0.5 * self.slope * self.slope / self.precision
        } else if self.slope > 0.0 {
            self.at(self.width)
        } else {
            self.start
        }
    }

    /// `∫ tⁿ e^{… − height} dt` for n = 0, 1, 2, given the density at both ends.
    #[inline]
    pub fn moments(&self, height: f64, at_start: f64, at_end: f64) -> [f64; 3] {
        if self.precision * self.width * self.width < NEARLY_STRAIGHT {
            return self.by_quadrature(height);
        }
        let peak = self.slope / self.precision;
        let root = self.precision.sqrt();
        let (z0, z1) = (-peak * root, (self.width - peak) * root);
        let scaled = |z: f64, e: f64| {
            if e > 0.0 { e * erfcx(z.abs() * core::f64::consts::FRAC_1_SQRT_2) } else { 0.0 }
        };
        let half = (PI / (2.0 * self.precision)).sqrt();
        let area = half
            * if self.peaks_inside() {
                2.0 * (self.highest() - height).exp() - scaled(z0, at_start) - scaled(z1, at_end)
            } else if z0 >= 0.0 {
                scaled(z0, at_start) - scaled(z1, at_end)
            } else {
                scaled(z1, at_end) - scaled(z0, at_start)
            };
        // About the peak, then about the start.
        let first = (at_start - at_end) / self.precision;
        let far = if at_end > 0.0 { (self.width - peak) * at_end } else { 0.0 };
        let second = (area - peak * at_start - far) / self.precision;
        [area, first + peak * area, second + 2.0 * peak * first + peak * peak * area]
    }

    /// Gauss and Legendre's three points, for pieces that hardly bend.
    #[inline]
    fn by_quadrature(&self, height: f64) -> [f64; 3] {
        const POINTS: [(f64, f64); 3] = [
            (0.112_701_665_379_258_31, 0.277_777_777_777_777_8),
            (0.5, 0.444_444_444_444_444_4),
            (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
        ];
        let mut out = [0.0; 3];
        for (u, weight) in POINTS {
            let t = u * self.width;
            let e = weight * self.width * (self.at(t) - height).exp();
            out[0] += e;
            out[1] += t * e;
            out[2] += t * t * e;
        }
        out
    }
}

/// `precision × width²` below which the closed form would cancel. Three points are exact to five digits there: pieces
/// fall by no more than a factor of e³ where they matter.
const NEARLY_STRAIGHT: f64 = 0.05;

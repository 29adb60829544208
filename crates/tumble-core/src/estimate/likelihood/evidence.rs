//! What one dwell says about its level: a curve, prepared so that scatter between dwells costs little to add.

use core::f64::consts::PI;

use super::cells::{Cells, Jet};
use crate::stats::erfcx;

/// Log-likelihood below the top at which a dwell's curve is cut into pieces; what lies lower weighs e⁻²⁰.
const DEEPEST: f64 = 20.0;
/// Each piece ends about this much lower than the one before it.
const STEP_RATIO: f64 = 3.0;
/// Where the first piece ends.
const SHALLOWEST: f64 = 0.01;
/// Parameters of the model.
const PARAMETERS: f64 = 3.0;
/// Log-likelihood below the top down to which a level is not contradicted: two standard deviations of a Gaussian.
const ALLOWED: f64 = 2.0;
/// Departure from a parabola at 1.5 and 3 standard deviations, over their square, up to which a dwell counts as
/// Gaussian: 0.12 of 4.5 at three.
const GAUSSIAN_WITHIN: f64 = 0.013;

/// `ln L(m)` of a dwell after its scatter was integrated out, with derivatives by `m`.
///
/// The derivative by the variance of the scatter comes with them: `∂L/∂v = ½ ∂²L/∂m²` (the heat equation).
pub(super) type Marginal = Jet;

/// A dwell's log-likelihood as a function of its level.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Evidence {
    /// A parabola: `−(μ − centre)²/(2 variance)`, with its integral as the value.
    Gaussian {
        /// Level, LSB.
        centre: f64,
        /// LSB²; may be zero where nothing is known about it.
        variance: f64,
        /// `ln ∫ e^ℓ dμ`.
        ln_integral: f64,
    },
    /// Any log-concave curve.
    Curve(Curve),
}

/// A log-concave curve in pieces of parabolas; the outermost go on to infinity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve {
    cells: Cells,
    sigma: f64,
    inflation: f64,
    /// Value at the top; pieces count from it.
    top: f64,
    pieces: Vec<Piece>,
    /// Smallest width on which the curve changes.
    grain: f64,
    centre: f64,
    variance: f64,
    /// Where the curve stands less than [`ALLOWED`] below its top.
    allowed: (f64, f64),
}

/// `ℓ(x) = value + slope t + ½ curvature t²` for `0 ≤ t = side·x − from ≤ width`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    /// −1 for the piece that goes to the left without end.
    side: f64,
    from: f64,
    width: f64,
    value: f64,
    slope: f64,
    curvature: f64,
}

impl Evidence {
    /// From the codes of a dwell.
    pub fn of(cells: &Cells, sigma: f64, inflation: f64) -> Self {
        let jet = |x: f64| cells.jet(x, sigma, inflation);
        let (top_at, top) = summit(cells, sigma, &jet);
        if top.curvature < 0.0 && !cells.one_sided() {
            let sd = (-top.curvature).sqrt().recip();
            let near = |k: f64| {
                let drop = top.value - jet(top_at + k * sd).value;
                (drop - 0.5 * k * k).abs() < GAUSSIAN_WITHIN * k * k
            };
            if [3.0, -3.0, 1.5, -1.5].into_iter().all(near) {
                let variance = -1.0 / top.curvature;
                return Self::Gaussian {
                    centre: top_at,
                    variance,
                    ln_integral: top.value + 0.5 * (2.0 * PI * variance).ln(),
                };
            }
        }
        Self::Curve(Curve::of(cells.clone(), sigma, inflation, top_at, top))
    }

    /// `ln ∫ e^ℓ(μ) N(μ; m, v) dμ` and its derivatives by `m`.
    pub fn marginal(&self, m: f64, v: f64) -> Marginal {
        match self {
            Self::Gaussian { centre, variance, ln_integral } => {
                let total = variance + v;
                let r = centre - m;
                Jet {
                    value: ln_integral - 0.5 * (2.0 * PI * total).ln() - 0.5 * r * r / total,
                    slope: r / total,
                    curvature: -1.0 / total,
                }
            }
            Self::Curve(curve) => curve.marginal(m, v),
        }
    }

    /// How far a modelled level is off what the dwell allows, measured minus modelled, LSB: from the centre of a
    /// Gaussian; from the nearest level that is less than e² times worse than the best, of a curve.
    pub fn contradiction(&self, m: f64) -> f64 {
        match self {
            Self::Gaussian { centre, .. } => centre - m,
            Self::Curve(c) => m.clamp(c.allowed.0, c.allowed.1) - m,
        }
    }

    /// Mean of the level when nothing else is known.
    pub fn centre(&self) -> f64 {
        match self {
            Self::Gaussian { centre, .. } => *centre,
            Self::Curve(c) => c.centre,
        }
    }

    /// Variance with which the dwell takes part among `count` of them: a box of one code says nothing inside and all at
    /// its edges, so that many boxes narrow the parameters like `1/count`, not like `1/√count`.
    pub fn resolution(&self, count: usize) -> f64 {
        match self {
            Self::Curve(c) if c.cells.one_code() => {
                c.variance * (PARAMETERS / count as f64).min(1.0).powi(2)
            }
            _ => self.variance(),
        }
    }

    /// Variance of the level when nothing else is known.
    pub fn variance(&self) -> f64 {
        match self {
            Self::Gaussian { variance, .. } => *variance,
            Self::Curve(c) => c.variance,
        }
    }
}

/// The top of the curve, by Newton steps held inside of a bracket.
fn summit(cells: &Cells, sigma: f64, jet: &impl Fn(f64) -> Jet) -> (f64, Jet) {
    let (lo, hi) = cells.extent();
    if cells.one_sided() {
        // A plateau to one side: five standard deviations in, nothing changes any more.
        let count = cells.cells[0].count.max(1.0);
        let depth = (2.0 * (count * 1e3).ln()).sqrt().max(5.0);
        let at = if lo.is_finite() { lo + depth * sigma } else { hi - depth * sigma };
        return (at, jet(at));
    }
    let middle = cells.middle();
    let (mut low, mut high) =
        (lo.max(middle - 1e3 * sigma - 1e3), hi.min(middle + 1e3 * sigma + 1e3));
    let mut at = middle.clamp(low, high);
    let mut here = jet(at);
    for _ in 0..60 {
        if here.slope > 0.0 {
            low = at;
        } else {
            high = at;
        }
        let newton = at - here.slope / here.curvature;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let step = (next - at).abs();
        // A step that gains less than 1e-9 in log-likelihood changes nothing.
        if step * here.slope.abs() < 1e-9 {
            break;
        }
        at = next;
        here = jet(at);
    }
    (at, here)
}

impl Curve {
    fn of(cells: Cells, sigma: f64, inflation: f64, top_at: f64, top: Jet) -> Self {
        let jet = |x: f64| {
            let j = cells.jet(x, sigma, inflation);
            Jet { value: j.value - top.value, ..j }
        };
        let (lo, hi) = cells.extent();
        let zero = Jet { value: 0.0, ..top };
        // Toward an end of the converter that was always reached, the plateau goes on.
        let side = |side: f64, edge: f64| {
            let open = cells.one_sided() && edge.is_infinite();
            if open { Vec::new() } else { knots(&jet, top_at, zero, side, sigma, edge) }
        };
        let (left, right) = (side(-1.0, lo), side(1.0, hi));
        let grain = left
            .windows(2)
            .chain(right.windows(2))
            .filter(|w| w[1].1.value < -0.3 && w[1].1.value > -12.0)
            .map(|w| (w[1].0 - w[0].0).abs())
            .fold(f64::INFINITY, f64::min);
        let mut all: Vec<(f64, Jet)> = left.into_iter().rev().collect();
        all.push((top_at, zero));
        all.extend(right);
        let pieces = pieces(&all);
        let side = |mut knots: Box<dyn Iterator<Item = &(f64, Jet)> + '_>, open: f64| {
            knots.find(|k| k.1.value < -ALLOWED).map_or(open, |k| k.0)
        };
        let (below, above): (Vec<_>, Vec<_>) = all.iter().partition(|k| k.0 < top_at);
        let allowed = (
            side(Box::new(below.into_iter().rev()), f64::NEG_INFINITY),
            side(Box::new(above.into_iter()), f64::INFINITY),
        );
        let mut curve = Self {
            cells,
            sigma,
            inflation,
            top: top.value,
            pieces,
            grain,
            centre: top_at,
            variance: 1.0,
            allowed,
        };
        let open = all.first().is_some_and(|k| k.1.value > -1.0)
            || all.last().is_some_and(|k| k.1.value > -1.0);
        if open {
            // A bound only: as wide as one likes.
            curve.variance = f64::INFINITY;
        } else {
            let flat = curve.integral(curve.centre, 0.0);
            curve.centre += flat.slope;
            curve.variance = flat.curvature;
        }
        curve
    }

    fn marginal(&self, m: f64, v: f64) -> Marginal {
        if v.sqrt() < 0.2 * self.grain {
            // The scatter is fine against the curve: exact for the parabola through the point.
            let j = self.cells.jet(m, self.sigma, self.inflation);
            let stiff = 1.0 - v * j.curvature;
            return Jet {
                value: j.value - 0.5 * stiff.ln() + 0.5 * v * j.slope * j.slope / stiff,
                slope: j.slope / stiff,
                curvature: j.curvature / stiff,
            };
        }
        let i = self.integral(m, 1.0 / v);
        Jet {
            value: self.top + i.value - 0.5 * (2.0 * PI * v).ln(),
            slope: i.slope / v,
            curvature: (i.curvature / v - 1.0) / v,
        }
    }

    /// `ln ∫ e^{ℓ(x) − ½ w (x−m)²} dx`, and under that weight mean − m and variance of `x`.
    fn integral(&self, m: f64, w: f64) -> Jet {
        let height = self
            .pieces
            .iter()
            .map(|p| Weighted::of(p, m, w).highest())
            .fold(f64::NEG_INFINITY, f64::max);
        let (mut i0, mut i1, mut i2) = (0.0, 0.0, 0.0);
        // Pieces are neighbours: where one ends the next begins, with the same density.
        let mut last_end = None;
        for p in &self.pieces {
            let part = Weighted::of(p, m, w);
            if part.highest() < height - NEGLIGIBLE {
                last_end = None;
                continue;
            }
            let start = last_end.unwrap_or_else(|| (part.start - height).exp());
            let end = if p.width.is_finite() { (part.at(p.width) - height).exp() } else { 0.0 };
            last_end = (p.side > 0.0).then_some(end);
            let [area, first, second] = part.moments(height, start, end);
            // Moments about the piece's own point, then about m.
            let shift = p.from - p.side * m;
            i0 += area;
            i1 += p.side * (first + shift * area);
            i2 += second + 2.0 * shift * first + shift * shift * area;
        }
        let mean = i1 / i0;
        Jet { value: height + i0.ln(), slope: mean, curvature: (i2 / i0 - mean * mean).max(0.0) }
    }
}

/// Below the highest point by this much, a piece adds less than 1e-11.
const NEGLIGIBLE: f64 = 25.0;

/// `start + slope t − ½ precision t²` on `0 ≤ t ≤ width`: a piece times the scatter's Gaussian.
#[derive(Debug, Clone, Copy)]
struct Weighted {
    start: f64,
    slope: f64,
    precision: f64,
    width: f64,
}

impl Weighted {
    #[inline]
    fn of(p: &Piece, m: f64, w: f64) -> Self {
        let off = p.from - p.side * m;
        Self {
            start: p.value - 0.5 * w * off * off,
            slope: p.slope - w * off,
            precision: w - p.curvature,
            width: p.width,
        }
    }

    #[inline]
    fn at(&self, t: f64) -> f64 {
        self.start + t * (self.slope - 0.5 * self.precision * t)
    }

    #[inline]
    fn peaks_inside(&self) -> bool {
        self.slope > 0.0 && self.slope < self.precision * self.width
    }

    #[inline]
    fn highest(&self) -> f64 {
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
    fn moments(&self, height: f64, at_start: f64, at_end: f64) -> [f64; 3] {
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

/// Points down one side of a log-concave curve, each some times lower than the one before it.
fn knots(
    jet: &impl Fn(f64) -> Jet,
    top_at: f64,
    top: Jet,
    side: f64,
    sigma: f64,
    edge: f64,
) -> Vec<(f64, Jet)> {
    // A first point a hundredth below the top, by doubling and halving.
    let by_curvature = 0.14 / (-top.curvature).sqrt();
    let by_edge = (side * (edge - top_at) - 4.5 * sigma).max(0.1 * sigma);
    let mut step = by_curvature.min(by_edge).max(1e-3 * sigma);
    if !step.is_finite() {
        step = sigma;
    }
    let (mut inside, mut outside) = (0.0, f64::INFINITY);
    let mut here = jet(top_at + side * step);
    for _ in 0..40 {
        let drop = -here.value;
        if drop < 0.3 * SHALLOWEST {
            inside = step;
            step = if outside.is_finite() { 0.5 * (inside + outside) } else { 2.0 * step };
        } else if drop > 3.0 * SHALLOWEST {
            outside = step;
            step = 0.5 * (inside + outside);
        } else {
            break;
        }
        here = jet(top_at + side * step);
    }
    let mut out = vec![(top_at + side * step, here)];
    // ln(drop) is concave in the distance: steps along its tangent fall short of the ratio, never past it. Where the
    // curve bends within a step (the far edge of a code comes near), the step is halved.
    for _ in 0..60 {
        let drop = -here.value;
        if !(1e-9..=DEEPEST).contains(&drop) {
            break;
        }
        let mut ahead = STEP_RATIO.ln() * drop / (side * -here.slope);
        let mut next = jet(top_at + side * (step + ahead));
        for _ in 0..8 {
            if fits(here, next, side * ahead) {
                break;
            }
            ahead *= 0.5;
            next = jet(top_at + side * (step + ahead));
        }
        step += ahead;
        here = next;
        out.push((top_at + side * step, here));
    }
    out
}

/// Curvature and slope of the parabola between two knots: through both, with the mean curvature between them.
fn parabola(a: Jet, b: Jet, width: f64) -> (f64, f64) {
    let curvature = ((b.slope - a.slope) / width).min(0.0);
    (curvature, (b.value - a.value) / width - 0.5 * curvature * width)
}

/// Whether a parabola between two knots keeps the slopes that it should have at its ends, within a sixth of their
/// difference.
fn fits(a: Jet, b: Jet, width: f64) -> bool {
    let (_, slope) = parabola(a, b, width);
    (slope - a.slope).abs() <= (b.slope - a.slope).abs() / 6.0
}

/// Parabolas through neighbouring knots with the mean curvature between them; exact at the middle for cubics.
fn pieces(knots: &[(f64, Jet)]) -> Vec<Piece> {
    let between = knots.windows(2).map(|w| {
        let ((x0, a), (x1, b)) = (w[0], w[1]);
        let width = x1 - x0;
        // From the top a curve may stay level and bend at the end: then its own curvature serves, within a hundredth.
        let shallow = a.value.max(b.value) == 0.0;
        let (curvature, slope) = if shallow {
            let level = a.curvature.max(b.curvature).min(0.0);
            (level, (b.value - a.value) / width - 0.5 * level * width)
        } else {
            parabola(a, b, width)
        };
        Piece { side: 1.0, from: x0, width, value: a.value, slope, curvature }
    });
    // The parabolas at the outermost knots, carried on.
    let outer = |knot: Option<&(f64, Jet)>, side: f64| {
        knot.map(|(x, j)| Piece {
            side,
            from: side * x,
            width: f64::INFINITY,
            value: j.value,
            // From its top on a plateau is level, whatever crumbs of slope are left there.
            slope: if j.value == 0.0 { 0.0 } else { (side * j.slope).min(0.0) },
            curvature: if j.value == 0.0 { 0.0 } else { j.curvature.min(0.0) },
        })
    };
    outer(knots.first(), -1.0).into_iter().chain(between).chain(outer(knots.last(), 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Code, CodeHistogram, ConverterEnds, Quantizer};

    fn cells(list: &[(i32, u64)], quantizer: Quantizer) -> Cells {
        let mut h = CodeHistogram::default();
        list.iter().for_each(|(n, k)| h.record_many(Code(*n), *k));
        Cells::of(&h, quantizer, &ConverterEnds::default())
    }

    /// Brute force: the trapezoidal rule on a fine grid.
    fn by_summing(c: &Cells, sigma: f64, m: f64, v: f64) -> f64 {
        let (lo, hi) = c.extent();
        let (from, to) = (lo - 6.0 * sigma - 0.1, hi + 6.0 * sigma + 0.1);
        let n = 200_000;
        let h = (to - from) / f64::from(n);
        let l = |x: f64| c.jet(x, sigma, 1.0).value - 0.5 * (x - m) * (x - m) / v;
        let values: Vec<f64> = (0..=n).map(|i| l(from + h * f64::from(i))).collect();
        let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = values.iter().map(|x| (x - top).exp()).sum();
        top + (sum * h).ln() - 0.5 * (2.0 * PI * v).ln()
    }

    #[test]
    fn scatter_is_integrated_out_as_a_fine_sum_does_it() {
        let shapes: [(&[(i32, u64)], f64); 6] = [
            (&[(7, 1500)], 0.02),
            (&[(7, 1500)], 0.2),
            (&[(7, 1498), (8, 2)], 0.1),
            (&[(0, 1500)], 0.05),
            (&[(0, 20)], 0.3),
            (&[(-1, 3), (0, 7)], 0.4),
        ];
        let mut worst = 0.0f64;
        for (list, sigma) in shapes {
            let c = cells(list, Quantizer::Truncate);
            let e = Evidence::of(&c, sigma, 1.0);
            for v in [0.5f64, 0.1, 0.03].map(|s| s * s) {
                for off in [-1.2, -0.5, -0.1, 0.0, 0.3, 0.6, 1.5] {
                    let m = e.centre() + off;
                    let theirs = by_summing(&c, sigma, m, v);
                    let ours = e.marginal(m, v);
                    // Far outside the curve is a carried-on parabola; nearer, the pieces err by about a hundredth.
                    if theirs > e.marginal(e.centre(), v).value - 12.0 {
                        let error = (ours.value - theirs).abs();
                        worst = worst.max(error);
                        assert!(
                            error < 0.02,
                            "{list:?} {sigma} v {v} off {off}: {ours:?} {theirs}"
                        );
                    }
                }
            }
        }
        assert!(worst > 0.0);
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        for (list, sigma) in [
            (&[(7, 1500)][..], 0.1),
            (&[(7, 1495), (8, 5)][..], 0.1),
            (&[(3, 7), (4, 90)][..], 0.5),
        ] {
            let e = Evidence::of(&cells(list, Quantizer::Floor), sigma, 1.0);
            for v in [0.4f64, 0.1].map(|s| s * s) {
                for off in [-0.7, -0.2, 0.1, 0.4] {
                    let m = e.centre() + off;
                    let h = 1e-4;
                    let (up, down, here) =
                        (e.marginal(m + h, v), e.marginal(m - h, v), e.marginal(m, v));
                    let slope = (up.value - down.value) / (2.0 * h);
                    let curvature = (up.slope - down.slope) / (2.0 * h);
                    assert!(
                        (slope - here.slope).abs() < 1e-5 * (1.0 + slope.abs()),
                        "{list:?} {off}: {slope} {here:?}"
                    );
                    assert!(
                        (curvature - here.curvature).abs() < 1e-4 * (1.0 + curvature.abs()),
                        "{list:?} {off}: {curvature} {here:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_quiet_dwell_is_a_box_and_a_noisy_one_gaussian() {
        let quiet = Evidence::of(&cells(&[(7, 1500)], Quantizer::Floor), 0.01, 1.0);
        assert!(matches!(quiet, Evidence::Curve(_)));
        // A box of 1 − 2·3.2σ: variance about width²/12.
        assert!((quiet.centre() - 7.5).abs() < 1e-6);
        assert!((quiet.variance() - 0.94f64.powi(2) / 12.0).abs() < 0.003, "{}", quiet.variance());
        let noisy =
            Evidence::of(&cells(&[(6, 242), (7, 1016), (8, 242)], Quantizer::Floor), 0.5, 1.0);
        let Evidence::Gaussian { centre, variance, .. } = noisy else { panic!("{noisy:?}") };
        assert!((centre - 7.5).abs() < 1e-9);
        assert!((variance / ((0.25 + 1.0 / 12.0) / 1500.0) - 1.0).abs() < 0.1, "{variance}");
    }

    #[test]
    fn a_saturated_dwell_is_a_plateau_with_one_edge() {
        for (code, side) in [(-1000, -1.0), (1000, 1.0)] {
            let mut h = CodeHistogram::default();
            h.record_many(Code(code), 200);
            let ends = ConverterEnds { min_code: Some(Code(-1000)), max_code: Some(Code(1000)) };
            let c = Cells::of(&h, Quantizer::Truncate, &ends);
            let e = Evidence::of(&c, 8.0, 1.0);
            assert!(e.variance().is_infinite());
            for v in [0.05, 0.3, 2.0, 100.0] {
                // Far inside nothing is known; a little outside it is what a fine sum says.
                let inside = e.marginal(side * (1100.0 + 5.0 * f64::sqrt(v)), v);
                assert!(inside.value.abs() < 1e-3 && inside.slope.abs() < 1e-4, "{v}: {inside:?}");
                assert!(inside.curvature.abs() < 1e-4, "{v}: {inside:?}");
                for m in [1035.0, 1020.0, 1010.0] {
                    let theirs = {
                        let n = 40_000;
                        let (a, b) = (side * m - 60.0, side * m + 60.0);
                        let h = (b - a) / f64::from(n);
                        let sum: f64 = (0..=n)
                            .map(|i| a + h * f64::from(i))
                            .map(|x| {
                                (c.jet(x, 8.0, 1.0).value - 0.5 * (x - side * m).powi(2) / v).exp()
                            })
                            .sum();
                        (sum * h).ln() - 0.5 * (2.0 * PI * v).ln()
                    };
                    let ours = e.marginal(side * m, v).value;
                    assert!(
                        (ours - theirs).abs() < 0.02 * (1.0 + theirs.abs()),
                        "{m} {v}: {ours} {theirs}"
                    );
                }
            }
        }
    }
}

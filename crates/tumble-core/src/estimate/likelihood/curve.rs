//! A dwell's log-likelihood that is no parabola: a log-concave curve, cut into parabolas.

use core::f64::consts::PI;

use super::cells::{Cells, Jet};
use super::piece::{NEGLIGIBLE, Piece, Weighted};

/// Log-likelihood below the top at which a dwell's curve is cut into pieces; what lies lower weighs e⁻²⁰.
const DEEPEST: f64 = 20.0;
/// Each piece ends about this much lower than the one before it.
const STEP_RATIO: f64 = 3.0;
/// Where the first piece ends.
const SHALLOWEST: f64 = 0.01;
/// Log-likelihood below the top down to which a level is not contradicted: two standard deviations of a Gaussian.
const ALLOWED: f64 = 2.0;

/// A log-concave curve in pieces of parabolas; the outermost go on to infinity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve {
    pub cells: Cells,
    sigma: f64,
    inflation: f64,
    /// Value at the top; pieces count from it.
    top: f64,
    pieces: Vec<Piece>,
    /// Smallest width on which the curve changes.
    grain: f64,
    pub centre: f64,
    pub variance: f64,
    /// Where the curve stands less than [`ALLOWED`] below its top.
    pub allowed: (f64, f64),
}

impl Curve {
    /// From the codes of a dwell, around its top.
    pub fn of(cells: Cells, sigma: f64, inflation: f64, top_at: f64, top: Jet) -> Self {
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

    /// As [`Evidence::marginal`](super::evidence::Evidence::marginal).
    pub fn marginal(&self, m: f64, v: f64) -> Jet {
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

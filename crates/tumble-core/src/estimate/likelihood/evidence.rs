//! What one dwell says about its level, prepared so that scatter between dwells costs little to add.

use core::f64::consts::PI;

use super::cells::{Cells, Jet};
use super::curve::Curve;

/// Parameters of the model.
const PARAMETERS: f64 = 3.0;
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

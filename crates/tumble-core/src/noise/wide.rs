//! The innermost loops, in the widest registers that the machine has (chosen when the program runs).

use pulp::{Arch, Simd, WithSimd};

/// Octaves that one pass over the points works on: each point is loaded once for all of them.
pub(super) const FUSED: usize = 4;

/// `Σ (x[i] − 2 x[i+m] + x[i+2m])²` of three streams of one length.
pub(super) fn one(streams: [&[f64]; 3]) -> f64 {
    Arch::new().dispatch(One(streams))
}

/// The same for `m, 2m, 4m, 8m`; streams at 0, m, 2m, 4m, 8m, 16m, of one length.
pub(super) fn four(streams: [&[f64]; FUSED + 2]) -> [f64; FUSED] {
    Arch::new().dispatch(Four(streams))
}

struct One<'a>([&'a [f64]; 3]);

impl WithSimd for One<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let [a, b, c] = self.0;
        let n = a.len().min(b.len()).min(c.len());
        let two = simd.splat_f64s(-2.0);
        let (mut even, mut odd) = (simd.splat_f64s(0.0), simd.splat_f64s(0.0));
        let [(a, a_rest), (b, b_rest), (c, c_rest)] = [a, b, c].map(|x| S::as_simd_f64s(&x[..n]));
        for (k, ((a, b), c)) in a.iter().zip(b).zip(c).enumerate() {
            let d = simd.mul_add_e_f64s(two, simd.sub_f64s(*b, *a), simd.sub_f64s(*c, *a));
            if k % 2 == 0 {
                even = simd.mul_add_e_f64s(d, d, even);
            } else {
                odd = simd.mul_add_e_f64s(d, d, odd);
            }
        }
        let rest = a_rest.iter().zip(b_rest).zip(c_rest);
        let tail: f64 = rest.map(|((a, b), c)| ((c - a) - 2.0 * (b - a)).powi(2)).sum();
        simd.reduce_sum_f64s(simd.add_f64s(even, odd)) + tail
    }
}

struct Four<'a>([&'a [f64]; FUSED + 2]);

impl WithSimd for Four<'_> {
    type Output = [f64; FUSED];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; FUSED] {
        let n = self.0.iter().map(|s| s.len()).min().unwrap_or(0);
        let two = simd.splat_f64s(-2.0);
        let mut sums = [simd.splat_f64s(0.0); FUSED];
        let split = self.0.map(|x| S::as_simd_f64s(&x[..n]));
        let [x0, x1, x2, x4, x8, x16] = split.map(|s| s.0);
        for (((((x0, x1), x2), x4), x8), x16) in x0.iter().zip(x1).zip(x2).zip(x4).zip(x8).zip(x16)
        {
            let from = |x: &S::f64s| simd.sub_f64s(*x, *x0);
            let d = [from(x1), from(x2), from(x4), from(x8), from(x16)];
            for k in 0..FUSED {
                let z = simd.mul_add_e_f64s(two, d[k], d[k + 1]);
                sums[k] = simd.mul_add_e_f64s(z, z, sums[k]);
            }
        }
        let mut out = sums.map(|s| simd.reduce_sum_f64s(s));
        let rest = split.map(|s| s.1);
        for i in 0..rest[0].len() {
            for k in 0..FUSED {
                let (a, b, c) = (rest[0][i], rest[k + 1][i], rest[k + 2][i]);
                out[k] += ((c - a) - 2.0 * (b - a)).powi(2);
            }
        }
        out
    }
}

/// Running sum of readings less a reference, from a start: `out[i] = start + Σ_{k<i} (y[k] − reference)`; gives the end.
///
/// Eight at a time, so that an addition need not wait for the last one; codes are summed exactly all the same. Memory is
/// slower than this: wide registers bring nothing.
pub(super) fn running_sum(
    readings: &[f64],
    reference: f64,
    mut start: f64,
    out: &mut [f64],
) -> f64 {
    let (eights, rest) = readings.as_chunks::<8>();
    let (outs, _) = out.as_chunks_mut::<8>();
    for (y, x) in eights.iter().zip(outs) {
        let [a, b, c, d, e, f, g, h] = y.map(|y| y - reference);
        let (ab, cd, ef, gh) = (a + b, c + d, e + f, g + h);
        let middle = start + (ab + cd);
        let first = [start, start + a, start + ab, start + (ab + c)];
        let second = [middle, middle + e, middle + ef, middle + (ef + g)];
        x[..4].copy_from_slice(&first);
        x[4..].copy_from_slice(&second);
        start += (ab + cd) + (ef + gh);
    }
    for (y, x) in rest.iter().zip(&mut out[readings.len() - rest.len()..]) {
        *x = start;
        start += y - reference;
    }
    start
}

//! The innermost loops, in the widest registers that the machine has (chosen when the program runs).

use fearless_simd::{Level, Simd, SimdBase, SimdFloat, dispatch};

/// Octaves that one pass over the points works on: each point is loaded once for all of them.
pub(super) const FUSED: usize = 4;

/// `Σ (x[i] − 2 x[i+m] + x[i+2m])²` of three streams of one length.
pub(super) fn one(streams: [&[f64]; 3]) -> f64 {
    dispatch!(Level::new(), simd => one_in(simd, streams))
}

/// The same for `m, 2m, 4m, 8m`; streams at 0, m, 2m, 4m, 8m, 16m, of one length.
pub(super) fn four(streams: [&[f64]; FUSED + 2]) -> [f64; FUSED] {
    dispatch!(Level::new(), simd => four_in(simd, streams))
}

/// Always inlined: the instructions are those of the caller's level.
#[inline(always)]
fn one_in<S: Simd>(simd: S, streams: [&[f64]; 3]) -> f64 {
    let lanes = S::f64s::LEN;
    let n = streams.iter().map(|s| s.len()).min().unwrap_or(0);
    let two = S::f64s::splat(simd, -2.0);
    // Two sums in turn, so that an addition need not wait for the last one.
    let mut sums = [S::f64s::splat(simd, 0.0); 2];
    let [a, b, c] = streams.map(|s| s[..n].chunks_exact(lanes));
    let rest = [a.remainder(), b.remainder(), c.remainder()];
    for (k, ((a, b), c)) in a.zip(b).zip(c).enumerate() {
        let load = |x: &[f64]| S::f64s::from_slice(simd, x);
        let a = load(a);
        let d = two.mul_add(load(b) - a, load(c) - a);
        sums[k % 2] = d.mul_add(d, sums[k % 2]);
    }
    let tail = rest[0].iter().zip(rest[1]).zip(rest[2]);
    let tail: f64 = tail.map(|((a, b), c)| square(*a, *b, *c)).sum();
    (sums[0] + sums[1]).reduce_sum() + tail
}

#[inline(always)]
fn four_in<S: Simd>(simd: S, streams: [&[f64]; FUSED + 2]) -> [f64; FUSED] {
    let lanes = S::f64s::LEN;
    let n = streams.iter().map(|s| s.len()).min().unwrap_or(0);
    let two = S::f64s::splat(simd, -2.0);
    let mut sums = [S::f64s::splat(simd, 0.0); FUSED];
    let chunks = streams.map(|s| s[..n].chunks_exact(lanes));
    let rest = chunks.each_ref().map(|c| c.remainder());
    let [x0, x1, x2, x4, x8, x16] = chunks;
    for (((((x0, x1), x2), x4), x8), x16) in x0.zip(x1).zip(x2).zip(x4).zip(x8).zip(x16) {
        let load = |x: &[f64]| S::f64s::from_slice(simd, x);
        let x0 = load(x0);
        // One by one: `map` is not inlined here, and what it calls would be built for the oldest machine.
        let d = [load(x1) - x0, load(x2) - x0, load(x4) - x0, load(x8) - x0, load(x16) - x0];
        for k in 0..FUSED {
            let z = two.mul_add(d[k], d[k + 1]);
            sums[k] = z.mul_add(z, sums[k]);
        }
    }
    let mut out = sums.map(|s| s.reduce_sum());
    for i in 0..rest[0].len() {
        for k in 0..FUSED {
            out[k] += square(rest[0][i], rest[k + 1][i], rest[k + 2][i]);
        }
    }
    out
}

/// `(a − 2b + c)²`
#[inline(always)]
fn square(a: f64, b: f64, c: f64) -> f64 {
    ((c - a) - 2.0 * (b - a)).powi(2)
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

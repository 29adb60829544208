//! The overlapping Allan variance at octaves, straight from readings: no running sum of the whole record is kept.

use super::Variance;
use super::velocity::origin;
use super::wide::{FUSED, four, one, running_sum};

/// Points that are worked on at once: six streams of them lie in the nearest cache.
const BLOCK: usize = 1024;
/// Largest factor of the first pass; its window of points lies in the second cache.
const NEAR: usize = 1 << 15;
/// Points that are added to the window at once.
const CHUNK: usize = 1 << 17;
/// Points of the second pass that belong together; a whole part of [`CHUNK`].
const FAR_BLOCK: usize = 1024;

/// Bytes of a line of the cache.
const LINE: usize = 64;

/// Overlapping Allan variances at octaves of the averaging factor, up to a third of the record, every place used.
///
/// The same as [`super::variances`] of the [`super::Velocity`], faster: memory is read twice, whatever the number of
/// octaves. A first pass holds a window of the running sum for small factors. For large ones a second pass takes blocks
/// that lie a multiple of the smallest large factor apart: all differences among them are differences of points that were
/// just loaded.
///
/// Empty below three readings, or where a reading is not finite.
#[must_use]
pub fn allan_octaves(readings: &[f64], interval_s: f64) -> Vec<Variance> {
    let factors = super::octaves(readings.len());
    if readings.len() < 3 {
        return Vec::new();
    }
    let mut sums = vec![0.0; factors.len()];
    let (near, far) = factors.split_at(factors.partition_point(|m| *m <= NEAR));
    let starts = first_pass(readings, near, &mut sums);
    if !far.is_empty() {
        second_pass(readings, &starts, far, &mut sums[near.len()..]);
    }
    if !sums.iter().all(|s| s.is_finite()) {
        return Vec::new();
    }
    let row = |(m, sum): (&usize, f64)| {
        let terms = readings.len() + 1 - 2 * m;
        // The sum is of readings, without τ0: it cancels.
        let variance = sum / (2.0 * (*m as f64).powi(2) * terms as f64);
        Variance { factor: *m, tau_s: *m as f64 * interval_s, terms, variance }
    };
    factors.iter().zip(sums).map(row).collect()
}

/// Adds the sums of consecutive octaves over `count` places from the start of `x`; places that want points beyond the end
/// of `x` are left out.
pub(super) fn octave_sums(
    x: &[f64],
    factors: &[usize],
    count: usize,
    mut add: impl FnMut(usize, f64),
) {
    let mut from = 0;
    while from < count {
        let length = BLOCK.min(count - from);
        let mut k = 0;
        while k < factors.len() {
            let m = factors[k];
            if k + FUSED <= factors.len() && from + length + 16 * m <= x.len() {
                let at = |offset: usize| &x[from + offset..][..length];
                let found = four([at(0), at(m), at(2 * m), at(4 * m), at(8 * m), at(16 * m)]);
                found.iter().enumerate().for_each(|(j, s)| add(k + j, *s));
                k += FUSED;
                continue;
            }
            let places = x.len().saturating_sub(from + 2 * m).min(length);
            if places > 0 {
                let at = |offset: usize| &x[from + offset..][..places];
                add(k, one([at(0), at(m), at(2 * m)]));
            }
            k += 1;
        }
        from += length;
    }
}

/// Sums for the small factors, and the running sum at the start of each [`FAR_BLOCK`].
fn first_pass(readings: &[f64], factors: &[usize], sums: &mut [f64]) -> Vec<f64> {
    let reference = origin(readings).unwrap_or_default();
    let reach = 2 * factors.last().copied().unwrap_or(1);
    let mut starts = Vec::with_capacity(readings.len() / FAR_BLOCK + 1);
    let mut room = Aligned::new(reach + CHUNK.min(readings.len()) + 1);
    let window = room.points();
    // Points in the window, and the running sum behind the last of them.
    let (mut held, mut sum) = (0, 0.0);
    let mut pieces = readings.chunks(CHUNK).peekable();
    while let Some(piece) = pieces.next() {
        for block in piece.chunks(FAR_BLOCK) {
            starts.push(sum);
            sum = running_sum(block, reference, sum, &mut window[held..held + block.len()]);
            held += block.len();
        }
        let last = pieces.peek().is_none();
        if last {
            window[held] = sum;
            held += 1;
        }
        let count = if last { held } else { held.saturating_sub(reach) };
        octave_sums(&window[..held], factors, count, |k, s| sums[k] += s);
        window.copy_within(count..held, 0);
        held -= count;
    }
    // The last point may stand alone in a block, behind the last reading.
    starts.push(sum);
    starts
}

/// Sums for the large factors, from blocks that lie the smallest of them apart.
fn second_pass(readings: &[f64], starts: &[f64], factors: &[usize], sums: &mut [f64]) {
    let reference = origin(readings).unwrap_or_default();
    let points = readings.len() + 1;
    let apart = factors[0] / FAR_BLOCK;
    let mut room = Aligned::new(points.div_ceil(factors[0]) * FAR_BLOCK);
    let blocks = room.points();
    for first in 0..apart.min(points.div_ceil(FAR_BLOCK)) {
        let mut held = 0;
        for block in (first..).step_by(apart).take_while(|b| b * FAR_BLOCK < points) {
            let from = block * FAR_BLOCK;
            let to = (from + FAR_BLOCK).min(readings.len());
            let out = &mut blocks[held..];
            let before = starts[block];
            let end = running_sum(&readings[from..to], reference, before, out);
            held += to - from;
            if to == readings.len() && to - from < FAR_BLOCK {
                blocks[held] = end;
                held += 1;
            }
        }
        let local: Vec<usize> = factors.iter().map(|m| m / apart).collect();
        octave_sums(&blocks[..held], &local, held, |k, s| sums[k] += s);
    }
}

/// Points that begin where a line of the cache begins: wide registers are then mostly filled from one line.
struct Aligned {
    room: Vec<f64>,
    length: usize,
}

impl Aligned {
    fn new(length: usize) -> Self {
        Self { room: vec![0.0; length + LINE / size_of::<f64>()], length }
    }

    fn points(&mut self) -> &mut [f64] {
        // Where it cannot be told, the start is as good as any.
        let skip = self.room.as_ptr().align_offset(LINE).min(LINE / size_of::<f64>());
        &mut self.room[skip..][..self.length]
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Deviation, Velocity, octaves, variances};
    use super::*;

    #[test]
    fn two_passes_are_the_sum_over_all_places() {
        let mut state = 1_234_567_890u64;
        let mut readings: Vec<f64> = (0..400_001)
            .map(|i| {
                state = 16_807 * state % 2_147_483_647;
                state as f64 / 2_147_483_647.0 + 1e-6 * f64::from(i)
            })
            .collect();
        for n in [400_001, 399_360, 399_359, 200_000, 1023, 1024, 7, 3] {
            readings.truncate(n);
            let velocity = Velocity::of(&readings, 0.01).unwrap();
            let direct = variances(&velocity, Deviation::Allan, &octaves(n));
            let passed = allan_octaves(&readings, 0.01);
            assert_eq!(passed.len(), direct.len());
            for (a, b) in passed.iter().zip(&direct) {
                assert_eq!((a.factor, a.terms), (b.factor, b.terms));
                assert!((a.variance / b.variance - 1.0).abs() < 1e-9, "{n}: {a:?} {b:?}");
            }
        }
        readings[1] = f64::NAN;
        assert!(allan_octaves(&readings, 0.01).is_empty());
    }
}

//! Streams give what the record in memory gives.

use tumble_core::noise::{Deviation, FULL_OVERLAP, Spacing, VarianceStream, Velocity, variances};

/// The generator of NBS14, with a slow drift.
fn readings(n: usize) -> Vec<f64> {
    let mut state = 1_234_567_890u64;
    (0..n)
        .map(|i| {
            state = 16_807 * state % 2_147_483_647;
            (100.0 * state as f64 / 2_147_483_647.0 + 2e-4 * i as f64).floor()
        })
        .collect()
}

/// What thinning may change of a variance: it takes other places, whose mean differs by less than its own spread.
const THINNED: f64 = 2e-3;
/// Rounding of sums in another order.
const ROUNDING: f64 = 1e-9;

#[test]
fn a_stream_in_pieces_is_the_record_in_memory() {
    let readings = readings(220_000);
    let velocity = Velocity::of(&readings, 0.5).unwrap();
    for deviation in [Deviation::Allan, Deviation::Modified, Deviation::Hadamard] {
        for spacing in [Spacing::Octave, Spacing::Decade] {
            let factors = spacing.factors(readings.len());
            let whole = variances(&velocity, deviation, &factors);
            for piece in [readings.len(), 65_537, 999] {
                let mut stream = VarianceStream::spaced(deviation, 0.5, spacing);
                readings.chunks(piece).for_each(|c| stream.push(c));
                let found = stream.finish();
                for w in &whole {
                    let (f, _) = found.iter().find(|(f, _)| f.factor == w.factor).unwrap();
                    let thinned = w.factor > FULL_OVERLAP && w.factor.trailing_zeros() > 0;
                    let tolerance = if thinned { THINNED } else { ROUNDING };
                    assert!(
                        (f.variance / w.variance - 1.0).abs() < tolerance,
                        "{} {spacing:?} {piece}: {f:?} {w:?}",
                        deviation.name()
                    );
                    assert!(thinned || f.terms == w.terms);
                }
            }
        }
    }
}

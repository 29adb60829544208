//! Long records against whole numbers: what running sums in `f64` lose, and what thinning loses.

use tumble_core::noise::{Deviation, FULL_OVERLAP, VarianceStream, allan_octaves};

/// A generator that is quick: 10⁸ of its numbers take a second (Marsaglia 2003, xorshift64*).
struct Quick(u64);

impl Quick {
    /// White, of 1.0 standard deviation: eight uniform numbers of eight bits.
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bytes = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d).to_be_bytes();
        let sum: u32 = bytes.iter().map(|b| u32::from(*b)).sum();
        // Mean 1020, variance 8·(256² − 1)/12.
        (f64::from(sum) - 1020.0) / 209.021_689
    }
}

/// `Σ (x[i] − 2x[i+m] + x[i+2m])²` over every `stride`-th place, in whole numbers; and the number of places.
fn exact_sum(x: &[i64], m: usize, stride: usize) -> (u128, usize) {
    let places = (0..x.len() - 2 * m).step_by(stride);
    let terms = places.len();
    let square = |i: usize| {
        let d = i128::from(x[i] - 2 * x[i + m] + x[i + 2 * m]);
        (d * d).unsigned_abs()
    };
    (places.map(square).sum(), terms)
}

fn long() -> bool {
    std::env::var_os("TUMBLE_LONG").is_some()
}

/// Rounding of some ten million additions, each relative to the sum: 10⁻¹² holds with room.
const ROUNDING: f64 = 1e-12;

/// Codes about 30 000 with noise of 1 LSB: nothing cancels, for codes are summed exactly. Beyond full overlap the places
/// are those of the thinning.
#[test]
fn codes_far_from_zero_lose_no_digit() {
    let n = if long() { 100_000_000 } else { 1_000_000 };
    let mut quick = Quick(88_172_645_463_325_252);
    let codes: Vec<i32> = (0..n).map(|_| (30_000.0 + quick.next()).round() as i32).collect();
    let mut x = Vec::with_capacity(n + 1);
    x.push(0i64);
    let mut sum = 0i64;
    for c in &codes {
        sum += i64::from(*c);
        x.push(sum);
    }
    let mut stream = VarianceStream::new(Deviation::Allan, 1.0);
    for piece in codes.chunks(50_000) {
        let readings: Vec<f64> = piece.iter().map(|c| f64::from(*c)).collect();
        stream.push(&readings);
    }
    let mut worst = 0.0f64;
    for (v, _) in stream.finish() {
        let (m, stride) = (v.factor, (v.factor / FULL_OVERLAP).max(1));
        let (sum, terms) = exact_sum(&x, m, stride);
        assert_eq!(v.terms, terms, "{m}");
        let exact = sum as f64 / (2.0 * (m as f64).powi(2) * terms as f64);
        worst = worst.max((v.variance / exact - 1.0).abs());
    }
    println!("{n} codes: streams are off by {worst:.1e} at most");
    assert!(worst < ROUNDING, "{worst:e}");
    // The same in memory, every place used.
    let part = &codes[..n.min(10_000_000)];
    let readings: Vec<f64> = part.iter().map(|c| f64::from(*c)).collect();
    for v in allan_octaves(&readings, 1.0) {
        let (sum, terms) = exact_sum(&x[..=part.len()], v.factor, 1);
        let exact = sum as f64 / (2.0 * (v.factor as f64).powi(2) * terms as f64);
        assert_eq!(v.terms, terms);
        assert!((v.variance / exact - 1.0).abs() < ROUNDING, "{v:?} {exact}");
    }
}

/// Binary digits behind the point of the readings below.
const DIGITS: i32 = 30;

/// Readings in m/s² that are not whole and begin with zeros, as loggers do: counted from zero the running sum would grow by
/// `g` a reading and lose a digit of its noise with every ten readings.
#[test]
fn readings_that_begin_with_zero_keep_enough_digits() {
    let n = if long() { 50_000_000 } else { 1_000_000 };
    let unit = 2f64.powi(-DIGITS);
    let mut quick = Quick(3_141_592_653);
    // Noise of 10 µg.
    let whole = |noise: f64| ((9.81 + 1e-4 * noise) / unit).round() as i64;
    let mut readings: Vec<i64> = (0..n).map(|_| whole(quick.next())).collect();
    readings[..3].fill(0);
    let mut stream = VarianceStream::new(Deviation::Allan, 1.0);
    for piece in readings.chunks(50_000) {
        let piece: Vec<f64> = piece.iter().map(|k| *k as f64 * unit).collect();
        stream.push(&piece);
    }
    let mut x = Vec::with_capacity(n + 1);
    x.push(0i64);
    let mut sum = 0i64;
    for k in &readings {
        sum += k;
        x.push(sum);
    }
    let mut worst = 0.0f64;
    for (v, _) in stream.finish() {
        let (sum, terms) = exact_sum(&x, v.factor, (v.factor / FULL_OVERLAP).max(1));
        let exact = sum as f64 * unit * unit / (2.0 * (v.factor as f64).powi(2) * terms as f64);
        worst = worst.max((v.variance / exact - 1.0).abs());
    }
    println!("{n} readings after zeros: off by {worst:.1e} at most");
    assert!(worst < 1e-9, "{worst:e}");
}

/// The documented loss of degrees of freedom beyond full overlap.
const LOSS: f64 = 1e-4;

/// At twice the factor of full overlap every second place is left out, at four times three of four, and so on: always
/// 2·16 384 to 16 384 places a time. What that adds to the scatter of the variance, from many records.
#[test]
fn thinning_costs_what_is_stated() {
    let records = if long() { 2000 } else { 60 };
    let m = 2 * FULL_OVERLAP;
    let n = 5 * m;
    let mut quick = Quick(271_828_182_845);
    for walk in [false, true] {
        let (mut apart, mut squares, mut mean) = (0.0, 0.0, 0.0);
        for _ in 0..records {
            let (mut x, mut bias, mut points) = (0i64, 0.0, vec![0i64]);
            let mut readings = Vec::with_capacity(n);
            for _ in 0..n {
                let white = 10.0 * quick.next();
                bias += if walk { white } else { 0.0 };
                let reading = if walk { bias } else { white }.round();
                x += reading as i64;
                points.push(x);
                readings.push(reading);
            }
            let (full, terms) = exact_sum(&points, m, 1);
            let full = full as f64 / (2.0 * (m as f64).powi(2) * terms as f64);
            let mut stream = VarianceStream::new(Deviation::Allan, 1.0);
            stream.push(&readings);
            let thinned = stream.finish().iter().find(|(v, _)| v.factor == m).map(|(v, _)| *v);
            let thinned = thinned.unwrap();
            assert_eq!(thinned.terms, terms.div_ceil(2));
            apart += (thinned.variance - full).powi(2);
            squares += full * full;
            mean += full;
        }
        let r = f64::from(records);
        let scatter = squares / r - (mean / r).powi(2);
        let loss = apart / r / scatter;
        println!("walk {walk}: thinning adds {loss:.1e} to the variance of the variance");
        assert!(loss < LOSS, "{loss:e}");
    }
}

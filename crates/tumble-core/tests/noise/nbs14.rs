//! The test suite of NIST SP 1065: 10 and 1000 points, to all published digits.

use tumble_core::noise::{Deviation, FULL_OVERLAP, VarianceStream, Velocity, variances};

/// The 1000 points, from their generator.
pub fn thousand() -> Vec<f64> {
    let mut n: u64 = 1_234_567_890;
    (0..1000)
        .map(|_| {
            let y = n as f64 / 2_147_483_647.0;
            n = 16_807 * n % 2_147_483_647;
            y
        })
        .collect()
}

const TEN: [f64; 9] = [892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0];

fn check(readings: &[f64], deviation: Deviation, table: &[(usize, f64)]) {
    let v = Velocity::of(readings, 1.0).unwrap();
    for (m, published) in table {
        let got = variances(&v, deviation, &[*m])[0].variance.sqrt();
        // Seven digits are published: half of the last one.
        let digit = 10f64.powf(published.log10().floor() - 6.0);
        println!("{} {m}: {got:.9} ({published})", deviation.name());
        assert!((got - published).abs() <= 0.51 * digit, "{deviation:?} {m}: {got} {published}");
    }
}

#[test]
fn ten_points_of_sp_1065() {
    // SP 1065 table 31 (metrology section 5).
    check(&TEN, Deviation::AllanPlain, &[(1, 91.22945), (2, 115.8082)]);
    check(&TEN, Deviation::Allan, &[(1, 91.22945), (2, 85.95287)]);
    check(&TEN, Deviation::Modified, &[(1, 91.22945), (2, 74.78849)]);
    check(&TEN, Deviation::Total, &[(1, 91.22945), (2, 93.90379)]);
}

#[test]
fn thousand_points_of_sp_1065() {
    // SP 1065 table 32.
    let y = thousand();
    check(&y, Deviation::AllanPlain, &[(1, 0.2922319), (10, 0.09965736), (100, 0.03897804)]);
    check(&y, Deviation::Allan, &[(1, 0.2922319), (10, 0.09159953), (100, 0.03241343)]);
    check(&y, Deviation::Modified, &[(1, 0.2922319), (10, 0.06172376), (100, 0.02170921)]);
    check(&y, Deviation::Hadamard, &[(1, 0.2943883), (10, 0.09581083), (100, 0.03237638)]);
    check(&y, Deviation::Total, &[(1, 0.2922319), (10, 0.09134743), (100, 0.03406530)]);
}

#[test]
fn a_stream_is_the_record() {
    // Long enough for two thinned octaves; cut anywhere.
    let y: Vec<f64> = {
        let mut n: u64 = 1_234_567_890;
        (0..200_000)
            .map(|_| {
                n = 16_807 * n % 2_147_483_647;
                (n % 4096) as f64
            })
            .collect()
    };
    let v = Velocity::of(&y, 0.02).unwrap();
    for deviation in [Deviation::Allan, Deviation::Modified, Deviation::Hadamard] {
        let mut stream = VarianceStream::new(deviation, 0.02);
        y.chunks(7_919).for_each(|c| stream.push(c));
        for (s, _) in stream.finish() {
            let whole = variances(&v, deviation, &[s.factor])[0];
            let off = s.variance / whole.variance - 1.0;
            println!("{deviation:?} {}: {off:.1e}, {} of {}", s.factor, s.terms, whole.terms);
            if s.factor <= FULL_OVERLAP {
                assert!(off.abs() < 1e-8 && s.terms == whole.terms);
            } else {
                assert!(off.abs() < 1e-3, "{off}");
            }
        }
    }
}

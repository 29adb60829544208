//! Times, rows and range of the record.

use tumble_core::{Angle, Experiment, FindingKind, Timing};

use super::bench::{THIRTEEN, all_findings, expect_one, findings, recorded, truth};

/// Gives a dwell (counted from one) the times of its samples.
fn timed(e: &mut Experiment, dwell: usize, times: &[f64]) {
    let p = &mut e.runs[0].positions[dwell - 1];
    let mut timing = Timing::default();
    let first = p.record.line.unwrap();
    times.iter().zip(first..).for_each(|(t, line)| timing.record(*t, line));
    p.record.timing = Some(timing);
}

fn clock(n: usize, rate_hz: f64) -> Vec<f64> {
    (0..n).map(|i| i as f64 / rate_hz).collect()
}

fn all_timed(f: impl Fn(usize) -> Vec<f64>) -> Experiment {
    let mut e = recorded(&truth(THIRTEEN));
    (1..=13).for_each(|d| timed(&mut e, d, &f(d)));
    e
}

#[test]
fn times_that_are_wrong_are_named_with_their_line() {
    let even = |_| clock(300, 50.0);
    let with = |change: fn(&mut Vec<f64>)| {
        move |d: usize| {
            let mut times = even(d);
            if d == 4 || d == 9 {
                change(&mut times);
            }
            times
        }
    };
    // Dwell 4 begins in line 902.
    for (name, e, kind, word) in [
        (
            "backwards",
            all_timed(with(|t| t.swap(100, 101))),
            FindingKind::TimeBackwards,
            "line 1003",
        ),
        (
            "backwards, a clock set",
            all_timed(with(|t| t[150..].iter_mut().for_each(|x| *x -= 3600.0))),
            FindingKind::TimeBackwards,
            "line 1052",
        ),
        (
            "repeated",
            all_timed(with(|t| t[150] = t[149])),
            FindingKind::RepeatedSamples,
            "line 1052",
        ),
        (
            "seven lost",
            all_timed(with(|t| {
                t.drain(100..107);
            })),
            FindingKind::MissingSamples,
            "14 samples are missing",
        ),
        (
            "every tenth lost",
            all_timed(with(|t| {
                let mut i = 0;
                t.retain(|_| {
                    i += 1;
                    i % 10 != 5
                });
            })),
            FindingKind::MissingSamples,
            "60 samples are missing",
        ),
    ] {
        expect_one(name, &e, kind, ["dwell 4 ", word, ""]);
        let found = findings(&e);
        assert!(found[0].observed.contains("2 of 13 dwells"), "{name}: {found:?}");
    }
    for rate in [25.0, 47.0, 53.0, 100.0, 50_000.0] {
        let e = all_timed(|_| clock(300, rate));
        expect_one(
            "rate",
            &e,
            FindingKind::RateDisagrees,
            ["dwell 1 ", "13 of 13 dwells", "rate_hz"],
        );
    }
}

#[test]
fn honest_clocks_raise_nothing() {
    let jitter = |share: f64| {
        move |d: usize| -> Vec<f64> {
            (0..300)
                .map(|i| (i as f64 + share * ((i * 7919 + d * 31) % 101) as f64 / 101.0) * 0.02)
                .collect()
        }
    };
    for (name, e) in [
        ("even", all_timed(|_| clock(300, 50.0))),
        ("2 % fast", all_timed(|_| clock(300, 51.0))),
        ("jitter of a tenth", all_timed(jitter(0.1))),
        ("jitter of a half", all_timed(jitter(0.5))),
        ("jitter of a whole step", all_timed(jitter(0.99))),
        (
            "milliseconds",
            all_timed(|_| clock(300, 50.7).iter().map(|t| (t * 1e3).round() / 1e3).collect()),
        ),
        (
            "one missing of 300",
            all_timed(|_| {
                let mut t = clock(300, 50.0);
                t.remove(70);
                t
            }),
        ),
        (
            "bursts",
            all_timed(|_| {
                (0..300).map(|i| f64::from(i / 10) * 0.2 + f64::from(i % 10) * 1e-4).collect()
            }),
        ),
    ] {
        assert!(findings(&e).is_empty(), "{name}: {:#?}", findings(&e));
    }
}

#[test]
fn rows_left_out_and_angles_beyond_the_table() {
    let mut e = recorded(&truth(THIRTEEN));
    e.runs[0].positions[2].record.without_reading = 4;
    e.runs[0].positions[5].record.without_reading = 2;
    e.runs[0].positions.iter_mut().for_each(|p| p.record.left_out = [100, 1]);
    e.bench.range = Some((Angle::from_deg(-55.0), Angle::from_deg(59.8)));
    let found = all_findings(&e);
    let of = |kind| {
        found.iter().find(|f| f.kind == kind).unwrap_or_else(|| panic!("{kind:?} in {found:#?}"))
    };
    let rows = of(FindingKind::RowsWithoutReading);
    assert!(
        rows.place.contains("dwell 3 ") && rows.observed.contains("6 of 3900 rows"),
        "{rows:?}"
    );
    let settling = of(FindingKind::SettlingLeftOut);
    assert!(
        settling.observed.contains("1300 samples at the start and 13 at the end"),
        "{settling:?}"
    );
    // 60° is within half a degree of 59.8°.
    expect_one(
        "range",
        &e,
        FindingKind::AngleOutsideRange,
        ["dwell 1 ", "1 of 13 dwells", "angle_range_deg"],
    );
}

//! What leaving out after looking does to the intervals.

use tumble_core::Position;
use tumble_core::estimate::{Estimate, Parameter};
use tumble_core::judge::FALSE_ALARM;

use crate::bench::{Truth, equal};
use crate::study::{each, fraction_se, runs};
use crate::{farthest, fitted, table};

fn holds(truth: &Truth, e: &Estimate) -> [u8; 3] {
    let theta = truth.parameters();
    Parameter::ALL.map(|p| {
        let [low, high] = e.interval(p, 0.95).unwrap();
        u8::from(low <= theta[p.index()] && theta[p.index()] <= high)
    })
}

fn without(positions: &[Position], at: usize) -> Vec<Position> {
    positions.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, p)| p.clone()).collect()
}

#[test]
fn naming_changes_nothing_and_leaving_out_the_worst_shortens_too_much() {
    let n = runs(400, 20_000);
    let mut lost = Vec::new();
    for (name, count) in [("12 positions", 12), ("60 positions", 60)] {
        let all: Vec<[[u8; 3]; 3]> = each(n, |seed| {
            let truth = Truth { angle_arcmin: 0.0, level: 0.2, ..table(equal(65.0, count)) };
            let truth = truth.dithered(seed).turned(seed);
            let positions = truth.run(seed + 77).positions;
            let whole = fitted(&truth, &positions);
            let (worst, p) = farthest(&whole).unwrap();
            let rest = fitted(&truth, &without(&positions, worst));
            let kept = holds(&truth, &whole);
            let dropped = holds(&truth, &rest);
            [kept, if p < FALSE_ALARM { dropped } else { kept }, dropped]
        });
        let share = |rule: usize, i: usize| {
            all.iter().map(|a| f64::from(a[rule][i])).sum::<f64>() / n as f64
        };
        for (rule, what) in
            ["nothing left out", "the named left out", "the worst left out"].iter().enumerate()
        {
            let [b, m, s] = [0, 1, 2].map(|i| 100.0 * share(rule, i));
            println!(
                "{name}, {what:18}: bias {b:.1}, misalignment {m:.1}, scale {s:.1} % (± {:.1})",
                200.0 * fraction_se(0.95, n)
            );
        }
        for i in 0..3 {
            // Every run is seen under all rules: the loss is paired, far less uncertain than each figure.
            assert!(share(1, i) > share(0, i) - 0.01, "{name}: {} {}", share(0, i), share(1, i));
            lost.push(share(0, i) - share(2, i));
        }
    }
    println!("lost by always leaving out the worst: {lost:.4?}");
    // 12 positions lose more than 60, and it is no small loss.
    assert!(lost[..3].iter().all(|l| *l > 0.03) && lost[0] > lost[3], "{lost:?}");
}

//! Turning the body by 180°: what belongs to the table against what turns with the body.

use tumble_core::assess::{RunAssessment, assess, pool_runs};
use tumble_core::estimate::{EstimateOptions, Method, Parameter, Weights};
use tumble_core::simulate::{Truth, experiment};
use tumble_core::{Angle, FindingKind, Orientation};

use super::bench::{covers, find, quiet_table, runs};

const OPTIONS: EstimateOptions = EstimateOptions {
    method: Method::Exact,
    weights: Weights::Equal,
    level: 0.95,
    monte_carlo_digits: 0,
    terms: tumble_core::estimate::TermChoice::Named(tumble_core::estimate::TermSet::EMPTY),
};

/// `ε` of the table, `δ` of the body, rad.
const EPSILON: f64 = 1.5e-3;
const DELTA: f64 = -2.3e-3;

/// `φ* = φ + ε + δ`; reversed `φ* = −φ_dial − ε + δ`, and the positions' angle is `−φ_dial`.
fn truth(orientation: Orientation, runs: u32, seed: u64) -> Truth {
    Truth {
        dial_zero: Angle::from_rad(orientation.sign() * EPSILON),
        misalignment: Angle::from_rad(DELTA),
        turn_on_m_s2: 0.003,
        runs,
        seed,
        ..quiet_table()
    }
}

fn both(normal: u32, reversed: u32, seed: u64) -> Vec<RunAssessment> {
    let mut all = runs(&truth(Orientation::Normal, normal, seed), Orientation::Normal, &OPTIONS);
    let other = truth(Orientation::Reversed, reversed, seed + 500_000);
    all.extend(runs(&other, Orientation::Reversed, &OPTIONS));
    all
}

#[test]
fn table_zero_and_misalignment_are_told_apart() {
    let n = if super::long() { 5000 } else { 600 };
    for (normal, reversed) in [(2, 2), (3, 1), (1, 1)] {
        let mut covered = [0usize; 3];
        for seed in 0..n {
            let all = both(normal, reversed, seed as u64 + 1);
            let together = pool_runs(&all, None, 0.95);
            let zero = together.table_zero.unwrap();
            let misalignment = find(&together.parameters, Parameter::Misalignment);
            assert_eq!(together.parameters.len(), 3);
            covered[0] += usize::from(covers(&zero, EPSILON));
            covered[1] += usize::from(covers(misalignment, DELTA));
            covered[2] += usize::from(covers(
                find(&together.parameters, Parameter::Bias),
                truth(Orientation::Normal, 1, 1).bias_m_s2,
            ));
        }
        let f = covered.map(|c| c as f64 / n as f64);
        println!(
            "{normal} + {reversed}: zero {:.4}, misalignment {:.4}, bias {:.4}",
            f[0], f[1], f[2]
        );
        let limit = 4.0 * super::bench::fraction_se(0.95, n);
        assert!(f.iter().all(|c| (c - 0.95).abs() < limit), "{normal} + {reversed}: {f:?}");
    }
}

#[test]
fn one_orientation_gives_the_sum() {
    let normal = pool_runs(&both(3, 0, 7), None, 0.95);
    let reversed = pool_runs(&both(0, 3, 7), None, 0.95);
    assert!(normal.table_zero.is_none() && reversed.table_zero.is_none());
    assert!(covers(find(&normal.parameters, Parameter::Misalignment), DELTA + EPSILON));
    assert!(covers(find(&reversed.parameters, Parameter::Misalignment), DELTA - EPSILON));
}

/// Another mounting keeps its own sum, and the first its separation.
#[test]
fn mountings_do_not_share_what_turns_with_the_body() {
    let mut all = both(2, 2, 11);
    let mut other = truth(Orientation::Normal, 2, 12);
    other.misalignment = Angle::from_rad(0.02);
    all.extend(
        runs(&other, Orientation::Normal, &OPTIONS)
            .into_iter()
            .map(|r| RunAssessment { mounting: "B".into(), ..r }),
    );
    let together = pool_runs(&all, None, 0.95);
    let found: Vec<(Option<&str>, f64, f64)> = together
        .parameters
        .iter()
        .filter(|p| p.parameter == Parameter::Misalignment)
        .map(|p| (p.mounting.as_deref(), p.value, p.standard_uncertainty))
        .collect();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].0 == Some("A") && (found[0].1 - DELTA).abs() < 5.0 * found[0].2, "{found:?}");
    assert!(
        found[1].0 == Some("B") && (found[1].1 - 0.02 - EPSILON).abs() < 10.0 * found[1].2,
        "{found:?}"
    );
}

#[test]
fn findings_say_what_reversal_did() {
    let mut e = experiment(&truth(Orientation::Normal, 2, 3));
    let mut turned = experiment(&truth(Orientation::Reversed, 2, 4));
    for (i, r) in turned.runs.iter_mut().enumerate() {
        r.orientation = Orientation::Reversed;
        r.name = format!("turned-{i}");
    }
    e.runs.extend(turned.runs);
    let kinds = |e: &tumble_core::Experiment| {
        let a = assess(e, &OPTIONS).unwrap();
        a.findings.iter().map(|f| f.kind).collect::<Vec<_>>()
    };
    let found = kinds(&e);
    assert!(found.contains(&FindingKind::ReversalSeparates), "{found:?}");
    assert!(!found.contains(&FindingKind::ReversalAlone), "{found:?}");
    e.runs[2..].iter_mut().for_each(|r| r.mounting = "B".into());
    let found = kinds(&e);
    assert!(found.contains(&FindingKind::ReversalAlone), "{found:?}");
    assert!(!found.contains(&FindingKind::ReversalSeparates), "{found:?}");
}

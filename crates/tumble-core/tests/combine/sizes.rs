//! One run, two, a hundred; runs that are copies; runs that nothing can be done with.

use tumble_core::assess::{assess, pool};
use tumble_core::combine::{CombineError, Unit, combine};
use tumble_core::estimate::{EstimateOptions, Parameter};
use tumble_core::linalg::Symmetric3;
use tumble_core::simulate::{Truth, experiment};
use tumble_core::{FindingKind, Orientation};

use super::bench::{find, quiet_table, runs};
use super::oracle::bias_only;

#[test]
fn one_run_has_its_own_uncertainty_and_no_prediction() {
    let a = assess(&experiment(&Truth { runs: 1, ..quiet_table() }), &EstimateOptions::default());
    let a = a.unwrap();
    let e = a.runs[0].estimate.as_ref().unwrap();
    for p in &a.pooled {
        let own = e.standard_uncertainty(p.parameter).unwrap();
        assert!((p.u_statistical / own - 1.0).abs() < 1e-9, "{p:?}");
        assert!((p.dof_statistical / e.effective_dof[p.parameter.index()] - 1.0).abs() < 1e-9);
        assert!((p.value - e.values[p.parameter.index()].unwrap()).abs() < 1e-9 * own);
        assert!(p.prediction_interval.is_none() && p.prediction_true_interval.is_none());
        assert!(p.between_runs.is_none());
    }
    assert!(a.findings.iter().any(|f| f.kind == FindingKind::OneRun));
}

#[test]
fn two_runs_are_honest_however_wide() {
    let options = EstimateOptions::default();
    let truth = Truth { runs: 2, turn_on_m_s2: 0.01, ..quiet_table() };
    let all = pool(&runs(&truth, Orientation::Normal, &options), 0.95);
    let bias = find(&all, Parameter::Bias);
    assert!((bias.coverage_factor - 12.706).abs() < 1e-3);
    let s = bias.between_run_sd.unwrap();
    let next = bias.prediction_interval.unwrap();
    let half = (next.high - next.low) / 2.0;
    assert!((half / (12.706 * s * 1.5f64.sqrt()) - 1.0).abs() < 1e-3);
    let next_true = bias.prediction_true_interval.unwrap();
    assert!(next_true.high < next.high && next_true.high > bias.interval.high);
}

#[test]
fn a_hundred_runs_are_known_well() {
    let options = EstimateOptions::default();
    let truth = Truth { runs: 100, turn_on_m_s2: 0.01, ..quiet_table() };
    let all = pool(&runs(&truth, Orientation::Normal, &options), 0.95);
    let bias = find(&all, Parameter::Bias);
    let between = bias.between_runs.unwrap();
    assert!((between.omega.unwrap() / 0.01 - 1.0).abs() < 0.25, "{between:?}");
    assert!(between.p_value < 1e-6);
    let (low, high) = between.omega_interval;
    assert!(low < 0.01 && 0.01 < high.unwrap(), "{between:?}");
    assert!((bias.dof_statistical - 99.0).abs() < 0.5, "{}", bias.dof_statistical);
    assert!((bias.value - truth.bias_m_s2).abs() < 4.0 * bias.standard_uncertainty);
    // What does not change between power-ups shows no spread.
    assert!(find(&all, Parameter::ScaleError).between_runs.unwrap().p_value > 1e-3);
}

/// A mounting a run: nothing shows how far the misalignment repeats, and each keeps its run's own uncertainty.
#[test]
fn every_run_in_a_mounting_of_its_own() {
    let options = EstimateOptions::default();
    let mut all = runs(&Truth { runs: 4, ..quiet_table() }, Orientation::Normal, &options);
    for (i, r) in all.iter_mut().enumerate() {
        r.mounting = format!("M{i}");
    }
    let pooled = pool(&all, 0.95);
    assert_eq!(pooled.len(), 6);
    for p in pooled.iter().filter(|p| p.parameter == Parameter::Misalignment) {
        assert!(p.runs == 1 && p.prediction_interval.is_none() && p.between_runs.is_none());
        assert!(p.standard_uncertainty > 0.0 && p.dof_statistical > 20.0, "{p:?}");
    }
    assert!((find(&pooled, Parameter::Bias).dof_statistical - 3.0).abs() < 1e-6);
}

#[test]
fn copies_and_nonsense() {
    // Copies scatter by nothing; so says the result.
    let copies = combine(&[bias_only(1.0, 1e-4), bias_only(1.0, 1e-4)], 1).unwrap();
    assert_eq!(copies.columns[0].standard_uncertainty, 0.0);
    assert_eq!(copies.omega_squared[0], Some(0.0));
    // Without any variance of their own, the spread is all there is.
    let exact =
        combine(&[bias_only(1.0, 0.0), bias_only(2.0, 0.0), bias_only(6.0, 0.0)], 1).unwrap();
    assert!((exact.columns[0].standard_uncertainty - (7.0f64 / 3.0).sqrt()).abs() < 1e-6);
    assert!((exact.omega_squared[0].unwrap() - 7.0).abs() < 1e-6);
    assert_eq!(combine(&[], 1), Err(CombineError::Empty));
    assert_eq!(combine(&[bias_only(1.0, 1.0)], 2), Err(CombineError::Undetermined));
    assert_eq!(combine(&[bias_only(f64::NAN, 1.0)], 1), Err(CombineError::NotPositive { unit: 0 }));
    assert_eq!(combine(&[bias_only(1.0, -1.0)], 1), Err(CombineError::NotPositive { unit: 0 }));
    let twisted = Unit {
        values: [Some(0.0); 3],
        covariance: Symmetric3([[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        design: [vec![(0, 1.0)], vec![(1, 1.0)], vec![(2, 1.0)]],
        dof: [9.0; 3],
    };
    assert_eq!(combine(&[twisted], 3), Err(CombineError::NotPositive { unit: 0 }));
}

/// Far from zero, in any unit, the same result.
#[test]
fn neither_offset_nor_unit_matters() {
    let y = [0.3, -0.2, 0.9, 0.1];
    let v = [0.01, 0.09, 0.04, 0.02];
    let of = |offset: f64, unit: f64| {
        let units: Vec<Unit> =
            y.iter().zip(v).map(|(y, v)| bias_only(unit * (y + offset), unit * unit * v)).collect();
        let c = combine(&units, 1).unwrap();
        let column = &c.columns[0];
        (column.value / unit - offset, column.standard_uncertainty / unit)
    };
    let (value, u) = of(0.0, 1.0);
    for (offset, unit) in [(1e6, 1.0), (0.0, 1e-9), (3.0, 1e12)] {
        let (other, u_other) = of(offset, unit);
        assert!(
            (value - other).abs() < 1e-8 && (u / u_other - 1.0).abs() < 1e-6,
            "{offset} {unit}"
        );
    }
}

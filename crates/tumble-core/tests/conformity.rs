//! The unit against its specification: statuses, reasons, statement, and what it leaves alone.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::sync::LazyLock;

use tumble_core::assess::{Conformity, PooledParameter, Verdict, assess, conformity};
use tumble_core::decision::{
    Distribution, GuardMultiple, Limits, Production, Quantity, Requirement, Rule, Specification,
    Status,
};
use tumble_core::estimate::{EstimateOptions, Method, Parameter};
use tumble_core::simulate::{Preset, Truth, experiment};
use tumble_core::{FindingKind, Severity};

const BIAS: Quantity = Quantity::Parameter(Parameter::Bias);
const MISALIGNMENT: Quantity = Quantity::Parameter(Parameter::Misalignment);
const SCALE_ERROR: Quantity = Quantity::Parameter(Parameter::ScaleError);

/// A result as the pipeline makes it, with numbers of our own in the fields that conformity reads.
fn pooled(parameter: Parameter, value: f64, u: f64, dof: f64) -> PooledParameter {
    static MADE: LazyLock<PooledParameter> = LazyLock::new(|| {
        let unit = experiment(&Truth { dwell_s: 0.2, ..Preset::Paper3.truth() });
        let options = EstimateOptions { method: Method::Exact, ..EstimateOptions::default() };
        assess(&unit, &options).unwrap().pooled.remove(0)
    });
    let coverage_factor = tumble_core::stats::student_factor(0.95, dof).unwrap();
    PooledParameter {
        parameter,
        mounting: None,
        value,
        standard_uncertainty: u,
        degrees_of_freedom: dof,
        coverage_factor,
        expanded_uncertainty: coverage_factor * u,
        ..MADE.clone()
    }
}

/// A bias of 0.2 ± 0.02 (standard), no misalignment, a scale error of 1 %.
fn result() -> Vec<PooledParameter> {
    vec![
        pooled(Parameter::Bias, 0.2, 0.02, 4.0),
        pooled(Parameter::Misalignment, 0.0, 1e-4, 4.0),
        pooled(Parameter::ScaleError, 0.01, 1e-4, f64::INFINITY),
    ]
}

fn within(lower: f64, upper: f64) -> Requirement {
    Requirement { limits: Limits::new(Some(lower), Some(upper)).unwrap(), production: None }
}

fn specified(rule: Rule, asked: &[(Quantity, Requirement)]) -> Specification {
    let mut specification = Specification::new(None, rule);
    asked.iter().for_each(|(q, r)| specification.require(*q, *r));
    specification
}

fn judged(specification: &Specification) -> Conformity {
    conformity(specification, Some(&result()), 0.0077, 0.95, Verdict::Accepted)
}

#[test]
fn without_limits_nothing_is_assessed_and_nothing_is_said() {
    let c = judged(&Specification::default());
    assert_eq!((c.status, c.reason, c.statement), (Status::NotAssessed, None, None));
    assert!(c.quantities.is_empty());
}

#[test]
fn without_a_result_the_reason_is_said() {
    let asked = specified(Rule::default(), &[(BIAS, within(-1.0, 1.0))]);
    for (verdict, words) in [(Verdict::Rejected, "rejected"), (Verdict::Indeterminate, "missing")] {
        let c = conformity(&asked, None, 0.0077, 0.95, verdict);
        assert_eq!(c.status, Status::NotAssessed);
        assert!(c.reason.unwrap().contains(words));
    }
}

#[test]
fn the_worst_quantity_decides() {
    let asked = [(BIAS, within(-0.25, 0.25)), (MISALIGNMENT, within(-0.01, 0.01))];
    // U = 2.776 · 0.02: inside of ±0.25, but not by a guard band.
    for (rule, status) in [
        (Rule::Simple, Status::Pass),
        (Rule::default(), Status::Fail),
        (Rule::NonBinary(GuardMultiple::ONE_U), Status::ConditionalPass),
    ] {
        let c = judged(&specified(rule, &asked));
        assert_eq!(c.status, status, "{rule:?}");
        let each: Vec<Status> = c.quantities.iter().map(|q| q.status).collect();
        assert_eq!(each, [status, Status::Pass], "{rule:?}");
    }
    let asked = [(BIAS, within(-0.19, 0.19)), (SCALE_ERROR, within(-0.001, 0.001))];
    let c = judged(&specified(Rule::NonBinary(GuardMultiple::ONE_U), &asked));
    assert_eq!(c.quantities[0].status, Status::ConditionalFail);
    assert_eq!(c.status, Status::Fail);
}

#[test]
fn risks_follow_the_decision_and_the_degrees_of_freedom() {
    // scipy 1.17.1: t(4).sf(2.5) + t(4).cdf(-22.5).
    let c = judged(&specified(Rule::Simple, &[(BIAS, within(-0.25, 0.25))]));
    let q = &c.quantities[0];
    assert_eq!(q.belief.distribution(), Distribution::Student);
    assert!((q.probability.fails - 0.033_394_825_375_294_76).abs() < 1e-12, "{:?}", q.probability);
    assert_eq!(q.risk(), Some(q.probability.fails));
    let c = judged(&specified(Rule::default(), &[(BIAS, within(-0.25, 0.25))]));
    let q = &c.quantities[0];
    assert_eq!((q.status, q.risk()), (Status::Fail, Some(q.probability.conforms)));
    let c = judged(&specified(Rule::Simple, &[(SCALE_ERROR, within(-0.02, 0.02))]));
    assert_eq!(c.quantities[0].belief.distribution(), Distribution::Normal);
}

#[test]
fn scale_factor_and_mountings() {
    let asked = specified(
        Rule::default(),
        &[(Quantity::ScaleFactor, within(0.0077, 0.0078)), (MISALIGNMENT, within(-0.01, 0.01))],
    );
    let mut values = result();
    let other = PooledParameter { mounting: Some("B".into()), value: 0.02, ..values[1].clone() };
    values[1].mounting = Some("A".into());
    values.push(other);
    let c = conformity(&asked, Some(&values), 0.0077, 0.95, Verdict::Accepted);
    let found: Vec<_> =
        c.quantities.iter().map(|q| (q.quantity, q.mounting.as_deref(), q.status)).collect();
    assert_eq!(
        found,
        [
            (MISALIGNMENT, Some("A"), Status::Pass),
            (MISALIGNMENT, Some("B"), Status::Fail),
            (Quantity::ScaleFactor, None, Status::Pass),
        ]
    );
    assert!((c.quantities[2].belief.value - 0.0077 * 1.01).abs() < 1e-15);
    let statement = c.statement.unwrap();
    assert!(statement.contains("misalignment in 2 mountings and scale factor"), "{statement}");
}

#[test]
fn the_statement_names_results_specification_rule_and_risk() {
    let mut asked = specified(
        Rule::default(),
        &[(BIAS, within(-0.5, 0.5)), (SCALE_ERROR, within(-0.05, 0.05))],
    );
    asked.name = Some("ADXL203 data sheet, rev. E".into());
    let c = judged(&asked);
    let statement = c.statement.unwrap();
    for words in [
        "Pass against ADXL203 data sheet, rev. E: bias and scale error",
        "guarded acceptance (ILAC-G8:09/2019, JCGM 106), guard band w = 1 U, U at 95 %",
        "Largest risk of the rule: 2.5 % that a passed value does not conform",
        "Largest risk of these decisions: ",
    ] {
        assert!(statement.contains(words), "{words}: {statement}");
    }
    assert!(!statement.contains("power-ups is not"), "{statement}");
    let c = conformity(&asked, Some(&result()), 0.0077, 0.95, Verdict::Indeterminate);
    assert!(c.statement.unwrap().contains("true of these runs only"));
}

#[test]
fn the_longest_statement_is_still_readable() {
    let rule = Rule::NonBinary(GuardMultiple::new(0.123_456_789_012_345).unwrap());
    let all = Quantity::ALL.map(|q| (q, within(-0.000_1, 0.000_1)));
    let mut asked = specified(rule, &all);
    asked.name = Some("x".repeat(Specification::LONGEST_NAME));
    let mut values = result();
    values.push(PooledParameter { mounting: Some("B".into()), ..values[1].clone() });
    let c = conformity(&asked, Some(&values), 0.0077, 0.9545, Verdict::Indeterminate);
    let longest = c.statement.unwrap().chars().count();
    // Renderers cut texts at 500 characters.
    assert!(longest > 400 && longest <= 500, "{longest}");
}

#[test]
fn large_uncertainties_are_findings_and_no_verdict() {
    // U = 0.0555: ratios 9.0, 2.7, and guard bands that meet.
    for (half, kind, status) in [
        (0.5, None, Status::Pass),
        (0.15, Some(FindingKind::LowUncertaintyRatio), Status::Fail),
        (0.05, Some(FindingKind::NothingCouldPass), Status::Fail),
    ] {
        let c = judged(&specified(Rule::default(), &[(BIAS, within(-half, half))]));
        let ratio = c.quantities[0].test_uncertainty_ratio.unwrap();
        assert!((ratio - half / (2.776_445 * 0.02)).abs() < 1e-4, "{ratio}");
        assert_eq!(c.status, status, "{half}");
        let found = c.findings();
        assert_eq!(found.iter().map(|f| f.kind).next(), kind, "{half}");
        assert!(found.iter().all(|f| f.kind.severity() == Severity::Warning));
        assert!(found.iter().all(|f| f.place == "[spec] limits of bias"));
    }
    // Inside of limits that could not be kept by a guard band: not the unit's fault.
    let narrow = within(0.17, 0.23);
    let c = judged(&specified(Rule::default(), &[(BIAS, narrow)]));
    assert_eq!((c.status, c.quantities[0].risk()), (Status::NotAssessed, None));
    assert_eq!(c.quantities[0].worst_case.consumer, None);
    // One side open: no tolerance, no ratio, nothing to find.
    let limits = Limits::new(None, Some(0.21)).unwrap();
    let open = Requirement { limits, production: None };
    let c = judged(&specified(Rule::default(), &[(BIAS, open)]));
    assert!(c.quantities[0].test_uncertainty_ratio.is_none() && c.findings().is_empty());
}

#[test]
fn a_stated_production_adds_global_risks() {
    let production = Production::new(0.0, 0.1);
    let requirement = Requirement { production, ..within(-0.25, 0.25) };
    let c = judged(&specified(Rule::default(), &[(BIAS, requirement)]));
    let (_, risk) = c.quantities[0].production.unwrap();
    // scipy 1.17.1, `integrate.quad` with A = ±(0.25 - t(4).ppf(0.975)·0.02).
    assert!((risk.consumer - 5.048_245_302_875e-6).abs() < 1e-12, "{risk:?}");
    assert!((risk.producer - 0.044_113_297_408_742).abs() < 1e-12, "{risk:?}");
}

/// The whole way, with known truth: a unit whose bias lies at its limit does not conform any better than it fails, and
/// the guarded rule passes it in 2.5 % of all calibrations; simple acceptance in half of them.
#[test]
fn a_unit_at_its_limit_passes_as_often_as_the_rule_says() {
    let n: u64 = if std::env::var_os("TUMBLE_LONG").is_some() { 20_000 } else { 2_000 };
    let truth = Truth {
        bias_m_s2: 0.1,
        turn_on_m_s2: 0.01,
        angles_deg: (-6..=6).map(|i| 10.0 * f64::from(i)).collect(),
        dwell_s: 0.2,
        runs: 4,
        ..Preset::Paper3.truth()
    };
    let options = EstimateOptions { method: Method::Exact, ..EstimateOptions::default() };
    let limits = Limits::new(None, Some(truth.bias_m_s2)).unwrap();
    let (mut guarded, mut simple, mut assessed) = (0u64, 0u64, 0u64);
    for seed in 0..n {
        let mut unit = experiment(&Truth { seed, ..truth.clone() });
        unit.specification.require(BIAS, Requirement { limits, production: None });
        let judged = assess(&unit, &options).unwrap().conformity;
        let Some(q) = judged.quantities.first() else { continue };
        assessed += 1;
        guarded += u64::from(q.status == Status::Pass);
        let plainly = Rule::Simple.decide(limits, q.belief.value, q.expanded_uncertainty);
        simple += u64::from(plainly == Status::Pass);
    }
    assert!(assessed * 100 >= n * 98, "{assessed} of {n}");
    for (count, stated) in [(guarded, 0.025), (simple, 0.5)] {
        let share = count as f64 / assessed as f64;
        // Four standard deviations of a binomial share.
        let band = 4.0 * (stated * (1.0 - stated) / assessed as f64).sqrt();
        println!("{share:.4} for {stated} ± {band:.4} of {assessed}");
        assert!((share - stated).abs() < band, "{share} for {stated}");
    }
}

/// A unit far out of its limits: its calibration is as good as before.
#[test]
fn a_failing_unit_keeps_verdict_and_coefficients() {
    let truth = Truth { dwell_s: 2.0, ..Preset::Paper3.truth() };
    let mut unit = experiment(&truth);
    let options = EstimateOptions::default();
    let before = assess(&unit, &options).unwrap();
    assert_eq!(before.verdict, Verdict::Accepted);
    assert_eq!(before.conformity.status, Status::NotAssessed);
    let bias = before.pooled.iter().find(|p| p.parameter == Parameter::Bias).unwrap().value;
    unit.specification.require(BIAS, within(bias + 1.0, bias + 2.0));
    let after = assess(&unit, &options).unwrap();
    assert_eq!(after.conformity.status, Status::Fail);
    assert_eq!(after.verdict, before.verdict);
    assert_eq!(after.compensation, before.compensation);
    assert_eq!(after.findings, before.findings);
    let mut wide = unit.clone();
    wide.specification.require(BIAS, within(bias - 1.0, bias + 1.0));
    assert_eq!(assess(&wide, &options).unwrap().conformity.status, Status::Pass);
}

//! Properties of decision rules, and their risks by simulation with known truth.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use proptest::prelude::*;
use rand_core::SeedableRng;
use rand_distr::{ChiSquared, Distribution as _, Normal, StandardNormal};
use tumble_core::decision::{Belief, GuardMultiple, Limits, Production, Rule, Status, global_risk};
use tumble_core::stats::student_factor;

fn limits() -> impl Strategy<Value = Limits> {
    (-5.0..5.0f64, 0.01..10.0f64, 0..4u8).prop_map(|(lower, width, open)| match open {
        0 => Limits::new(Some(lower), None).unwrap(),
        1 => Limits::new(None, Some(lower)).unwrap(),
        _ => Limits::new(Some(lower), Some(lower + width)).unwrap(),
    })
}

fn beliefs() -> impl Strategy<Value = Belief> {
    let dof = prop_oneof![Just(f64::INFINITY), 1.0..300.0f64, 1e4..1e7f64];
    (-20.0..20.0f64, prop_oneof![Just(0.0), 1e-4..5.0f64], dof).prop_map(
        |(value, standard_uncertainty, degrees_of_freedom)| Belief {
            value,
            standard_uncertainty,
            degrees_of_freedom,
        },
    )
}

fn multiples() -> impl Strategy<Value = GuardMultiple> {
    (0.01..4.0f64).prop_map(|r| GuardMultiple::new(r).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn probabilities_are_probabilities(belief in beliefs(), limits in limits()) {
        let p = belief.conformity(limits);
        prop_assert!((0.0..=1.0).contains(&p.conforms) && (0.0..=1.0).contains(&p.fails));
        prop_assert!((p.conforms + p.fails - 1.0).abs() < 1e-12);
    }

    #[test]
    fn wider_limits_conform_more(belief in beliefs(), limits in limits(), by in 0.0..3.0f64) {
        let wider = limits.moved_inward(-by).unwrap();
        let (narrow, wide) = (belief.conformity(limits), belief.conformity(wider));
        prop_assert!(wide.conforms >= narrow.conforms - 1e-12);
    }

    #[test]
    fn farther_from_the_middle_conforms_less(
        belief in beliefs(), limits in limits(), one in -9.0..9.0f64, other in -9.0..9.0f64,
    ) {
        // Distance beyond which a value leaves the limits: from the middle, or against the open side.
        let at = |distance: f64| {
            let value = match (limits.lower(), limits.upper()) {
                (Some(lower), Some(upper)) => 0.5 * (lower + upper) + distance,
                (Some(lower), None) => lower - distance,
                (None, upper) => upper.unwrap() + distance,
            };
            Belief { value, ..belief }.conformity(limits).conforms
        };
        let two_sided = limits.width().is_some();
        let (near, far) = if two_sided {
            (one.abs().min(other.abs()), one.abs().max(other.abs()))
        } else {
            (one.min(other), one.max(other))
        };
        prop_assert!(at(near) >= at(far) - 1e-12, "{near} {far}");
    }

    #[test]
    fn rules_refine_each_other(
        limits in limits(), value in -20.0..20.0f64, u in 0.0..3.0f64, r in multiples(),
    ) {
        let simple = Rule::Simple.decide(limits, value, u);
        let guarded = Rule::Guarded(r).decide(limits, value, u);
        let four = Rule::NonBinary(r).decide(limits, value, u);
        // Simple acceptance has two answers, guarded acceptance passes nothing that simple acceptance fails.
        prop_assert!(matches!(simple, Status::Pass | Status::Fail));
        prop_assert!(guarded != Status::Pass || simple == Status::Pass);
        // The conditions of the non-binary rule divide both answers of simple acceptance,
        prop_assert_eq!(four.accepted(), simple.accepted());
        // and its unconditional pass is the guarded one.
        prop_assert_eq!(four == Status::Pass, guarded == Status::Pass);
        prop_assert!(four != Status::Fail || guarded == Status::Fail);
    }

    #[test]
    fn no_decision_risks_more_than_the_rule_says(
        belief in beliefs(), limits in limits(), r in multiples(), which in 0..3u8,
    ) {
        let rule = match which {
            0 => Rule::Simple,
            1 => Rule::Guarded(r),
            _ => Rule::NonBinary(r),
        };
        let u = 2.0 * belief.standard_uncertainty;
        let worst = rule.worst_case(limits, &belief, u);
        let p = belief.conformity(limits);
        let (own, largest) = match rule.decide(limits, belief.value, u) {
            Status::Pass => (p.fails, worst.consumer.unwrap()),
            Status::Fail => (p.conforms, worst.producer),
            Status::ConditionalPass => (p.fails, worst.conditional.unwrap()),
            Status::ConditionalFail => (p.conforms, worst.conditional.unwrap()),
            Status::NotAssessed => return Ok(()),
        };
        prop_assert!(own <= largest + 1e-12, "{own} > {largest}");
    }

    #[test]
    fn global_risks_are_shares(
        limits in limits(), mean in -5.0..5.0f64, sd in 1e-3..5.0f64, u in 1e-4..5.0f64, w in 0.0..2.0f64,
    ) {
        let production = Production::new(mean, sd).unwrap();
        let simple = global_risk(limits, Some(limits), production, u);
        let guarded = global_risk(limits, limits.moved_inward(w), production, u);
        prop_assert!((0.0..=1.0).contains(&simple.consumer) && (0.0..=1.0).contains(&simple.producer));
        // A guard band moves risk from the consumer to the producer.
        prop_assert!(guarded.consumer <= simple.consumer + 1e-12);
        prop_assert!(guarded.producer >= simple.producer - 1e-12);
    }
}

/// Four standard deviations of a binomial share: false alarms of 6e-5, and the seed is fixed.
fn band(p: f64, n: usize) -> f64 {
    4.0 * (p * (1.0 - p) / n as f64).sqrt()
}

fn draws() -> usize {
    if std::env::var_os("TUMBLE_LONG").is_some() { 20_000_000 } else { 400_000 }
}

/// Units whose true value is anything (a flat production), measured with few degrees of freedom: of those whose
/// value came out at the acceptance limit the stated share fails the limits.
///
/// The error of the mean of `ν + 1` readings over its own standard uncertainty is Student's t, so a value at `T − k s` hides
/// a true value beyond `T` where the error is below `−k s`.
#[test]
fn the_consumers_risk_at_the_acceptance_limit_is_the_stated_one() {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(106);
    let n = draws();
    for (dof, r) in [(2u32, 1.0), (4, 1.0), (9, 0.83), (57, 1.0), (57, 0.5)] {
        let nu = f64::from(dof);
        let k = student_factor(0.95, nu).unwrap();
        let rule = Rule::Guarded(GuardMultiple::new(r).unwrap());
        let limits = Limits::new(None, Some(0.25)).unwrap();
        let chi_squared = ChiSquared::new(nu).unwrap();
        let mut wrong = 0usize;
        for _ in 0..n {
            let error: f64 = StandardNormal.sample(&mut rng);
            let s = (chi_squared.sample(&mut rng) / nu).sqrt();
            let (error, s) = (0.02 * error, 0.02 * s);
            let value = rule.acceptance(limits, k * s).unwrap().upper().unwrap();
            wrong += usize::from(!limits.contain(value - error));
        }
        let belief = Belief { value: 0.0, standard_uncertainty: 0.02, degrees_of_freedom: nu };
        let stated = rule.worst_case(limits, &belief, k * 0.02).consumer.unwrap();
        let share = wrong as f64 / n as f64;
        assert!((share - stated).abs() < band(stated, n), "ν {dof}, r {r}: {share} for {stated}");
        if dof == 2 {
            // It can fail: with a normal distribution the stated risk would be far off.
            let normal = Belief { degrees_of_freedom: f64::INFINITY, ..belief };
            let wrongly = rule.worst_case(limits, &normal, k * 0.02).consumer.unwrap();
            assert!((share - wrongly).abs() > 10.0 * band(stated, n), "{wrongly}");
        }
    }
}

/// A production whose units are measured and decided: shares of wrong decisions against the integrals.
#[test]
fn global_risks_are_the_shares_of_a_simulated_production() {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(8);
    let n = draws();
    let (mean, sd, u) = (0.05, 0.12, 0.04);
    let limits = Limits::new(Some(-0.25), Some(0.25)).unwrap();
    let rule = Rule::Guarded(GuardMultiple::ISO_14253_1);
    let production = Normal::new(mean, sd).unwrap();
    let (mut consumer, mut producer) = (0usize, 0usize);
    for _ in 0..n {
        let truth: f64 = production.sample(&mut rng);
        let noise: f64 = StandardNormal.sample(&mut rng);
        let passed = rule.decide(limits, truth + u * noise, 2.0 * u) == Status::Pass;
        consumer += usize::from(passed && !limits.contain(truth));
        producer += usize::from(!passed && limits.contain(truth));
    }
    let stated = global_risk(
        limits,
        rule.acceptance(limits, 2.0 * u),
        Production::new(mean, sd).unwrap(),
        u,
    );
    for (share, stated) in [(consumer, stated.consumer), (producer, stated.producer)] {
        let share = share as f64 / n as f64;
        assert!((share - stated).abs() < band(stated, n), "{share} for {stated}");
    }
}

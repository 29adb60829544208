//! Further terms in whole experiments: false entries, power, what may not enter, what is named. Seeds are fixed;
//! `TUMBLE_LONG=1` runs the numbers of `docs/terms.md`.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

use tumble_core::assess::{Assessment, Verdict, assess};
use tumble_core::estimate::{EstimateOptions, Method, Parameter, Term, TermChoice, TermSet};
use tumble_core::simulate::{Preset, Truth, experiment, parse_plan};
use tumble_core::{ARCMIN_RAD, Angle, FindingKind, STANDARD_GRAVITY_M_S2};

const GN: f64 = STANDARD_GRAVITY_M_S2;

fn runs_of(default: usize, long: usize) -> usize {
    if std::env::var_os("TUMBLE_LONG").is_some() { long } else { default }
}

/// Applies a function to every seed on all cores; results come in the order of the seeds.
fn each<T: Send>(count: usize, f: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let part = count.div_ceil(threads);
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads)
            .map(|t| {
                let f = &f;
                let range = t * part..((t + 1) * part).min(count);
                scope.spawn(move || range.map(|s| f(s as u64)).collect::<Vec<T>>())
            })
            .collect();
        handles.into_iter().flat_map(|h| h.join().unwrap()).collect()
    })
}

/// Three runs over ±65°, angles in no order, temperatures that rise by 4 K in each; upright dwells in each power-up.
fn bench() -> Truth {
    let order = (0..60).map(|i| -65.0 + 130.0 * f64::from(i * 37 % 60) / 59.0);
    Truth {
        angles_deg: order.map(|a| (a * 1e4).round() / 1e4).collect(),
        upright_in_each_run: true,
        vertical_lean: Angle::from_arcmin(5.0),
        temperature_degc: Some((20.0, 24.0)),
        turn_on_m_s2: 1e-3,
        misalignment: Angle::from_arcmin(4.0),
        dwell_s: 2.0,
        noise_m_s2: 0.3 * 0.007_69,
        runs: 3,
        ..Preset::Paper2.truth()
    }
}

fn options(method: Method, terms: TermChoice) -> EstimateOptions {
    EstimateOptions { method, terms, ..EstimateOptions::default() }
}

fn judged(truth: &Truth, method: Method, terms: TermChoice) -> Assessment {
    let mut e = experiment(truth);
    e.bench.vertical_lean = Angle::from_arcmin(5.0);
    assess(&e, &options(method, terms)).unwrap()
}

fn auto(truth: &Truth) -> Assessment {
    judged(truth, Method::Likelihood, TermChoice::Auto)
}

fn has(a: &Assessment, kind: FindingKind) -> bool {
    a.findings.iter().any(|f| f.kind == kind)
}

fn only(term: Term) -> TermChoice {
    TermChoice::Named(TermSet::EMPTY.with(term))
}

/// 99.9 % upper end for a count of a fraction, normal approximation.
fn at_most(p: f64, n: usize) -> f64 {
    p + 3.1 * (p * (1.0 - p) / n as f64).sqrt()
}

#[test]
fn terms_that_are_absent_seldom_enter() {
    let plans: [(&str, Truth); 2] = [
        ("±65°, up and down", bench()),
        (
            "the paper's plan",
            Truth {
                angles_deg: parse_plan("paper").unwrap(),
                upright_in_each_run: false,
                temperature_degc: None,
                ..bench()
            },
        ),
    ];
    for (k, (name, base)) in plans.iter().enumerate() {
        let n = runs_of(80, 2000);
        let entered = each(n, |seed| {
            let a = auto(&Truth { seed: seed + 1 + 100_000 * k as u64, ..base.clone() });
            assert_eq!(has(&a, FindingKind::TermEntered), !a.terms.entered.is_empty());
            usize::from(!a.terms.entered.is_empty())
        });
        let count: usize = entered.iter().sum();
        let rate = count as f64 / n as f64;
        let se = (0.01f64 * 0.99 / n as f64).sqrt();
        println!(
            "{name}: {count} of {n} entered a term, {:.2} % (stated 1 % ± {:.2} %)",
            100.0 * rate,
            100.0 * se
        );
        assert!(rate <= at_most(0.01, n), "{name}: {rate}");
    }
}

#[test]
fn terms_that_are_present_enter() {
    type With = fn(f64) -> Truth;
    // Size in the usual unit, smallest share that must enter.
    type Curve = (Term, With, [(f64, f64); 4]);
    let curves: [Curve; 4] = [
        (
            Term::K2,
            |x| Truth { k2_per_m_s2: x * 1e-6 / GN, ..bench() },
            [(50.0, 0.0), (100.0, 0.0), (200.0, 0.03), (400.0, 0.5)],
        ),
        (
            Term::K3,
            |x| Truth { k3_per_m2_s4: x * 1e-6 / (GN * GN), ..bench() },
            [(50.0, 0.0), (100.0, 0.08), (200.0, 0.65), (400.0, 0.9)],
        ),
        (
            Term::ScaleSign,
            |x| Truth { scale_sign: x * 1e-6, ..bench() },
            [(100.0, 0.0), (200.0, 0.0), (400.0, 0.2), (800.0, 0.65)],
        ),
        (
            Term::TempBias,
            |x| Truth { bias_per_k_m_s2: x * 1e-6 * GN, ..bench() },
            [(20.0, 0.12), (40.0, 0.9), (80.0, 0.95), (160.0, 0.95)],
        ),
    ];
    // The largest size alone in the default tier.
    let n = runs_of(40, 400);
    let first = runs_of(3, 0);
    for (k, (term, with, sizes)) in curves.iter().enumerate() {
        for (size, least) in &sizes[first..] {
            let base = with(*size);
            let found = each(n, |seed| {
                let a =
                    auto(&Truth { seed: seed + 1 + 1_000_000 * (k as u64 + 1), ..base.clone() });
                // By name only (a wrongly declared converter looks the same): there the test is what has the power.
                let tried = a.terms.tried.iter().find(|t| t.term == *term).unwrap();
                let shows = tried.test.is_some_and(|t| t.p_value < 0.002 && t.bic_gain > 0.0);
                match term {
                    Term::ScaleSign => !tried.entered && shows,
                    _ => tried.entered,
                }
            });
            let share = found.iter().filter(|f| **f).count() as f64 / n as f64;
            println!("{} of {size} {}: enters {share:.3}", term.name(), term.usual().0);
            assert!(share >= *least, "{} of {size}: {share}", term.name());
        }
    }
}

#[test]
fn an_entered_term_takes_its_error_out_of_the_others() {
    let truth = Truth { k2_per_m_s2: 500e-6 / GN, ..bench() };
    // The exact form, whose weights differ, by name.
    let e = judged(&truth, Method::Exact, only(Term::K2));
    let t = e.terms.tried[0].pooled.unwrap();
    println!("exact: {t:?} {:?} {:?}", e.terms.tried[0].test, e.terms.tried[0].obstacle());
    assert!((t.value - truth.k2_per_m_s2).abs() < 2.0 * t.expanded_uncertainty, "{t:?}");
    for method in [Method::Likelihood] {
        let with = judged(&truth, method, TermChoice::Auto);
        let without = judged(&truth, method, TermChoice::Named(TermSet::EMPTY));
        assert!(with.terms.entered.contains(Term::K2), "{method:?}");
        let f = with.findings.iter().find(|f| f.kind == FindingKind::TermEntered).unwrap();
        assert!(f.observed.contains("ug/g2") && f.observed.contains("p ="), "{}", f.observed);
        // Left out it is a rejected curvature; entered it is a result whose intervals hold the truth.
        assert!(has(&without, FindingKind::QuadraticResidual), "{method:?}");
        assert_eq!(without.verdict, Verdict::Rejected);
        assert_eq!(with.verdict, Verdict::Accepted, "{:?}", with.findings);
        let t = with.terms.tried.iter().find(|t| t.term == Term::K2).unwrap().pooled.unwrap();
        assert!((t.value - truth.k2_per_m_s2).abs() < 2.0 * t.expanded_uncertainty, "{t:?}");
        let dial = format!("eccentric by {:.1}′", t.value * truth.gravity_m_s2 / ARCMIN_RAD);
        assert!(f.remedy.contains(&dial) && f.remedy.contains("±90°"), "{dial}: {}", f.remedy);
        let is = [truth.bias_m_s2, truth.misalignment.rad(), truth.scale_error];
        for p in &with.pooled {
            let off = (p.value - is[p.parameter.index()]).abs();
            assert!(off < 2.0 * p.expanded_uncertainty, "{method:?} {:?}", p.parameter);
        }
        // Coefficients undo what the sensor does.
        let c = with.compensation.as_ref().unwrap();
        let terms = c.terms.as_ref().unwrap();
        // At ±90°, where the up and down dwells stand.
        assert!((terms.peak_m_s2 / (t.value * 9.81 * 9.81) - 1.0).abs() < 0.03, "{terms:?}");
        let (before, after) = (with.error_level.as_ref().unwrap(), without.error_level.unwrap());
        assert!(before.after_held_out_lsb.unwrap() < after.after_held_out_lsb.unwrap());
    }
}

#[test]
fn what_may_not_enter_is_said_and_rejected() {
    // Beyond what sensors have.
    let large = auto(&Truth { k2_per_m_s2: 3e-3 / GN, ..bench() });
    assert!(large.terms.entered.is_empty());
    let f = large.findings.iter().find(|f| f.kind == FindingKind::QuadraticResidual).unwrap();
    assert!(f.remedy.contains("term k2 of +") && f.remedy.contains("--terms k2"), "{}", f.remedy);
    // A badly eccentric dial is not taken for K2, nor for anything else.
    let dial = |arcmin: f64, phase: f64| Truth {
        eccentricity: Angle::from_arcmin(arcmin),
        eccentricity_phase: Angle::from_deg(phase),
        upright_in_each_run: false,
        ..bench()
    };
    for phase in [0.0, 45.0, 90.0] {
        let a = auto(&dial(10.0, phase));
        assert!(a.terms.entered.is_empty(), "{phase}");
        assert_eq!(a.verdict, Verdict::Rejected, "{phase}");
    }
    // A small one is: which is why the warning stands in the passport.
    let small = auto(&dial(2.0, 0.0));
    assert!(small.terms.entered.contains(Term::K3));
    let f = small.findings.iter().find(|f| f.kind == FindingKind::TermEntered).unwrap();
    assert!(f.remedy.contains("dial that is eccentric by about"), "{}", f.remedy);
}

#[test]
fn named_terms_enter_or_say_why_not() {
    // Identifiable: entered though absent, without a warning.
    let a = judged(&bench(), Method::Likelihood, only(Term::K2));
    assert!(a.terms.entered.contains(Term::K2) && !has(&a, FindingKind::TermEntered));
    let k2 = a.terms.tried.iter().find(|t| t.term == Term::K2).unwrap();
    assert!(k2.test.unwrap().p_value > 0.001 && k2.pooled.is_some());
    // Not identifiable: what to measure.
    let narrow =
        Truth { angles_deg: parse_plan("paper").unwrap(), upright_in_each_run: false, ..bench() };
    let a = judged(&narrow, Method::Likelihood, only(Term::K2));
    let f = a.findings.iter().find(|f| f.kind == FindingKind::TermNotIdentifiable).unwrap();
    assert!(f.observed.contains("times its target") && f.remedy.contains("axis up"), "{f:?}");
    assert_eq!(a.verdict, Verdict::Indeterminate);
    // No temperatures.
    let cold = Truth { temperature_degc: None, ..bench() };
    let a = judged(&cold, Method::Exact, only(Term::TempBias));
    let f = a.findings.iter().find(|f| f.kind == FindingKind::TermNeedsTemperature).unwrap();
    assert!(f.remedy.contains("temperature_degc"), "{f:?}");
    // All five at once.
    let all =
        judged(&bench(), Method::Likelihood, TermChoice::Named(Term::ALL.into_iter().collect()));
    assert_eq!(all.terms.entered.len(), 5, "{:?}", all.findings);
    let e = all.runs[0].estimate.as_ref().unwrap();
    assert_eq!((e.terms.len(), e.degrees_of_freedom), (5, 62 - 8));
    assert_eq!(e.full_covariance.as_ref().unwrap().rows(), 8);
    // The paper's method has none.
    let paper = judged(&bench(), Method::Paper, TermChoice::Auto);
    assert!(paper.terms.entered.is_empty());
    for p in Parameter::ALL {
        assert!(paper.pooled.iter().any(|x| x.parameter == p));
    }
}

//! What a plan predicts against what the whole judgement ([`assess`]) states of experiments that follow it.

use tumble_core::assess::assess;
use tumble_core::estimate::{EstimateOptions, Parameter};
use tumble_core::plan::{
    Plan, PlanConverter, PlanNoise, PlanProblem, Possible, Source, Term, TermPrediction, plan,
};
use tumble_core::simulate::{Preset, Truth, experiment};
use tumble_core::systematic::{Inputs, Systematics};
use tumble_core::{Angle, Gravity, Quantizer};

/// Experiments a case.
const EXPERIMENTS: u64 = 150;
const MANY_EXPERIMENTS: u64 = 600;
/// What no scatter shows is the same formulas at the true angles: nearly exact.
const BUDGET: f64 = 0.04;
/// The plan knows the scatter and the weights, the judgement finds them in the data: that costs up to 13 % where the
/// weights differ most, of the scale factor with up and down. In the short tier four standard errors of the mean square
/// come on top.
const STATISTICAL: f64 = 0.15;

struct Case {
    name: &'static str,
    truth: Truth,
    problem: PlanProblem,
}

/// A bench, its sensor as the simulation knows it and the question to the plan that belongs to it.
fn case(name: &'static str, scatter_arcmin: f64, upright: bool, edit: fn(&mut Truth)) -> Case {
    let mut truth = Truth {
        quantizer: Quantizer::Round,
        setting_scatter: Angle::from_arcmin(scatter_arcmin),
        upright_in_each_run: upright,
        // Here a draw a dwell, in the budget the same for all: small enough not to be seen as scatter, too.
        vertical_lean: Angle::from_arcmin(if upright { 5.0 } else { 0.0 }),
        rate_hz: 20.0,
        ..Preset::Paper3.truth()
    };
    edit(&mut truth);
    let range = Angle::from_deg(65.0);
    let problem = PlanProblem {
        setting_scatter: truth.setting_scatter,
        noise: PlanNoise {
            white_m_s2_rts: truth.noise_m_s2 / truth.rate_hz.sqrt(),
            walk_m_s2_rts: truth.random_walk_m_s2_rts,
            ..PlanNoise::default()
        },
        converter: Some(PlanConverter {
            lsb_m_s2: truth.nominal_scale_m_s2_per_lsb,
            rate_hz: truth.rate_hz,
        }),
        turn_on_m_s2: Some(truth.turn_on_m_s2),
        upright_lean: truth.vertical_lean,
        upright: if upright { Possible::Yes } else { Possible::No },
        total_s: Some(5400.0),
        gravity: Gravity { value_m_s2: truth.gravity_m_s2, ..Gravity::normal(50.0, 150.0) },
        ..PlanProblem::with_range(range)
    };
    Case { name, truth, problem }
}

fn systematics() -> Systematics {
    Systematics { dial_scale: Some(2e-4), ..Systematics::default() }
}

/// Root mean squares of what the judgement states, statistical and of the budget, and of its errors, by parameter.
fn stated(c: &Case, plan: &Plan, experiments: u64) -> [[f64; 3]; 3] {
    let mut squares = [[0.0; 3]; 3];
    let t = &c.truth;
    let true_values = [t.bias_m_s2, t.misalignment.rad(), t.scale_error];
    for seed in 1..=experiments {
        let truth = Truth {
            seed,
            angles_deg: plan
                .sites
                .iter()
                .filter(|s| !s.is_upright())
                .map(|s| s.angle.deg())
                .collect(),
            dwell_s: plan.dwell_s,
            runs: plan.runs,
            ..c.truth.clone()
        };
        let mut e = experiment(&truth);
        e.bench.systematics = systematics();
        e.bench.range = Some(c.problem.range);
        e.bench.gravity = c.problem.gravity;
        let a = assess(&e, &EstimateOptions::default()).unwrap();
        for p in &a.pooled {
            let i = p.parameter.index();
            squares[i][0] += p.u_statistical.powi(2);
            squares[i][1] += p.u_budget.powi(2);
            squares[i][2] += (p.value - true_values[i]).powi(2);
        }
    }
    squares.map(|both| both.map(|s| (s / experiments as f64).sqrt()))
}

fn predicted(t: &TermPrediction) -> [f64; 2] {
    let of = |keep: &dyn Fn(Source) -> bool| {
        t.sources.iter().filter(|s| keep(s.0)).map(|s| s.1 * s.1).sum::<f64>().sqrt()
    };
    [of(&Source::averages_out), of(&|s| !s.averages_out())]
}

#[test]
fn the_judgement_states_what_the_plan_predicts() {
    let long = std::env::var_os("TUMBLE_LONG").is_some();
    let experiments = if long { MANY_EXPERIMENTS } else { EXPERIMENTS };
    // Of errors; what is stated has more degrees of freedom.
    let chance = if long { 0.0 } else { 4.0 / (2.0 * experiments as f64).sqrt() };
    let cases = [
        case("hand-set", 3.0, false, |_| ()),
        case("fine dial, power-ups differ", 0.5, false, |t| t.turn_on_m_s2 = 0.003),
        case("up and down", 2.0, true, |_| ()),
    ];
    let mut faults = Vec::new();
    for mut c in cases {
        let mut e = experiment(&c.truth);
        e.bench.systematics = systematics();
        e.bench.range = Some(c.problem.range);
        e.bench.gravity = c.problem.gravity;
        c.problem.systematics = Inputs::of(&e, c.truth.nominal_scale_m_s2_per_lsb);
        let made = plan(&c.problem).unwrap();
        let found = stated(&c, &made, experiments);
        for (parameter, term) in
            Parameter::ALL.into_iter().zip([Term::Bias, Term::Misalignment, Term::ScaleError])
        {
            let p = predicted(made.prediction.of(term).unwrap());
            let s = found[parameter.index()];
            println!(
                "{}: {}: statistical {:.3e} stated, {:.3e} predicted ({:+.1} %); budget {:.3e}, {:.3e} ({:+.1} %); errors {:.3e}",
                c.name,
                term.name(),
                s[0],
                p[0],
                100.0 * (s[0] / p[0] - 1.0),
                s[1],
                p[1],
                100.0 * (s[1] / p[1] - 1.0),
                s[2]
            );
            // The simulated bench is without systematic errors: what the results are off by is scatter.
            let compared = [
                ("statistical", s[0], p[0], STATISTICAL + 0.5 * chance),
                ("budget", s[1], p[1], BUDGET),
                ("errors", s[2], p[0], STATISTICAL + chance),
            ];
            for (what, seen, predicted, bound) in compared {
                if (seen / predicted - 1.0).abs() > bound {
                    faults.push(format!("{} {} {what}: {seen} {predicted}", c.name, term.name()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

//! The plan of a calibration: which angles, in which order, how long, how often. Chosen before anyone turns the table.
//!
//! [`plan`] takes a [`PlanProblem`] and gives a [`Plan`] with what it will know by source, what it gives away against the best
//! that is possible, the paper's plan at equal time beside it, and what would help. [`predict_plan`] predicts any plan.
//!
//! **Source** method sections 7, 10, 11; `docs/plan.md`.

mod advice;
mod candidates;
mod estimator;
mod exact;
mod information;
mod layout;
mod order;
mod phases;
mod predict;
mod problem;
mod relax;
mod search;
mod shared;
mod spare;
mod variance;
mod whole;

pub use advice::{Gain, Lever, WORTH_SAYING};
pub use order::OrderEffect;
pub use phases::DITHERED_LSB;
pub use predict::{Prediction, Source, TermPrediction, predict_plan};
pub use problem::{
    Criterion, DEFAULT_SPARES, PlanConverter, PlanNoise, PlanProblem, PlanTimes, Possible, Site,
    TERMS, Term,
};

use crate::systematic::Input;
use layout::{Layout, run_s};

/// Time where neither time nor targets were given, s.
pub const DEFAULT_TOTAL_S: f64 = 3600.0;
/// No plan is longer, s: a week of turning a table is no plan.
pub const LONGEST_TOTAL_S: f64 = 7.0 * 86_400.0;
/// Steps of the search for the least time.
const TIME_STEPS: usize = 8;
/// Distance from what shares of dwells could reach from which on whole numbers are looked at.
const GAP_WORTH_A_LOOK: f64 = 0.002;
/// The least time is found to this share.
const TIME_TOLERANCE: f64 = 0.02;

/// A plan that cannot be made.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanError {
    /// A quantity is not possible.
    Value {
        /// Name.
        name: &'static str,
        /// Value.
        value: f64,
        /// What is possible.
        expected: &'static str,
    },
    /// The time is too short for the fewest positions.
    TooShort {
        /// Time given, s.
        total_s: f64,
        /// Time needed, s.
        needed_s: f64,
    },
    /// No positions on this table tell the terms apart.
    NotToldApart {
        /// The range, degrees.
        range_deg: [f64; 2],
    },
}

impl std::fmt::Display for PlanError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Value { name, value, expected } => {
                // Endless rows of zeros help nobody.
                let common =
                    *value == 0.0 || !value.is_finite() || (1e-6..1e9).contains(&value.abs());
                let shown = if common { value.to_string() } else { format!("{value:e}") };
                write!(f, "{name} = {shown} does not fit; give {expected}")
            }
            Self::TooShort { total_s, needed_s } => write!(
                f,
                "{:.1} min are too short for the smallest plan, which takes {:.1} min; give more time, or shorter times to set, settle and restart",
                total_s / 60.0,
                needed_s / 60.0
            ),
            Self::NotToldApart { range_deg: [lo, hi] } => write!(
                f,
                "no angles between {lo:.6} and {hi:.6} deg tell the wanted terms apart; ask for fewer terms, or use a wider range"
            ),
        }
    }
}

impl std::error::Error for PlanError {}

/// A number of runs with what it would give in the same time.
#[derive(Debug, Clone, PartialEq)]
pub struct RunsChoice {
    /// Number of runs.
    pub runs: u32,
    /// What they would tell; `None`: too short.
    pub prediction: Option<Prediction>,
}

/// The paper's plan in the same time.
#[derive(Debug, Clone, PartialEq)]
pub struct PaperPlan {
    /// Positions of a run: 60, or as many as the time allows.
    pub positions: usize,
    /// Length of a dwell, s.
    pub dwell_s: f64,
    /// What it will know.
    pub prediction: Prediction,
}

/// A plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Dwells of each run in order; upright ones first.
    pub sites: Vec<Site>,
    /// Start of each dwell from power-up, s.
    pub starts_s: Vec<f64>,
    /// Those of them that are there to test the model.
    pub spares: Vec<Site>,
    /// Length of a dwell, s.
    pub dwell_s: f64,
    /// Number of runs.
    pub runs: u32,
    /// Time of a run from power-up to its end, s.
    pub run_s: f64,
    /// Time of all runs, s.
    pub total_s: f64,
    /// What it will know.
    pub prediction: Prediction,
    /// By how much uncertainty over target is above what no plan with these spares, this step, this many positions and this
    /// dwell is below: the criterion's own measure, as a ratio of standard uncertainties less one.
    pub gap: f64,
    /// What the spares cost, the same way.
    pub spare_price: f64,
    /// What drift would do to each term, in the order of the dial and in this order.
    pub order: Vec<OrderEffect>,
    /// The paper's plan in the same time, where there is one.
    pub paper: Option<PaperPlan>,
    /// One, three and five runs in the same time.
    pub by_runs: Vec<RunsChoice>,
    /// What would help.
    pub gains: Vec<Gain>,
    /// What would meet the targets together, where no single one of [`Self::gains`] does.
    pub together: Option<Vec<Lever>>,
    /// Noise of a reading over one LSB, where the converter is known.
    pub dither_lsb: Option<f64>,
    /// Whether repeats are spread over the step of the converter.
    pub phases_spread: bool,
    /// Whether all targets are met.
    pub met: bool,
    /// Least time that meets the targets, s, as far as it can be told from this plan; `None`: no time does.
    pub needed_s: Option<f64>,
}

/// Plans a calibration.
///
/// **Model** shares of positions by convex optimization, whole numbers by apportionment and exchange, the distance to the best
/// possible from the equivalence theorem (`relax`); dwell, number of positions and of runs by trying them all.
///
/// **Assumes** errors small against one, noise and scatter as given, and runs that differ by their scatter and
/// [`PlanProblem::turn_on_m_s2`] alone. Angles, dwell and runs are chosen for what averages out; what no repetition averages out
/// is predicted beside it.
///
/// **Errors** [`PlanError`]. Targets out of reach are no error: [`Plan::met`].
///
/// **Source** method section 11.
///
/// ```
/// use tumble_core::Angle;
/// use tumble_core::plan::{PlanProblem, Term, plan};
/// let mut problem = PlanProblem::with_range(Angle::from_deg(65.0));
/// problem.total_s = Some(3600.0);
/// let ours = plan(&problem)?;
/// assert!(ours.gap < 0.02 && ours.runs >= 3 && ours.total_s <= 3600.0);
/// // The paper's plan in the same hour knows the bias several times worse.
/// let paper = ours.paper.as_ref().unwrap().prediction.of(Term::Bias).unwrap().u;
/// assert!(paper > 5.0 * ours.prediction.of(Term::Bias).unwrap().u);
///
/// // Ten minutes are no time for three runs.
/// problem.total_s = Some(600.0);
/// assert!(plan(&problem).is_err());
/// # Ok::<(), tumble_core::plan::PlanError>(())
/// ```
pub fn plan(problem: &PlanProblem) -> Result<Plan, PlanError> {
    check(problem)?;
    let least_s = search::least_s(problem);
    let asked = problem.total_s.or((!has_targets(problem)).then_some(DEFAULT_TOTAL_S));
    if let Some(total_s) = asked.filter(|t| *t < least_s) {
        return Err(PlanError::TooShort { total_s, needed_s: least_s });
    }
    let made = match asked {
        Some(total_s) => search::within(problem, total_s).map(|l| (l, total_s)),
        None => in_least_time(problem, least_s),
    };
    let (layout, total_s) = made.ok_or_else(|| PlanError::NotToldApart {
        range_deg: [problem.range.0.deg(), problem.range.1.deg()],
    })?;
    Ok(finished(problem, layout, total_s))
}

fn has_targets(problem: &PlanProblem) -> bool {
    problem.targets.iter().any(Option::is_some)
}

/// Looks for the least time that meets the targets: what scatters falls with the root of the time, the rest stays.
fn in_least_time(problem: &PlanProblem, least_s: f64) -> Option<(Layout, f64)> {
    let mut total_s = DEFAULT_TOTAL_S.max(least_s);
    let mut best: Option<(Layout, f64)> = None;
    // The longest time that was too short.
    let mut short = least_s;
    for _ in 0..TIME_STEPS {
        let made = search::within(problem, total_s)?;
        let met = made.prediction.worst_ratio() <= 1.0;
        let needed = needed_s(&made.prediction, total_s);
        let enough =
            if met { Some(total_s) } else { best.as_ref().filter(|b| is_met(b)).map(|b| b.1) };
        if !met {
            short = total_s;
        }
        if met || enough.is_none() {
            best = Some((made, total_s));
        }
        total_s = match (needed, enough) {
            (_, Some(enough)) if enough <= short * (1.0 + TIME_TOLERANCE) => break,
            // From above, by a hair: the guess forgets that whole dwells and seconds do not fill the time.
            (Some(t), Some(enough)) if t > short * 1.01 && t < enough * 0.98 => t * 1.01,
            (_, Some(enough)) => (short * enough).sqrt(),
            (Some(t), None) => t.clamp(short * (1.0 + TIME_TOLERANCE), LONGEST_TOTAL_S),
            // Out of reach: show what this time gives.
            (None, None) => break,
        };
    }
    best
}

fn is_met(made: &(Layout, f64)) -> bool {
    made.0.prediction.worst_ratio() <= 1.0
}

/// Time in which a plan's statistical part has fallen to what the targets leave for it.
fn needed_s(p: &Prediction, total_s: f64) -> Option<f64> {
    let mut factor: f64 = 0.0;
    for t in &p.terms {
        let Some(target) = t.target else { continue };
        let allowed =
            (target / t.coverage_factor).powi(2) - (t.u * t.u - t.u_statistical * t.u_statistical);
        if allowed <= 0.0 {
            return None;
        }
        factor = factor.max(t.u_statistical * t.u_statistical / allowed);
    }
    Some(total_s * factor).filter(|t| *t <= LONGEST_TOTAL_S)
}

fn finished(problem: &PlanProblem, l: Layout, total_s: f64) -> Plan {
    let table = l.sites.iter().filter(|s| !s.is_upright()).count();
    let run = run_s(problem, table, l.dwell_s);
    let used_s = run * f64::from(l.runs);
    let by_runs = [1, 3, 5]
        .into_iter()
        .map(|runs| {
            let fixed = PlanProblem { runs: Some(runs), ..problem.clone() };
            let made = search::best_of(&fixed, total_s, search::COMPARED);
            RunsChoice { runs, prediction: made.map(|l| l.prediction) }
        })
        .collect();
    let met = l.prediction.worst_ratio() <= 1.0;
    let gains = advice::gains(problem, &l, used_s);
    let enough = gains.iter().any(|g| g.prediction.worst_ratio() <= 1.0);
    let known_gap = Some(l.gap).filter(|g| *g > GAP_WORTH_A_LOOK);
    let by_whole_numbers = known_gap.and_then(|_| whole::gap(problem, &l));
    let gap = by_whole_numbers.map_or(l.gap, |w| w.min(l.gap).max(0.0));
    let timeline = estimator::Timeline::of(problem, &l.sites, l.dwell_s);
    Plan {
        starts_s: timeline.starts_s(problem, &l.sites, l.dwell_s),
        paper: paper(problem, l.runs, run),
        by_runs,
        together: if met || enough { None } else { advice::together(problem, &l) },
        gains,
        dither_lsb: variance::dither_lsb(problem),
        phases_spread: phases::needed(problem),
        met,
        needed_s: needed_s(&l.prediction, used_s),
        sites: l.sites,
        spares: l.spares,
        dwell_s: l.dwell_s,
        runs: l.runs,
        run_s: run,
        total_s: used_s,
        prediction: l.prediction,
        gap,
        spare_price: l.spare_price,
        order: l.order,
    }
}

/// −30…29° in 1° steps on the same table with the same times, the dwell filling the run; fewer and wider steps where the run is
/// too short for sixty.
fn paper(problem: &PlanProblem, runs: u32, run: f64) -> Option<PaperPlan> {
    let without = PlanProblem { upright: Possible::No, ..problem.clone() };
    let (mut positions, mut dwell_s) = (60, None);
    while positions >= 4 && dwell_s.is_none() {
        dwell_s = layout::filling_dwell_s(&without, positions, run);
        if dwell_s.is_none() {
            positions -= 1;
        }
    }
    let dwell_s = dwell_s?;
    let step = 59.0 / (positions as f64 - 1.0);
    let sites: Vec<Site> =
        (0..positions).map(|i| Site::table((-30.0 + step * i as f64).round())).collect();
    let prediction = predict_plan(&without, &sites, dwell_s, runs)?;
    Some(PaperPlan { positions, dwell_s, prediction })
}

/// Refuses what cannot be.
fn check(p: &PlanProblem) -> Result<(), PlanError> {
    let wrong = |name, value, expected| Err(PlanError::Value { name, value, expected });
    let (low, high) = (p.range.0.deg(), p.range.1.deg());
    if !(low < high && low >= -90.0 && high <= 90.0) {
        return wrong(
            "range",
            high,
            "lowest and highest angle of the table, between -90 and 90 deg",
        );
    }
    if !(p.step.deg() >= 1e-4 && p.step.rad() <= (p.range.1.rad() - p.range.0.rad()) / 4.0) {
        return wrong(
            "step",
            p.step.deg(),
            "the step of the dial, 0.0001 deg to a quarter of the range",
        );
    }
    check_sizes(p)?;
    if p.total_s.is_some_and(|t| t > LONGEST_TOTAL_S) {
        return wrong("time", p.total_s.unwrap_or(0.0), "at most a week, in s");
    }
    if p.terms().iter().any(|t| t.needs_temperature()) && p.systematics.temperature_spread_k <= 0.0
    {
        return wrong(
            "rise of temperature",
            0.0,
            "how much it rises during a run, K, to fit what it does",
        );
    }
    if let Some(t) =
        Term::ALL.iter().find(|t| p.targets[t.index()].is_some() && !p.terms().contains(t))
    {
        return wrong("target", t.index() as f64, "targets only for terms that are fitted");
    }
    if p.runs == Some(0) || p.runs.is_some_and(|r| r > 100) {
        return wrong("runs", f64::from(p.runs.unwrap_or(0)), "1 to 100 runs");
    }
    if p.spares > 12 {
        return wrong("spares", p.spares as f64, "at most 12 spare angles");
    }
    if !(0.5..1.0).contains(&p.level) {
        return wrong("level", p.level, "a level of confidence between 0.5 and 1");
    }
    Ok(())
}

/// Refuses sizes that no quantity has.
fn check_sizes(p: &PlanProblem) -> Result<(), PlanError> {
    let wrong = |name, value, expected| Err(PlanError::Value { name, value, expected });
    let not_negative = [
        ("scatter of angles", p.setting_scatter.rad()),
        ("scatter of the level", p.level_scatter_m_s2),
        ("noise", p.noise.white_m_s2_rts),
        ("bias instability", p.noise.flicker_m_s2),
        ("random walk", p.noise.walk_m_s2_rts),
        ("drift", p.noise.ramp_m_s3),
        ("spread between power-ups", p.turn_on_m_s2.unwrap_or(0.0)),
        ("uncertainty of gravity", p.gravity.standard_uncertainty_m_s2),
        ("lean of upright dwells", p.upright_lean.rad()),
        ("time to set", p.times.setting_s),
        ("time to settle", p.times.settle_s),
        ("time to stand upright", p.times.upright_s),
        ("time to restart", p.times.restart_s),
        ("rise of temperature", p.systematics.temperature_spread_k),
    ];
    if let Some((name, value)) = not_negative.iter().find(|(_, v)| !(v.is_finite() && *v >= 0.0)) {
        return wrong(name, *value, "a finite number, zero or more");
    }
    let uncertain =
        |l: &&Input| !(l.standard_uncertainty.is_finite() && l.standard_uncertainty >= 0.0);
    if let Some(l) = p.systematics.lines.iter().find(uncertain) {
        return wrong(l.quantity.name(), l.standard_uncertainty, "a finite number, zero or more");
    }
    let positive = [
        ("gravity", Some(p.gravity.value_m_s2)),
        ("time", p.total_s),
        ("dwell", p.dwell_s),
        ("LSB", p.converter.map(|c| c.lsb_m_s2)),
        ("rate", p.converter.map(|c| c.rate_hz)),
    ];
    let targets = p.targets.iter().map(|t| ("target", *t));
    let all = positive.into_iter().chain(targets);
    if let Some((name, value)) =
        all.filter_map(|(n, v)| Some((n, v?))).find(|(_, v)| !(v.is_finite() && *v > 0.0))
    {
        return wrong(name, value, "a positive number");
    }
    Ok(())
}

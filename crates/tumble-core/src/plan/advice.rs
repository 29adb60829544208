//! What would make the result better, each reckoned through.

use super::layout::{Layout, layout};
use super::predict::{Prediction, Source, predict_plan};
use super::problem::{PlanProblem, Possible, Term};
use super::search;
use crate::Angle;
use crate::systematic::{Input, Inputs};

/// Something that can be done about a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lever {
    /// One more minute in all.
    Minute,
    /// Twice the time.
    TwiceTheTime,
    /// Two more runs of the same kind.
    TwoRuns,
    /// Half the scatter of setting angles.
    Setting,
    /// Dwells up and down in each run.
    Upright,
    /// A table that turns ±90°.
    Range,
    /// Half the tilt, lean and zero of the table.
    Level,
    /// Half the errors of the dial's scale and centre.
    Dial,
    /// Gravity measured, to 1 mGal.
    Gravity,
    /// Turning the body by 180° between runs.
    Remounting,
    /// Half the lean of upright dwells.
    Lean,
    /// Half the uncertainty of K2 and K3.
    Curvature,
    /// K2 fitted, not taken from the data sheet.
    FitK2,
    /// The same of K3.
    FitK3,
}

impl Lever {
    /// All, in the order of lists.
    pub const ALL: [Self; 14] = [
        Self::Minute,
        Self::TwiceTheTime,
        Self::TwoRuns,
        Self::Setting,
        Self::Upright,
        Self::Range,
        Self::Level,
        Self::Dial,
        Self::Gravity,
        Self::Remounting,
        Self::Lean,
        Self::Curvature,
        Self::FitK2,
        Self::FitK3,
    ];

    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Minute => "minute",
            Self::TwiceTheTime => "twice_the_time",
            Self::TwoRuns => "two_runs",
            Self::Setting => "setting",
            Self::Upright => "up_down",
            Self::Range => "range",
            Self::Level => "level",
            Self::Dial => "dial",
            Self::Gravity => "gravity",
            Self::Remounting => "remounting",
            Self::Lean => "lean",
            Self::Curvature => "curvature",
            Self::FitK2 => "fit_k2",
            Self::FitK3 => "fit_k3",
        }
    }

    /// For people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Minute => "one more minute",
            Self::TwiceTheTime => "twice the time",
            Self::TwoRuns => "two more runs like these",
            Self::Setting => "angles set twice as well",
            Self::Upright => "dwells up and down in each run",
            Self::Range => "a table that turns 90 deg both ways",
            Self::Level => "table levelled twice as well",
            Self::Dial => "dial calibrated twice as well",
            Self::Gravity => "gravity measured to 1 mGal",
            Self::Remounting => "body turned 180 deg between runs",
            Self::Lean => "upright dwells set twice as well",
            Self::Curvature => "K2 and K3 known twice as well",
            Self::FitK2 => "K2 fitted",
            Self::FitK3 => "K3 fitted",
        }
    }
}

/// What a lever does.
#[derive(Debug, Clone, PartialEq)]
pub struct Gain {
    /// The lever.
    pub lever: Lever,
    /// What the plan would know with it.
    pub prediction: Prediction,
}

/// Levers that change the limiting term by more than this share are worth a line.
pub const WORTH_SAYING: f64 = 0.01;

/// Every lever that is not pulled yet.
pub(super) fn gains(problem: &PlanProblem, plan: &Layout, total_s: f64) -> Vec<Gain> {
    Lever::ALL
        .into_iter()
        .filter_map(|lever| Some(Gain { lever, prediction: with(problem, plan, total_s, lever)? }))
        .collect()
}

fn with(problem: &PlanProblem, plan: &Layout, total_s: f64, lever: Lever) -> Option<Prediction> {
    match lever {
        Lever::Minute => Some(longer(problem, &plan.prediction, 1.0 + 60.0 / total_s)),
        Lever::TwiceTheTime => {
            search::best_of(problem, 2.0 * total_s, search::COMPARED).map(|l| l.prediction)
        }
        Lever::TwoRuns => predict_plan(problem, &plan.sites, plan.dwell_s, plan.runs + 2),
        Lever::Upright | Lever::Range | Lever::FitK2 | Lever::FitK3 => {
            again(&pulled(problem, lever)?, plan)
        }
        _ => predict_plan(&pulled(problem, lever)?, &plan.sites, plan.dwell_s, plan.runs),
    }
}

/// The question with a lever pulled; `None` where that changes nothing, and for what is time and not the bench.
fn pulled(problem: &PlanProblem, lever: Lever) -> Option<PlanProblem> {
    let mut other = problem.clone();
    let half = |a: Angle| Angle::from_rad(0.5 * a.rad());
    let has_upright = problem.upright == Possible::Yes;
    match lever {
        Lever::Setting => other.setting_scatter = half(problem.setting_scatter),
        Lever::Level => halve(&mut other.systematics, &[Source::TiltAndLean, Source::DialZero]),
        Lever::Dial => halve(&mut other.systematics, &[Source::DialScale, Source::Eccentricity]),
        Lever::Curvature => halve(&mut other.systematics, &[Source::Nonlinearity]),
        Lever::Lean if has_upright => other.upright_lean = half(problem.upright_lean),
        Lever::Gravity if problem.gravity.standard_uncertainty_m_s2 > MEASURED_GRAVITY_M_S2 => {
            other.gravity.standard_uncertainty_m_s2 = MEASURED_GRAVITY_M_S2;
        }
        Lever::Remounting => other.remounting = Possible::Yes,
        Lever::Upright => other.upright = Possible::Yes,
        Lever::Range if problem.range.1.deg() < 90.0 && !has_upright => {
            other.range = (Angle::from_deg(-90.0), Angle::from_deg(90.0));
        }
        Lever::FitK2 if !problem.further_terms.contains(&Term::K2) => {
            other.further_terms.push(Term::K2);
        }
        Lever::FitK3 if !problem.further_terms.contains(&Term::K3) => {
            other.further_terms.push(Term::K3);
        }
        _ => {}
    }
    Some(other).filter(|o| o != problem)
}

/// Several levers that meet the targets together, in the order in which they help most; some are pulled more than once.
/// `None` where no such way is found.
pub(super) fn together(problem: &PlanProblem, plan: &Layout) -> Option<Vec<Lever>> {
    let mut now = problem.clone();
    let mut ratio = plan.prediction.worst_ratio();
    let mut out = Vec::new();
    while ratio > 1.0 && out.len() < MOST_PULLED {
        let best = Lever::ALL
            .into_iter()
            .filter_map(|lever| {
                let other = pulled(&now, lever)?;
                let ratio = again(&other, plan)?.worst_ratio();
                Some((ratio, lever, other))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|b| b.0 < ratio * (1.0 - WORTH_SAYING))?;
        (ratio, now) = (best.0, best.2);
        out.push(best.1);
    }
    Some(out).filter(|_| ratio <= 1.0)
}

/// Halves what some sources come from.
fn halve(inputs: &mut Inputs, sources: &[Source]) {
    let of_them = |l: &&mut Input| Source::of(l.quantity).is_some_and(|s| sources.contains(&s));
    inputs.lines.iter_mut().filter(of_them).for_each(|l| *l = l.scaled(0.5));
}

/// More levers than these are another bench.
const MOST_PULLED: usize = 8;
/// 1 mGal: any gravimeter, or a gravity base station within a few kilometres.
const MEASURED_GRAVITY_M_S2: f64 = 1e-5;

/// As many dwells of the same length, in as many runs.
fn again(problem: &PlanProblem, plan: &Layout) -> Option<Prediction> {
    let table = plan.sites.iter().filter(|s| !s.is_upright()).count();
    layout(problem, plan.dwell_s, table, plan.runs).map(|l| l.prediction)
}

/// The same plan with `factor` times the dwells: what scatters falls with the root.
fn longer(problem: &PlanProblem, p: &Prediction, factor: f64) -> Prediction {
    let mut out = p.clone();
    for t in &mut out.terms {
        for (source, u) in &mut t.sources {
            if source.averages_out() && *source != Source::BetweenRuns {
                *u /= factor.sqrt();
            }
        }
        let sum = |keep: &dyn Fn(Source) -> bool| {
            t.sources.iter().filter(|s| keep(s.0)).map(|s| s.1 * s.1).sum::<f64>().sqrt()
        };
        (t.u, t.u_statistical) = (sum(&|_| true), sum(&Source::averages_out));
    }
    debug_assert_eq!(problem.terms().len(), out.terms.len());
    out
}

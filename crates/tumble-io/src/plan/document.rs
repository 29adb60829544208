//! A plan as plain data: for JSON and for renderers.

use serde::Serialize;
use tumble_core::plan::{
    Gain, Lever, OrderEffect, Plan, Possible, Prediction, RunsChoice, Term, TermPrediction,
    WORTH_SAYING,
};

use super::PlanRequest;

/// A plan with what it was made from. Units stand in the names or beside the numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlanDocument {
    /// Version of this format.
    pub format: u32,
    /// Model of the sensor; empty where nobody named it.
    pub sensor: String,
    /// Whether all targets are met.
    pub met: bool,
    /// Whether somebody asked for these targets; else they are the defaults of `certify`.
    pub targets_stated: bool,
    /// Number of runs.
    pub runs: u32,
    /// Length of a dwell, s.
    pub dwell_s: f64,
    /// Time to set an angle, s.
    pub setting_s: f64,
    /// Time to settle, s.
    pub settle_s: f64,
    /// Time to stand the body upright, s.
    pub upright_s: f64,
    /// Time from power-up to the first dwell's setting, s.
    pub restart_s: f64,
    /// Time of a run, s.
    pub run_s: f64,
    /// Time of all runs, s.
    pub total_s: f64,
    /// Least time for the targets, s, as far as this plan tells; absent where no time would do.
    pub needed_s: Option<f64>,
    /// Dwells up and down at the start of each run.
    pub updown: bool,
    /// The body turned by 180° in every second run.
    pub remounting: bool,
    /// Dwells of each run, in order.
    pub positions: Vec<PlannedPosition>,
    /// Level of confidence of expanded uncertainties.
    pub level: f64,
    /// What the plan will know.
    pub predicted: Vec<PlannedTerm>,
    /// Criterion that chose the angles.
    pub criterion: String,
    /// Ratio to what no plan can beat under the same constraints, less one.
    pub gap: f64,
    /// What the spares cost, the same way.
    pub spare_price: f64,
    /// What drift would do.
    pub order: Vec<PlannedOrder>,
    /// The paper's plan in the same time.
    pub paper: Option<PlannedPaper>,
    /// One, three and five runs in the same time.
    pub by_runs: Vec<PlannedRuns>,
    /// What would help, the limiting term's.
    pub gains: Vec<PlannedGain>,
    /// What one more minute in all would buy.
    pub next_minute: Option<PlannedGain>,
    /// What would meet the targets together, where no single one does; absent where no way was found.
    pub together: Option<Vec<PlannedLever>>,
    /// Noise of a reading over one LSB.
    pub dither_lsb: Option<f64>,
    /// Whether repeats are spread over the step of the converter.
    pub phases_spread: bool,
    /// What nobody stated.
    pub assumed: Vec<String>,
}

/// One dwell.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedPosition {
    /// From one.
    pub number: usize,
    /// Dial angle; ±90 for upright dwells.
    pub angle_deg: f64,
    /// Stood off the table.
    pub upright: bool,
    /// There to test the model.
    pub spare: bool,
    /// The dial stands there already: turn away, and set it anew.
    pub set_anew: bool,
    /// Start of the dwell from power-up, s.
    pub start_s: f64,
}

/// One term.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedTerm {
    /// Name.
    pub term: String,
    /// Unit of all its numbers.
    pub unit: String,
    /// Standard uncertainty.
    pub u: f64,
    /// The part that repetition averages out.
    pub u_statistical: f64,
    /// Coverage factor.
    pub coverage_factor: f64,
    /// Expanded uncertainty.
    pub expanded: f64,
    /// Its target, where it is wanted.
    pub target: Option<f64>,
    /// By source, the largest first.
    pub sources: Vec<PlannedSource>,
}

/// One source of a term's uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedSource {
    /// Name.
    pub source: String,
    /// For people.
    pub words: String,
    /// Standard uncertainty.
    pub u: f64,
}

/// What drift would do to a term: shift by a line and by a bow of 1 m/s² over the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedOrder {
    /// Name.
    pub term: String,
    /// One sweep in rising order: a line.
    pub line_sorted: f64,
    /// In this order.
    pub line: f64,
    /// One sweep in rising order: a bow.
    pub bow_sorted: f64,
    /// In this order.
    pub bow: f64,
}

/// The paper's plan.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedPaper {
    /// Positions of a run.
    pub positions: usize,
    /// Length of a dwell, s.
    pub dwell_s: f64,
    /// What it will know.
    pub predicted: Vec<PlannedTerm>,
}

/// A number of runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedRuns {
    /// Number.
    pub runs: u32,
    /// Largest expanded uncertainty over target; absent where there is no time for it.
    pub worst_ratio: Option<f64>,
}

/// What would help.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedGain {
    /// Name.
    pub lever: String,
    /// For people.
    pub words: String,
    /// Expanded uncertainty of the limiting term with it.
    pub expanded: f64,
    /// Largest expanded uncertainty over target with it.
    pub worst_ratio: f64,
    /// Whether all targets would be met.
    pub met: bool,
}

/// Something to change about the bench or the question.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedLever {
    /// Name.
    pub lever: String,
    /// For people.
    pub words: String,
    /// How often: twice is a quarter where once is half.
    pub times: usize,
}

/// Unit of a term's numbers.
fn unit(term: Term) -> &'static str {
    match term {
        Term::Bias => "m/s2",
        Term::Misalignment => "rad",
        Term::ScaleError => "1",
        _ => term.further().map_or("", tumble_core::estimate::Term::unit),
    }
}

impl PlanDocument {
    /// Of a plan.
    #[must_use]
    pub fn new(request: &PlanRequest, plan: &Plan) -> Self {
        let p = &request.problem;
        let limiting = plan.prediction.limiting().map_or(Term::Bias, |t| t.term);
        let now = plan.prediction.worst_ratio();
        let gain = |g: &Gain| PlannedGain::of(g, limiting);
        // The next minute has a line of its own, however little it buys.
        let gains = plan
            .gains
            .iter()
            .filter(|g| g.lever != Lever::Minute)
            .filter(|g| g.prediction.worst_ratio() < now * (1.0 - WORTH_SAYING))
            .filter_map(gain)
            .collect();
        let next_minute = plan.gains.iter().find(|g| g.lever == Lever::Minute).and_then(gain);
        Self {
            format: 1,
            sensor: request.sensor.clone(),
            met: plan.met,
            targets_stated: p.targets.iter().any(Option::is_some),
            runs: plan.runs,
            dwell_s: plan.dwell_s,
            setting_s: p.times.setting_s,
            settle_s: p.times.settle_s,
            upright_s: p.times.upright_s,
            restart_s: p.times.restart_s,
            run_s: plan.run_s,
            total_s: plan.total_s,
            needed_s: plan.needed_s,
            updown: p.upright == Possible::Yes,
            remounting: p.remounting == Possible::Yes,
            positions: positions(plan),
            level: p.level,
            predicted: predicted(&plan.prediction),
            criterion: p.criterion.name().into(),
            gap: plan.gap,
            spare_price: plan.spare_price,
            order: plan.order.iter().map(PlannedOrder::of).collect(),
            paper: plan.paper.as_ref().map(|q| PlannedPaper {
                positions: q.positions,
                dwell_s: q.dwell_s,
                predicted: predicted(&q.prediction),
            }),
            by_runs: plan.by_runs.iter().map(PlannedRuns::of).collect(),
            gains,
            next_minute,
            together: plan.together.as_deref().map(levers),
            dither_lsb: plan.dither_lsb,
            phases_spread: plan.phases_spread,
            assumed: request.assumed.clone(),
        }
    }

    /// As JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Plain data of finite numbers always serializes.
        serde_json::to_string_pretty(self).map(|t| t + "\n").unwrap_or_default()
    }
}

impl PlannedOrder {
    fn of(o: &OrderEffect) -> Self {
        Self {
            term: o.term.name().into(),
            line_sorted: o.linear_sorted,
            line: o.linear,
            bow_sorted: o.bow_sorted,
            bow: o.bow,
        }
    }
}

impl PlannedRuns {
    fn of(r: &RunsChoice) -> Self {
        let worst_ratio = r.prediction.as_ref().map(Prediction::worst_ratio);
        Self { runs: r.runs, worst_ratio }
    }
}

impl PlannedGain {
    /// `None` where it does not fit the limiting term.
    fn of(g: &Gain, limiting: Term) -> Option<Self> {
        Some(Self {
            lever: g.lever.name().into(),
            words: g.lever.words().into(),
            expanded: g.prediction.of(limiting)?.expanded(),
            worst_ratio: g.prediction.worst_ratio(),
            met: g.prediction.worst_ratio() <= 1.0,
        })
    }
}

/// In the order in which they were pulled first.
fn levers(pulled: &[Lever]) -> Vec<PlannedLever> {
    let mut out: Vec<PlannedLever> = Vec::new();
    for lever in pulled {
        match out.iter_mut().find(|l| l.lever == lever.name()) {
            Some(there) => there.times += 1,
            None => out.push(PlannedLever {
                lever: lever.name().into(),
                words: lever.words().into(),
                times: 1,
            }),
        }
    }
    out
}

fn positions(plan: &Plan) -> Vec<PlannedPosition> {
    let tidy = |deg: f64| (deg * 1e6).round() / 1e6;
    plan.sites
        .iter()
        .zip(&plan.starts_s)
        .enumerate()
        .map(|(i, (site, start_s))| PlannedPosition {
            number: i + 1,
            // Never −0.
            angle_deg: tidy(site.angle.deg()) + 0.0,
            upright: site.is_upright(),
            spare: plan.spares.contains(site),
            set_anew: i > 0 && plan.sites[i - 1] == *site,
            start_s: *start_s,
        })
        .collect()
}

fn predicted(p: &Prediction) -> Vec<PlannedTerm> {
    p.terms.iter().map(term).collect()
}

fn term(t: &TermPrediction) -> PlannedTerm {
    let mut sources: Vec<PlannedSource> = t
        .sources
        .iter()
        .map(|(s, u)| PlannedSource { source: s.name().into(), words: s.words().into(), u: *u })
        .collect();
    sources.sort_by(|a, b| b.u.total_cmp(&a.u));
    PlannedTerm {
        term: t.term.name().into(),
        unit: unit(t.term).into(),
        u: t.u,
        u_statistical: t.u_statistical,
        coverage_factor: t.coverage_factor,
        expanded: t.expanded(),
        target: t.target,
        sources,
    }
}

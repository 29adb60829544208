//! One plan for a given number of positions and length of dwell.

use super::candidates::{Dial, Rows};
use super::exact::exact;
use super::order::{OrderEffect, effects, ordered, whole};
use super::predict::{Prediction, predict_plan};
use super::problem::{PlanProblem, Possible, Site};
use super::relax::{TOLERANCE, Tangent, relax};
use super::{phases, spare};

/// What neighbours on the dial in the place of one angle may cost (variances).
const TURN_COSTS: f64 = 1.004;

/// A plan with what was given away for it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    /// Upright dwells first, then the table in order.
    pub sites: Vec<Site>,
    pub spares: Vec<Site>,
    pub dwell_s: f64,
    pub runs: u32,
    pub gap: f64,
    pub spare_price: f64,
    pub order: Vec<OrderEffect>,
    pub prediction: Prediction,
}

/// Finds angles, spares and order. `None` where the terms are not told apart, or the positions are too few.
pub(super) fn layout(
    problem: &PlanProblem,
    dwell_s: f64,
    positions: usize,
    runs: u32,
) -> Option<Layout> {
    let rows = Rows::new(problem, dwell_s);
    let dial = Dial::of(problem);
    let free = positions.checked_sub(problem.spares).filter(|n| *n > 0)?;
    let coarse = dial.coarse();
    let coarse_rows = rows.rows(&coarse);
    let goal = rows.goal();
    let upright = rows.information(rows.upright());
    // Without spares, for their price and to know where not to put them.
    let all_free = relax(&coarse_rows, &upright, positions as f64, &goal, TOLERANCE)?;
    let support = exact(&rows, &dial, &coarse, &all_free, &upright, positions, &goal);
    let spares = spare::spares(&rows, &dial, &support, problem.spares);
    let free = free + problem.spares - spares.len();
    let mut fixed = upright;
    spares.iter().for_each(|s| fixed.add(&rows.row(*s), 1.0));
    let relaxed = relax(&coarse_rows, &fixed, free as f64, &goal, TOLERANCE)?;
    let counted = exact(&rows, &dial, &coarse, &relaxed, &fixed, free, &goal);
    let laid = |counted: &[(Site, usize)]| {
        let mut table = phases::spread(problem, &dial, counted);
        table.extend(&spares);
        let value = goal.value(&rows.information(&whole(&rows, &table)))?;
        Some((value, table))
    };
    // Neighbours on the dial in turn, where that costs next to nothing; else the same angle is set anew.
    let (same, turn) = (laid(&counted)?, laid(&phases::alternated(&dial, &counted, positions))?);
    let (value, table) = if turn.0 <= same.0 * TURN_COSTS { turn } else { same };
    let every_step = rows.rows(&dial.all());
    let everywhere = 0..every_step.len();
    let one = core::slice::from_ref(&everywhere);
    let tangent = Tangent::of(&every_step, one, &coarse_rows, &relaxed, &fixed, &goal)?;
    let least = tangent.bound(&[free as f64])?.max(f64::MIN_POSITIVE);
    let sites = ordered(&rows, &table)?;
    Some(Layout {
        order: effects(&rows, &sites)?,
        prediction: predict_plan(problem, &sites, dwell_s, runs)?,
        sites,
        spares,
        dwell_s,
        runs,
        gap: (value / least).sqrt() - 1.0,
        spare_price: (least / all_free.bound.max(f64::MIN_POSITIVE)).sqrt() - 1.0,
    })
}

/// Time of one run with some positions on the table, s: from power-up to the end of the last dwell.
pub(super) fn run_s(problem: &PlanProblem, positions: usize, dwell_s: f64) -> f64 {
    let t = &problem.times;
    let handling = match problem.upright {
        // Up, down, and onto the table; then one turn less.
        Possible::Yes => 3.0 * t.upright_s - t.setting_s + 2.0 * (t.settle_s + dwell_s),
        Possible::No => 0.0,
    };
    t.restart_s + handling + positions as f64 * (t.setting_s + t.settle_s + dwell_s)
}

/// The dwell that fills the time of a run, whole seconds; `None` below zero.
pub(super) fn filling_dwell_s(
    problem: &PlanProblem,
    positions: usize,
    run_s_wanted: f64,
) -> Option<f64> {
    let dwells = positions as f64 + if problem.upright == Possible::Yes { 2.0 } else { 0.0 };
    let left = run_s_wanted - run_s(problem, positions, 0.0);
    Some((left / dwells + 1e-9).floor()).filter(|t| *t >= 1.0)
}

//! The plan on a terminal: the answer first, 80 columns, ASCII.

use std::fmt::Write as _;

use tumble_io::{PlanDocument, PlannedLever, PlannedTerm};

use super::units::{name, number, scale, shown};
use super::{angles, degrees, duration};
use crate::numbers::{fixed, significant};
use crate::sanitize::clean_text;
use crate::words::{counted, shortened, wrapped};

const WIDTH: usize = 80;
/// Column at which values start.
const VALUES: usize = 16;
/// Share of a term's variance below which a source is not listed.
const LISTED: f64 = 0.001;

/// A plan for the terminal.
#[must_use]
pub fn plan_summary(d: &PlanDocument) -> String {
    let mut out = String::new();
    headline(&mut out, d);
    out.push('\n');
    subject(&mut out, d);
    out.push('\n');
    uncertainties(&mut out, d);
    out.push('\n');
    by_source(&mut out, d);
    out.push('\n');
    limits(&mut out, d);
    quality(&mut out, d);
    let heads = core::iter::once("assumed").chain(core::iter::repeat(""));
    for (head, sentence) in heads.zip(&d.assumed) {
        row(&mut out, head, &clean_text(sentence));
    }
    out
}

fn row(out: &mut String, name: &str, value: &str) {
    let lead = format!("  {name:<width$}", width = VALUES - 2);
    out.push_str(&wrapped(&lead, value, VALUES, WIDTH));
}

/// A ratio in words: times.
fn times(ratio: f64) -> String {
    if ratio < 10.0 { fixed(ratio, 1) } else { fixed(ratio, 0) }
}

fn limiting(d: &PlanDocument) -> Option<&PlannedTerm> {
    let ratio = |t: &PlannedTerm| t.target.map_or(0.0, |target| t.expanded / target);
    d.predicted.iter().filter(|t| t.target.is_some()).max_by(|a, b| ratio(a).total_cmp(&ratio(b)))
}

fn headline(out: &mut String, d: &PlanDocument) {
    let what = format!(
        "{} of {} of {}, {} in all.",
        counted(d.runs as usize, "run"),
        counted(d.positions.len(), "dwell"),
        duration(d.dwell_s),
        duration(d.total_s)
    );
    if d.met {
        let met =
            if d.targets_stated { "All targets are met." } else { "The usual targets are met." };
        out.push_str(&wrapped("PLAN - ", &format!("{what} {met}"), 7, WIDTH));
        return;
    }
    if !d.targets_stated {
        let missed = "The usual targets are missed: see what limits, or name yours with --target.";
        out.push_str(&wrapped("PLAN - ", &format!("{what} {missed}"), 7, WIDTH));
        return;
    }
    out.push_str(&wrapped("TARGETS NOT MET - ", &format!("the best plan: {what}"), 18, WIDTH));
    for t in &d.predicted {
        if let Some(target) = t.target.filter(|target| t.expanded > *target) {
            let text = format!(
                "{} will be known to {}, {} times the target of {}.",
                name(&t.term),
                shown(&t.term, t.expanded),
                times(t.expanded / target),
                shown(&t.term, target)
            );
            out.push_str(&wrapped("  ", &text, 2, WIDTH));
        }
    }
    let could = d.gains.iter().filter(|g| g.met && g.lever != "twice_the_time");
    let mut could: Vec<String> = could.map(|g| g.words.clone()).collect();
    if let Some(t) = d.needed_s.filter(|t| *t > d.total_s) {
        could.insert(0, format!("about {} in all", duration(t)));
    }
    let text = match (&d.together, could.is_empty()) {
        (_, false) => format!("What would meet them: {}.", could.join("; or ")),
        (Some(levers), true) => {
            let each: Vec<String> = levers.iter().map(repeated).collect();
            format!("What would meet them, together: {}.", each.join("; "))
        }
        (None, true) => {
            "No time meets them, nor what was tried of the bench: the targets must be wider, or \
                         the bench another one."
                .into()
        }
    };
    out.push_str(&wrapped("  ", &text, 2, WIDTH));
}

/// A change with how often: what is halved twice is a quarter.
fn repeated(l: &PlannedLever) -> String {
    match l.times {
        1 => l.words.clone(),
        n => format!("{}, and that {n} times over", l.words),
    }
}

fn subject(out: &mut String, d: &PlanDocument) {
    if !d.sensor.is_empty() {
        row(out, "sensor", &shortened(&clean_text(&d.sensor), 40));
    }
    let list = |spare| {
        let each = angles(d, spare).into_iter().map(|(a, n)| match n {
            1 => degrees(a),
            n => format!("{} ({n}x)", degrees(a)),
        });
        each.collect::<Vec<_>>().join("  ")
    };
    let upright = if d.updown { "up, down;  " } else { "" };
    row(out, "angles, deg", &format!("{upright}{}", list(false)));
    let spares = list(true);
    if !spares.is_empty() {
        row(out, "spare angles", &format!("{spares}   (they test the model)"));
    }
    row(
        out,
        "each dwell",
        &format!(
            "set {}, settle {}, read {}; a run takes {} from power-up",
            duration(d.setting_s),
            duration(d.settle_s),
            duration(d.dwell_s),
            duration(d.run_s)
        ),
    );
    if d.remounting {
        row(out, "mounting", "turn the body by 180 deg on the platform for every second run");
    }
}

fn uncertainties(out: &mut String, d: &PlanDocument) {
    let _ = writeln!(
        out,
        "  {:<14}{:<18}{:<16}{:<13}the paper's plan",
        "",
        format!("known to ({} %)", significant(d.level * 100.0, 2)),
        "target",
        "of target"
    );
    for t in &d.predicted {
        let target = t.target.map_or_else(|| "-".into(), |v| shown(&t.term, v));
        let ratio = t.target.map_or_else(
            || "-".into(),
            |v| format!("{} %", significant(100.0 * t.expanded / v, 2)),
        );
        let paper = d
            .paper
            .as_ref()
            .and_then(|p| p.predicted.iter().find(|q| q.term == t.term))
            .map_or_else(
                || "-".into(),
                |q| format!("{} times that", times(q.expanded / t.expanded)),
            );
        let line = format!(
            "  {:<14}{:<18}{target:<16}{ratio:<13}{paper}",
            name(&t.term),
            shown(&t.term, t.expanded),
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
}

fn by_source(out: &mut String, d: &PlanDocument) {
    let wide = ((WIDTH - 28) / d.predicted.len().max(1)).min(13);
    let mut head = format!("  {:<26}", "standard uncertainty by");
    for t in &d.predicted {
        let _ = write!(head, "{:>wide$}", shortened(name(&t.term), wide - 1));
    }
    let _ = writeln!(out, "{head}");
    let mut units = format!("  {:<26}", "");
    for t in &d.predicted {
        let _ = write!(units, "{:>wide$}", scale(&t.term).1);
    }
    let _ = writeln!(out, "{units}");
    let mut names: Vec<(&str, &str)> = Vec::new();
    for t in &d.predicted {
        for s in &t.sources {
            let counts = s.u * s.u > LISTED * t.u * t.u;
            if counts && !names.iter().any(|n| n.0 == s.source) {
                names.push((&s.source, &s.words));
            }
        }
    }
    for (source, words) in names {
        let mut line = format!("  {words:<26}");
        for t in &d.predicted {
            let u = t.sources.iter().find(|s| s.source == source).map(|s| s.u);
            let _ = write!(line, "{:>wide$}", u.map_or_else(|| "-".into(), |u| number(&t.term, u)));
        }
        let _ = writeln!(out, "{line}");
    }
    let mut line = format!("  {:<26}", "together");
    for t in &d.predicted {
        let _ = write!(line, "{:>wide$}", number(&t.term, t.u));
    }
    let _ = writeln!(out, "{line}");
}

fn limits(out: &mut String, d: &PlanDocument) {
    let Some(t) = limiting(d) else { return };
    if let Some(s) = t.sources.first() {
        let share = 100.0 * (s.u / t.u).powi(2);
        row(
            out,
            "limited by",
            &format!("{}, in {}: {} % of its variance", s.words, name(&t.term), fixed(share, 0)),
        );
    }
    if let Some(minute) = &d.next_minute {
        let share = 100.0 * (1.0 - minute.expanded / t.expanded);
        let text = format!("takes {} % off {}", significant(share.max(0.001), 1), name(&t.term));
        row(out, "next minute", &text);
    }
    if d.gains.is_empty() {
        row(out, "would help", "nothing that was tried, by a hundredth or more");
        return;
    }
    let lead = format!("{} to (now {}):", name(&t.term), shown(&t.term, t.expanded));
    let list: Vec<String> = d
        .gains
        .iter()
        .map(|g| format!("{} with {}", shown(&t.term, g.expanded), g.words))
        .collect();
    row(out, "would help", &lead);
    for line in list {
        row(out, "", &format!("  {line}"));
    }
}

/// The paper's plan by what the choice of angles can change.
fn paper(out: &mut String, d: &PlanDocument) {
    let Some(p) = &d.paper else { return };
    let each: Vec<String> = d
        .predicted
        .iter()
        .filter_map(|t| {
            let theirs = p.predicted.iter().find(|q| q.term == t.term)?;
            let ratio = theirs.u_statistical / t.u_statistical;
            Some(format!("{} {}", name(&t.term), times(ratio))).filter(|_| ratio.is_finite())
        })
        .collect();
    let text = format!(
        "-30 to 29 deg, {} dwells of {}, in the same time scatters {} times as much",
        p.positions,
        duration(p.dwell_s),
        each.join(", ")
    );
    row(out, "paper's plan", &text);
}

fn quality(out: &mut String, d: &PlanDocument) {
    paper(out, d);
    let mut best = format!(
        "no plan with these spares, steps and times is more than {} % better",
        significant((100.0 * d.gap).max(0.01), 2)
    );
    if d.positions.iter().any(|p| p.spare) {
        let _ = write!(best, "; the spares cost {} %", fixed(100.0 * d.spare_price, 1));
    }
    row(out, "best possible", &best);
    let worst = |f: &dyn Fn(&tumble_io::PlannedOrder) -> f64| {
        d.order.iter().find(|o| o.term == "bias").map_or(0.0, f)
    };
    let before = worst(&|o| o.line_sorted.hypot(o.bow_sorted));
    let after = worst(&|o| o.line.hypot(o.bow));
    row(
        out,
        "order",
        &format!(
            "1 mm/s2 of drift (line and bow) in a run moves the bias by {} mm/s2; in one sweep {}",
            significant(after, 2),
            significant(before, 2)
        ),
    );
    let each: Vec<String> = d
        .by_runs
        .iter()
        .map(|r| match r.worst_ratio {
            Some(v) => format!("{}: {} %", r.runs, significant(100.0 * v, 2)),
            None => format!("{}: no time", r.runs),
        })
        .collect();
    row(
        out,
        "runs",
        &format!(
            "of target, in this time, with {}; one shows nothing of the next power-up",
            each.join(", ")
        ),
    );
    if let Some(s) = d.dither_lsb {
        let spread = if d.phases_spread { "; repeats are spread over its step" } else { "" };
        row(out, "converter", &format!("noise of {} LSB a reading{spread}", significant(s, 2)));
    }
}

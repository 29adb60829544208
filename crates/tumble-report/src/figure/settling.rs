//! Figure 1: how the estimates settle as positions are added.

use maud::{Markup, html};
use tumble_io::passport::{Estimate, Passport, Run};

use super::Figure;
use super::axis::{Axis, drawable, range};
use super::canvas::{WIDTH, c, document, label};
use super::legend::{Sample, legend};
use super::mark::{colour, marker, upright};
use crate::runs::{MOST_RUNS, Panel, panels};
use crate::standing::Standing;
use crate::units::Units;
use crate::words::shortened;

const LEFT: f64 = 84.0;
/// Room at the right for the runs' final intervals.
const FINAL: f64 = 78.0;
const PANEL: f64 = 150.0;
const GAP: f64 = 40.0;
/// The first estimates are wild and are cut off: the range holds what the estimates do from a third of the run on,
/// but at least and at most so many half-widths of the run's final interval.
const HALF_RANGE: (f64, f64) = (4.0, 8.0);

/// Absent without estimates in a sequence, or where they may not be shown.
pub(super) fn figure(passport: &Passport) -> Option<Figure> {
    if !Standing::of(passport).has_estimates() {
        return None;
    }
    let units = Units::of(passport);
    let mut panels = panels(passport, &units);
    for p in &mut panels {
        p.runs.retain(|(_, r, _)| r.sequential.len() > 1);
    }
    panels.retain(|p| !p.runs.is_empty());
    let shown: Vec<(usize, &Run)> = passport
        .runs
        .iter()
        .enumerate()
        .take(MOST_RUNS)
        .filter(|(_, r)| r.sequential.len() > 1)
        .collect();
    let most = shown.iter().flat_map(|(_, r)| &r.sequential).map(|s| s.positions).max()?;
    let x = Axis::new((0.0, most as f64), (LEFT, WIDTH - FINAL), 8.0)?;

    let settled = shown.iter().any(|(_, r)| r.settled_at.is_some());
    let banded = panels.iter().any(|p| p.result.is_some_and(|r| r.interval.is_some()));
    let (keys, top) = keys(&shown, settled, banded);
    let mut drawn = Vec::new();
    for p in &panels {
        let at = top + 14.0 + drawn.len() as f64 * (PANEL + GAP);
        drawn.extend(panel(p, &x, at, drawn.len()));
    }
    if drawn.is_empty() {
        return None;
    }
    let bottom = top + 14.0 + drawn.len() as f64 * (PANEL + GAP) - GAP + 20.0;
    let body = html! {
        (keys)
        @for p in &drawn { (p) }
        (label((LEFT + WIDTH - FINAL) / 2.0, bottom + 13.0, "name middle", "Number of positions, in measured order"))
    };
    let title = "How the estimates settle".to_owned();
    let caption = caption(shown.len(), passport.runs.len(), settled, banded);
    let svg = document("settling", &title, &caption, bottom + 22.0, &body);
    Some(Figure { name: "settling", title, caption, svg })
}

fn caption(shown: usize, all: usize, settled: bool, banded: bool) -> String {
    let mut text = String::from(
        "Estimates from the first positions alone, in measured order. The first ones are wild and cut off. \
         At the right each run's final interval.",
    );
    if banded {
        text.push_str(" Shaded: the result with its expanded uncertainty.");
    }
    if settled {
        text.push_str(
            " A marker on a line is where the run settled: from there on all three estimates stay within the run's \
             final expanded uncertainty.",
        );
    }
    if shown < all {
        text.push_str(&format!(" Shown: {shown} of {all} runs."));
    }
    text
}

fn keys(shown: &[(usize, &Run)], settled: bool, banded: bool) -> (Markup, f64) {
    let mut entries: Vec<(Sample, String)> =
        shown.iter().map(|(i, r)| (Sample::Line(*i), shortened(&r.name, 18))).collect();
    if settled {
        entries.push((Sample::Place, "settled".into()));
    }
    if banded {
        entries.push((Sample::Band(0), "result ± U".into()));
    }
    entries.push((Sample::Interval, "final interval of a run".into()));
    legend(&entries, (LEFT - 10.0, WIDTH - 10.0), 6.0)
}

/// Half-width of what is drawn around a run's final estimate, in the panel's unit.
fn half_range(p: &Panel<'_>, run: &Run, e: &Estimate) -> f64 {
    let last = p.unit.of(e.value);
    let third = run.positions / 3;
    let late = run.sequential.iter().filter(|s| s.positions >= third);
    let moved = range(late.map(|s| (p.sequential(s) - last).abs())).map_or(0.0, |(_, most)| most);
    match e.interval {
        Some([lo, hi]) => {
            let own = (p.unit.of(hi - lo) / 2.0).abs();
            moved.max(HALF_RANGE.0 * own).min(HALF_RANGE.1 * own)
        }
        None => 1.2 * moved,
    }
}

fn panel(p: &Panel<'_>, x: &Axis, top: f64, index: usize) -> Option<Markup> {
    let wanted = p.runs.iter().flat_map(|(_, r, e)| {
        let (v, h) = (p.unit.of(e.value), half_range(p, r, e));
        [v - h, v + h]
    });
    let result = p.result.and_then(|r| r.interval).map(|i| i.map(|v| p.unit.of(v)));
    let y = Axis::new(range(wanted.chain(result.into_iter().flatten()))?, (top + PANEL, top), 5.0)?;
    let clip = format!("tumble-settling-clip-{index}");
    let right = WIDTH - FINAL;
    let spacing = (56.0 / p.runs.len() as f64).min(11.0);
    Some(html! {
        clipPath id=(clip) {
            rect x=(c(LEFT)) y=(c(top)) width=(c(right - LEFT)) height=(c(PANEL)) {}
        }
        (x.bottom(top + PANEL, top, None))
        (y.left(LEFT, right, &y.title(p.parameter.name(), &p.unit.name)))
        @if p.title != p.parameter.name() {
            (label(right - 4.0, top - 5.0, "panel end", &p.title))
        }
        g clip-path={ "url(#" (clip) ")" } {
            @if let Some([lo, hi]) = result {
                rect class="band s0" x=(c(LEFT)) width=(c(right - LEFT))
                    y=(c(y.at(hi))) height=(c((y.at(lo) - y.at(hi)).max(0.5))) {}
            }
            @for (i, run, _) in &p.runs {
                path class={ "line " (colour(*i)) } d=(trace(p, run, x, &y)) {}
                @if let Some((sx, sy)) = settled_point(p, run, x, &y) {
                    path class={ "dot " (colour(*i)) } d=(marker(*i, sx, sy, 4.2)) {}
                }
            }
        }
        @for (place, (i, _, e)) in p.runs.iter().enumerate() {
            @if let Some([lo, hi]) = e.interval.map(|v| v.map(|v| p.unit.of(v))) {
                @if y.holds(lo) && y.holds(hi) {
                    @let at = right + 10.0 + place as f64 * spacing;
                    path class={ "bar " (colour(*i)) } d=(upright(at, y.at(lo), y.at(hi), 2.5)) {}
                    path class={ "dot " (colour(*i)) } d=(marker(*i, at, y.at(p.unit.of(e.value)), 3.0)) {}
                }
            }
        }
    })
}

fn trace(p: &Panel<'_>, run: &Run, x: &Axis, y: &Axis) -> String {
    let mut path = String::new();
    for s in &run.sequential {
        let v = p.sequential(s);
        if drawable(v) {
            path.push(if path.is_empty() { 'M' } else { 'L' });
            path.push_str(&format!("{} {}", c(x.at(s.positions as f64)), c(y.at(v))));
        }
    }
    path
}

fn settled_point(p: &Panel<'_>, run: &Run, x: &Axis, y: &Axis) -> Option<(f64, f64)> {
    let at = run.settled_at?;
    // Long sequences are thinned: the first estimate that is kept from there on.
    let s = run.sequential.iter().find(|s| s.positions >= at)?;
    let v = p.sequential(s);
    y.holds(v).then(|| (x.at(s.positions as f64), y.at(v)))
}

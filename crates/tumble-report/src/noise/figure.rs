//! Deviation against averaging time, both logarithmic.

use maud::{Markup, html};
use tumble_io::noise::{CurveEntry, NoiseDocument};

use super::{deviation_name, duration, stated};
use crate::Figure;
use crate::figure::parts::{Sample, WIDTH, c, colour, document, drawable, label, legend, marker};
use crate::numbers::{power_of_ten, significant, typographic};

const LEFT: f64 = 84.0;
const RIGHT: f64 = WIDTH - 16.0;
const HEIGHT: f64 = 380.0;
/// Points that are drawn with a marker and a bar; more are a line.
const MOST_MARKED: usize = 80;
/// Colour of the converter's line.
const ROUNDING: usize = 4;
/// Curves stand so far beside one another: bars on one place could not be told apart.
const APART: f64 = 4.0;
/// Symbols of the components.
const SYMBOLS: [&str; 5] = ["Q", "N", "B", "K", "R"];

/// A logarithmic axis.
struct Log {
    lo: f64,
    hi: f64,
    from: f64,
    to: f64,
}

impl Log {
    fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Option<Self> {
        let logs = values.filter(|v| drawable(*v) && *v > 0.0).map(f64::log10);
        let (lo, hi) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        // At least half a decade, or nothing could be seen.
        let margin = (0.5 - (hi - lo)).max(0.0) / 2.0 + 0.04 * (hi - lo);
        (lo <= hi).then_some(Self { lo: lo - margin, hi: hi + margin, from, to })
    }

    fn at(&self, v: f64) -> f64 {
        let part = ((v.log10() - self.lo) / (self.hi - self.lo)).clamp(-0.5, 1.5);
        self.from + part * (self.to - self.from)
    }

    /// Decades; with 2 and 5 between them where the axis is short.
    fn ticks(&self) -> Vec<(f64, String)> {
        let between: &[f64] = if self.hi - self.lo < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (first, last) = (self.lo.floor() as i32, self.hi.ceil() as i32);
        let all = (first..=last).flat_map(|e| between.iter().map(move |m| (*m, e)));
        all.map(|(m, e)| (m * 10f64.powi(e), m, e))
            .filter(|(v, _, _)| (self.lo..=self.hi).contains(&v.log10()))
            .map(|(v, m, e)| {
                let text = match (-3..=4).contains(&e) {
                    true => typographic(&significant(v, 1)),
                    false if m == 1.0 => power_of_ten(e),
                    false => format!("{m}·{}", power_of_ten(e)),
                };
                (v, text)
            })
            .collect()
    }
}

pub(super) fn figure(d: &NoiseDocument) -> Option<Figure> {
    let allan = d.curves.first()?;
    let mut entries: Vec<(Sample, String)> = d
        .curves
        .iter()
        .enumerate()
        .map(|(i, curve)| (Sample::Marker(i), deviation_name(&curve.deviation).to_owned()))
        .collect();
    if d.fit.is_some() {
        entries.push((Sample::Plain(5), "fitted".into()));
        entries.push((Sample::Edge(5), "what each coefficient adds".into()));
    }
    let rounding = d.converter.as_ref().map_or(&[][..], |c| &c.line);
    if !rounding.is_empty() {
        entries.push((Sample::Dashed(ROUNDING), "rounding of the converter alone".into()));
    }
    let (keys, keys_height) = legend(&entries, (LEFT - 10.0, RIGHT), 6.0);
    let top = keys_height + 16.0;
    let bottom = top + HEIGHT;
    let points = || d.curves.iter().flat_map(|c| &c.points);
    let x = Log::new(points().map(|p| p.tau_s), LEFT, RIGHT)?;
    let bands = points().flat_map(|p| p.band.into_iter().flatten());
    let y = Log::new(points().map(|p| p.deviation).chain(bands), bottom, top)?;
    let body = html! {
        (keys)
        clipPath id="tumble-noise-clip" {
            rect x=(c(LEFT)) y=(c(top)) width=(c(RIGHT - LEFT)) height=(c(HEIGHT)) {}
        }
        (axes(&x, &y, (top, bottom), d))
        g clip-path="url(#tumble-noise-clip)" {
            (model(d, &x, &y))
            path class={ "line dashed " (colour(ROUNDING)) } d=(path(rounding.iter().map(|[t, v]| (x.at(*t), y.at(*v))))) {}
            (best(d, &x, &y, (top, bottom)))
            @for (i, curve) in d.curves.iter().enumerate() {
                (measured(i, curve, &x, &y, APART * i as f64))
            }
            (symbols(d, &x, &y, (top, bottom)))
        }
    };
    let title = format!("Noise against the averaging time: {}", deviation_name(&allan.deviation));
    let caption = caption(d);
    let svg = document("noise", &title, &caption, bottom + 44.0, &body);
    Some(Figure { name: "noise", title, caption, svg })
}

fn caption(d: &NoiseDocument) -> String {
    let mut text = format!(
        "Both scales are logarithmic. Bars: band of {} % by the equivalent degrees of freedom.",
        stated(100.0 * d.level)
    );
    if d.fit.is_some() {
        text.push_str(
            " Slopes: Q −1, N −1/2, B 0, K +1/2, R +1. The line is their sum, fitted to the Allan variances with their \
             covariance.",
        );
    }
    if d.curves.len() > 1 {
        text.push_str(" Points of one time stand beside one another; those of the Allan deviation stand at it.");
    }
    if let Some(best) = &d.dwell {
        text.push_str(&format!(" The vertical line is the best dwell, {}.", duration(best.tau_s)));
    }
    text
}

fn axes(x: &Log, y: &Log, (top, bottom): (f64, f64), d: &NoiseDocument) -> Markup {
    let unit = if d.unit == "m/s2" { "m/s²" } else { &d.unit };
    let (tx, ty) = (LEFT - 62.0, (top + bottom) / 2.0);
    html! {
        @for (v, text) in x.ticks() {
            @let at = x.at(v);
            line .grid x1=(c(at)) x2=(c(at)) y1=(c(top)) y2=(c(bottom)) {}
            (label(at, bottom + 16.0, "tick middle", &text))
        }
        @for (v, text) in y.ticks() {
            @let at = y.at(v);
            line .grid x1=(c(LEFT)) x2=(c(RIGHT)) y1=(c(at)) y2=(c(at)) {}
            (label(LEFT - 7.0, at + 3.8, "tick end", &text))
        }
        line .axis x1=(c(LEFT)) x2=(c(RIGHT)) y1=(c(bottom)) y2=(c(bottom)) {}
        line .axis x1=(c(LEFT)) x2=(c(LEFT)) y1=(c(top)) y2=(c(bottom)) {}
        (label((LEFT + RIGHT) / 2.0, bottom + 34.0, "name middle", "averaging time τ, s"))
        text class="name middle" x=(c(tx)) y=(c(ty)) transform={ "rotate(-90 " (c(tx)) " " (c(ty)) ")" } {
            "deviation σ(τ), " (unit)
        }
    }
}

fn path(points: impl Iterator<Item = (f64, f64)>) -> String {
    let mut out = String::new();
    for (x, y) in points {
        out.push(if out.is_empty() { 'M' } else { 'L' });
        out.push_str(&format!("{} {}", c(x), c(y)));
    }
    out
}

fn model(d: &NoiseDocument, x: &Log, y: &Log) -> Markup {
    let Some(fit) = &d.fit else { return html! {} };
    let seen: Vec<usize> =
        (0..5).filter(|i| fit.coefficients.get(*i).is_some_and(|c| c.value > 0.0)).collect();
    html! {
        @for i in seen {
            path class={ "edge " (colour(5)) }
                d=(path(fit.curve.iter().map(|m| (x.at(m.tau_s), y.at(m.parts[i].max(f64::MIN_POSITIVE)))))) {}
        }
        path class={ "line " (colour(5)) } d=(path(fit.curve.iter().map(|m| (x.at(m.tau_s), y.at(m.deviation))))) {}
    }
}

/// Names of the parts, each where it is farthest from the curve and can still be seen.
fn symbols(d: &NoiseDocument, x: &Log, y: &Log, (top, bottom): (f64, f64)) -> Markup {
    let Some(fit) = &d.fit else { return html! {} };
    let place = |i: usize| {
        let seen = fit.curve.iter().filter(|m| {
            let at = y.at(m.parts[i].max(f64::MIN_POSITIVE));
            (top + 14.0..=bottom - 10.0).contains(&at)
        });
        seen.min_by(|a, b| (a.parts[i] / a.deviation).total_cmp(&(b.parts[i] / b.deviation)))
    };
    html! {
        @for i in 0..SYMBOLS.len() {
            @if let Some(m) = place(i) {
                (label((x.at(m.tau_s) + 7.0).clamp(LEFT + 6.0, RIGHT - 14.0), y.at(m.parts[i]) - 4.0, "key", SYMBOLS[i]))
            }
        }
    }
}

fn best(d: &NoiseDocument, x: &Log, y: &Log, (top, bottom): (f64, f64)) -> Markup {
    let Some(best) = &d.dwell else { return html! {} };
    let at = x.at(best.tau_s);
    html! {
        path class="edge ink" d=(format!("M{} {}V{}", c(at), c(top), c(bottom))) {}
        path class="dot ink" d=(marker(3, at, y.at(best.deviation), 7.0)) {}
        @let text = format!("best dwell {}", duration(best.tau_s));
        @if at < (LEFT + RIGHT) / 2.0 { (label(at + 6.0, top + 12.0, "key", &text)) }
        @else { (label(at - 6.0, top + 12.0, "key end", &text)) }
    }
}

fn measured(i: usize, curve: &CurveEntry, x: &Log, y: &Log, aside: f64) -> Markup {
    if curve.points.len() > MOST_MARKED {
        let line = path(curve.points.iter().map(|p| (x.at(p.tau_s), y.at(p.deviation))));
        return html! { path class={ "line " (colour(i)) } d=(line) {} };
    }
    html! {
        @for p in &curve.points {
            @if let Some([low, high]) = p.band {
                path class={ "bar " (colour(i)) }
                    d=(crate::figure::parts::upright(x.at(p.tau_s) + aside, y.at(high), y.at(low), 2.5)) {}
            }
            path class={ "dot " (colour(i)) } d=(marker(i, x.at(p.tau_s) + aside, y.at(p.deviation), 3.2)) {}
        }
    }
}

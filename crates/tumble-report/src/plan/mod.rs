//! A plan on a terminal and as a checklist on paper.

mod checklist;
mod summary;
mod units;

pub use checklist::plan_checklist;
pub use summary::plan_summary;

use tumble_io::PlanDocument;

/// Seconds as people say them.
fn duration(seconds: f64) -> String {
    let s = seconds.round();
    let (h, m) = ((s / 3600.0).floor(), (s % 3600.0 / 60.0).floor());
    match () {
        () if s < 120.0 => format!("{s} s"),
        () if h < 1.0 => format!("{} min", (s / 60.0).round()),
        () => format!("{h} h {m} min"),
    }
}

/// A time from the start, `12:05` minutes and seconds.
fn clock(seconds: f64) -> String {
    let s = seconds.round();
    format!("{}:{:02}", (s / 60.0).floor(), s % 60.0)
}

/// An angle of the dial.
fn degrees(deg: f64) -> String {
    let text = format!("{deg:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Angles of the table in rising order with how often each is set.
fn angles(d: &PlanDocument, spare: bool) -> Vec<(f64, usize)> {
    let mut all: Vec<f64> = d
        .positions
        .iter()
        .filter(|p| !p.upright && p.spare == spare)
        .map(|p| p.angle_deg)
        .collect();
    all.sort_by(f64::total_cmp);
    all.chunk_by(|a, b| a == b).map(|same| (same[0], same.len())).collect()
}

//! Figure 4: error before and after compensation.

use maud::{Markup, html};
use tumble_io::passport::Passport;

use super::Figure;
use super::axis::{Axis, drawable};
use super::canvas::{WIDTH, c, document, label};
use super::legend::{Sample, legend};
use super::mark::colour;
use crate::numbers::{significant, typographic};
use crate::runs::MOST_RUNS;
use crate::standing::Standing;
use crate::units::Units;
use crate::words::shortened;

const LEFT: f64 = 132.0;
const RIGHT: f64 = WIDTH - 70.0;
const BAR: f64 = 13.0;
const GAP: f64 = 12.0;

/// Name of a group and up to three bars: series colour and value.
type Group = (String, Vec<(usize, f64)>);

/// Absent without error levels, and where there are no coefficients to compensate with.
pub(super) fn figure(passport: &Passport) -> Option<Figure> {
    if !Standing::of(passport).has_coefficients() {
        return None;
    }
    let groups = groups(passport);
    let largest = groups.iter().flat_map(|(_, bars)| bars).map(|(_, v)| *v).fold(0.0, f64::max);
    let x = Axis::new((0.0, largest), (LEFT, RIGHT), 7.0).filter(|_| largest > 0.0)?;
    let units = Units::of(passport);
    let held_out = groups.iter().flat_map(|(_, bars)| bars).any(|(series, _)| *series == HELD_OUT);
    let mut entries = vec![
        (Sample::Box(BEFORE), "before compensation".to_owned()),
        (Sample::Box(AFTER), "after, own coefficients".to_owned()),
    ];
    if held_out {
        entries.push((
            Sample::Box(HELD_OUT),
            "after, coefficients of the other runs (held out)".to_owned(),
        ));
    }
    let (keys, top) = legend(&entries, (LEFT - 10.0, WIDTH - 10.0), 6.0);
    let top = top + 10.0;
    let height = |bars: usize| bars as f64 * BAR + GAP;
    let bottom = top + groups.iter().map(|(_, bars)| height(bars.len())).sum::<f64>();
    let mut at = top;
    let placed: Vec<(f64, &Group)> = groups
        .iter()
        .map(|g| {
            let here = at;
            at += height(g.1.len());
            (here, g)
        })
        .collect();
    let body = html! {
        (keys)
        (x.bottom(bottom, top, Some(&x.title("Error, root mean square", &units.reading))))
        @for (y, group) in &placed { (bars(group, *y, &x)) }
        line .axis x1=(c(LEFT)) x2=(c(LEFT)) y1=(c(top)) y2=(c(bottom)) {}
    };
    let title = "Error before and after compensation".to_owned();
    let mut caption = format!(
        "Root mean square of the compensated reading minus gravity's component, in {}. \"Own coefficients\" is \
         optimistic: the same positions made them.",
        units.reading
    );
    caption.push_str(if held_out {
        " \"Held out\" is the honest level: the coefficients come from the other runs."
    } else {
        " There is no held-out level: that needs another run."
    });
    let svg = document("error-level", &title, &caption, bottom + 44.0, &body);
    Some(Figure { name: "error-level", title, caption, svg })
}

/// Series of the three kinds of bar.
const BEFORE: usize = 5;
const AFTER: usize = 0;
const HELD_OUT: usize = 1;

fn groups(passport: &Passport) -> Vec<Group> {
    let bars = |before: f64, after: f64, held_out: Option<f64>| -> Vec<(usize, f64)> {
        [(BEFORE, Some(before)), (AFTER, Some(after)), (HELD_OUT, held_out)]
            .into_iter()
            .filter_map(|(series, v)| v.filter(|v| drawable(*v) && *v >= 0.0).map(|v| (series, v)))
            .collect()
    };
    let mut groups: Vec<Group> = passport
        .runs
        .iter()
        .take(MOST_RUNS)
        .filter_map(|r| {
            let e = r.error_level_lsb.as_ref()?;
            Some((shortened(&r.name, 17), bars(e.before, e.after, e.after_held_out)))
        })
        .collect();
    if let Some(e) = passport.error_level_lsb.as_ref().filter(|_| groups.len() != 1) {
        groups.push(("all runs".into(), bars(e.before, e.after, e.after_held_out)));
    }
    groups.retain(|(_, bars)| !bars.is_empty());
    groups
}

fn bars((name, bars): &Group, top: f64, x: &Axis) -> Markup {
    let height = bars.len() as f64 * BAR;
    html! {
        (label(LEFT - 10.0, top + GAP / 2.0 + height / 2.0 + 3.8, "end", name))
        @for (i, (series, value)) in bars.iter().enumerate() {
            @let y = top + GAP / 2.0 + i as f64 * BAR;
            rect class={ "solid " (colour(*series)) } x=(c(LEFT)) y=(c(y + 1.0))
                width=(c((x.at(*value) - LEFT).max(1.0))) height=(c(BAR - 2.0)) {}
            (label(x.at(*value) + 5.0, y + BAR - 3.0, "", &typographic(&significant(*value, 2))))
        }
    }
}

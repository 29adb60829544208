//! Misleading experiments: the truth is known; none is accepted with a wrong answer and nothing said.

use tumble_io::passport::{Estimate, Passport};

use crate::bench::{BIAS_LSB, Bench, Dwell, MISALIGNMENT_RAD, SCALE, level};
use crate::{G, K0, steps};

/// A case: its passport, and findings of which at least one must be there.
struct Case {
    name: &'static str,
    passport: Passport,
    says: &'static [&'static str],
}

fn case(name: &'static str, says: &'static [&'static str], bench: Bench) -> Case {
    Case { name, passport: bench.certify(), says }
}

fn wide() -> Vec<f64> {
    steps(-65.0, 65.0, 60)
}

/// A fixed order that mixes all angles.
fn mixed() -> Vec<f64> {
    let plan = wide();
    (0..60).map(|i| plan[(i * 37) % 60]).collect()
}

/// Values of the passport that are off the truth by more than their expanded uncertainty, in uncertainties.
fn wrong(p: &Passport) -> Vec<String> {
    let Some(r) = &p.result else { return Vec::new() };
    let off = |name: &str, e: &Estimate, truth: f64| {
        let u = e.expanded_uncertainty.unwrap_or(0.0);
        let off = (e.value - truth) / u;
        (off.abs() > 1.0 || off.is_nan()).then(|| format!("{name} off by {off:.1} U"))
    };
    let misalignments = r.misalignment.iter().chain(r.mountings.iter().map(|m| &m.misalignment));
    [off("bias", &r.bias, BIAS_LSB * SCALE), off("scale factor", &r.scale_factor, SCALE)]
        .into_iter()
        .chain(misalignments.map(|m| off("misalignment", m, MISALIGNMENT_RAD)))
        .flatten()
        .collect()
}

/// What is wrong with the answer to a case, if anything.
fn judged(c: &Case) -> Option<String> {
    let p = &c.passport;
    let ids: Vec<&str> = p.findings.iter().map(|f| f.id.as_str()).collect();
    let wrong = wrong(p);
    println!("{:52} {:13} {wrong:?} {ids:?}", c.name, p.verdict);
    let said = c.says.is_empty() || c.says.iter().any(|id| ids.contains(id));
    match (wrong.is_empty(), said) {
        (false, _) => Some(format!("{}: {wrong:?} {ids:?}", c.name)),
        (_, false) => Some(format!("{}: none of {:?} in {ids:?}", c.name, c.says)),
        _ => None,
    }
}

fn table_and_dial() -> Vec<Case> {
    let dial = |name, says, read: fn(f64) -> f64| {
        case(name, says, Bench::new(wide()).typed(move |d: Dwell| read(d.deg)))
    };
    vec![
        dial("eccentric dial, 30′", &["T0112", "T0111"], |d| {
            d + 0.5 * (d + 40.0).to_radians().sin()
        }),
        dial("dial scale off by 2 %", &["T0112"], |d| 1.02 * d),
        dial("gon read as degrees", &["T0112", "T0110"], |d| d / 0.9),
        dial("signs of the angles lost", &["T0110"], f64::abs),
        dial("degrees.minutes read as decimals", &["T0112", "T0111", "T0110"], |d| {
            let minutes = (60.0 * d.abs().fract()).round();
            d.signum() * (d.abs().trunc() + minutes / 100.0)
        }),
        dial("a tooth skipped: 1.5° more above 20°", &["T0110", "T0112", "T0111"], |d| {
            if d > 20.0 { d + 1.5 } else { d }
        }),
        dial("a dial that sticks: steps of 6°", &["T0110", "T0301"], |d| (d / 6.0).round() * 6.0),
        dial("angles rounded to 5°", &["T0110", "T0301"], |d| (d / 5.0).round() * 5.0),
        case(
            "angle of the dwell before, mixed order",
            &["T0110"],
            Bench::new(mixed()).typed(|d| {
                let plan = mixed();
                plan[(d.index + 59) % 60]
            }),
        ),
        case(
            "backlash: up and down sweeps 10′ apart",
            &["T0301"],
            Bench::new([wide(), steps(64.0, -64.0, 60)].concat())
                .code(|d| level(d.deg + if d.index < 60 { 0.083 } else { -0.083 }) + d.scatter),
        ),
    ]
}

fn mounting_and_runs() -> Vec<Case> {
    vec![
        case(
            "one of two runs reversed",
            &["T0101"],
            Bench { runs: 2, ..Bench::new(wide()) }
                .code(|d| level(if d.run == 1 { -d.deg } else { d.deg }) + d.scatter),
        ),
        case(
            "first half of a run in another mounting",
            &["T0110", "T0111", "T0112"],
            Bench::new(wide())
                .code(|d| level(d.deg + if d.index < 30 { 0.5 } else { 0.0 }) + d.scatter),
        ),
        case(
            "the body slips by 6′ half way",
            &["T0111", "T0112"],
            Bench::new(wide())
                .code(|d| level(d.deg + if d.index < 30 { 0.1 } else { 0.0 }) + d.scatter),
        ),
        case(
            "sine and cosine exchanged",
            &["T0105", "T0110", "T0103"],
            Bench::new(wide()).code(|d| level(90.0 - d.deg) + d.scatter),
        ),
        case(
            "runs of two sensors",
            &["T0208"],
            Bench { runs: 4, ..Bench::new(wide()) }.code(|d| {
                let other = if d.run % 2 == 1 { 1.02 } else { 1.0 };
                level(d.deg) * other + 6.0 * (other - 1.0) / 0.02 + d.scatter
            }),
        ),
        case(
            "one of three runs in mg",
            &["T0102", "T0103"],
            Bench::new(wide()).code(|d| {
                let code = level(d.deg) + d.scatter;
                if d.run == 2 { code * SCALE / 9.80665e-3 } else { code * 0.1 }
            }),
        ),
        case(
            "one of three runs at four times the gain",
            &["T0103"],
            Bench::new(wide())
                .code(|d| (level(d.deg) + d.scatter) * if d.run == 1 { 4.0 } else { 1.0 }),
        ),
        case(
            "one of three runs offset binary",
            &["T0104"],
            Bench::new(wide())
                .code(|d| level(d.deg) + d.scatter + if d.run == 1 { 2048.0 } else { 0.0 }),
        ),
        case(
            "mountings of three runs not told apart",
            &["T0208"],
            Bench::new(wide()).code(|d| {
                let turned = [0.0, 0.8, -0.8][d.run];
                level(d.deg + turned) + d.scatter
            }),
        ),
        case(
            "11 of 12 positions at one angle",
            &["T0201"],
            Bench::new([vec![30.0; 11], vec![-30.0]].concat()),
        ),
        case(
            "one reading copied to 11 of 12 angles",
            &["T0107"],
            Bench::new(steps(-60.0, 60.0, 12)).code(|d| {
                level(if d.index == 5 { d.deg } else { -60.0 })
                    + if d.index == 5 { d.scatter } else { 0.0 }
            }),
        ),
    ]
}

fn converter() -> Vec<Case> {
    let raw = |quantizer, converter: fn(f64) -> f64| Bench {
        quantizer,
        raw: Some((1.25, converter)),
        ..Bench::new(wide())
    };
    vec![
        case("floor declared truncate", &["T0111", "T0112", "T0311"], raw("truncate", f64::floor)),
        case("truncate declared floor", &["T0111", "T0112", "T0311"], raw("floor", f64::trunc)),
        case("the lowest bit is stuck", &["T0107"], raw("floor", |x| (x / 2.0).floor() * 2.0)),
        case(
            "the two lowest bits are stuck",
            &["T0107"],
            raw("floor", |x| (x / 4.0).floor() * 4.0),
        ),
        case(
            "the lowest bit is stuck at one",
            &["T0107"],
            raw("floor", |x| (x / 2.0).floor() * 2.0 + 1.0),
        ),
        case(
            "every tenth code is missing",
            &[],
            raw("round", |x| {
                let n = x.round();
                if n.rem_euclid(10.0) == 3.0 { n + 1.0 } else { n }
            }),
        ),
        case(
            "saturated at one end, ends not stated",
            &["T0111", "T0112", "T0110"],
            raw("round", |x| x.round().min(900.0)),
        ),
        case(
            "saturated at one end, ends stated",
            &["T0109"],
            Bench {
                output: "min_code = -2048\nmax_code = 900",
                ..raw("round", |x| x.round().min(900.0))
            },
        ),
        case(
            "k0 twice too large",
            &["T0103", "T0106"],
            Bench { nominal_scale: 2.0 * K0, ..Bench::new(wide()) },
        ),
        case(
            "k0 twice too small",
            &["T0103", "T0106"],
            Bench { nominal_scale: 0.5 * K0, ..Bench::new(wide()) },
        ),
        case(
            "gain changed by 1 % half way",
            &["T0111", "T0112"],
            Bench::new(wide())
                .code(|d| level(d.deg) * if d.index < 30 { 1.0 } else { 1.01 } + d.scatter),
        ),
        case(
            "gain doubled half way",
            &["T0110"],
            Bench::new(wide())
                .code(|d| level(d.deg) * if d.index < 30 { 1.0 } else { 2.0 } + d.scatter),
        ),
        case(
            "the bias steps by 3 LSB within each run",
            &["T0111", "T0112", "T0131"],
            Bench::new(wide())
                .code(|d| level(d.deg) + d.scatter + if d.index < 40 { 0.0 } else { 3.0 }),
        ),
        case(
            "the bias steps by 3 LSB, mixed order",
            &["T0301"],
            Bench::new(mixed())
                .code(|d| level(d.deg) + d.scatter + if d.index < 40 { 0.0 } else { 3.0 }),
        ),
        case(
            "unplugged for the last third",
            &["T0107", "T0110"],
            Bench::new(wide()).code(|d| if d.index < 40 { level(d.deg) + d.scatter } else { 0.0 }),
        ),
        case(
            "display rounded to ten",
            &["T0301"],
            Bench { scatter: 0.0, ..Bench::new(wide()) }
                .code(|d| (level(d.deg) / 10.0).round() * 10.0),
        ),
    ]
}

fn drift_and_temperature() -> Vec<Case> {
    let warming: (&str, fn(Dwell) -> f64) =
        ("temperature_degc", |d| 20.0 + 10.0 * (d.deg + 65.0) / 130.0);
    vec![
        case(
            "temperature rises with the angle: scale",
            &["T0112", "T0111", "T0310"],
            Bench { column: Some(warming), ..Bench::new(wide()) }
                .code(|d| level(d.deg) + 6.0 * d.deg / 65.0 + d.scatter),
        ),
        case(
            "drift in the order of the angles, not recorded",
            &["T0112", "T0111"],
            Bench::new(wide()).code(|d| level(d.deg) + 3.0 * d.index as f64 / 59.0 + d.scatter),
        ),
        case(
            "drift in mixed order",
            &["T0301"],
            Bench::new(mixed())
                .code(|d| level(d.deg) + 3.0 * (d.index as f64 / 59.0 - 0.5) + d.scatter),
        ),
        case(
            "half a gram of wax: the body creeps by 0.3° in each run",
            &["T0111", "T0112"],
            Bench::new(wide())
                .code(|d| level(d.deg + 0.3 * (d.index as f64 / 59.0 - 0.5)) + d.scatter),
        ),
        case(
            "no reading: the temperature column as code",
            &["T0130", "T0104"],
            Bench::new(wide()).code(|d| 21.0 + 0.01 * d.index as f64 + 0.1 * d.scatter),
        ),
    ]
}

fn vertical_pairs() -> Vec<Case> {
    let pair = |run: &str, up: f64, down: f64| {
        format!(
            "[scale]\nup_mean_code = {up}\ndown_mean_code = {down}\nup_samples = 3000\ndown_samples = 3000\nup_std_code = 1.25\ndown_std_code = 1.25\n{run}"
        )
    };
    let full = G / SCALE;
    vec![
        case(
            "up/down of another sensor, for the scale",
            &["T0309", "T0308"],
            Bench { tail: pair("", 1.04 * full + 30.0, -1.04 * full + 30.0), ..Bench::new(wide()) },
        ),
        case(
            "up/down of another sensor, in a run",
            &["T0309", "T0110", "T0119", "T0121"],
            Bench {
                tail: pair("run = \"run-0\"\n", 1.04 * full + 30.0, -1.04 * full + 30.0),
                ..Bench::new(wide())
            },
        ),
        case(
            "up and down exchanged",
            &["T0101"],
            Bench { tail: pair("run = \"run-0\"\n", -full, full), ..Bench::new(wide()) },
        ),
        case(
            "up measured twice, never down",
            &["T0309", "T0101", "T0103"],
            Bench { tail: pair("", full + BIAS_LSB, full - 40.0), ..Bench::new(wide()) },
        ),
    ]
}

/// Runs that are copies of the last one with some rows changed by hand. (The first happens to be 2 σ off: one interval in
/// twenty misses, and copies of such a run miss together.)
fn nearly_copied(
    name: &'static str,
    says: &'static [&'static str],
    change: fn(usize, &str) -> String,
) -> Case {
    let bench = Bench::new(wide());
    let mut files = bench.files();
    for first in [0, 1] {
        let copy: Vec<String> =
            files[2].lines().enumerate().map(|(i, l)| change(i + 7 * first, l)).collect();
        files[first] = copy.join("\n") + "\n";
    }
    Case { name, passport: bench.certify_files(&files), says }
}

/// A row with its mean moved.
fn moved(line: &str, by: f64) -> String {
    let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
    if let Some(mean) = fields.get(1).and_then(|m| m.parse::<f64>().ok()) {
        fields[1] = format!("{:.6}", mean + by);
    }
    fields.join(",")
}

fn copies() -> Vec<Case> {
    vec![
        nearly_copied("copies with one row changed", &["T0115"], |i, l| {
            if i == 20 { moved(l, 0.01) } else { l.to_owned() }
        }),
        nearly_copied("copies with every fifth row changed", &["T0115"], |i, l| {
            if i % 5 == 2 { moved(l, 0.1) } else { l.to_owned() }
        }),
        nearly_copied("copies shifted by a constant", &["T0211"], |i, l| {
            moved(l, if i % 2 == 0 { 0.03 } else { 0.031 })
        }),
    ]
}

#[test]
fn no_wrong_answer_is_given_in_silence() {
    let groups: [fn() -> Vec<Case>; 6] = [
        table_and_dial,
        mounting_and_runs,
        converter,
        drift_and_temperature,
        vertical_pairs,
        copies,
    ];
    let cases: Vec<Case> = groups.iter().flat_map(|g| g()).collect();
    let failed: Vec<String> = cases.iter().filter_map(judged).collect();
    println!("{} misleading cases, {} silent wrong answers", cases.len(), failed.len());
    assert!(cases.len() >= 30, "{} cases", cases.len());
    assert!(failed.is_empty(), "{failed:#?}");
}

/// What no data can tell: the numbers are those of another sensor. Only the budget, or somebody who looks, can help.
/// Printed for the person who works on either; a case that turns out not to be silent any more belongs above.
#[test]
#[ignore = "known silent: the model cannot see these; the budget of systematic errors widens U for some of them"]
fn known_to_be_silent() {
    let narrow = || steps(-30.0, 30.0, 60);
    let cases = [
        case(
            "eccentric dial, 3′, ±30°: the budget's",
            &[],
            Bench::new(narrow()).typed(|d| d.deg + 0.05 * (d.deg + 40.0).to_radians().sin()),
        ),
        case(
            "dial scale off by 0.1 %, ±30°: the budget's",
            &[],
            Bench::new(narrow()).typed(|d| 1.001 * d.deg),
        ),
        case(
            "the sensor leans out of the tilt plane by 3°: the budget's",
            &[],
            Bench::new(wide()).code(|d| {
                (level(d.deg) - BIAS_LSB) * 3f64.to_radians().cos() + BIAS_LSB + d.scatter
            }),
        ),
        case(
            "drift of 1 LSB in the order of the angles, ±30°",
            &[],
            Bench::new(narrow()).code(|d| level(d.deg) + d.scatter + d.index as f64 / 59.0 - 0.5),
        ),
        case(
            "a rounding converter declared floor",
            &[],
            Bench { quantizer: "floor", raw: Some((1.25, f64::round)), ..Bench::new(wide()) },
        ),
        case(
            "angle of the dwell before, in one sweep: a misalignment",
            &[],
            Bench::new(wide()).code(|d| level(d.deg + 130.0 / 59.0) + d.scatter),
        ),
    ];
    let silent: Vec<String> = cases.iter().filter_map(judged).collect();
    assert!(silent.is_empty(), "{silent:#?}");
}

//! Benches, and what is found on them.

use tumble_core::assess::assess;
use tumble_core::estimate::{EstimateOptions, Method};
use tumble_core::simulate::{Preset, Truth, experiment, parse_plan, readings, simulate_run};
use tumble_core::{Angle, Experiment, Finding, FindingKind, Quantizer, Readings};

/// What this test is about.
pub const HYGIENE: [FindingKind; 17] = [
    FindingKind::SignReversed,
    FindingKind::UnitsMixedUp,
    FindingKind::ScaleImplausible,
    FindingKind::StuckConverter,
    FindingKind::CodesWrap,
    FindingKind::MistypedAngle,
    FindingKind::ZeroRows,
    FindingKind::DwellDoesNotFit,
    FindingKind::DwellDrifts,
    FindingKind::DwellTwoLevels,
    FindingKind::OutlyingSamples,
    FindingKind::TimeBackwards,
    FindingKind::RateDisagrees,
    FindingKind::MissingSamples,
    FindingKind::RepeatedSamples,
    FindingKind::UnitIsNotTheScales,
    FindingKind::AngleOutsideRange,
];

/// LSB of the paper's sensor, m/s².
pub const LSB: f64 = 0.007_69;

/// Short dwells at the given angles, floor, 1.2 LSB of noise, 0.55′ of scatter.
pub fn truth(plan: &str) -> Truth {
    Truth {
        angles_deg: parse_plan(plan).unwrap(),
        quantizer: Quantizer::Floor,
        dwell_s: 6.0,
        runs: 1,
        misalignment: Angle::from_rad(0.002),
        bias_m_s2: 5.3 * LSB,
        ..Preset::Paper1.truth()
    }
}

/// Seven angles, thirteen, and the paper's sixty.
pub const SEVEN: &str = "-60:60:7";
pub const THIRTEEN: &str = "-60:60:13";
pub const SIXTY: &str = "paper";

/// The experiment with files, lines and places as a reader gives them.
pub fn recorded(truth: &Truth) -> Experiment {
    let mut e = experiment(truth);
    for run in &mut e.runs {
        let file = format!("{}.csv", run.name);
        let mut line = 2;
        for (i, p) in run.positions.iter_mut().enumerate() {
            let typed = p.record.dial.as_ref().unwrap().typed.clone();
            p.record.file.clone_from(&file);
            p.record.line = Some(line);
            p.place = format!("{file}, line {line}, dwell {} ({typed}°)", i + 1);
            line += p.record.rows;
        }
    }
    e
}

/// Averages instead of codes.
pub fn averaged(mut e: Experiment) -> Experiment {
    for p in e.runs.iter_mut().flat_map(|r| &mut r.positions) {
        let r = &p.readings;
        p.readings =
            Readings::Averaged { mean: r.mean().unwrap(), samples: r.samples(), std: r.std() };
    }
    e
}

/// Types another angle at a dwell (counted from one) of a run.
pub fn mistype(e: &mut Experiment, run: usize, dwell: usize, typed: &str) {
    let bench = e.bench.clone();
    let p = &mut e.runs[run].positions[dwell - 1];
    let dial = p.record.dial.as_mut().unwrap();
    dial.typed = typed.to_owned();
    dial.value = typed.parse().unwrap();
    p.angle = Angle::from_deg(dial.value * dial.unit_deg * dial.direction);
    p.seat = bench.seat(p.angle);
}

/// Everything that is found.
pub fn all_findings(e: &Experiment) -> Vec<Finding> {
    let options = EstimateOptions { method: Method::Exact, ..EstimateOptions::default() };
    assess(e, &options).unwrap().findings
}

/// What is found of the kinds above.
pub fn findings(e: &Experiment) -> Vec<Finding> {
    all_findings(e).into_iter().filter(|f| HYGIENE.contains(&f.kind)).collect()
}

/// The experiment after something happened to its analogue samples (first run).
pub fn disturbed(truth: &Truth, happens: impl Fn(usize, &mut Vec<f64>)) -> Experiment {
    let mut e = recorded(truth);
    for (i, mut simulated) in simulate_run(truth, 0).positions.into_iter().enumerate() {
        happens(i + 1, &mut simulated.analogue_lsb);
        let p = &mut e.runs[0].positions[i];
        p.readings = readings(truth, &simulated);
        p.record.rows = simulated.analogue_lsb.len() as u64;
    }
    e
}

/// Fails unless exactly one kind is found, once, where and as it should be.
pub fn expect_one(name: &str, e: &Experiment, kind: FindingKind, says: [&str; 3]) {
    let found = findings(e);
    let ids: Vec<&str> = found.iter().map(|f| f.kind.id()).collect();
    assert_eq!(ids, [kind.id()], "{name}: {found:#?}");
    let f = &found[0];
    let texts = [&f.place, &f.observed, &f.remedy];
    for (text, word) in texts.into_iter().zip(says) {
        assert!(text.contains(word), "{name}: `{text}` does not name `{word}`");
    }
    assert!(!f.limit.is_empty(), "{name}: no limit");
}

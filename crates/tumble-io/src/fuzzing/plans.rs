//! What a plan is asked for and what was planned: `bench.toml`, `plan.toml`.

use tumble_core::plan::plan;

use super::{Scratch, said};
use crate::plan::{PlanDocument, PlanSettings, plan_request, plan_toml, read_plan_file};

/// Coarsest step that is planned here, and most time: planning is not what is fuzzed, but it must answer.
const COARSE_DEG: f64 = 5.0;
const SHORT_S: f64 = 3600.0;

/// bench.toml: understood or refused with a reason; what is understood is planned or refused, and the plan reads again.
pub fn bench_toml(text: &[u8]) {
    let scratch = Scratch::new();
    let path = scratch.write("bench.toml", text);
    let request = match plan_request(Some(&path), PlanSettings::default(), None) {
        Ok(request) => request,
        Err(e) => {
            said(&e);
            return;
        }
    };
    request.assumed.iter().for_each(|a| assert!(!a.is_empty()));
    let p = &request.problem;
    let targets = p.targets.iter().any(Option::is_some);
    let short = p.total_s.map_or(!targets, |t| t <= SHORT_S);
    if p.step.deg() < COARSE_DEG || !short {
        return;
    }
    match plan(p) {
        Ok(made) => {
            let document = PlanDocument::new(&request, &made);
            let file = scratch.write("made.toml", plan_toml(&document).as_bytes());
            let again = read_plan_file(&file).expect("what was planned reads again");
            assert_eq!((again.runs, again.dwell_s), (document.runs, document.dwell_s));
        }
        Err(e) => {
            said(&e);
        }
    }
}

/// plan.toml: read or refused with a reason.
pub fn plan_file(text: &[u8]) {
    let scratch = Scratch::new();
    let path = scratch.write("plan.toml", text);
    match read_plan_file(&path) {
        Ok(p) => assert!(p.angles_deg.iter().all(|a| a.abs() <= 90.0)),
        Err(e) => {
            said(&e);
        }
    }
}

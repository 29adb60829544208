//! `tumble plan`

use tumble_core::plan::{PlanNoise, TERMS, plan};
use tumble_core::systematic::Systematics;
use tumble_io::noise::read_document as read_noise_document;
use tumble_io::{
    Catalogue, Existing, OutputFolder, PlanDocument, PlanRequest, PlanSettings, ReadError, Written,
    plan_request, plan_toml,
};

use crate::cli::PlanArgs;
use crate::exit::{Exit, complain, deliver};
use crate::interrupt;
use crate::quantity::{AccelerationArg, Target};

pub(crate) fn run(args: &PlanArgs) -> Exit {
    let settings = match settings(args) {
        Ok(settings) => settings,
        Err(why) => {
            complain(why);
            return Exit::Usage;
        }
    };
    let request = request(args, settings);
    let request = match request {
        Ok(request) => request,
        Err(e) => {
            complain(&e);
            return Exit::of_reading(&e);
        }
    };
    let document = match plan(&request.problem) {
        Ok(plan) => PlanDocument::new(&request, &plan),
        Err(e) => {
            complain(&e);
            return Exit::Usage;
        }
    };
    let text = if args.json { document.to_json() } else { tumble_report::plan_summary(&document) };
    if deliver(&text) != Exit::Ok {
        return Exit::Failure;
    }
    // Defaults are a yardstick; a target that somebody asked for is a question with an answer.
    let answer = if document.met || !document.targets_stated { Exit::Ok } else { Exit::Rejected };
    answer.worse(write(args, &document))
}

/// The question, whole: flags over the record's noise over the file over the catalogue.
fn request(args: &PlanArgs, flags: PlanSettings) -> Result<PlanRequest, ReadError> {
    let user = args.catalogue.as_deref().map(Catalogue::read).transpose()?;
    let known_noise = match &args.noise_file {
        Some(path) => Some(read_noise_document(path)?.known(&path.display().to_string())?),
        None => None,
    };
    let settings = PlanSettings { known_noise, ..flags };
    plan_request(args.bench.as_deref(), settings, user.as_ref())
}

fn write(args: &PlanArgs, document: &PlanDocument) -> Exit {
    let Some(out) = &args.out else { return Exit::Ok };
    let mut folder = OutputFolder::default();
    folder.add("plan.toml", plan_toml(document));
    folder.add("plan.json", document.to_json());
    folder.add("plan.html", tumble_report::plan_checklist(document));
    let existing = if args.replace { Existing::Replace } else { Existing::Keep };
    match interrupt::while_writing(|| folder.write(out, existing, &interrupt::interrupted)) {
        Ok(written) => {
            let page = out.join("plan.html");
            match written {
                Written::New => eprintln!("wrote {} (print it) and plan.toml", page.display()),
                Written::Same => eprintln!("{} holds this plan already", out.display()),
                Written::Replaced { kept } => {
                    eprintln!("wrote {}; the old plan is in {}", page.display(), kept.display());
                }
            }
            Exit::Ok
        }
        Err(e) => {
            complain(&e);
            Exit::of_writing(&e)
        }
    }
}

/// Flags as settings; what is not a flag is left open.
fn settings(a: &PlanArgs) -> Result<PlanSettings, String> {
    let lsb = a.lsb.map(|l| l.m_s2(1.0));
    // Accelerations in LSB need to know how much that is.
    let m_s2 = |given: Option<AccelerationArg>, flag: &str| match (given, lsb) {
        (None, _) => Ok(None),
        (Some(AccelerationArg::MS2(v)), _) => Ok(Some(v)),
        (Some(lsbs), Some(k0)) => Ok(Some(lsbs.m_s2(k0))),
        (Some(_), None) => Err(format!("{flag} in LSB needs --lsb, for instance --lsb 7.69mm/s2")),
    };
    let rate_hz = a.rate.unwrap_or(PAPER_RATE_HZ);
    let white = match a.noise {
        None => None,
        Some(crate::quantity::NoiseArg::Sample(AccelerationArg::Lsb(_))) if lsb.is_none() => {
            return Err("--noise in LSB needs --lsb, for instance --lsb 7.69mm/s2".into());
        }
        Some(n) => Some(PlanNoise::white_of_sample(n.m_s2(lsb.unwrap_or(1.0), rate_hz), rate_hz)),
    };
    let ug = 1e-6 * tumble_core::STANDARD_GRAVITY_M_S2;
    Ok(PlanSettings {
        hours: a.hours,
        runs: a.runs,
        dwell_s: a.dwell,
        spares: a.spares,
        criterion: a.criterion.clone(),
        terms: (!a.terms.is_empty()).then(|| a.terms.clone()),
        step_deg: a.step.map(|s| s.deg()),
        setting_s: a.set_time,
        settle_s: a.settle,
        upright_s: a.upright_time,
        restart_s: a.restart,
        updown: a.updown.then_some(true),
        remounting: a.remounting.then_some(true),
        noise_ug_rthz: None,
        white_m_s2_rts: white,
        bias_instability_ug: m_s2(a.bias_instability, "--bias-instability")?.map(|b| b / ug),
        random_walk_m_s2_rts: a.random_walk,
        drift_m_s2_h: m_s2(a.drift, "--drift")?,
        turn_on_m_s2: m_s2(a.turn_on, "--turn-on")?,
        systematics: systematics(a),
        sensor: a.sensor.clone(),
        range_deg: a.range.clone().map(|r| r.0),
        scatter_arcmin: a.scatter.map(|s| s.arcmin()),
        gravity_m_s2: a.gravity,
        updown_lean_arcmin: a.lean.map(|l| l.arcmin()),
        lsb_m_s2: lsb,
        rate_hz: a.rate,
        targets: targets(&a.target, |given| m_s2(Some(given), "--target"))?,
        level: a.level,
        ..PlanSettings::default()
    })
}

/// Targets by term; `m_s2` knows how much an LSB is.
fn targets(
    given: &[Target],
    m_s2: impl Fn(AccelerationArg) -> Result<Option<f64>, String>,
) -> Result<[Option<f64>; TERMS], String> {
    let mut targets = [None; TERMS];
    for t in given {
        let (term, size) = match *t {
            Target::Acceleration(term, size) => (term, m_s2(size)?.unwrap_or_default()),
            Target::Plain(term, size) => (term, size),
        };
        targets[term.index()] = Some(size);
    }
    Ok(targets)
}

fn systematics(a: &PlanArgs) -> Systematics {
    Systematics {
        dial_scale: a.dial_scale,
        eccentricity: a.eccentricity,
        dial_zero: a.dial_zero,
        axis_tilt: a.tilt,
        sensor_lean: a.tilt,
        temperature_spread_k: a.temperature_rise,
        k2_per_m_s2: a.k2,
        k3_per_m2_s4: a.k3,
        ..Systematics::default()
    }
}

/// Samples per second where nobody states them.
const PAPER_RATE_HZ: f64 = 50.0;

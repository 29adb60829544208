//! `tumble simulate`

use tumble_core::simulate::{Preset, Truth};
use tumble_core::{Code, Quantizer};
use tumble_io::{
    Existing, PlanFile, SimulationError, SimulationOptions, Written, read_plan_file,
    write_simulation,
};

use crate::cli::{PresetArg, QuantizerArg, SimulateArgs};
use crate::exit::{Exit, complain};
use crate::interrupt;

pub(crate) fn run(args: &SimulateArgs) -> Exit {
    let plan = match args.plan.as_deref().map(read_plan_file).transpose() {
        Ok(plan) => plan,
        Err(e) => {
            complain(&e);
            return Exit::of_reading(&e);
        }
    };
    let truth = truth(args, plan.as_ref());
    let options = SimulationOptions {
        model: args.model.clone(),
        serial: args.serial.clone().unwrap_or_else(|| preset_serial(args.preset).into()),
        gzip: args.gz,
        averaged: args.averaged,
        stated_angle_uncertainty_arcmin: args
            .stated_scatter
            .unwrap_or(truth.setting_scatter)
            .arcmin(),
        scale_pair: args.scale_pair,
        existing: if args.replace { Existing::Replace } else { Existing::Keep },
    };
    let write = || write_simulation(&truth, &options, &args.out, &interrupt::interrupted);
    match interrupt::while_writing(write) {
        Ok(written) => {
            let out = args.out.display();
            match written {
                Written::New => eprintln!("wrote {out}; certify it with: tumble certify {out}"),
                Written::Same => eprintln!("{out} holds this simulation already"),
                Written::Replaced { kept } => {
                    eprintln!("wrote {out}; the old folder is {}", kept.display());
                }
            }
            Exit::Ok
        }
        Err(e) => {
            complain(&e);
            match e {
                SimulationError::Truth(_) => Exit::Usage,
                SimulationError::Output(e) => Exit::of_writing(&e),
                SimulationError::Pack(_) => Exit::Failure,
            }
        }
    }
}

fn preset(arg: PresetArg) -> Preset {
    match arg {
        PresetArg::Paper1 => Preset::Paper1,
        PresetArg::Paper2 => Preset::Paper2,
        PresetArg::Paper3 => Preset::Paper3,
    }
}

fn preset_serial(arg: PresetArg) -> &'static str {
    match arg {
        PresetArg::Paper1 => "1",
        PresetArg::Paper2 => "2",
        PresetArg::Paper3 => "3",
    }
}

/// The preset with the plan put over it, and every flag over both.
fn truth(a: &SimulateArgs, plan: Option<&PlanFile>) -> Truth {
    let mut p = preset(a.preset).truth();
    if let Some(plan) = plan {
        p.angles_deg.clone_from(&plan.angles_deg);
        p.upright_in_each_run = plan.updown;
        (p.dwell_s, p.runs) = (plan.dwell_s, plan.runs);
    }
    let k0 = a.nominal_scale.unwrap_or(p.nominal_scale_m_s2_per_lsb);
    let rate_hz = a.rate.unwrap_or(p.rate_hz);
    Truth {
        gravity_m_s2: a.gravity.unwrap_or(p.gravity_m_s2),
        nominal_scale_m_s2_per_lsb: k0,
        bias_m_s2: a.bias.map_or(p.bias_m_s2, |b| b.m_s2(k0)),
        misalignment: a.misalignment.unwrap_or(p.misalignment),
        scale_error: a.scale_error.unwrap_or(p.scale_error),
        k2_per_m_s2: a.k2.unwrap_or(p.k2_per_m_s2),
        k3_per_m2_s4: a.k3.unwrap_or(p.k3_per_m2_s4),
        noise_m_s2: a.noise.map_or(p.noise_m_s2, |n| n.m_s2(k0, rate_hz)),
        random_walk_m_s2_rts: a.random_walk.unwrap_or(p.random_walk_m_s2_rts),
        turn_on_m_s2: a.turn_on.map_or(p.turn_on_m_s2, |t| t.m_s2(k0)),
        scale_sign: p.scale_sign,
        scale_per_k: p.scale_per_k,
        bias_per_k_m_s2: a.bias_per_kelvin.map_or(p.bias_per_k_m_s2, |b| b.m_s2(k0)),
        temperature_degc: a.temperature.or(p.temperature_degc),
        setting_scatter: a.scatter.unwrap_or(p.setting_scatter),
        dial_zero: a.dial_zero.unwrap_or(p.dial_zero),
        dial_scale: a.dial_scale.unwrap_or(p.dial_scale),
        eccentricity: a.eccentricity.unwrap_or(p.eccentricity),
        eccentricity_phase: a.eccentricity_phase.unwrap_or(p.eccentricity_phase),
        axis_tilt: a.axis_tilt.unwrap_or(p.axis_tilt),
        sensor_lean: a.sensor_lean.unwrap_or(p.sensor_lean),
        vertical_lean: a.lean.unwrap_or(p.vertical_lean),
        upright_in_each_run: a.updown || p.upright_in_each_run,
        quantizer: a.quantizer.map_or(p.quantizer, |q| match q {
            QuantizerArg::Truncate => Quantizer::Truncate,
            QuantizerArg::Floor => Quantizer::Floor,
            QuantizerArg::Round => Quantizer::Round,
            QuantizerArg::None => Quantizer::None,
        }),
        ends: tumble_core::ConverterEnds {
            min_code: a.min_code.map(Code).or(p.ends.min_code),
            max_code: a.max_code.map(Code).or(p.ends.max_code),
        },
        angles_deg: a.angles.clone().map_or(p.angles_deg, |angles| angles.0),
        dwell_s: a.dwell.unwrap_or(p.dwell_s),
        rate_hz,
        runs: a.runs.unwrap_or(p.runs),
        seed: a.seed.unwrap_or(p.seed),
    }
}

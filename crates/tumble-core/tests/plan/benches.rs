//! Ten benches, from a hand-turned table to a dividing head.

use tumble_core::plan::{Criterion, PlanConverter, PlanNoise, PlanProblem, Possible, Term};
use tumble_core::systematic::{Inputs, Systematics};
use tumble_core::{
    Angle, Bench, ConverterEnds, Gravity, Output, Quantizer, STANDARD_GRAVITY_M_S2, Sensor,
};

/// One-sided density in µg/√Hz as the coefficient N.
pub fn density(ug_rthz: f64) -> f64 {
    ug_rthz * 1e-6 * STANDARD_GRAVITY_M_S2 / 2f64.sqrt()
}

/// The budget of a bench whose errors are all stated.
pub fn stated(systematics: Systematics) -> Inputs {
    let sensor =
        Sensor { model: String::new(), serial: String::new(), axis: String::new(), kind: None };
    let output = Output {
        quantizer: Quantizer::None,
        unit: "m/s2".into(),
        nominal_scale_m_s2_per_lsb: None,
        rate_hz: None,
        ends: ConverterEnds::default(),
    };
    let bench = Bench {
        gravity: Gravity::normal(50.0, 150.0),
        angle_uncertainty: None,
        range: None,
        vertical_lean: Angle::from_rad(0.0),
        systematics,
    };
    Inputs::before_any_run(&sensor, &output, &bench, Angle::from_deg(65.0), 1.0)
}

fn base(range_deg: f64, hours: f64) -> PlanProblem {
    PlanProblem {
        total_s: Some(3600.0 * hours),
        ..PlanProblem::with_range(Angle::from_deg(range_deg))
    }
}

/// Names and problems; every kind of uncertainty occurs.
pub fn ten() -> Vec<(&'static str, PlanProblem)> {
    let arcmin = Angle::from_arcmin;
    let noise = |ug| PlanNoise { white_m_s2_rts: density(ug), ..PlanNoise::default() };
    let paper = PlanProblem {
        noise: noise(110.0),
        setting_scatter: arcmin(0.55),
        converter: Some(PlanConverter { lsb_m_s2: 0.007_69, rate_hz: 50.0 }),
        ..base(65.0, 3.0)
    };
    vec![
        ("paper's table, ±65°", paper.clone()),
        ("hand-turned, 3′, 90 minutes", base(65.0, 1.5)),
        (
            "narrow: −30…29°",
            PlanProblem {
                range: (Angle::from_deg(-30.0), Angle::from_deg(29.0)),
                ..base(30.0, 2.0)
            },
        ),
        (
            "up and down, lean of 20′",
            PlanProblem { upright: Possible::Yes, upright_lean: arcmin(20.0), ..paper },
        ),
        (
            "dividing head ±90°, 0.1′, quiet sensor",
            PlanProblem {
                step: Angle::from_deg(0.5),
                setting_scatter: arcmin(0.1),
                noise: noise(22.5),
                ..base(90.0, 4.0)
            },
        ),
        (
            "random walk, bias wanted",
            PlanProblem {
                noise: PlanNoise { walk_m_s2_rts: 2e-4, ..noise(50.0) },
                targets: [Some(0.002), None, None, None, None, None, None],
                ..base(60.0, 2.0)
            },
        ),
        (
            "steady drift",
            PlanProblem {
                noise: PlanNoise { ramp_m_s3: 5e-6, ..noise(110.0) },
                setting_scatter: arcmin(1.0),
                ..base(65.0, 2.0)
            },
        ),
        (
            "K2 wanted, ±90°, five runs",
            PlanProblem {
                further_terms: vec![Term::K2],
                targets: [Some(0.01), None, Some(1e-3), Some(3e-4), None, None, None],
                runs: Some(5),
                turn_on_m_s2: Some(0.003),
                ..base(90.0, 4.0)
            },
        ),
        (
            "systematic table, turned by 180°, D",
            PlanProblem {
                criterion: Criterion::D,
                systematics: stated(Systematics {
                    dial_scale: Some(3e-4),
                    eccentricity: Some(arcmin(1.0)),
                    dial_zero: Some(arcmin(2.0)),
                    axis_tilt: Some(arcmin(15.0)),
                    sensor_lean: Some(arcmin(20.0)),
                    ..Systematics::NONE
                }),
                remounting: Possible::Yes,
                ..base(65.0, 1.5)
            },
        ),
        (
            "fine step, one-sided −20…70°, A",
            PlanProblem {
                criterion: Criterion::A,
                range: (Angle::from_deg(-20.0), Angle::from_deg(70.0)),
                step: arcmin(1.0),
                setting_scatter: arcmin(0.5),
                level_scatter_m_s2: 5e-4,
                ..base(70.0, 2.0)
            },
        ),
    ]
}

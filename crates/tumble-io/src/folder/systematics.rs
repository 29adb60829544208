//! What experiment.toml states of errors that no scatter shows; `docs/budget.md` says what each key means.

use tumble_core::systematic::Systematics;
use tumble_core::{Angle, STANDARD_GRAVITY_M_S2};

use super::settings::value;
use crate::error::ReadError;
use crate::experiment_file::{BenchTable, ExperimentFile, QuantizerName, SensorTable};

/// Parts per million, and micro-g, as ratios.
const MILLIONTH: f64 = 1e-6;
/// Largest uncertainty of a scale: a dial or a reference that is off by a tenth is no dial and no reference.
const MOST_PPM: f64 = 1e5;
/// Largest angle of tilt, lean and eccentricity: 10°. Beyond it first and second order do not describe what it does.
const MOST_ARCMIN: f64 = 600.0;
/// Largest K2 and K3: at 1 g a tenth of the reading.
const MOST_UG: f64 = 1e5;
/// Largest change of temperature in a run.
const MOST_K: f64 = 200.0;
/// Largest nonlinearity of a converter, LSB: half of 24 bits.
const MOST_LSB: f64 = 8_388_608.0;

/// A number between zero and a limit.
fn up_to(
    key: &str,
    given: Option<f64>,
    limit: f64,
    expected: &str,
) -> Result<Option<f64>, ReadError> {
    match given {
        Some(v) if !(0.0..=limit).contains(&v) => {
            Err(value(key, v, &format!("{expected}, between 0 and {limit}")))
        }
        other => Ok(other),
    }
}

/// The keys of `[output]` that the budget reads and a bench without a unit may state, too.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ConverterKeys {
    pub(crate) nonlinearity_lsb: Option<f64>,
    pub(crate) reference_uncertainty_ppm: Option<f64>,
}

/// The keys of `[bench]`, `[output]` and `[sensor]` that the budget reads.
pub(super) fn systematics(file: &ExperimentFile) -> Result<Systematics, ReadError> {
    let output = &file.output;
    let converter = ConverterKeys {
        nonlinearity_lsb: output.nonlinearity_lsb,
        reference_uncertainty_ppm: output.reference_uncertainty_ppm,
    };
    Ok(Systematics {
        resolution: resolution(output.quantizer, output.resolution)?,
        ..systematics_of_tables(&file.bench, Some(&file.sensor), converter)?
    })
}

/// The same of tables that need not be whole; the resolution of the readings is left open.
pub(crate) fn systematics_of_tables(
    bench: &BenchTable,
    sensor: Option<&SensorTable>,
    output: ConverterKeys,
) -> Result<Systematics, ReadError> {
    let ppm = |key: &str, given: Option<f64>| {
        let v = up_to(key, given, MOST_PPM, "a standard uncertainty in ppm")?;
        Ok::<_, ReadError>(v.map(|v| v * MILLIONTH))
    };
    let arcmin = |key: &str, given: Option<f64>, expected: &str| {
        Ok::<_, ReadError>(up_to(key, given, MOST_ARCMIN, expected)?.map(Angle::from_arcmin))
    };
    let micro_g = |key: &str, given: Option<f64>, per: f64, expected: &str| {
        let v = up_to(key, given, MOST_UG, expected)?;
        Ok::<_, ReadError>(v.map(|v| v * MILLIONTH / per))
    };
    let standard = "a standard uncertainty in minutes of arc";
    let g = STANDARD_GRAVITY_M_S2;
    Ok(Systematics {
        dial_scale: ppm("[bench] dial_scale_uncertainty_ppm", bench.dial_scale_uncertainty_ppm)?,
        eccentricity: arcmin(
            "[bench] eccentricity_arcmin",
            bench.eccentricity_arcmin,
            "the amplitude in minutes of arc",
        )?,
        dial_zero: arcmin(
            "[bench] angle_zero_uncertainty_arcmin",
            bench.angle_zero_uncertainty_arcmin,
            standard,
        )?,
        axis_tilt: arcmin("[bench] axis_tilt_arcmin", bench.axis_tilt_arcmin, standard)?,
        sensor_lean: arcmin("[bench] sensor_lean_arcmin", bench.sensor_lean_arcmin, standard)?,
        nonlinearity_lsb: up_to(
            "[output] nonlinearity_lsb",
            output.nonlinearity_lsb,
            MOST_LSB,
            "the largest deviation from a straight line in LSB",
        )?,
        reference: ppm("[output] reference_uncertainty_ppm", output.reference_uncertainty_ppm)?,
        resolution: None,
        temperature_spread_k: up_to(
            "[bench] temperature_spread_k",
            bench.temperature_spread_k,
            MOST_K,
            "the change of temperature over a run in K",
        )?,
        k2_per_m_s2: micro_g(
            "[sensor] k2_uncertainty_ug_per_g2",
            sensor.and_then(|s| s.k2_uncertainty_ug_per_g2),
            g,
            "a standard uncertainty in µg/g²",
        )?,
        k3_per_m2_s4: micro_g(
            "[sensor] k3_uncertainty_ug_per_g3",
            sensor.and_then(|s| s.k3_uncertainty_ug_per_g3),
            g * g,
            "a standard uncertainty in µg/g³",
        )?,
    })
}

/// The step of readings that are not codes.
fn resolution(quantizer: QuantizerName, given: Option<f64>) -> Result<Option<f64>, ReadError> {
    let key = "[output] resolution";
    match (quantizer, given) {
        (_, None) => Ok(None),
        (QuantizerName::None, Some(v)) if v.is_finite() && v >= 0.0 => Ok(Some(v)),
        (QuantizerName::None, Some(v)) => {
            Err(value(key, v, "the step of the readings in their own unit, 0 or more"))
        }
        (_, Some(v)) => {
            Err(value(key, v, "it only with quantizer = \"none\"; codes have a step of 1 LSB"))
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.
    use super::*;
    use crate::experiment_file::parse;

    fn read(sensor: &str, output: &str, bench: &str) -> Result<Systematics, ReadError> {
        let text = format!("[sensor]\n{sensor}\n[output]\n{output}\n[bench]\n{bench}\n");
        systematics(&parse(&text, "experiment.toml").unwrap())
    }

    const CODES: &str = "quantizer = \"round\"";
    const VOLTS: &str = "quantizer = \"none\"\nunit = \"V\"";

    #[test]
    fn what_is_not_stated_is_absent() {
        assert_eq!(read("", CODES, "").unwrap(), Systematics::default());
    }

    #[test]
    fn every_key_arrives_in_si() {
        let s = read(
            "k2_uncertainty_ug_per_g2 = 50\nk3_uncertainty_ug_per_g3 = 20",
            &format!("{VOLTS}\nresolution = 0.001\nnonlinearity_lsb = 0.5\nreference_uncertainty_ppm = 30"),
            "dial_scale_uncertainty_ppm = 100\neccentricity_arcmin = 2\nangle_zero_uncertainty_arcmin = 1\n\
             axis_tilt_arcmin = 10\nsensor_lean_arcmin = 20\ntemperature_spread_k = 3",
        )
        .unwrap();
        let near =
            |a: Option<f64>, b: f64| assert!((a.unwrap() / b - 1.0).abs() < 1e-12, "{a:?} {b}");
        near(s.dial_scale, 1e-4);
        near(s.eccentricity.map(Angle::arcmin), 2.0);
        near(s.dial_zero.map(Angle::arcmin), 1.0);
        near(s.axis_tilt.map(Angle::arcmin), 10.0);
        near(s.sensor_lean.map(Angle::arcmin), 20.0);
        near(s.temperature_spread_k, 3.0);
        near(s.resolution, 1e-3);
        near(s.nonlinearity_lsb, 0.5);
        near(s.reference, 3e-5);
        // 50 µg at 1 g is 490 µm/s² at 9.80665 m/s².
        near(s.k2_per_m_s2.map(|k| k * 9.806_65 * 9.806_65), 50e-6 * 9.806_65);
        near(s.k3_per_m2_s4.map(|k| k * 9.806_65f64.powi(3)), 20e-6 * 9.806_65);
    }

    #[test]
    fn impossible_values_are_refused_with_their_key() {
        for (sensor, output, bench, key) in [
            ("", CODES, "dial_scale_uncertainty_ppm = -1", "dial_scale_uncertainty_ppm"),
            ("", CODES, "dial_scale_uncertainty_ppm = 2e5", "dial_scale_uncertainty_ppm"),
            ("", CODES, "eccentricity_arcmin = 601", "eccentricity_arcmin"),
            ("", CODES, "axis_tilt_arcmin = nan", "axis_tilt_arcmin"),
            ("", CODES, "sensor_lean_arcmin = inf", "sensor_lean_arcmin"),
            ("", CODES, "angle_zero_uncertainty_arcmin = -0.5", "angle_zero_uncertainty_arcmin"),
            ("", CODES, "temperature_spread_k = 1000", "temperature_spread_k"),
            ("k2_uncertainty_ug_per_g2 = -1", CODES, "", "k2_uncertainty_ug_per_g2"),
            ("k3_uncertainty_ug_per_g3 = 1e9", CODES, "", "k3_uncertainty_ug_per_g3"),
            ("", "quantizer = \"round\"\nresolution = 1", "", "resolution"),
            ("", "quantizer = \"none\"\nunit = \"V\"\nresolution = -1", "", "resolution"),
            ("", "quantizer = \"round\"\nnonlinearity_lsb = -1", "", "nonlinearity_lsb"),
            (
                "",
                "quantizer = \"round\"\nreference_uncertainty_ppm = 1e6",
                "",
                "reference_uncertainty_ppm",
            ),
        ] {
            let text = read(sensor, output, bench).unwrap_err().to_string();
            assert!(text.contains(key), "{key}: {text}");
        }
    }
}

//! What stands for each quantity of the budget, and why: as stated, or a default with its reason.

use super::quantity::{Quantity, Shape};
use super::{Systematics, catalogued};
use crate::{ARCMIN_RAD, Angle, Bench, Experiment, GravitySource, Output, Quantizer, Seat, Sensor};

/// Limits of what a dial is as accurate as, where no setting error is stated: the table of the paper is set by hand "to a few
/// arcminutes" (method section 1). A rectangle of that half width: 1/√3 of it is the standard uncertainty.
pub const DEFAULT_ACCURACY_ARCMIN: f64 = 3.0;
/// Tilt of the table's axis and lean of the sensor, where not stated: half a degree is what a bubble level and a hand give,
/// as for upright dwells ([`crate::DEFAULT_VERTICAL_LEAN_ARCMIN`]).
pub const DEFAULT_TILT_ARCMIN: f64 = 30.0;
/// Change of temperature during a run, where none was recorded: a room in which nobody controls it, over an hour.
const DEFAULT_TEMPERATURE_SPREAD_K: f64 = 1.0;

/// A quantity with its uncertainty. Its estimate is zero (gravity apart): what is known is corrected beforehand.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// Which.
    pub quantity: Quantity,
    /// Standard uncertainty, in [`Quantity::unit`].
    pub standard_uncertainty: f64,
    /// Distribution.
    pub shape: Shape,
    /// `stated`, or where the default comes from.
    pub source: String,
}

impl Input {
    /// The same with what it comes from (angles, for tilt and lean) so many times as large.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let larger = |u_rad: [f64; 2]| u_rad.map(|u| factor * u);
        let shape = match self.shape {
            Shape::Product { u_rad } => Shape::Product { u_rad: larger(u_rad) },
            Shape::HalfSquares { u_rad } => Shape::HalfSquares { u_rad: larger(u_rad) },
            plain => plain,
        };
        let plain = factor * self.standard_uncertainty;
        let standard_uncertainty = shape.own_uncertainty().unwrap_or(plain);
        Self { shape, standard_uncertainty, ..self.clone() }
    }
}

/// All quantities of an experiment, common to its runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs {
    /// In the order of [`Quantity::ALL`]; those of zero uncertainty stand there too, with the reason.
    pub lines: Vec<Input>,
    /// Change of temperature over a run in which none was recorded, K.
    pub temperature_spread_k: f64,
}

impl Inputs {
    /// What is stated of an experiment's bench and sensor, and defaults for the rest.
    ///
    /// **Source** of every default: `docs/budget.md`.
    ///
    /// ```
    /// use tumble_core::simulate::{Preset, experiment};
    /// use tumble_core::systematic::{Inputs, Quantity, Systematics};
    /// let mut e = experiment(&Preset::Paper3.truth());      // angles set to 0.55′, −30…29°
    /// e.bench.systematics = Systematics::default();
    /// let inputs = Inputs::of(&e, 0.007_69);
    /// let dial = inputs.of_quantity(Quantity::DialScale).unwrap();
    /// assert!((dial.standard_uncertainty - 0.55 / 60.0 / 30.0).abs() < 1e-12);
    /// assert_eq!(dial.source, "default: 0.55′, the stated setting error, over 30°");
    /// ```
    #[must_use]
    pub fn of(experiment: &Experiment, nominal_scale_m_s2_per_lsb: f64) -> Self {
        let on_table = |p: &&crate::Position| p.seat == Seat::Table;
        let largest = experiment
            .runs
            .iter()
            .flat_map(|r| &r.positions)
            .filter(on_table)
            .map(|p| p.angle.rad().abs())
            .fold(0.0, f64::max);
        let Experiment { sensor, output, bench, .. } = experiment;
        let largest = Angle::from_rad(largest);
        Self::before_any_run(sensor, output, bench, largest, nominal_scale_m_s2_per_lsb)
    }

    /// The same for measurements that are still to come, at angles up to `largest`.
    #[must_use]
    pub fn before_any_run(
        sensor: &Sensor,
        output: &Output,
        bench: &Bench,
        largest: Angle,
        nominal_scale_m_s2_per_lsb: f64,
    ) -> Self {
        let mut lines = vec![gravity(bench)];
        lines.extend(dial(bench, largest));
        lines.extend(tilt_and_lean(bench));
        lines.extend(converter(output, &bench.systematics));
        let stated = &bench.systematics;
        lines.extend(catalogued::lines(sensor, output, stated, nominal_scale_m_s2_per_lsb));
        let spread = stated.temperature_spread_k;
        Self { lines, temperature_spread_k: spread.unwrap_or(DEFAULT_TEMPERATURE_SPREAD_K) }
    }

    /// No systematic errors at all.
    pub const NONE: Self = Self { lines: Vec::new(), temperature_spread_k: 0.0 };

    /// The line of a quantity.
    #[must_use]
    pub fn of_quantity(&self, quantity: Quantity) -> Option<&Input> {
        self.lines.iter().find(|l| l.quantity == quantity)
    }
}

fn stated_or(quantity: Quantity, given: Option<f64>, default: f64, reason: &str) -> Input {
    Input {
        quantity,
        standard_uncertainty: given.unwrap_or(default),
        shape: Shape::Normal,
        source: match given {
            Some(_) => "stated".into(),
            None => reason.into(),
        },
    }
}

fn gravity(bench: &Bench) -> Input {
    let g = &bench.gravity;
    let (shape, source) = match g.source {
        GravitySource::Stated => (Shape::Normal, "stated".into()),
        GravitySource::StatedWithoutUncertainty => {
            (Shape::Normal, "stated without uncertainty: taken as exact".into())
        }
        GravitySource::Normal { latitude_deg, height_m } => (
            Shape::Rectangular,
            format!(
                "what the field differs from normal gravity at {latitude_deg}° and {height_m} m"
            ),
        ),
    };
    Input {
        quantity: Quantity::Gravity,
        standard_uncertainty: g.standard_uncertainty_m_s2,
        shape,
        source,
    }
}

/// Scale, eccentricity and zero of the dial.
///
/// **Model** a dial is as accurate as it is set: scale error = accuracy over the end of the table's range (the largest angle used,
/// where none is stated or that is larger), eccentricity = accuracy.
/// An amplitude `e` of unknown phase is two independent components of `e/√2` each.
fn dial(bench: &Bench, largest: Angle) -> [Input; 4] {
    let stated = &bench.systematics;
    let setting = bench.angle_uncertainty;
    let accuracy = setting.unwrap_or(Angle::from_arcmin(DEFAULT_ACCURACY_ARCMIN / 3f64.sqrt()));
    let words = match setting {
        Some(s) if s.rad() == 0.0 => "angles stated as exact".to_owned(),
        Some(s) => format!("{}′, the stated setting error", shown(s.arcmin())),
        None => format!("±{DEFAULT_ACCURACY_ARCMIN}′, a table that is set by hand"),
    };
    // The scale of the whole dial, where its range is stated.
    let range = bench.range.map_or(0.0, |(lo, hi)| lo.rad().abs().max(hi.rad().abs()));
    let largest = range.max(largest.rad());
    let scale = if largest > 0.0 { accuracy.rad() / largest } else { 0.0 };
    let of_scale = match accuracy.rad() > 0.0 {
        true => format!("default: {words}, over {}°", shown(largest.to_degrees())),
        false => format!("default: {words}"),
    };
    let component = |q| {
        let given = stated.eccentricity.map(|e| e.rad() / 2f64.sqrt());
        let default = accuracy.rad() / 2f64.sqrt();
        let mut line = stated_or(q, given, default, &format!("default: amplitude {words}"));
        if let Some(e) = stated.eccentricity.filter(|e| e.rad() > 0.0) {
            line.source = format!("stated: amplitude {}′", shown(e.arcmin()));
        }
        line
    };
    [
        stated_or(Quantity::DialScale, stated.dial_scale, scale, &of_scale),
        component(Quantity::EccentricitySine),
        component(Quantity::EccentricityCosine),
        stated_or(
            Quantity::DialZero,
            stated.dial_zero.map(Angle::rad),
            0.0,
            "default: zero of the dial and level of the table are part of the misalignment",
        ),
    ]
}

/// Tilt of the table's axis and lean of the sensor out of the plane in which it turns.
fn tilt_and_lean(bench: &Bench) -> [Input; 2] {
    let stated = &bench.systematics;
    let default = Angle::from_arcmin(DEFAULT_TILT_ARCMIN);
    let u = [stated.axis_tilt, stated.sensor_lean].map(|s| s.unwrap_or(default).rad());
    let says = |name: &str, given: Option<Angle>, u: f64| {
        let minutes = shown(u / ARCMIN_RAD);
        match given {
            Some(_) => format!("{name} {minutes}′ stated"),
            None => format!("{name} {minutes}′ by default: a bubble level and a hand"),
        }
    };
    let source = format!(
        "{}; {}",
        says("tilt of the axis", stated.axis_tilt, u[0]),
        says("lean of the sensor", stated.sensor_lean, u[1])
    );
    let line = |quantity, shape: Shape| Input {
        quantity,
        standard_uncertainty: shape.own_uncertainty().unwrap_or(0.0),
        shape,
        source: source.clone(),
    };
    [
        line(Quantity::TiltTimesLean, Shape::Product { u_rad: u }),
        line(Quantity::TiltAndLeanCosine, Shape::HalfSquares { u_rad: u }),
    ]
}

/// Nonlinearity, reference and resolution of the converter.
///
/// **Model** a limit `L` of the deviation from a straight line, bow and S equally likely: where both reach their peak, at the
/// ends of the range, their variance is that of a rectangle ±L; so `u = L/√6` each.
fn converter(output: &Output, stated: &Systematics) -> [Input; 4] {
    let not_stated = "default: not stated, taken as zero";
    let bent = |q| {
        let mut line = stated_or(q, stated.nonlinearity_lsb, 0.0, not_stated);
        line.standard_uncertainty /= 6f64.sqrt();
        line.shape = Shape::Rectangular;
        line
    };
    let is_code = output.quantizer != Quantizer::None;
    let step = if is_code { Some(1.0) } else { stated.resolution };
    let reason = if is_code { "one code" } else { "stated" };
    let resolution = Input {
        quantity: Quantity::Resolution,
        standard_uncertainty: step.unwrap_or(0.0) / 12f64.sqrt(),
        shape: Shape::Rectangular,
        source: if step.is_some() { reason.into() } else { not_stated.into() },
    };
    let reference = stated_or(
        Quantity::Reference,
        stated.reference,
        0.0,
        "default: the reference that was calibrated with is the one in use",
    );
    [bent(Quantity::ConverterBow), bent(Quantity::ConverterS), reference, resolution]
}

/// A number for people, up to four digits.
fn shown(v: f64) -> String {
    let text = format!("{v:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Preset, Truth, experiment, parse_plan};

    fn bench(edit: impl Fn(&mut Experiment)) -> Inputs {
        let truth = Truth {
            angles_deg: parse_plan("-65:65:5").unwrap(),
            dwell_s: 0.1,
            runs: 1,
            ..Preset::Paper3.truth()
        };
        let mut e = experiment(&truth);
        e.bench.systematics = Systematics::default();
        e.bench.angle_uncertainty = None;
        edit(&mut e);
        Inputs::of(&e, 0.007_69)
    }

    fn line(inputs: &Inputs, quantity: Quantity) -> (f64, String) {
        let l = inputs.of_quantity(quantity).unwrap();
        (l.standard_uncertainty, l.source.clone())
    }

    #[test]
    fn every_quantity_has_a_line_with_a_reason() {
        let inputs = bench(|_| ());
        let quantities: Vec<Quantity> = inputs.lines.iter().map(|l| l.quantity).collect();
        assert_eq!(quantities, Quantity::ALL);
        for l in &inputs.lines {
            assert!(l.standard_uncertainty.is_finite() && l.standard_uncertainty >= 0.0);
            assert!(!l.source.is_empty(), "{}", l.quantity.name());
        }
        let (u, source) = line(&inputs, Quantity::DialScale);
        // 3′/65° = 769 ppm, as the end of a rectangle.
        assert!((u - 3.0 / 3f64.sqrt() / 60.0 / 65.0).abs() < 1e-12);
        assert_eq!(source, "default: ±3′, a table that is set by hand, over 65°");
        let (u, _) = line(&inputs, Quantity::EccentricityCosine);
        assert!((u - 3.0 * ARCMIN_RAD / 6f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_table_said_to_be_perfect_is_perfect() {
        let inputs = bench(|e| e.bench.angle_uncertainty = Some(Angle::from_rad(0.0)));
        for q in [Quantity::DialScale, Quantity::EccentricitySine, Quantity::EccentricityCosine] {
            let (u, source) = line(&inputs, q);
            assert_eq!(u, 0.0);
            assert!(source.contains("angles stated as exact"), "{source}");
        }
    }

    #[test]
    fn nothing_is_left_where_all_is_stated_as_zero() {
        let inputs = bench(|e| e.bench.systematics = Systematics::NONE);
        for l in inputs.lines.iter().filter(|l| l.quantity != Quantity::Resolution) {
            assert_eq!(l.standard_uncertainty, 0.0, "{}", l.quantity.name());
        }
        assert_eq!(inputs.temperature_spread_k, 0.0);
    }

    #[test]
    fn stated_values_go_before_defaults() {
        let inputs = bench(|e| {
            e.bench.systematics = Systematics {
                dial_scale: Some(1e-4),
                axis_tilt: Some(Angle::from_arcmin(60.0)),
                nonlinearity_lsb: Some(0.6),
                ..Systematics::default()
            };
        });
        assert_eq!(line(&inputs, Quantity::DialScale), (1e-4, "stated".into()));
        let (u, _) = line(&inputs, Quantity::ConverterBow);
        assert!((u - 0.6 / 6f64.sqrt()).abs() < 1e-15);
        let (u, source) = line(&inputs, Quantity::TiltTimesLean);
        assert!((u - 60.0 * 30.0 * ARCMIN_RAD * ARCMIN_RAD).abs() < 1e-12);
        assert!(source.starts_with("tilt of the axis 60′ stated; lean"), "{source}");
    }
}

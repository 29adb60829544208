//! What was measured, before anything is computed from it.

use crate::decision::Specification;
use crate::systematic::Systematics;
use crate::{Angle, ConverterEnds, Gravity, Quantizer, Readings, Record, SensorType};

/// One sensor, one axis, one bench, one or more runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// The unit under calibration.
    pub sensor: Sensor,
    /// What the converter delivers.
    pub output: Output,
    /// The tilt table and the field that it stands in.
    pub bench: Bench,
    /// Dwells with the axis up and down, when they were taken.
    pub vertical: Option<VerticalPair>,
    /// Runs in the order of the experiment file.
    pub runs: Vec<Run>,
    /// Largest expanded uncertainties that still serve.
    pub targets: Targets,
    /// What the unit is held against; without limits nothing is.
    pub specification: Specification,
}

/// The unit under calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Model, free text.
    pub model: String,
    /// Serial number, free text.
    pub serial: String,
    /// Sensitive axis, free text.
    pub axis: String,
    /// What the catalogue says of the model, where it knows it.
    pub kind: Option<SensorType>,
}

/// What the converter delivers.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// How it rounds.
    pub quantizer: Quantizer,
    /// Unit of a reading: `LSB`, or the user's own for [`Quantizer::None`].
    pub unit: String,
    /// Stated nominal scale factor, m/s² per LSB.
    pub nominal_scale_m_s2_per_lsb: Option<f64>,
    /// Samples per second.
    pub rate_hz: Option<f64>,
    /// Ends of the converter.
    pub ends: ConverterEnds,
}

/// The tilt table.
#[derive(Debug, Clone, PartialEq)]
pub struct Bench {
    /// Local gravity.
    pub gravity: Gravity,
    /// `σφ`: random error of setting an angle, standard. `None`: not stated.
    pub angle_uncertainty: Option<Angle>,
    /// Range of the table. Dwells at ±90° inside of it stand on the table like all others.
    pub range: Option<(Angle, Angle)>,
    /// `u(δ)`: standard uncertainty of how far the ±90° dwells lean from the vertical.
    pub vertical_lean: Angle,
    /// What is stated of errors that no scatter shows; what is not, gets a default
    /// ([`crate::systematic::Inputs::of`]).
    pub systematics: Systematics,
}

/// Default of [`Bench::vertical_lean`]: a body stood on its end against a square or on a flat plate.
/// 0.5° is what a person sets by eye with a bubble level; it costs 0.05 LSB of the paper's sensor.
pub const DEFAULT_VERTICAL_LEAN_ARCMIN: f64 = 30.0;

impl Bench {
    /// Where a dwell at a table angle was taken: ±90° outside the table's range is a mounting of its own.
    #[must_use]
    pub fn seat(&self, angle: Angle) -> Seat {
        let upright = (angle.rad().abs() - core::f64::consts::FRAC_PI_2).abs() < 1e-9;
        let on_table = self.range.is_some_and(|(lo, hi)| lo <= angle && angle <= hi);
        match (upright && !on_table, angle.rad() > 0.0) {
            (true, true) => Seat::Up,
            (true, false) => Seat::Down,
            _ => Seat::Table,
        }
    }
}

/// Where a dwell was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seat {
    /// On the table, at its angle.
    Table,
    /// Stood with the axis up, outside the table: a mounting of its own, leaning by an unknown small angle.
    Up,
    /// The same with the axis down.
    Down,
}

impl Seat {
    /// +1 up, −1 down, `None` on the table.
    #[must_use]
    pub fn vertical_sign(self) -> Option<f64> {
        match self {
            Self::Table => None,
            Self::Up => Some(1.0),
            Self::Down => Some(-1.0),
        }
    }
}

/// One angle with its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Position {
    /// The angle `φ` after the dial's sign, zero and the run's orientation.
    pub angle: Angle,
    /// On the table or stood upright.
    pub seat: Seat,
    /// What was read.
    pub readings: Readings,
    /// Mean temperature during the dwell.
    pub temperature_degc: Option<f64>,
    /// Where it was recorded, for people: `run-1.csv, dwell 7 (−24°)`.
    pub place: String,
    /// What the record shows beside the readings.
    pub record: Record,
}

/// A series of positions in one mounting and one power-up.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Name, unique within the experiment.
    pub name: String,
    /// Mounting; runs of one mounting share the misalignment, but for what turning the body does to it.
    pub mounting: String,
    /// Which way the body was turned. Angles of the positions have it already.
    pub orientation: Orientation,
    /// Positions in measured order.
    pub positions: Vec<Position>,
    /// Day of measurement, as given.
    pub date: Option<String>,
}

/// Which way the body is turned about the platform's normal.
///
/// **Model** `φ* = φ + ε + δ` normal, `φ* = −φ − ε + δ` reversed, `φ` the dial's angle after its sign and zero. `ε` belongs to
/// the table (zero, level), `δ` turns with the body (seat, cross-axis sensitivity). Angles of a reversed run are `−φ`, so its
/// misalignment is `δ − ε`, that of a normal one `δ + ε`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Orientation {
    /// As drawn.
    #[default]
    Normal,
    /// Turned by 180° about the platform's normal.
    Reversed,
}

impl Orientation {
    /// Sign of the table's zero `ε` in a run's misalignment.
    ///
    /// ```
    /// use tumble_core::Orientation;
    /// assert_eq!(Orientation::Reversed.sign(), -1.0);
    /// ```
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Normal => 1.0,
            Self::Reversed => -1.0,
        }
    }

    /// A mounting with its orientation, for people: `A`, `A reversed`.
    #[must_use]
    pub fn seating(self, mounting: &str) -> String {
        match self {
            Self::Normal => mounting.to_owned(),
            Self::Reversed => format!("{mounting} reversed"),
        }
    }
}

/// What an up/down pair is used for that belongs to no run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PairUse {
    /// The nominal scale factor only.
    #[default]
    NominalScale,
    /// Also, once, the joint adjustment of all runs, with a bias of its own.
    JointAdjustment,
}

/// Dwells with the axis up and down.
#[derive(Debug, Clone, PartialEq)]
pub struct VerticalPair {
    /// Axis up.
    pub up: Position,
    /// Axis down.
    pub down: Position,
    /// Name of the run in whose power-up they were taken.
    pub run: Option<String>,
    /// What they are used for without one.
    pub alone: PairUse,
}

/// Largest expanded uncertainties that still serve the user.
///
/// **Source** of the defaults: `docs/decisions/0004-default-targets.md`. They separate the paper's own plan
/// (−30…29°: usable) from arcs of ±10° and less (not usable) on the paper's bench, by a factor of three each way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Targets {
    /// Bias, m/s².
    pub bias_m_s2: f64,
    /// Misalignment, rad.
    pub misalignment_rad: f64,
    /// Scale error, relative.
    pub scale_error: f64,
}

impl Default for Targets {
    fn default() -> Self {
        Self { bias_m_s2: 0.03, misalignment_rad: 0.003, scale_error: 0.002 }
    }
}

impl Targets {
    /// In the order of the parameters.
    #[must_use]
    pub fn in_order(&self) -> [f64; 3] {
        [self.bias_m_s2, self.misalignment_rad, self.scale_error]
    }
}

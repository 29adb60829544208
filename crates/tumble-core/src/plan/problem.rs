//! What a plan is asked for: bench, sensor, time, and what is wanted.

use crate::estimate;
use crate::systematic::{Inputs, Quantity};
use crate::{Angle, Gravity, Seat, Targets};

/// What a plan can be asked to determine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// `Δa`, m/s².
    Bias,
    /// `Δφ`, rad.
    Misalignment,
    /// `δk`, relative.
    ScaleError,
    /// Quadratic nonlinearity, (m/s²)/(m/s²)².
    K2,
    /// Cubic nonlinearity, (m/s²)/(m/s²)³.
    K3,
    /// Bias per kelvin, m/s²/K: temperature that rises evenly during a run.
    BiasPerKelvin,
    /// Scale factor per kelvin, 1/K.
    ScalePerKelvin,
}

/// Terms that a plan can be asked for.
pub const TERMS: usize = 7;

impl Term {
    /// All, in the order of every array.
    pub const ALL: [Self; TERMS] = [
        Self::Bias,
        Self::Misalignment,
        Self::ScaleError,
        Self::K2,
        Self::K3,
        Self::BiasPerKelvin,
        Self::ScalePerKelvin,
    ];

    /// Index in arrays.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// The further term of the adjustment that it is; `None` for the first three.
    #[must_use]
    pub fn further(self) -> Option<estimate::Term> {
        match self {
            Self::Bias | Self::Misalignment | Self::ScaleError => None,
            Self::K2 => Some(estimate::Term::K2),
            Self::K3 => Some(estimate::Term::K3),
            Self::BiasPerKelvin => Some(estimate::Term::TempBias),
            Self::ScalePerKelvin => Some(estimate::Term::TempScale),
        }
    }

    /// Name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bias => "bias",
            Self::Misalignment => "misalignment",
            Self::ScaleError => "scale",
            _ => self.further().map_or("", estimate::Term::name),
        }
    }

    /// Name for people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::ScaleError => "scale error",
            Self::K2 => "K2",
            Self::K3 => "K3",
            Self::BiasPerKelvin => "bias per kelvin",
            Self::ScalePerKelvin => "scale per kelvin",
            _ => self.name(),
        }
    }

    /// Whether it needs a change of temperature: time tells it, not angles alone.
    #[must_use]
    pub fn needs_temperature(self) -> bool {
        self.further().is_some_and(estimate::Term::needs_temperature)
    }

    /// The systematic error whose place it takes where it is fitted.
    #[must_use]
    pub fn replaces(self) -> Option<Quantity> {
        match self {
            Self::Bias | Self::Misalignment | Self::ScaleError => None,
            Self::K2 => Some(Quantity::Quadratic),
            Self::K3 => Some(Quantity::Cubic),
            Self::BiasPerKelvin => Some(Quantity::BiasTempco),
            Self::ScalePerKelvin => Some(Quantity::ScaleTempco),
        }
    }

    /// Element of a position's equation, as in equation (6) of the method with `+ K2 a² + K3 a³` and temperature on bias and
    /// scale, `warmth_k` above the run's mean.
    #[must_use]
    pub fn column(self, site: Site, gravity_m_s2: f64, warmth_k: f64) -> f64 {
        let a = gravity_m_s2 * site.sine();
        match self {
            Self::Bias => 1.0,
            Self::Misalignment => gravity_m_s2 * site.cosine(),
            Self::ScaleError => -a,
            _ => self.further().map_or(0.0, |t| t.basis(a, warmth_k)),
        }
    }
}

/// Where a dwell is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Table angle.
    pub angle: Angle,
    /// On the table or stood upright.
    pub seat: Seat,
}

impl Site {
    /// On the table.
    #[must_use]
    pub fn table(angle_deg: f64) -> Self {
        Self { angle: Angle::from_deg(angle_deg), seat: Seat::Table }
    }

    /// Stood upright, up then down.
    pub const UPRIGHT: [Self; 2] = [
        Self { angle: Angle::from_rad(core::f64::consts::FRAC_PI_2), seat: Seat::Up },
        Self { angle: Angle::from_rad(-core::f64::consts::FRAC_PI_2), seat: Seat::Down },
    ];

    /// Share of gravity along the axis.
    #[must_use]
    pub fn sine(self) -> f64 {
        self.seat.vertical_sign().unwrap_or_else(|| self.angle.sin())
    }

    /// What an error of the table's angle does, over gravity; an upright dwell knows none.
    #[must_use]
    pub fn cosine(self) -> f64 {
        if self.is_upright() { 0.0 } else { self.angle.cos() }
    }

    /// Whether it stands off the table.
    #[must_use]
    pub fn is_upright(self) -> bool {
        self.seat.vertical_sign().is_some()
    }
}

/// Noise of the sensor in the coefficients of the Allan variance.
///
/// **Model** `σ²(τ) = N²/τ + (2 ln 2/π) B² + K² τ/3`, and a steady drift.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlanNoise {
    /// `N`, m/s² √s: one-sided density over √2.
    pub white_m_s2_rts: f64,
    /// `B`, m/s²: flicker.
    pub flicker_m_s2: f64,
    /// `K`, m/s² per √s: random walk.
    pub walk_m_s2_rts: f64,
    /// Steady drift, m/s² per s, standard: its sign is not known.
    pub ramp_m_s3: f64,
}

impl PlanNoise {
    /// N of the sensor alone, where readings were rounded when it was measured.
    ///
    /// **Model** rounding adds white noise of its own: `N² − N_r²`, not below zero. A plan reckons with the converter by itself.
    ///
    /// ```
    /// use tumble_core::plan::PlanNoise;
    /// assert!((PlanNoise::white_without_rounding(5e-4, 3e-4) - 4e-4).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn white_without_rounding(white_m_s2_rts: f64, rounding_m_s2_rts: f64) -> f64 {
        (white_m_s2_rts.powi(2) - rounding_m_s2_rts.powi(2)).max(0.0).sqrt()
    }

    /// N of readings that scatter by a standard deviation, `rate_hz` a second: `s/√rate`.
    #[must_use]
    pub fn white_of_sample(sample_m_s2: f64, rate_hz: f64) -> f64 {
        sample_m_s2 / rate_hz.sqrt()
    }

    /// N of a one-sided density `n` in m/s²/√Hz, as data sheets give it: `n/√2`.
    ///
    /// **Source** metrology notes, section 5.
    #[must_use]
    pub fn white_of_density(density_m_s2_rthz: f64) -> f64 {
        density_m_s2_rthz / 2f64.sqrt()
    }
}

/// The converter, as far as a plan depends on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanConverter {
    /// One LSB, m/s².
    pub lsb_m_s2: f64,
    /// Samples per second.
    pub rate_hz: f64,
}

/// How long things take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanTimes {
    /// To turn the table to an angle and read it, s.
    pub setting_s: f64,
    /// To let it settle before the dwell, s.
    pub settle_s: f64,
    /// To stand the body upright, or to take it off, s: instead of turning the table.
    pub upright_s: f64,
    /// From the end of a run to the first dwell of the next: power off, on, warm up, s.
    pub restart_s: f64,
}

/// Whether the bench can do something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Possible {
    /// It can.
    Yes,
    /// It cannot.
    No,
}

/// What is made small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Criterion {
    /// The largest uncertainty over its target. The default.
    Minimax,
    /// The mean square of the uncertainties over their targets.
    A,
    /// The volume of the confidence ellipsoid of all fitted terms.
    D,
}

/// What a plan is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanProblem {
    /// Lowest and highest angle of the table.
    pub range: (Angle, Angle),
    /// Step in which the dial is set.
    pub step: Angle,
    /// `σφ`: random error of setting an angle, standard.
    pub setting_scatter: Angle,
    /// `τ0`: scatter between positions that is the same at all angles, m/s², standard.
    pub level_scatter_m_s2: f64,
    /// Local gravity.
    pub gravity: Gravity,
    /// The sensor.
    pub noise: PlanNoise,
    /// The converter; `None`: its steps are small against everything else.
    pub converter: Option<PlanConverter>,
    /// Standard deviation of the bias between power-ups, m/s²; `None`: not known.
    pub turn_on_m_s2: Option<f64>,
    /// What no repetition averages out, as the budget knows it. Its [`Inputs::temperature_spread_k`] is the even rise of a
    /// run that terms of temperature are fitted to.
    pub systematics: Inputs,
    /// Lean of upright dwells, standard.
    pub upright_lean: Angle,
    /// How long things take.
    pub times: PlanTimes,
    /// Time for everything, s; `None`: as little as the targets need, or an hour without targets.
    pub total_s: Option<f64>,
    /// Dwells with the axis up and down, off the table, at the start of each run.
    pub upright: Possible,
    /// Turning the body by 180° on the platform between runs.
    pub remounting: Possible,
    /// Fitted beside bias, misalignment and scale error.
    pub further_terms: Vec<Term>,
    /// Largest expanded uncertainties that still serve, by [`Term::index`]; `None`: this term is not wanted, it is only
    /// fitted. All `None`: the defaults of [`Targets`] for the first three.
    pub targets: [Option<f64>; TERMS],
    /// What is made small.
    pub criterion: Criterion,
    /// Number of runs; `None`: chosen, at least three.
    pub runs: Option<u32>,
    /// Length of a dwell, s; `None`: chosen.
    pub dwell_s: Option<f64>,
    /// Angles that are there only to test the model.
    pub spares: usize,
    /// Level of confidence of expanded uncertainties.
    pub level: f64,
}

impl PlanProblem {
    /// A bench of ±`range` without anything known to be wrong, and the paper's table and times: 1° steps, a noise of
    /// 78 µg√s, 3′ of setting scatter, 30 s to turn and settle.
    #[must_use]
    pub fn with_range(range: Angle) -> Self {
        Self {
            range: (Angle::from_rad(-range.rad()), range),
            step: Angle::from_deg(1.0),
            setting_scatter: Angle::from_arcmin(3.0),
            level_scatter_m_s2: 0.0,
            gravity: Gravity::normal(50.0, 150.0),
            noise: PlanNoise { white_m_s2_rts: 7.6e-4, ..PlanNoise::default() },
            converter: None,
            turn_on_m_s2: None,
            systematics: Inputs::NONE,
            upright_lean: Angle::from_rad(0.0),
            times: PlanTimes { setting_s: 20.0, settle_s: 10.0, upright_s: 60.0, restart_s: 120.0 },
            total_s: None,
            upright: Possible::No,
            remounting: Possible::No,
            further_terms: Vec::new(),
            targets: [None; TERMS],
            criterion: Criterion::Minimax,
            runs: None,
            dwell_s: None,
            spares: DEFAULT_SPARES,
            level: 0.95,
        }
    }

    /// Terms that the adjustment fits, in order.
    #[must_use]
    pub fn terms(&self) -> Vec<Term> {
        let further = |t: &Term| self.further_terms.contains(t);
        let (first, rest) = Term::ALL.split_at(3);
        first.iter().chain(rest.iter().filter(|t| further(t))).copied().collect()
    }

    /// Targets of the wanted terms, as asked or by default.
    #[must_use]
    pub fn wanted(&self) -> [Option<f64>; TERMS] {
        if self.targets.iter().any(Option::is_some) {
            return self.targets;
        }
        let [bias, misalignment, scale] = Targets::default().in_order();
        [Some(bias), Some(misalignment), Some(scale), None, None, None, None]
    }

    /// What an uncertainty of a term is measured in: its target, or a size of the same order where it is not wanted.
    pub(super) fn unit(&self, term: Term) -> f64 {
        let [bias, misalignment, scale] = Targets::default().in_order();
        let g = self.gravity.value_m_s2;
        self.wanted()[term.index()].unwrap_or(match term {
            Term::Bias => bias,
            Term::Misalignment => misalignment,
            Term::ScaleError => scale,
            Term::K2 => bias / (g * g),
            Term::K3 => bias / (g * g * g),
            Term::BiasPerKelvin => bias,
            Term::ScalePerKelvin => scale,
        })
    }
}

/// Three: enough to tell a bow from an S, and one for what is neither.
pub const DEFAULT_SPARES: usize = 3;

//! Units that people read: conversions for display only.

use tumble_io::passport::{Passport, RunEstimates};

/// Minutes of arc in a radian.
const ARCMIN_PER_RAD: f64 = 180.0 * 60.0 / std::f64::consts::PI;
/// Scale errors from here on are shown in per cent, smaller ones in ppm.
const PERCENT_FROM: f64 = 0.005;

/// How a quantity is shown: the passport's number times `factor`, in `unit`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Unit {
    pub factor: f64,
    pub name: String,
}

impl Unit {
    fn new(factor: f64, name: impl Into<String>) -> Self {
        Self { factor, name: name.into() }
    }

    /// The number in this unit.
    pub fn of(&self, v: f64) -> f64 {
        v * self.factor
    }
}

/// One unit a quantity for a whole passport, so that tables and figures agree.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Units {
    pub bias: Unit,
    pub misalignment: Unit,
    pub scale_error: Unit,
    pub scale_factor: Unit,
    /// Name of the reading's unit, mostly `LSB`.
    pub reading: String,
}

/// The three parameters of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Parameter {
    Bias,
    Misalignment,
    ScaleError,
}

impl Parameter {
    pub const ALL: [Self; 3] = [Self::Bias, Self::Misalignment, Self::ScaleError];

    /// Name in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bias => "Bias",
            Self::Misalignment => "Misalignment",
            Self::ScaleError => "Scale error",
        }
    }

    /// This parameter of a run.
    pub fn in_run(self, estimates: &RunEstimates) -> Option<&tumble_io::passport::Estimate> {
        match self {
            Self::Bias => estimates.bias.as_ref(),
            Self::Misalignment => estimates.misalignment.as_ref(),
            Self::ScaleError => estimates.scale_error.as_ref(),
        }
    }
}

impl Units {
    /// Units that suit the sizes in this passport.
    pub fn of(passport: &Passport) -> Self {
        let scale_errors = passport
            .runs
            .iter()
            .filter_map(|r| r.estimates.scale_error.as_ref())
            .chain(passport.result.as_ref().map(|r| &r.scale_error));
        let largest = scale_errors
            .flat_map(|e| [e.value, e.standard_uncertainty.unwrap_or(0.0)])
            .fold(0.0, |m: f64, v| m.max(v.abs()));
        let reading = match passport.output.unit.as_str() {
            "" => "LSB".to_owned(),
            unit => crate::words::shortened(unit, 12),
        };
        Self {
            bias: Unit::new(1.0, "m/s²"),
            misalignment: Unit::new(ARCMIN_PER_RAD, "arcmin"),
            scale_error: if largest >= PERCENT_FROM { percent() } else { ppm() },
            scale_factor: Unit::new(1.0, format!("m/s² per {reading}")),
            reading,
        }
    }

    /// The unit of a parameter.
    pub fn parameter(&self, parameter: Parameter) -> &Unit {
        match parameter {
            Parameter::Bias => &self.bias,
            Parameter::Misalignment => &self.misalignment,
            Parameter::ScaleError => &self.scale_error,
        }
    }

    /// A second unit for the same parameter: bias in readings, misalignment in mrad, ppm for per cent and back.
    pub fn second(&self, parameter: Parameter, nominal_scale: f64) -> Option<Unit> {
        match parameter {
            Parameter::Bias => {
                (nominal_scale != 0.0).then(|| Unit::new(1.0 / nominal_scale, self.reading.clone()))
            }
            Parameter::Misalignment => Some(Unit::new(1e3, "mrad")),
            Parameter::ScaleError if self.scale_error == percent() => Some(ppm()),
            Parameter::ScaleError => Some(percent()),
        }
    }
}

fn percent() -> Unit {
    Unit::new(1e2, "%")
}

fn ppm() -> Unit {
    Unit::new(1e6, "ppm")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_degree_has_sixty_minutes() {
        let unit = Unit::new(ARCMIN_PER_RAD, "arcmin");
        assert!((unit.of(1f64.to_radians()) - 60.0).abs() < 1e-12);
    }
}

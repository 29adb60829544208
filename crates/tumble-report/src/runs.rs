//! Runs sorted into panels: one a parameter, misalignments one a mounting.

use tumble_io::passport::{Estimate, Passport, Run, Sequential};

use crate::standing;
use crate::units::{Parameter, Unit, Units};
use crate::words::shortened;

/// Most runs that figures and tables of runs show; beyond that they say so.
pub(crate) const MOST_RUNS: usize = 24;
/// Most mountings that get a panel of their own.
const MOST_MOUNTINGS: usize = 4;

/// One parameter (in one mounting), what the runs say of it and what came out.
pub(crate) struct Panel<'p> {
    pub parameter: Parameter,
    /// `Misalignment, mounting A`.
    pub title: String,
    pub unit: Unit,
    /// The runs together, where that may be shown.
    pub result: Option<&'p Estimate>,
    /// Index in the passport, run, its estimate.
    pub runs: Vec<(usize, &'p Run, &'p Estimate)>,
}

impl Panel<'_> {
    /// This panel's number of a sequential estimate, in its unit.
    pub fn sequential(&self, s: &Sequential) -> f64 {
        self.unit.of(match self.parameter {
            Parameter::Bias => s.bias,
            Parameter::Misalignment => s.misalignment,
            Parameter::ScaleError => s.scale_error,
        })
    }
}

/// Panels that have at least one run's estimate.
pub(crate) fn panels<'p>(passport: &'p Passport, units: &Units) -> Vec<Panel<'p>> {
    let mountings = mountings(passport);
    let mut out = Vec::new();
    for parameter in Parameter::ALL {
        let several = parameter == Parameter::Misalignment && mountings.len() > 1;
        let groups: Vec<Option<&str>> = if several {
            mountings.iter().take(MOST_MOUNTINGS).map(|m| Some(*m)).collect()
        } else {
            vec![None]
        };
        for mounting in groups {
            let runs: Vec<_> = passport
                .runs
                .iter()
                .enumerate()
                .take(MOST_RUNS)
                .filter(|(_, r)| mounting.is_none_or(|m| r.mounting == m))
                .filter_map(|(i, r)| parameter.in_run(&r.estimates).map(|e| (i, r, e)))
                .collect();
            if runs.is_empty() {
                continue;
            }
            let title = match mounting {
                Some(m) => format!("{}, mounting {}", parameter.name(), shortened(m, 20)),
                None => parameter.name().to_owned(),
            };
            let result = pooled(passport, parameter, mounting);
            out.push(Panel {
                parameter,
                title,
                unit: units.parameter(parameter).clone(),
                result,
                runs,
            });
        }
    }
    out
}

/// Mountings of the runs in order of appearance.
pub(crate) fn mountings(passport: &Passport) -> Vec<&str> {
    let mut seen: Vec<&str> = Vec::new();
    for run in &passport.runs {
        if !seen.contains(&run.mounting.as_str()) {
            seen.push(&run.mounting);
        }
    }
    seen
}

fn pooled<'p>(
    passport: &'p Passport,
    parameter: Parameter,
    mounting: Option<&str>,
) -> Option<&'p Estimate> {
    let result = standing::result(passport)?;
    if parameter == Parameter::Misalignment && separated(passport, mounting) {
        // The runs show it with the table's zero, the result without.
        return None;
    }
    match parameter {
        Parameter::Bias => Some(&result.bias),
        Parameter::ScaleError => Some(&result.scale_error),
        Parameter::Misalignment => match mounting {
            None => result.misalignment.as_ref(),
            Some(name) => result.mountings.iter().find(|m| m.name == name).map(|m| &m.misalignment),
        },
    }
}

/// Whether the table's zero stands apart from the misalignment of a mounting: its runs were taken in both orientations.
fn separated(passport: &Passport, mounting: Option<&str>) -> bool {
    let zero = standing::result(passport).is_some_and(|r| r.table_zero.is_some());
    let turned =
        |name: &str| passport.runs.iter().any(|r| r.mounting == format!("{name} reversed"));
    zero && mounting.is_some_and(|m| turned(m) || m.ends_with(" reversed"))
}

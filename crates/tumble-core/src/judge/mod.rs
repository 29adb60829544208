//! Judgement: what is worth knowing about the data and the estimates, as findings.
//!
//! Each file looks at one thing and returns findings; the verdict follows from their severities alone.

mod belonging;
mod budgeted;
mod copies;
mod dwell_fit;
mod hygiene;
mod identifiable;
mod misfit;
mod motion;
mod outlying;
mod plausible;
mod recorded;
mod reproducible;
mod reversed;
mod robust;
mod run_hygiene;
mod settled;
mod slip;
mod structure;
mod stuck_bit;
mod table;
mod together;
mod type_limits;
mod unit;
mod upright;
mod wrap;
mod zero_rows;

pub use belonging::{Belonging, FALSE_ALARM, belonging, of_farthest};
pub use budgeted::{assumed, intervals_differ};
pub use copies::identical_runs;
pub use hygiene::{Censored, Usable, usable_positions};
pub use identifiable::{determined_result, determined_run, few_angles};
pub use plausible::plausible;
pub use reproducible::reproducible;
pub use reversed::some_runs_reversed;
pub use run_hygiene::{Hygiene, data_hygiene};
pub use settled::settled;
pub use structure::{Structure, structure};
pub use table::{noise, slow_noise, table};
pub use together::{reversal, runs_differ};
pub use type_limits::{Judged, type_limits};

/// Thresholds that the explanations name, so that text and judgement cannot drift apart.
pub(crate) mod limits {
    pub(crate) use super::budgeted::{ASSUMED_SHARE, DIFFERS_BY};
    pub(crate) use super::copies::{COPIED_SHARE, FEWEST_COPIED};
    pub(crate) use super::dwell_fit::{
        FEWEST as FEWEST_DWELLS, LEAST_SCATTER_RAD, LEVEL as MISFIT_LEVEL, WRONG_SHARE,
    };
    pub(crate) use super::hygiene::STUCK_LIMIT_LSB;
    pub(crate) use super::identifiable::CONDITION_WARNING;
    pub(crate) use super::motion::{
        FEWEST_BLOCKS, HARM_LSB, HARM_SCATTERS, SIGNIFICANT as MOTION_SIGNIFICANT,
    };
    pub(crate) use super::outlying::{FAR, FAR_BLOCK, FAR_LSB};
    pub(crate) use super::plausible::{
        BIAS_UNUSUAL_M_S2, MISALIGNMENT_LIMIT_RAD, MISALIGNMENT_UNUSUAL_RAD, SCALE_ERROR_LIMIT,
        SCALE_ERROR_UNUSUAL, UNITS_RATIO,
    };
    pub(crate) use super::recorded::{MISSING_SAMPLES, MISSING_SHARE, RANGE_LIMIT_DEG, RATE_LIMIT};
    pub(crate) use super::reproducible::FEW;
    pub(crate) use super::settled::STEP_LIMIT;
    pub(crate) use super::structure::{MATERIAL_SHARE, SIGNIFICANCE as STRUCTURE_SIGNIFICANCE};
    pub(crate) use super::stuck_bit::FEWEST_CODES;
    pub(crate) use super::table::{
        HOPELESS_DEG, LITTLE_DITHER_LSB2, NOTEWORTHY_FACTOR, SIGNIFICANCE as TABLE_SIGNIFICANCE,
        SLOW_NOISE,
    };
    pub(crate) use super::together::DIFFER;
    pub(crate) use super::unit::{CODES_PER_G, FACTOR as UNIT_FACTOR};
    pub(crate) use super::wrap::BETTER as WRAP_BETTER;
    pub(crate) use super::zero_rows::{DOES_NOT_FIT, DOES_NOT_FIT_LSB};
}

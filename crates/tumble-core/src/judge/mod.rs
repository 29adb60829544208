//! Judgement: what is worth knowing about the data and the estimates, as findings.
//!
//! Each file looks at one thing and returns findings; the verdict follows from their severities alone.

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
mod table;
mod unit;
mod upright;
mod wrap;
mod zero_rows;

pub use hygiene::{Censored, Usable, identical_runs, usable_positions};
pub use identifiable::{determined_result, determined_run, few_angles};
pub use plausible::plausible;
pub use reproducible::reproducible;
pub use reversed::some_runs_reversed;
pub use run_hygiene::data_hygiene;
pub use settled::settled;
pub use structure::{Structure, structure};
pub use table::{noise, slow_noise, table};

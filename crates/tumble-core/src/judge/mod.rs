//! Judgement: what is worth knowing about the data and the estimates, as findings.
//!
//! Each file looks at one thing and returns findings; the verdict follows from their severities alone.

mod hygiene;
mod identifiable;
mod plausible;
mod reproducible;
mod settled;
mod structure;
mod table;
mod type_limits;

pub use hygiene::{Censored, Usable, identical_runs, usable_positions};
pub use identifiable::{determined_result, determined_run, few_angles};
pub use plausible::plausible;
pub use reproducible::reproducible;
pub use settled::settled;
pub use structure::{Structure, structure};
pub use table::{noise, slow_noise, table};
pub use type_limits::{Judged, type_limits};

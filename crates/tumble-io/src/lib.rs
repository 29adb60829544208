//! Experiment folders in, passports out: everything of Tumble that touches files, and the one pipeline.
//!
//! Only this crate knows serialized shapes. Arithmetic on measurands happens in `tumble-core`.

mod advice;
mod certify;
mod compensation;
mod csv;
mod date;
mod digest;
mod error;
mod experiment_file;
mod explained;
mod folder;
mod output;
pub mod passport;
mod simulation;
mod source;

pub use advice::{advice, advice_at};
pub use certify::{CertifyError, CertifyOptions, certify};
pub use compensation::{CompensationRefused, Proof, compensator};
pub use csv::{CodeStream, CodeStreamError, Reading};
pub use date::is_iso_date;
pub use error::{Place, Problem, ReadError};
pub use explained::explained_json;
pub use folder::{ExperimentFolder, FileDigest, read_experiment};
pub use output::{Existing, OutputError, OutputFolder, Written};
pub use simulation::{SimulationError, SimulationOptions, write_simulation};

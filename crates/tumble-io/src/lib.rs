//! Experiment folders in, passports out: everything of Tumble that touches files, and the one pipeline.
//!
//! Only this crate knows serialized shapes. Arithmetic on measurands happens in `tumble-core`.

mod certify;
mod compensation;
mod csv;
mod digest;
mod error;
mod experiment_file;
mod folder;
mod output;
pub mod passport;
mod simulation;
mod source;
mod zst;

pub use certify::{CertifyError, CertifyOptions, certify, certify_watched};
pub use compensation::{CompensationRefused, Proof, compensator};
pub use csv::{CodeStream, CodeStreamError, Reading};
pub use error::{Place, Problem, ReadError};
pub use folder::{ExperimentFolder, FileDigest, read_experiment};
pub use output::{Existing, OutputError, OutputFolder, Written};
pub use simulation::{SimulationError, SimulationOptions, write_simulation};
pub use source::Watch;

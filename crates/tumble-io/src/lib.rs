//! Experiment folders in, passports out: everything of Tumble that touches files, and the one pipeline.
//!
//! Only this crate knows serialized shapes. Arithmetic on measurands happens in `tumble-core`.

mod advice;
mod catalogue;
mod certify;
mod check;
mod compensation;
mod csv;
mod date;
mod digest;
mod error;
mod experiment_file;
mod explained;
mod folder;
#[doc(hidden)]
pub mod fuzzing;
mod init;
pub mod noise;
mod output;
pub mod passport;
mod plan;
mod simulation;
mod source;
mod toml_text;
mod zst;

pub use advice::{advice, advice_at};
pub use catalogue::{Catalogue, CatalogueEntry, Converter, ConverterMode, UserCatalogue};
pub use certify::{CertifyError, CertifyOptions, certify, certify_watched};
pub use check::{Check, CheckedDwell, CheckedRun, check};
pub use compensation::{CompensationRefused, Proof, compensator};
pub use csv::{CodeStream, CodeStreamError, Reading};
pub use date::is_iso_date;
pub use error::{Place, Problem, ReadError};
pub use explained::explained_json;
pub use folder::{ExperimentFolder, FileDigest, read_experiment, read_experiment_with};
pub use init::{Assumed, InitDraft, InitFacts, draft_experiment, experiment_file};
pub use output::{Existing, OutputError, OutputFolder, Written, write_file};
pub use plan::{
    PlanDocument, PlanFile, PlanRequest, PlanSettings, PlannedGain, PlannedLever, PlannedOrder,
    PlannedPaper, PlannedPosition, PlannedRuns, PlannedSource, PlannedTerm, plan_request,
    plan_toml, read_plan_file,
};
pub use simulation::{SimulationError, SimulationOptions, write_simulation};
pub use source::{Watch, open_text};

//! Plans as files: what is asked for (`bench.toml`), what was planned (`plan.toml`, JSON).

mod assumed;
mod document;
mod plan_file;
mod request;
mod settings;

pub use document::{
    PlanDocument, PlannedGain, PlannedLever, PlannedOrder, PlannedPaper, PlannedPosition,
    PlannedRuns, PlannedSource, PlannedTerm,
};
pub use plan_file::{PlanFile, plan_toml, read_plan_file};
pub use request::{PlanRequest, plan_request};
pub use settings::PlanSettings;

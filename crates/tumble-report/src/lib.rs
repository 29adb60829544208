//! Renders a passport: terminal text, figures (SVG) and one self-contained page (HTML).
//!
//! Pure functions from [`Passport`] to text. Nothing is judged, averaged or fitted here: numbers are rounded,
//! converted to the units that people read, and placed. What the passport does not say is left out and named,
//! never made up.
//!
//! Texts in a passport come from files that strangers wrote. Every public renderer calls [`sanitized`] first, and
//! all markup is built by `maud`, which escapes.
//!
//! Coefficients are shown only where the contract allows: accepted, or indeterminate for want of runs alone. A
//! rejected passport gets a report of why.

mod catalogue;
mod characters;
mod check;
mod conformity;
mod explain;
mod figure;
mod html;
mod merge;
mod noise;
mod numbers;
mod outliers;
mod plan;
mod runs;
mod sanitize;
mod standing;
mod summary;
mod units;
mod words;

pub use catalogue::{catalogue, catalogue_converter, catalogue_entry};
pub use check::{check_table, init_summary};
pub use explain::{explanation_list, explanation_page, explanations};
pub use figure::{Figure, figures};
pub use html::html;
pub use noise::{noise_figure, noise_page, noise_table};
pub use numbers::value_with_uncertainty;
pub use plan::{plan_checklist, plan_summary};
pub use sanitize::sanitized;
pub use summary::summary;
pub use tumble_io::passport::Passport;

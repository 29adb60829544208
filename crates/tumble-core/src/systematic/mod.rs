//! Errors that no scatter shows: of the dial, the table, gravity, the converter, the sensor's curve, temperature.
//!
//! [`Systematics`] is what the user states, [`Inputs`] what stands for each quantity with the reason, [`effects`] what each
//! does to the parameters of one run: derivatives through the run's own weighted equations.
//!
//! **Source** method section 10; `docs/budget.md` for the model, every formula and every default.

mod catalogued;
mod effect;
mod inputs;
mod linearized;
mod pattern;
mod quantity;
mod resolution;
mod stated;

pub use catalogued::{DEFAULT_K2_PER_M_S2, DEFAULT_K3_PER_M2_S4};
pub use effect::{SystematicEffect, effects, upright_lean};
pub use inputs::{DEFAULT_ACCURACY_ARCMIN, DEFAULT_TILT_ARCMIN, Input, Inputs};
pub use linearized::{ExtraColumn, Linearized, Shift};
pub use pattern::{Planned, Sites, pattern};
pub use quantity::{Quantity, Shape};
pub use resolution::left_over;
pub use stated::Systematics;

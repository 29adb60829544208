//! Decisions of conformity: whether a value with an uncertainty meets limits, by which rule, and at which risk.
//!
//! The way of a decision: [`Limits`] and what is known of the value ([`Belief`]) → a [`Rule`] gives the acceptance limits
//! and the [`Status`] → [`Belief::conformity`] the risk of that very decision, [`Rule::worst_case`] the largest risk that
//! the rule allows, [`global_risk`] the share of wrong decisions over a production that is known.
//!
//! **Source** JCGM 106:2012; ILAC-G8:09/2019. The formulas stand in `docs/conformity.md`.

mod belief;
mod global;
mod limits;
mod rule;
mod specification;

pub use belief::{Belief, ConformityProbability, Distribution};
pub use global::{GlobalRisk, Production, global_risk};
pub use limits::Limits;
pub use rule::{GuardMultiple, Rule, Status, WorstCase};
pub use specification::{Quantity, Requirement, Specification};

//! What the user asks of a unit: limits, the rule that decides, and what is known of the production.

use super::{Limits, Production, Rule};
use crate::estimate::Parameter;

/// A quantity of the result that can have limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// One of the parameters.
    Parameter(Parameter),
    /// The scale factor `k*`, m/s² per LSB.
    ScaleFactor,
}

impl Quantity {
    /// All, in the order in which they are judged.
    pub const ALL: [Self; 4] = [
        Self::Parameter(Parameter::Bias),
        Self::Parameter(Parameter::Misalignment),
        Self::Parameter(Parameter::ScaleError),
        Self::ScaleFactor,
    ];

    /// Name in the passport.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Parameter(p) => p.name(),
            Self::ScaleFactor => "scale_factor",
        }
    }

    /// Unit of the value and of its limits, as the passport writes it.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Parameter(p) => p.unit(),
            Self::ScaleFactor => "m/s2/LSB",
        }
    }

    const fn index(self) -> usize {
        match self {
            Self::Parameter(Parameter::Bias) => 0,
            Self::Parameter(Parameter::Misalignment) => 1,
            Self::Parameter(Parameter::ScaleError) => 2,
            Self::ScaleFactor => 3,
        }
    }
}

/// Limits of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Requirement {
    /// What it has to keep.
    pub limits: Limits,
    /// How the production spreads; asks for global risks.
    pub production: Option<Production>,
}

/// What the user asks of a unit. Without any limits nothing is judged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Specification {
    /// Which document the limits come from, free text.
    pub name: Option<String>,
    /// The rule that decides.
    pub rule: Rule,
    requirements: [Option<Requirement>; 4],
}

impl Specification {
    /// Longest name of a document, in characters: it stands in a statement that has to stay readable.
    pub const LONGEST_NAME: usize = 80;

    /// A specification without limits so far.
    #[must_use]
    pub fn new(name: Option<String>, rule: Rule) -> Self {
        Self { name, rule, requirements: [None; 4] }
    }

    /// Asks for limits of a quantity.
    pub fn require(&mut self, quantity: Quantity, requirement: Requirement) {
        self.requirements[quantity.index()] = Some(requirement);
    }

    /// What is asked of a quantity.
    #[must_use]
    pub fn of(&self, quantity: Quantity) -> Option<&Requirement> {
        self.requirements[quantity.index()].as_ref()
    }

    /// All that is asked, in order.
    pub fn requirements(&self) -> impl Iterator<Item = (Quantity, &Requirement)> {
        Quantity::ALL.into_iter().filter_map(|j| self.of(j).map(|r| (j, r)))
    }
}

//! The verdict on the calibration: it follows from the severities of the findings, nothing else.

use crate::{Finding, FindingKind, Severity};

/// The verdict on a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The numbers deserve belief.
    Accepted,
    /// The data contradict the model.
    Rejected,
    /// Something is missing.
    Indeterminate,
}

impl Verdict {
    /// Name in the passport.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::Rejected => "rejected",
            Self::Indeterminate => "indeterminate",
        }
    }
}

/// Any contradiction rejects; otherwise anything missing leaves it open; otherwise it is accepted.
#[must_use]
pub fn verdict(findings: &[Finding]) -> Verdict {
    match findings.iter().map(|f| f.kind.severity()).max() {
        Some(Severity::Reject) => Verdict::Rejected,
        Some(Severity::Missing) => Verdict::Indeterminate,
        _ => Verdict::Accepted,
    }
}

/// Whether coefficients may be given: accepted, or indeterminate for want of runs alone.
#[must_use]
pub fn may_carry_result(findings: &[Finding]) -> bool {
    findings.iter().all(|f| f.kind.severity() < Severity::Missing || for_want_of_runs(f.kind))
}

/// Whether a kind asks for more runs and nothing else.
pub(crate) fn for_want_of_runs(kind: FindingKind) -> bool {
    matches!(kind, FindingKind::OneRun | FindingKind::RunsTooFew)
}

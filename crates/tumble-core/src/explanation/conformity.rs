//! T04xx: the unit against its specification.

use super::Explanation;
use crate::assess::LOW_TEST_UNCERTAINTY_RATIO;

const SOURCE: &str = "JCGM 106:2012; ILAC-G8:09/2019; docs/conformity.md";

pub(super) fn low_uncertainty_ratio() -> Explanation {
    Explanation::new(
        format!(
            "The tolerance in [spec] is less than {LOW_TEST_UNCERTAINTY_RATIO} times 2U wide (test uncertainty ratio). \
             The limit is a choice: there a guard band of one U on both sides takes a third of the tolerance."
        ),
        "The decision on the unit then mostly reflects the uncertainty of its calibration: good units are failed, or bad \
         ones passed, depending on the rule. The risk stands beside the decision.",
        "Lower U: more runs, a table that repeats better, dwells with the axis up and down. Or agree wider limits with the \
         customer. The coefficients are not touched by this.",
        SOURCE,
    )
}

pub(super) fn nothing_could_pass() -> Explanation {
    Explanation::new(
        "The guard bands at both limits of [spec] meet: whatever value the unit had, this rule could not pass it. A value \
         inside of the limits is then not assessed; one outside fails.",
        "A fail would say something about the measurement, not about the unit.",
        "Lower U, agree wider limits, or a rule that can answer: `decision_rule = \"non-binary\"` gives a conditional \
         pass, a smaller `guard_band` a larger risk that is stated.",
        SOURCE,
    )
}

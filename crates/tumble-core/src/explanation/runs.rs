//! Explanations of what runs say together.

use super::Explanation;
use crate::judge::limits::DIFFER;

const TOGETHER: &str = "method, section 9; docs/runs.md";
const REVERSAL: &str = "method, section 7; docs/runs.md";

pub(super) fn runs_differ() -> Explanation {
    Explanation::new(
        format!(
            "Cochran's Q compares the spread of the runs with their own uncertainties. Were there no spread between \
             power-ups, a Q that large would have a probability below {DIFFER}."
        ),
        "The value changes from power-up to power-up, as the bias of most accelerometers does. The result holds that \
         spread: its interval is for the mean over power-ups, the predictions are for the next one.",
        "Nothing, where the spread is what the sensor's type has. Otherwise compare temperature, warm-up and mounting of \
         the runs.",
        TOGETHER,
    )
}

pub(super) fn reversal_separates() -> Explanation {
    Explanation::new(
        "In one mounting there are runs with the body as drawn and with the body turned by 180° about the platform's \
         normal.",
        "What belongs to the table (zero of the dial, level) changes its sign against what turns with the body (seat, \
         cross-axis sensitivity). So the two are told apart: the misalignment is the body's part alone, and the table's \
         zero is given beside it.",
        "Nothing. The table's zero may be taken out on the table or with `angle_zero_deg` in [bench].",
        REVERSAL,
    )
}

pub(super) fn reversal_alone() -> Explanation {
    Explanation::new(
        "A run is marked `orientation = \"reversed\"`, and no run in normal orientation has the same mounting.",
        "The misalignment is then that of the body less the table's zero, and neither is known alone.",
        "If the body stayed on its seat when it was turned, write the same `mounting` in both runs. Otherwise measure a \
         run in the normal orientation in this mounting.",
        REVERSAL,
    )
}

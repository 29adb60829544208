//! T0131 to T0133: positions that do not belong, and positions that were left out.

use super::Explanation;
use crate::assess::LEAVABLE_SHARE;
use crate::judge::FALSE_ALARM;
use crate::judge::limits::FEWEST_DWELLS;

const SOURCE: &str =
    "docs/outliers.md; Cook and Weisberg, Residuals and Influence in Regression (1982)";

pub(super) fn does_not_belong() -> Explanation {
    Explanation::new(
        format!(
            "After the adjustment each position is held against the others alone (externally studentized residual, in \
             runs of {FEWEST_DWELLS} positions and more). The farthest is named where chance would bring one so far out \
             in less than {} % of honest experiments; then the next without it.",
            100.0 * FALSE_ALARM
        ),
        "One position off by several times the scatter pulls bias, misalignment and scale with it; by how much is in \
         the finding and in the table of the report. It stays in the result until you decide.",
        "Look into the notes and at the table there, and measure that position again. If the notes say why it is \
         wrong, leave it out with `--leave-out RUN:POSITION`, or `leave_out = [POSITION]` in its [[run]]; the passport \
         records it. In one honest experiment of a hundred it is chance: then leave it in.",
        SOURCE,
    )
}

pub(super) fn left_out_by_user() -> Explanation {
    Explanation::new(
        "Positions were left out of the adjustment because `--leave-out` or `leave_out` says so. The finding lists \
         them, says which of them nothing in the data speaks against, and gives the result with and without them.",
        "Leaving out what looks wrong makes the rest agree better than it should. Where the worst position is always \
         left out, intervals at 95 % cover 87 % with 12 positions and 92 % with 60 (docs/outliers.md).",
        "Write the reason into `note` of the run: a knock, a slip of the hand, a line of the log. Without a reason put \
         the position back; measure it again if you can.",
        SOURCE,
    )
}

pub(super) fn too_many_left_out() -> Explanation {
    Explanation::new(
        format!(
            "More than one in {LEAVABLE_SHARE} positions of a run was left out on request (one is always allowed)."
        ),
        "Whoever may choose which positions count can reach almost any result. The rest shows a good table whatever \
         the table was.",
        "Find out what disturbs the bench and measure the run again. If a whole part of it was disturbed, \
         for instance after a knock, make a run of the good part and say so in `note`.",
        SOURCE,
    )
}

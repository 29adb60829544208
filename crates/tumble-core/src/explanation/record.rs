//! T0118 to T0130, T0314, T0317 to T0319: what the record itself gives away.

use super::Explanation;
use crate::judge::limits::{
    CODES_PER_G, DOES_NOT_FIT, DOES_NOT_FIT_LSB, FAR, FAR_BLOCK, FAR_LSB, FEWEST_BLOCKS,
    FEWEST_DWELLS, HARM_LSB, HARM_SCATTERS, MISFIT_LEVEL, MISSING_SAMPLES, MISSING_SHARE,
    MOTION_SIGNIFICANT, RATE_LIMIT, UNIT_FACTOR, WRAP_BETTER, WRONG_SHARE,
};

const HYGIENE: &str = "method, section 5 (data hygiene)";

pub(super) fn codes_wrap() -> Explanation {
    Explanation::new(
        format!(
            "The codes jump from one end of a power of two to the other where the reading passes zero: signed words of \
             the converter (two's complement) were read as unsigned. With the sign put back the run follows its angles \
             {WRAP_BETTER} times better."
        ),
        "A reading of -1 then stands as 65535 in a word of 16 bits. Averages over such codes mean nothing.",
        "Write `code_bits = 16` in [csv] (the width of the word that the finding names): the codes are then read with \
         their sign. Next time read the word as signed in the logger.",
        HYGIENE,
    )
}

pub(super) fn mistyped_angle() -> Explanation {
    Explanation::new(
        format!(
            "One angle contradicts the others, and a number that differs from it by a slip of the pen (12 for 21, a lost \
             sign, a lost decimal point, the angle before not advanced) would fit. It is judged by leaving that position \
             out of the fit, in runs of {FEWEST_DWELLS} positions and more, at a level of {MISFIT_LEVEL} a run. Up to one \
             position in {WRONG_SHARE} can be named."
        ),
        "One wrong angle bends the whole fit. 9° in one of 60 positions can move the bias further than all noise \
         together.",
        "Look into the notes of the measurement. If they show the other angle, correct it in the file. If they show \
         the angle as it stands, do not touch it because the fit would like that: measure the position again, or \
         remove it with a remark in `note`.",
        HYGIENE,
    )
}

pub(super) fn zero_rows() -> Explanation {
    Explanation::new(
        format!(
            "The record ends in rows of zeros that do not belong to the readings before them: the others expect a \
             reading more than {DOES_NOT_FIT} standard deviations and {DOES_NOT_FIT_LSB} LSB away, or zero stands far \
             outside its own dwell. Loggers fill an unfinished block that way."
        ),
        "Zeros are legal codes. Averaged in, they pull their dwell toward zero, and if the angle is zero as well they \
         count as a dwell that nobody measured.",
        "Remove the zero rows from the end of the file. If dwells are missing because the logger stopped early, \
         measure them again.",
        HYGIENE,
    )
}

pub(super) fn dwell_does_not_fit() -> Explanation {
    Explanation::new(
        format!(
            "One position contradicts the fit of all the others (leave one out, at a level of {MISFIT_LEVEL} a run), and \
             no slip of the pen explains its angle."
        ),
        "If the reading or the angle is wrong, the position pulls all values its way. If it is right, the model does not hold there.",
        "Measure that angle once more. If the new dwell fits, the first one was disturbed: remove it and say so in \
         `note`. If it does not, look at the table there: a worn spot, a cable that pulls, a stop.",
        HYGIENE,
    )
}

pub(super) fn dwell_drifts() -> Explanation {
    Explanation::new(
        format!(
            "The reading moves in one direction through a dwell: by {MOTION_SIGNIFICANT} standard errors of its blocks \
             ({FEWEST_BLOCKS} blocks and more), more than the other dwells of the run do, and by enough to shift its mean \
             by {HARM_SCATTERS} times the scatter of the positions and {HARM_LSB} LSB."
        ),
        "The table was still creeping, or the sensor was still warming up. The mean of the dwell belongs to no single \
         angle and no single temperature.",
        "Wait after each setting until the reading stands, or throw the start of each dwell away: `discard_s = 2.0` in \
         its [[run]], or `discard_s = \"detect\"`. If dwells drift all through the run, let the sensor warm up before it.",
        HYGIENE,
    )
}

pub(super) fn dwell_two_levels() -> Explanation {
    Explanation::new(
        format!(
            "The reading stands at one level in the first part of a dwell and at another in the rest: {MOTION_SIGNIFICANT} \
             standard errors apart, and enough to shift the mean by {HARM_SCATTERS} times the scatter of the positions \
             and {HARM_LSB} LSB."
        ),
        "The table or the sensor moved, or somebody touched the bench. The mean is neither of the two levels, and at \
         0° one minute of arc is already 0.37 LSB of the paper's sensor.",
        "Clamp the platform before the dwell starts and let go of it. Measure that angle again, or keep only the part \
         before or after the step if the notes say at which angle the table then stood.",
        HYGIENE,
    )
}

pub(super) fn outlying_samples() -> Explanation {
    Explanation::new(
        format!(
            "Single samples stand farther from the middle of their dwell than {FAR} robust standard deviations and \
             {FAR_LSB} LSB. Of real readings only blocks are kept: there it is a block beyond {FAR_BLOCK} of them."
        ),
        "Spikes come from the link, the supply or a knock on the bench. A few of them move the mean of a dwell, and \
         they make the noise look larger than it is.",
        "Look at the named lines. Mend the cause (cable, grounding, a lost bit) and measure the dwell again; remove \
         samples only where the logger itself marks them as bad.",
        HYGIENE,
    )
}

pub(super) fn outside_type_limits() -> Explanation {
    Explanation::new(
        "A value of this unit lies outside the limits that the catalogue has for its type.",
        "The unit may be out of its data sheet, or `model` names another type or range. A unit out of its limits with \
         a sound calibration still gets its coefficients.",
        "Check `model` in [sensor] and the range that is switched on. If both are right, the calibration stands; \
         decide whether the unit is good enough for its use.",
        "method, section 5 (plausibility)",
    )
}

pub(super) fn time_backwards() -> Explanation {
    Explanation::new(
        "The recorded time steps back between two rows.",
        "Rows are out of order, the logger's clock was set, or two records were joined. Drift within dwells and the \
         order of positions are then not what they seem.",
        "If records were joined, give each its own [[run]] or dwell file. If rows are out of order, export the record \
         again in order of time. If the clock was set, leave the time column out of the file.",
        HYGIENE,
    )
}

pub(super) fn rate_disagrees() -> Explanation {
    Explanation::new(
        format!(
            "The recorded times run at another rate than `rate_hz` in [output] says, by more than {} %.",
            100.0 * RATE_LIMIT
        ),
        "`discard_s` and everything that counts in seconds cut at the wrong row. Bias and scale do not depend on the \
         rate, but noise densities do.",
        "Write the rate that the record shows as `rate_hz` in [output], or, where the times count \
         milliseconds, `time_unit = \"ms\"` in [csv].",
        HYGIENE,
    )
}

pub(super) fn missing_samples() -> Explanation {
    Explanation::new(
        format!(
            "Between recorded times there is room for samples that are not in the record: {MISSING_SAMPLES} of a dwell, \
             or more than {} % of it.",
            100.0 * MISSING_SHARE
        ),
        "The mean of the dwell hardly suffers. But samples are often lost when something disturbs the link, and then \
         the neighbours deserve a look.",
        "Check link and logger for lost packets. If only a few samples of a long dwell are gone, go on; if a large part \
         is gone, measure that dwell again.",
        HYGIENE,
    )
}

pub(super) fn repeated_samples() -> Explanation {
    Explanation::new(
        "Two or more rows carry the same time.",
        "A sample that is written twice counts twice: the mean looks better known than it is.",
        "Check whether the logger polls faster than the sensor delivers. Log at the sensor's own rate (its data-ready \
         signal), or write times with enough digits.",
        HYGIENE,
    )
}

pub(super) fn unit_is_not_the_scales() -> Explanation {
    Explanation::new(
        format!(
            "The readings are of a size that does not go with the nominal scale: by a factor of {UNIT_FACTOR} and more, or \
             fewer than {CODES_PER_G} codes per g. Volts, g or m/s² stand where codes should be, or the scale is one per \
             another unit."
        ),
        "Scale and bias would come out in the wrong unit, and wrong by the size of an LSB.",
        "For readings in volts write in [output] `quantizer = \"none\"`, `unit = \"V\"` and `nominal_scale` in m/s² per \
         volt, and call the column `output`. Otherwise log the converter's codes.",
        "method, section 5 (units mixed up)",
    )
}

pub(super) fn ignored_columns() -> Explanation {
    Explanation::new(
        "A run file has columns that Tumble does not know and did not use.",
        "Usually there is nothing wrong: a counter, a second axis. But a time or temperature column under another name \
         is lost with what it could have shown.",
        "If one of them matters, name it in its [[run]], for instance `columns = {temperature_degc = \"Temp\"}`. \
         Otherwise nothing.",
        "docs/experiment.md, `columns`",
    )
}

pub(super) fn rows_without_reading() -> Explanation {
    Explanation::new(
        "Rows have an angle and no reading. They were left out and nothing was put in their place.",
        "A few empty cells do no harm. Many of them mean that the logger or the link failed, and that the dwells are \
         shorter than planned.",
        "Look at the named lines. If the cells should have held readings, export the record again or measure those \
         dwells again.",
        HYGIENE,
    )
}

pub(super) fn settling_left_out() -> Explanation {
    Explanation::new(
        "The start or the end of dwells was left out of the averages, because the table had not come to rest there.",
        "Rows taken while the platform still moves belong to no angle. Leaving them out costs a few samples of noise \
         and nothing else.",
        "Check that the time left out suits your table. To set it yourself, write `discard_s = 2.0` in the [[run]].",
        "method, section 5; docs/experiment.md, `discard_s`",
    )
}

pub(super) fn dwells_cut_out() -> Explanation {
    Explanation::new(
        "The record runs on while the table is turned. The dwells were cut out of it, and the rows between them were not used.",
        "The cut decides which rows count for which angle. A cut at the wrong place mixes movement into a dwell.",
        "Compare number and length of the dwells in the report with your notes. If they differ, write one file a dwell \
         (`files = [{file = \"a.csv\", angle_deg = -30.0}]`) or an angle in every row.",
        HYGIENE,
    )
}

//! T0101 to T0117: values that no sensor has, converters that do not convert, structure that is left over.

use super::Explanation;
use crate::STANDARD_GRAVITY_M_S2;
use crate::judge::limits::{
    BIAS_UNUSUAL_M_S2, COPIED_SHARE, FEWEST_CODES, FEWEST_COPIED, HOPELESS_DEG, MATERIAL_SHARE,
    MISALIGNMENT_LIMIT_RAD, MISALIGNMENT_UNUSUAL_RAD, SCALE_ERROR_LIMIT, SCALE_ERROR_UNUSUAL,
    STEP_LIMIT, STRUCTURE_SIGNIFICANCE, STUCK_LIMIT_LSB, UNITS_RATIO,
};

const PLAUSIBILITY: &str = "method, section 5 (plausibility)";
const HYGIENE: &str = "method, section 5 (data hygiene)";

pub(super) fn sign_reversed() -> Explanation {
    Explanation::new(
        "The reading falls where the angle rises. The fit shows it as a misalignment beyond 90°, with `--method \
         paper` as a negative scale factor.",
        "A dial that counts the other way, a sensor that sits turned round and an output with inverted sign all \
         look alike in the data. Only the person at the table knows which it is, and a wrong guess gives readings \
         with the wrong sign.",
        "Turn the table so that the arrow of the axis points up, and look at the reading. If it rises, the dial \
         counts the other way: write `angle_sign = -1` in [bench]. If it falls, the sensor sits turned round or its \
         output is inverted: turn the sensor and measure again.",
        "method, sections 2 and 5; docs/experiment.md, `angle_sign`",
    )
}

pub(super) fn units_mixed_up() -> Explanation {
    Explanation::new(
        format!(
            "The scale factor found is {} to {} times `nominal_scale`, or the other way round. Such a ratio is what g \
             written for m/s² gives ({STANDARD_GRAVITY_M_S2}).",
            UNITS_RATIO.start, UNITS_RATIO.end
        ),
        "Scale error, bias in LSB and every limit refer to the nominal scale. With the wrong unit all of them are \
         wrong by a factor of ten.",
        format!(
            "Write `nominal_scale` in [output] in m/s² per LSB: g per LSB times {STANDARD_GRAVITY_M_S2}. A data \
             sheet's 0.784 mg per LSB is `nominal_scale = 0.00769`."
        ),
        HYGIENE,
    )
}

pub(super) fn scale_implausible() -> Explanation {
    Explanation::new(
        format!(
            "The scale factor found is off the nominal one by more than {:.0} %, beyond its own uncertainty.",
            SCALE_ERROR_LIMIT * 100.0
        ),
        "Data sheets allow 4 to 8 %. Half or twice the scale is another measuring range, another sensor, or a \
         column that does not hold the table's angles in degrees.",
        "Compare `nominal_scale` with the data sheet for the range that is switched on, in m/s² per LSB and not \
         LSB per m/s². Then look whether the angle column really holds degrees and not minutes, radians or turns.",
        PLAUSIBILITY,
    )
}

pub(super) fn bias_impossible() -> Explanation {
    Explanation::new(
        "The bias is larger than local gravity itself (1 g), beyond its own uncertainty.",
        "No working accelerometer reads more than 1 g while it lies level. It is nearly always an offset of the \
         coding: codes from 0 to 4095 with level at 2048, for instance.",
        "Look at the code with the axis level. If it is half of the converter's range, the codes are offset: \
         subtract that half in the file. If the code is right, check the angle column and `angle_zero_deg` in [bench].",
        PLAUSIBILITY,
    )
}

pub(super) fn misalignment_impossible() -> Explanation {
    Explanation::new(
        format!(
            "The axis seems to point {:.0}° or more away from where the dial says, beyond the uncertainty of that \
             angle.",
            MISALIGNMENT_LIMIT_RAD.to_degrees()
        ),
        "No seat is that crooked. So the angles are not what the table stood at, and everything that is computed \
         from them is wrong.",
        "Look at the angle column. If it counts steps or positions, write degrees. If the dial reads something \
         other than 0 with the axis level, write that reading as `angle_zero_deg` in [bench].",
        PLAUSIBILITY,
    )
}

pub(super) fn unusual() -> Explanation {
    Explanation::new(
        format!(
            "A value that is possible and rare: scale error beyond {:.0} %, misalignment beyond {:.1}° or bias \
             beyond {BIAS_UNUSUAL_M_S2} m/s², each beyond its own uncertainty.",
            SCALE_ERROR_UNUSUAL * 100.0,
            MISALIGNMENT_UNUSUAL_RAD.to_degrees()
        ),
        "It may be the sensor. More often it is `nominal_scale`, the zero of the dial or the level of the table. \
         The result is computed as it stands.",
        "Check the value against the data sheet. Scale: `nominal_scale` in [output]. Misalignment: level the \
         table, or write `angle_zero_deg` in [bench]. Bias: supply and reference of the converter.",
        PLAUSIBILITY,
    )
}

pub(super) fn stuck_converter() -> Explanation {
    Explanation::new(
        format!(
            "Two dwells in a row show the same single code (averages: the same mean and scatter to the last digit), \
             although the angle moved by more than {STUCK_LIMIT_LSB} LSB's worth; one code in a quiet dwell is normal. \
             Or a low bit is the same in {FEWEST_CODES} different codes and more, so that codes are missing."
        ),
        "The logger repeats an old sample, or the converter hangs. Readings that do not follow the table are no \
         measurement, and they pull bias and scale to wherever they stopped.",
        "Tilt the sensor by hand and watch the code: it must move. If it stays, restart converter and logger, and \
         check that each row is a fresh sample. Then measure the run again. Words of 12 bits in the upper end of 16: \
         divide the codes by 16 and give `nominal_scale` per true step.",
        HYGIENE,
    )
}

pub(super) fn saturated_throughout() -> Explanation {
    Explanation::new(
        "Every dwell of the run holds codes at the converter's end (`min_code` or `max_code`).",
        "A code at the end says only \"this or more\". With nothing but such codes there is no reading to fit.",
        "Choose a range of the sensor that covers ±1 g, or lower the gain before the converter, and measure again. \
         If the codes are sound, correct `min_code` and `max_code` in [output].",
        "method, section 2 (the end codes stand for half-lines)",
    )
}

pub(super) fn saturated_dwell() -> Explanation {
    Explanation::new(
        "Some dwells hold codes at the converter's end (`min_code` or `max_code`). With `--method likelihood` \
         their codes count as bounds; the other methods leave such dwells out.",
        "An average over cut-off codes is too small, so it is never used. What is lost is the information of those \
         angles, and they are the far ones that separate bias from misalignment.",
        "Keep the angles where the codes stay off the ends, or lower the gain. With `--method exact` or `paper`, \
         change to `--method likelihood`.",
        "method, section 2; docs/estimators.md",
    )
}

pub(super) fn scatter_hopeless() -> Explanation {
    Explanation::new(
        format!(
            "The positions scatter around the fitted curve as if the angles had been set to {HOPELESS_DEG}° or worse \
             (and by more than 1 LSB)."
        ),
        "A table set by hand repeats to a few minutes of arc. Scatter of a degree means that readings and angles do \
         not belong together, and then no number from the fit means anything.",
        "Check that the angle column holds the table's angles in degrees, in the order in which they were measured. \
         Then check that the table stood still during each dwell, and that nobody leaned on the bench.",
        HYGIENE,
    )
}

pub(super) fn quadratic_residual() -> Explanation {
    Explanation::new(
        format!(
            "What the fit leaves over follows the square of the acceleration (p below {STRUCTURE_SIGNIFICANCE}, \
             divided by the number of runs where each is tested alone), and its peak is more than {MATERIAL_SHARE} \
             of the scatter of the positions."
        ),
        "The data are not linear, and bias and scale of a straight line through a curve depend on the angles that \
         were chosen. Even 100 µg/g² of curvature, far too little to see, moves the bias by 0.13 to 0.24 LSB.",
        "Look at the figure of the residuals. One wrong point at one end: correct that angle or measure it again. A \
         smooth bow: repeat the run over a smaller range of angles; if the bow stays, the sensor is curved, and a \
         linear passport does not suit it.",
        "method, sections 5 and 8; K2 of IEEE 1293",
    )
}

pub(super) fn cubic_residual() -> Explanation {
    Explanation::new(
        format!(
            "What the fit leaves over follows the cube of the acceleration (p below {STRUCTURE_SIGNIFICANCE}, divided \
             by the number of runs where each is tested alone), and its peak is more than {MATERIAL_SHARE} of the \
             scatter of the positions."
        ),
        "Either the sensor is bent in an S, or the dial is: an eccentric or wrongly divided dial looks just like \
         it. 3' of eccentricity at ±65° shift the scale by 568 ppm.",
        "Measure another sensor on the same table. If it shows the same S, the dial is wrong: check it against a \
         reference. If not, the sensor is: repeat the run over a smaller range of angles.",
        "method, sections 5, 8 and 10; K3 of IEEE 1293",
    )
}

pub(super) fn small_structure() -> Explanation {
    Explanation::new(
        format!(
            "A curvature is there beyond doubt (p below {STRUCTURE_SIGNIFICANCE}), but its peak is at most \
             {MATERIAL_SHARE} of the scatter of the positions."
        ),
        "It does not spoil this result visibly: it is smaller than what the positions scatter by. But it is a \
         systematic error, so more runs or longer dwells do not average it out.",
        "Nothing, if the stated uncertainty serves. For more: look at the residuals against the angle, check the dial \
         against a reference, or use a smaller range of angles.",
        "method, section 5; K2 and K3 of IEEE 1293",
    )
}

pub(super) fn runs_identical() -> Explanation {
    Explanation::new(
        format!(
            "Two runs have the same angles and the same readings, to the last digit, in all dwells or in {} % of them \
             ({FEWEST_COPIED} and more). Noise never repeats, so one is a copy of the other, perhaps with rows changed. \
             Dwells with a single code, and averages to two decimals, do not count.",
            100.0 * COPIED_SHARE
        ),
        "A copy agrees with its original perfectly. It would make the spread between power-ups look small and the \
         uncertainty far too good.",
        "Look at the two `file` lines in experiment.toml: one of them names the wrong file, or a file was copied under \
         two names. Remove the copy, or measure that run again with a power-up of its own.",
        "method, sections 5 and 9 (reproducibility)",
    )
}

pub(super) fn not_settled() -> Explanation {
    Explanation::new(
        format!(
            "In the second half of the run an estimate still differed from the final one by more than {STEP_LIMIT} \
             times what chance makes of such a difference."
        ),
        "Something changed during the run: the sensor warmed up, the table was moved, or one angle is wrong. The \
         run's values then depend on when it was stopped.",
        "Look at the figure \"How the estimates settle\". A slow slope: let the sensor warm up longer and repeat. A \
         single step: find the position where it comes, and check its angle and what happened there.",
        "method, section 5 (stabilization)",
    )
}

pub(super) fn not_converged() -> Explanation {
    Explanation::new(
        "The weights of the positions and the values computed with them do not come to rest, or the codes bound the \
         values without fixing them. The run is then fitted with equal weights, only to show its residuals.",
        "Sound data come to rest in a few steps. Where they do not, readings and angles do not belong together, and \
         there is no value to give.",
        "Look at the residuals in the report and find the positions that stand apart. Check their angles, check \
         `min_code` and `max_code` in [output], and measure again what is wrong.",
        "method, section 8; docs/likelihood.md",
    )
}

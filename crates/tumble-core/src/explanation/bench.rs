//! T03xx: what is known about table, gravity, noise and surroundings.

use super::Explanation;
use crate::assess::INFLUENCE_SIGNIFICANCE;
use crate::judge::limits::{
    ASSUMED_SHARE, DIFFERS_BY, LITTLE_DITHER_LSB2, NOTEWORTHY_FACTOR, RANGE_LIMIT_DEG, SLOW_NOISE,
    TABLE_SIGNIFICANCE,
};
use crate::nominal::DISAGREEMENT_LIMIT;
use crate::{DEFAULT_VERTICAL_LEAN_ARCMIN, STANDARD_GRAVITY_M_S2};

const LIKELIHOOD: &str = "method, section 8; docs/likelihood.md";

pub(super) fn table_worse() -> Explanation {
    Explanation::new(
        format!(
            "The positions scatter more than {NOTEWORTHY_FACTOR} times what `angle_uncertainty_arcmin` gives, and chance \
             does not explain it (p below {TABLE_SIGNIFICANCE})."
        ),
        "The table repeats worse than you say, or something drifts. The uncertainties follow the scatter that is there, \
         so they are honest; but a cause that you do not know may get worse.",
        "Compare with \"table repeats to\" in the summary. Set the angles more carefully, always from the same side. If \
         the table is simply like that, write that number as `angle_uncertainty_arcmin` in [bench].",
        "method, section 8; docs/estimators.md, Weights",
    )
}

pub(super) fn table_better() -> Explanation {
    Explanation::new(
        format!(
            "The positions scatter by less than 1/{NOTEWORTHY_FACTOR} of what `angle_uncertainty_arcmin` gives, and \
             chance does not explain it (p below {TABLE_SIGNIFICANCE})."
        ),
        "Good news: your table repeats better than you say. The uncertainties follow the scatter. Repeating well is not \
         being right: an eccentric dial repeats perfectly.",
        "If you like, write the number of \"table repeats to\" in the summary as `angle_uncertainty_arcmin` in [bench].",
        "method, sections 8 and 13; docs/estimators.md, Weights",
    )
}

pub(super) fn near_code_zero() -> Explanation {
    Explanation::new(
        "A converter that cuts toward zero was measured close to code zero (mean within 1 + 4 times the noise of a \
         sample), with a method that works on averages.",
        "Codes -1 to 1 stand for intervals of different widths there, and the rule \"add half with the sign\" is off by \
         up to half an LSB. With little noise that is more than all other errors.",
        "Use `--method likelihood`, which takes each code for the interval that it is. For the other methods shift \
         those angles by a degree.",
        LIKELIHOOD,
    )
}

pub(super) fn one_code_dwell() -> Explanation {
    Explanation::new(
        "All samples of some dwells have the same code.",
        "It is normal where the noise is small against one LSB. Such a dwell says only that the level lies somewhere \
         within that code; `--method likelihood` uses it as that.",
        "Nothing, if the uncertainty serves. More noise before the converter (a higher bandwidth) makes averages finer \
         than one code.",
        LIKELIHOOD,
    )
}

pub(super) fn little_dither() -> Explanation {
    Explanation::new(
        format!(
            "Within dwells the codes scatter by less than {:.2} LSB, which is what noise of about 0.3 LSB shows, and the \
             method works on averages.",
            LITTLE_DITHER_LSB2.sqrt()
        ),
        "Without enough noise the code hardly changes while the level moves by a whole LSB. Averages are then off by up \
         to half an LSB, differently at every angle: at 0.1 LSB of noise the bias comes out six times worse than it \
         could.",
        "Use `--method likelihood`. Or let more noise into the converter: raise the bandwidth of the filter before it.",
        LIKELIHOOD,
    )
}

pub(super) fn gravity_exact() -> Explanation {
    Explanation::new(
        "[bench] gives `gravity` without `gravity_uncertainty`: it is taken as exact.",
        "Gravity is the reference. A relative error of it goes one to one into the scale factor: 0.001 m/s² is 100 ppm. \
         It is not in the stated uncertainty now.",
        "Write `gravity_uncertainty = 0.0005` (m/s², standard) with the value that you know. Or give `latitude_deg` and \
         `height_m` in place of `gravity`; the uncertainty then comes along.",
        "method, section 10 (uncertainty budget)",
    )
}

pub(super) fn standard_gravity() -> Explanation {
    Explanation::new(
        format!("`gravity` in [bench] is exactly {STANDARD_GRAVITY_M_S2} m/s², the unit gn."),
        "It is a conversion factor and not what pulls at your bench. Local gravity differs from it by up to 0.3 %, and \
         the scale factor is then wrong by as much.",
        "Write the latitude and height of your laboratory in place of `gravity`: `latitude_deg = 50.0` and \
         `height_m = 150.0`. A gravity survey's value with its uncertainty is better still.",
        "method, section 10 (uncertainty budget)",
    )
}

pub(super) fn pair_for_scale_only() -> Explanation {
    Explanation::new(
        "[scale] has dwells with the axis up and down and does not say in which run's power-up they were taken. They \
         give the nominal scale only.",
        "Named, one pair makes the bias of a narrow plan four times better known (0.616 to 0.138 LSB at -30° to 29°). \
         But it must belong to the same power-up: smuggled into other runs it pulls all of them the same way, and a 95 % \
         interval of five such runs holds the truth 21 times of 100.",
        format!(
            "If the pair was taken without switching off before or after a run, write `run = \"run-1\"` in [scale], and \
             in [bench] `updown_lean_arcmin` (default {DEFAULT_VERTICAL_LEAN_ARCMIN}). Otherwise leave it."
        ),
        "method, section 7 (a); docs/decisions/0006-lean-of-upright-dwells.md",
    )
}

pub(super) fn nominal_scale_disagrees() -> Explanation {
    Explanation::new(
        format!(
            "`nominal_scale` in [output] differs from what the dwells with the axis up and down give by more than {:.0} \
             %. The stated value is used.",
            DISAGREEMENT_LIMIT * 100.0
        ),
        "Data sheets allow 4 to 8 %. So one of the two is wrong: the unit of the number, the range of the sensor, or \
         which file is up.",
        "Check that `nominal_scale` is in m/s² per LSB for the range in use, and that the file in `up` was measured with \
         the arrow of the axis upward. Or leave `nominal_scale` out: then the pair gives it.",
        "method, section 3 (nominal scale factor)",
    )
}

pub(super) fn temperature_effect() -> Explanation {
    Explanation::new(
        format!(
            "Within the runs the bias follows the recorded temperature, and chance does not explain it (p below \
             {INFLUENCE_SIGNIFICANCE}). The finding gives the effect per kelvin."
        ),
        "Temperature moved while the angles were measured, so part of its effect sits in the values. At another \
         temperature the bias will be another.",
        "Let the sensor warm up until its reading stands, keep drafts and sun away, and repeat. Use the passport near the \
         temperature that it was made at (`validity` in the passport).",
        "method, section 9 (influence of temperature and signal level)",
    )
}

pub(super) fn signal_level_effect() -> Explanation {
    Explanation::new(
        format!(
            "The error grows with the size of the acceleration, whatever its sign, and chance does not explain it (p \
             below {INFLUENCE_SIGNIFICANCE})."
        ),
        "One scale factor then does not suit both directions. A scale that differs by sign does this, and so does a \
         wrong angle at one end.",
        "Compare the residuals on both sides of 0° in the figure. One point apart: check its angle. Both wings: measure \
         another sensor on the same table to see whether sensor or dial is to blame.",
        "method, section 9 (influence of temperature and signal level)",
    )
}

pub(super) fn budget_incomplete() -> Explanation {
    Explanation::new(
        "Passports of versions before the budget say so, all of them: their uncertainty holds scatter, spread of the runs, \
         gravity and the lean of upright dwells, and nothing of the errors of the table that are the same in every run.",
        "They do not show in the scatter. 3' of eccentricity of the dial at ±65° shift the scale by 568 ppm or the bias \
         by 4.4 mm/s²; 1° of tilt of the table's axis together with 1° of lean of the sensor shifts the bias by 3.0 \
         mm/s² (0.39 LSB of the paper's sensor).",
        "Certify the experiment again: this version has them in the uncertainty, and says in T0328 what of it is assumed.",
        "method, section 10 (uncertainty budget); docs/budget.md",
    )
}

pub(super) fn budget_assumed() -> Explanation {
    Explanation::new(
        format!(
            "Quantities that experiment.toml does not state, and that the data cannot show, make up {:.0} % or more of the \
             variance of a parameter: the scale and eccentricity of the dial, tilt and lean, K2 and K3 where no data sheet is \
             known.",
            100.0 * ASSUMED_SHARE
        ),
        "The uncertainty is honest only if the defaults are as large as what your bench does. A dial is taken to be as \
         accurate as it is set, a bubble level and a hand as good as half a degree.",
        "State what you know in [bench] (docs/budget.md lists the keys). Check the dial against a polygon or an electronic \
         level; measure also with the body turned round (orientation = \"reversed\"), or with dwells at ±90°.",
        "method, section 10 (uncertainty budget); docs/budget.md",
    )
}

pub(super) fn intervals_differ() -> Explanation {
    Explanation::new(
        format!(
            "The uncertainty is computed twice: by propagation (value ± k u, Welch-Satterthwaite) and by drawing all inputs from \
             their distributions. Ends of the two intervals differ by more than {:.0} % of U. Smaller differences stand in the \
             passport alone.",
            100.0 * DIFFERS_BY
        ),
        "Propagation takes everything as proportional and nearly Gaussian. With few runs, or where tilt times lean counts, it is \
         not quite so; which of the two is wider depends on the case.",
        "Nothing, if the last digit of U does not matter. Else take the interval by Monte Carlo, which stands beside it in the \
         passport.",
        "JCGM 101:2008, clause 8; docs/budget.md",
    )
}

pub(super) fn no_angle_uncertainty() -> Explanation {
    Explanation::new(
        "[bench] has no `angle_uncertainty_arcmin`, the random error of setting an angle.",
        "Where scatter comes from the angle, positions near 0° are worth less than far ones. Unweighted, 3' of it \
         overstate the uncertainty of bias and scale by 23 % at ±65°. `--method likelihood` finds the scatter by itself, \
         less surely.",
        "Write what your table does, as a standard uncertainty in minutes of arc: `angle_uncertainty_arcmin = 3.0`. To \
         find it, set the same angle ten times from the same side and look how far the reading scatters.",
        "method, section 8; docs/estimators.md, Weights",
    )
}

pub(super) fn compensation_worse() -> Explanation {
    Explanation::new(
        "With the coefficients of the other runs this run's error is larger than without any compensation.",
        "The errors of this unit are smaller than what they repeat to, or the runs differ in something that the \
         coefficients do not hold. Compensating with them does not help.",
        "Look whether one run stands apart (another mounting, temperature or warm-up). Otherwise measure over wider \
         angles or more runs; if it stays so, the nominal scale and no bias serve this unit as well.",
        "method, section 12 (honest error level)",
    )
}

pub(super) fn slow_noise() -> Explanation {
    Explanation::new(
        format!(
            "The mean of a dwell scatters with more than {SLOW_NOISE} times the variance that its single samples \
             promise: the noise is not white (drift, 1/f noise)."
        ),
        "Averaging longer does not help as it should. It is in the uncertainty already.",
        "Nothing, if the uncertainty serves. Shorter dwells at more angles, or a longer warm-up, use the same time \
         better.",
        "method, section 8 (block means); docs/likelihood.md",
    )
}

pub(super) fn angle_outside_range() -> Explanation {
    Explanation::new(
        format!(
            "Dwells stand more than {RANGE_LIMIT_DEG}° outside `angle_range_deg` in [bench], and are not upright (±90°) \
             either."
        ),
        "Either the angle is wrong, or the table goes further than you say. Beyond its range a dial is often no longer \
         checked.",
        "Check the named angles against your notes. If they are right, write the true range, for instance \
         `angle_range_deg = [-70.0, 70.0]`.",
        "docs/experiment.md, `angle_range_deg`",
    )
}

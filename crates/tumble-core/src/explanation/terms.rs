//! T0321 to T0323: further terms of the model.

use super::Explanation;
use crate::assess::{PLAUSIBLE_K2_UG_G2, TERMS_FAMILY_LEVEL};

const SOURCE: &str = "method, section 8; IEEE 1293 (static model); docs/terms.md";

pub(super) fn term_entered() -> Explanation {
    Explanation::new(
        format!(
            "A further term of the sensor's model entered by itself: it is significant ({:.0} % over all terms tried \
             together), Schwarz' criterion favours it, the other values still reach their targets with it, all runs \
             agree on it, and its size is one that sensors have (K2 up to {PLAUSIBLE_K2_UG_G2:.0} ug/g2).",
            100.0 * TERMS_FAMILY_LEVEL
        ),
        "The coefficients now hold one more number, and a program that ignores it is wrong by up to \
         `terms_peak_m_s2`. The data cannot say whose error it is: an eccentric dial of 3.4' makes the same residuals as \
         1000 ug/g2 of K2, unless up and down dwells (±90°, off the table) are in the run.",
        "Check the dial, or measure another sensor on the same table: the same term in both is the table's. Add up and \
         down dwells to each power-up. `--terms none` leaves it out, `--terms k2` enters it without this warning.",
        SOURCE,
    )
}

pub(super) fn term_not_identifiable() -> Explanation {
    Explanation::new(
        "`--terms` names a term that these positions cannot tell from bias, misalignment and scale error, or with which \
         one of those would miss its target. It was left out.",
        "Entered all the same it would take the place of the others: with K2 at -30 to 29° the uncertainty of the bias \
         rises from 0.6 to 35 LSB.",
        "Measure over a wider range, and put one dwell with the axis up and one with it down into the same power-up. For \
         a term on temperature, let it change by several kelvin within the run. Or leave the term out of `--terms`.",
        SOURCE,
    )
}

pub(super) fn term_needs_temperature() -> Explanation {
    Explanation::new(
        "`--terms` names a term on temperature, and not every position has a temperature.",
        "Without temperatures the term has no values to be fitted to. It was left out, so the coefficients are not those \
         that you asked for.",
        "Give the temperature of every dwell in a column `temperature_degc`. Or leave `temp-bias` and `temp-scale` out \
         of `--terms`.",
        SOURCE,
    )
}
